//! Bonded bodies on springs and dashpots in space.

use std::ops::Range;

use basemat::bem::plan::Plan;
use basemat::bem::{ContactElement, Ground, SpringGround};
use basemat::coupled::Load;
use basemat::interface::Bonded;
use basemat::motion::{Record, Triaxial, el_centro_1940};
use basemat::structure::{DofCombination, RigidBody};
use basemat::{Error, Result, Simulation};

use super::cells::{BedProperties, CrossingPulses, SpringCells};
use super::equations::Cuboid;

const SPRING_PROPERTIES: BedProperties =
    BedProperties { stiffness: [3.0e7, 2.0e7, 1.4e7], dashpot: [6.0e5, 3.0e5, 3.0e5] };
/// Gravity so small that loads are not lost in the rounding of weight, m/s².
const SMALL_GRAVITY: f64 = 0.1;
/// Load along one degree of freedom, N or N·m.
const UNIT_LOAD: f64 = 1e6;
const ECCENTRIC_CUBOID: Cuboid =
    Cuboid { sides: [8.0, 6.0, 9.0], density: 2000.0, center: [2.0, -1.0] };

fn body(cuboid: Cuboid) -> RigidBody {
    RigidBody::cuboid(cuboid.sides, cuboid.density)
        .unwrap()
        .centered_at(cuboid.center)
        .unwrap()
}

/// The eccentric cuboid's base along an axis.
fn base_range(axis: usize) -> Range<f64> {
    let half = 0.5 * ECCENTRIC_CUBOID.sides[axis];
    ECCENTRIC_CUBOID.center[axis] - half..ECCENTRIC_CUBOID.center[axis] + half
}

/// A bed under the eccentric cuboid, with `count` cells along its shorter side.
fn bed(count: usize) -> Result<SpringGround> {
    let plan = Plan::rectangle(base_range(0), base_range(1), count)?;
    let dashpot = SPRING_PROPERTIES.dashpot;
    SpringGround::in_plan(plan, SPRING_PROPERTIES.stiffness)?.with_dashpots(dashpot[0], dashpot[1])
}

/// Displacement at rest under forces or moments along the six degrees of freedom.
fn static_displacement(ground: SpringGround, forces: [f64; 6]) -> [f64; 6] {
    let mut builder = Simulation::builder(0.01)
        .gravity(SMALL_GRAVITY)
        .structure(body(ECCENTRIC_CUBOID))
        .ground(ground);
    for (dof, force) in forces.into_iter().enumerate() {
        builder = builder.load(Load::constant(DofCombination::from([(dof, 1.0)]), force));
    }
    let simulation = builder.interface(Bonded).build().unwrap();
    simulation.static_displacement().try_into().unwrap()
}

/// Rocking stiffness of `count` rows of cells along `side`, without the moments of the cells about their middles.
fn rocking_stiffness(stiffness: f64, side: f64, other_side: f64, count: f64) -> f64 {
    stiffness * other_side * side.powi(3) / 12.0 * (1.0 - 1.0 / (count * count))
}

/// k A, and k times the second moments of area, minus the moments of each cell about its middle.
#[test]
fn springs_add_up_to_winklers_stiffness() {
    let [l, b, _] = ECCENTRIC_CUBOID.sides;
    let [z, x, y] = SPRING_PROPERTIES.stiffness;
    let torsion = rocking_stiffness(y, l, b, 8.0) + rocking_stiffness(x, b, l, 6.0);
    let about_x = rocking_stiffness(z, b, l, 6.0);
    let about_y = rocking_stiffness(z, l, b, 8.0);
    let stiffness = [x * l * b, y * l * b, z * l * b, about_x, about_y, torsion];
    let unloaded_displacement = static_displacement(bed(6).unwrap(), [0.0; 6]);
    let settlement_ratio =
        unloaded_displacement[2] * stiffness[2] / (SMALL_GRAVITY * ECCENTRIC_CUBOID.mass());
    assert!((settlement_ratio + 1.0).abs() < 1e-9, "{settlement_ratio}");
    for (dof, stiffness) in stiffness.into_iter().enumerate() {
        let mut forces = [0.0; 6];
        forces[dof] = UNIT_LOAD;
        let loaded_displacement = static_displacement(bed(6).unwrap(), forces);
        for (other, (loaded_displacement, unloaded_displacement)) in
            loaded_displacement.into_iter().zip(unloaded_displacement).enumerate()
        {
            let expected = if other == dof { UNIT_LOAD / stiffness } else { 0.0 };
            let error = (loaded_displacement - unloaded_displacement - expected).abs() * stiffness
                / UNIT_LOAD;
            assert!(
                error < 1e-10,
                "{dof} {other}: {loaded_displacement} {unloaded_displacement} {expected}"
            );
        }
    }
}

/// Boundaries of `count` cells along a side of the eccentric cuboid.
fn cell_boundaries(axis: usize, count: u32) -> Vec<f64> {
    (0..=count)
        .map(|k| ECCENTRIC_CUBOID.sides[axis] * (f64::from(k) / f64::from(count) - 0.5))
        .map(|place| ECCENTRIC_CUBOID.center[axis] + place)
        .collect()
}

/// Displacement of the eccentric cuboid after `duration`.
fn displacement_after(duration: f64, steps: usize) -> [f64; 6] {
    let mut simulation = Simulation::builder(duration / steps as f64)
        .structure(body(ECCENTRIC_CUBOID))
        .ground(bed(3).unwrap())
        .interface(Bonded)
        .motion(CrossingPulses { quarter_turns: 0 })
        .build()
        .unwrap();
    let run = simulation.run(steps, |_| {}).unwrap();
    assert!(run.energy_error < 1e-10, "{}", run.energy_error);
    simulation.state().absolute_displacement().try_into().unwrap()
}

/// The equations of motion of the same cells; errors of the step are of second order.
#[test]
fn a_cuboid_on_springs_follows_its_equations_of_motion() {
    let duration = 0.8;
    let cells =
        SpringCells::between(&cell_boundaries(0, 4), &cell_boundaries(1, 3), SPRING_PROPERTIES);
    let pulses = CrossingPulses { quarter_turns: 0 };
    let expected =
        ECCENTRIC_CUBOID.march(&cells, SPRING_PROPERTIES, &pulses, duration / 1600.0, 1600);
    let coarse_displacement = displacement_after(duration, 200);
    let fine_displacement = displacement_after(duration, 400);
    let size = expected.iter().fold(0.0_f64, |max, x| max.max(x.abs()));
    for ((coarse_displacement, fine_displacement), expected) in
        coarse_displacement.into_iter().zip(fine_displacement).zip(expected)
    {
        let extrapolated_displacement = (4.0 * fine_displacement - coarse_displacement) / 3.0;
        assert!(
            (extrapolated_displacement - expected).abs() < 2e-6 * size,
            "{extrapolated_displacement} {expected}"
        );
    }
}

/// Displacement of a square body shaken along x and y.
fn shaken_square(x: Option<Record>, y: Option<Record>) -> [f64; 6] {
    let square = Cuboid { sides: [6.0, 6.0, 9.0], density: 2000.0, center: [0.0; 2] };
    // As `under` makes it: one tangential stiffness for both directions.
    let ground = SpringGround::under(&body(square), 5, 3e7, 2e7).unwrap();
    let mut simulation = Simulation::builder(5e-3)
        .structure(body(square))
        .ground(ground.with_dashpots(6e5, 3e5).unwrap())
        .interface(Bonded)
        .motion(Triaxial { x, y, ..Triaxial::default() })
        .build()
        .unwrap();
    simulation.run(400, |_| {}).unwrap();
    simulation.state().absolute_displacement().try_into().unwrap()
}

/// A square bed responds to a motion at 45 degrees as it does to one along x.
#[test]
fn a_square_bed_responds_at_45_degrees_as_along_x() {
    let along_x = shaken_square(Some(el_centro_1940()), None);
    let component = el_centro_1940().scaled(0.5_f64.sqrt()).unwrap();
    let diagonal = shaken_square(Some(component.clone()), Some(component));
    let u = along_x[0] * 0.5_f64.sqrt();
    let r = along_x[4] * 0.5_f64.sqrt();
    let expected = [u, u, along_x[2], -r, r, 0.0];
    for (computed, value) in diagonal.into_iter().zip(expected) {
        assert!((computed - value).abs() < 1e-12 * u.abs(), "{diagonal:?} {expected:?}");
    }
    assert!(u.abs() > 1e-4 && r.abs() > 1e-6 && along_x[5].abs() < 1e-12 * u.abs());
}

fn square_mat() -> Plan {
    Plan::rectangle(-4.0..4.0, -4.0..4.0, 6).unwrap()
}

/// Cells of a bed end at the outline of the base, and so do unions of them.
#[test]
fn springs_have_no_overhang() {
    let union_sizes = [1, 2, 2, 1];
    let united = square_mat()
        .without_overhang()
        .unwrap()
        .with_unions(&union_sizes, &union_sizes)
        .unwrap();
    for (plan, count) in [(square_mat(), 36), (united, 16)] {
        let ground = SpringGround::in_plan(plan, [1.0; 3]).unwrap();
        assert_eq!(ground.elements().len(), count);
        let area: f64 = ground.elements().iter().map(ContactElement::area).sum();
        assert!((area - 64.0).abs() < 1e-12);
    }
    let overhanging = square_mat().with_unions(&union_sizes, &union_sizes).unwrap();
    let error = SpringGround::in_plan(overhanging, [1.0; 3]).unwrap_err();
    assert!(matches!(error, Error::Scene { quantity: "plan with unions", .. }), "{error}");
    for axis in 0..3 {
        let mut stiffness = [1.0; 3];
        stiffness[axis] = -1.0;
        let error = SpringGround::in_plan(square_mat(), stiffness).unwrap_err();
        assert!(matches!(error, Error::Input { value: -1.0, .. }), "{error}");
    }
}
