//! Rigid bases that stand eccentrically on springs without tension.

use basemat::Simulation;
use basemat::bem::SpringGround;
use basemat::bem::plan::Plan;
use basemat::interface::Coulomb;
use basemat::structure::RigidBody;

/// Greatest pressure, slopes of pressure and part in contact of a base of `sides` under a unit force at `at`, springs of
/// one per area in cells as large as its shorter side over `cells`.
fn stand(sides: [f64; 2], at: [f64; 2], cells: usize) -> [f64; 4] {
    let [x, y] = sides.map(|side| 0.5 * side);
    let outline = vec![[-x, -y], [x, -y], [x, y], [-x, y]];
    let inertia = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let body = RigidBody::from_mass(outline, 1.0, inertia, [at[0], at[1], 1e-3]).unwrap();
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
    let corner = -u[2] + x * slopes[0] + y * slopes[1];
    [corner, 1.0 - simulation.state().uplifted_fraction, slopes[0], slopes[1]]
}

/// `winkler_biaxial.csv`: a sum over 1200 × 1200 points; inside the kern, one-way and on a triangle closed forms. Errors of
/// cells are of second order, so that two sizes tell what none would leave.
#[test]
fn eccentric_bases_have_winklers_pressures() {
    let table = include_str!("../data/plan/winkler_biaxial.csv");
    for line in table.lines().skip(2) {
        let row: Vec<f64> = line.split(',').map(|number| number.parse().unwrap()).collect();
        let (sides, at) = ([row[0], row[1]], [row[2], row[3]]);
        let largest = if row[8].is_nan() { row[4] } else { row[8] };
        let cells = if sides[1] < sides[0] { 8 } else { 12 };
        let [coarse, fine] = [cells, 2 * cells].map(|cells| stand(sides, at, cells));
        let extrapolated = |k: usize| (4.0 * fine[k] - coarse[k]) / 3.0;
        let pressure = extrapolated(0) / largest - 1.0;
        let size = row[6].hypot(row[7]);
        let slope = (extrapolated(2) - row[6]).hypot(extrapolated(3) - row[7]) / size;
        println!("{sides:?} {at:?}: pressure {pressure:.1e}, slope {slope:.1e}, {fine:?}");
        assert!(pressure.abs() < 1e-3 && slope < 1.5e-3, "{sides:?} {at:?}");
        // A line through corners of cells cuts as many as there are along a side.
        assert!((fine[1] - row[5]).abs() < 0.51 / (2 * cells) as f64, "{sides:?} {at:?}");
        let lost = (coarse[0] - largest).abs() / (fine[0] - largest).abs();
        assert!((3.5..4.5).contains(&lost), "{lost}");
    }
}
