//! Rigid bases that stand eccentrically on springs without tension.

use basemat::Simulation;
use basemat::bem::SpringGround;
use basemat::bem::plan::Plan;
use basemat::interface::Coulomb;
use basemat::structure::RigidBody;

/// Static state of a base under a unit force on springs of unit stiffness per area.
#[derive(Debug)]
struct StandingBase {
    max_pressure: f64,
    contact_fraction: f64,
    /// Change of pressure per length along x and y.
    pressure_slopes: [f64; 2],
}

/// Static state of a base of `sides` under a unit force at `load_point`.
///
/// Cells are as large as the shorter side over `cells`.
fn stand(sides: [f64; 2], load_point: [f64; 2], cells: usize) -> StandingBase {
    let x = 0.5 * sides[0];
    let y = 0.5 * sides[1];
    let outline = vec![[-x, -y], [x, -y], [x, y], [-x, y]];
    let inertia = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let center = [load_point[0], load_point[1], 1e-3];
    let body = RigidBody::from_mass(outline, 1.0, inertia, center).unwrap();
    let plan = Plan::rectangle(-x..x, -y..y, cells).unwrap();
    let simulation = Simulation::builder(0.1)
        .gravity(1.0)
        .structure(body)
        .ground(SpringGround::in_plan(plan, [1.0; 3]).unwrap())
        .interface(Coulomb::new(0.5).unwrap())
        .build()
        .unwrap();
    let u = simulation.static_displacement();
    let slopes = [u[4], -u[3]];
    StandingBase {
        max_pressure: -u[2] + x * slopes[0] + y * slopes[1],
        contact_fraction: 1.0 - simulation.state().uplifted_fraction,
        pressure_slopes: slopes,
    }
}

/// Richardson extrapolation of errors of second order in the cell.
fn extrapolated(coarse: f64, fine: f64) -> f64 {
    (4.0 * fine - coarse) / 3.0
}

/// `winkler_biaxial.csv`: a sum over 1200 × 1200 points; closed forms inside the kern, one-way and on a triangle.
///
/// Errors of cells are of second order, so that two sizes give the limit.
#[test]
fn eccentric_bases_have_winklers_pressures() {
    let table = include_str!("../data/plan/winkler_biaxial.csv");
    for line in table.lines().skip(2) {
        let row: Vec<f64> = line.split(',').map(|number| number.parse().unwrap()).collect();
        let sides = [row[0], row[1]];
        let load_point = [row[2], row[3]];
        let expected_pressure = if row[8].is_nan() { row[4] } else { row[8] };
        let expected_slopes = [row[6], row[7]];
        let cells = if sides[1] < sides[0] { 8 } else { 12 };
        let coarse_base = stand(sides, load_point, cells);
        let fine_base = stand(sides, load_point, 2 * cells);
        let pressure = extrapolated(coarse_base.max_pressure, fine_base.max_pressure);
        let pressure_error = pressure / expected_pressure - 1.0;
        let difference: [f64; 2] = std::array::from_fn(|axis| {
            extrapolated(coarse_base.pressure_slopes[axis], fine_base.pressure_slopes[axis])
                - expected_slopes[axis]
        });
        let slope_size = expected_slopes[0].hypot(expected_slopes[1]);
        let slope_error = difference[0].hypot(difference[1]) / slope_size;
        println!(
            "{sides:?} {load_point:?}: pressure {pressure_error:.1e}, slope {slope_error:.1e}, {fine_base:?}"
        );
        assert!(pressure_error.abs() < 1e-3 && slope_error < 1.5e-3, "{sides:?} {load_point:?}");
        // A line through corners of cells cuts as many as there are along a side.
        let fraction_error = (fine_base.contact_fraction - row[5]).abs();
        assert!(fraction_error < 0.51 / (2 * cells) as f64, "{sides:?} {load_point:?}");
        let error_ratio = (coarse_base.max_pressure - expected_pressure).abs()
            / (fine_base.max_pressure - expected_pressure).abs();
        assert!((3.5..4.5).contains(&error_ratio), "{error_ratio}");
    }
}
