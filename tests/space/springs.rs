//! Bonded bodies on springs and dashpots in plan.

use basemat::bem::plan::Plan;
use basemat::bem::{Ground, SpringGround};
use basemat::coupled::Load;
use basemat::interface::Bonded;
use basemat::motion::{Record, Triaxial, el_centro_1940};
use basemat::structure::{DofCombination, RigidBody};
use basemat::{Error, Result, Simulation};

use super::cells::{Bed, Cells, Waves};
use super::equations::Cuboid;

const BED: Bed = Bed { stiffness: [3.0e7, 2.0e7, 1.4e7], dashpot: [6.0e5, 3.0e5, 3.0e5] };
/// Little, so that loads are not lost in the rounding of weight.
const GRAVITY: f64 = 0.1;
const CUBOID: Cuboid = Cuboid { sides: [8.0, 6.0, 9.0], density: 2000.0, center: [2.0, -1.0] };

fn body(cuboid: Cuboid) -> RigidBody {
    RigidBody::cuboid(cuboid.sides, cuboid.density).unwrap().centered_at(cuboid.center).unwrap()
}

/// Under the base of a cuboid, with so many cells along its shorter side.
fn bed(cuboid: Cuboid, count: usize, bed: Bed) -> Result<SpringGround> {
    let range = |axis: usize| {
        let [middle, half] = [cuboid.center[axis], 0.5 * cuboid.sides[axis]];
        middle - half..middle + half
    };
    let plan = Plan::rectangle(range(0), range(1), count)?;
    SpringGround::in_plan(plan, bed.stiffness)?.with_dashpots(bed.dashpot[0], bed.dashpot[1])
}

/// Displacement at rest under forces or moments along the six degrees of freedom.
fn at_rest(ground: SpringGround, forces: [f64; 6]) -> [f64; 6] {
    let mut builder =
        Simulation::builder(0.01).gravity(GRAVITY).structure(body(CUBOID)).ground(ground);
    for (dof, force) in forces.into_iter().enumerate() {
        builder = builder.load(Load::constant(DofCombination::from([(dof, 1.0)]), force));
    }
    let simulation = builder.interface(Bonded).build().unwrap();
    simulation.static_displacement().try_into().unwrap()
}

/// k A, and k times the second moments of area, minus the moments of each cell about its own
/// middle.
#[test]
fn springs_add_up_to_winklers_stiffness() {
    let ([l, b, _], [z, x, y]) = (CUBOID.sides, BED.stiffness);
    let tilting = |k: f64, side: f64, other: f64, count: f64| {
        k * other * side.powi(3) / 12.0 * (1.0 - 1.0 / (count * count))
    };
    let torsion = tilting(y, l, b, 8.0) + tilting(x, b, l, 6.0);
    let [about_x, about_y] = [tilting(z, b, l, 6.0), tilting(z, l, b, 8.0)];
    let stiffness = [x * l * b, y * l * b, z * l * b, about_x, about_y, torsion];
    let own = at_rest(bed(CUBOID, 6, BED).unwrap(), [0.0; 6]);
    let settled = own[2] * stiffness[2] / (GRAVITY * CUBOID.mass());
    assert!((settled + 1.0).abs() < 1e-9, "{settled}");
    for (dof, stiffness) in stiffness.into_iter().enumerate() {
        let mut forces = [0.0; 6];
        forces[dof] = 1e6;
        let loaded = at_rest(bed(CUBOID, 6, BED).unwrap(), forces);
        for (other, (loaded, own)) in loaded.into_iter().zip(own).enumerate() {
            let wanted = if other == dof { 1e6 / stiffness } else { 0.0 };
            let error = (loaded - own - wanted).abs() * stiffness / 1e6;
            assert!(error < 1e-10, "{dof} {other}: {loaded} {own} {wanted}");
        }
    }
}

/// The equations of motion of the same cells; errors of the step are of second order.
#[test]
fn a_cuboid_on_springs_follows_its_equations_of_motion() {
    let (waves, duration) = (Waves { quarters: 0 }, 0.8);
    let lines = |axis: usize, count: u32| -> Vec<f64> {
        let place = |k: u32| CUBOID.sides[axis] * (f64::from(k) / f64::from(count) - 0.5);
        (0..=count).map(|k| CUBOID.center[axis] + place(k)).collect()
    };
    let cells = Cells::between(&lines(0, 4), &lines(1, 3), BED);
    let exact = CUBOID.march(&cells, BED, &waves, duration / 1600.0, 1600);
    let march = |steps: usize| -> [f64; 6] {
        let mut simulation = Simulation::builder(duration / steps as f64)
            .structure(body(CUBOID))
            .ground(bed(CUBOID, 3, BED).unwrap())
            .interface(Bonded)
            .motion(waves)
            .build()
            .unwrap();
        let run = simulation.run(steps, |_| {}).unwrap();
        assert!(run.energy_error < 1e-10, "{}", run.energy_error);
        simulation.state().absolute_displacement().try_into().unwrap()
    };
    let [coarse, fine] = [march(200), march(400)];
    let size = exact.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    for ((coarse, fine), exact) in coarse.into_iter().zip(fine).zip(exact) {
        let extrapolated = (4.0 * fine - coarse) / 3.0;
        assert!((extrapolated - exact).abs() < 2e-6 * size, "{extrapolated} {exact}");
    }
}

/// A square bed answers a motion at 45 degrees as it does one along x.
#[test]
fn a_square_bed_has_no_directions() {
    let square = Cuboid { sides: [6.0, 6.0, 9.0], density: 2000.0, center: [0.0; 2] };
    let march = |x: Option<Record>, y: Option<Record>| -> [f64; 6] {
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
    };
    let along = march(Some(el_centro_1940()), None);
    let part = || Some(el_centro_1940().scaled(0.5_f64.sqrt()).unwrap());
    let slanting = march(part(), part());
    let [u, r] = [along[0], along[4]].map(|value| value * 0.5_f64.sqrt());
    let wanted = [u, u, along[2], -r, r, 0.0];
    for (found, wanted) in slanting.into_iter().zip(wanted) {
        assert!((found - wanted).abs() < 1e-12 * u.abs(), "{slanting:?} {wanted:?}");
    }
    assert!(u.abs() > 1e-4 && r.abs() > 1e-6 && along[5].abs() < 1e-12 * u.abs());
}

/// Cells of a bed end where the base does, and unions are made of these.
#[test]
fn springs_have_no_overhang() {
    let area = |ground: &SpringGround| -> f64 {
        ground.elements().iter().map(basemat::bem::ContactElement::area).sum()
    };
    let mat = || Plan::rectangle(-4.0..4.0, -4.0..4.0, 6).unwrap();
    let sizes = [1, 2, 2, 1];
    let joined = mat().without_overhang().unwrap().with_unions(&sizes, &sizes).unwrap();
    for (plan, count) in [(mat(), 36), (joined, 16)] {
        let ground = SpringGround::in_plan(plan, [1.0; 3]).unwrap();
        assert_eq!(ground.elements().len(), count);
        assert!((area(&ground) - 64.0).abs() < 1e-12);
    }
    let overhanging = mat().with_unions(&sizes, &sizes).unwrap();
    let error = SpringGround::in_plan(overhanging, [1.0; 3]).unwrap_err();
    assert!(matches!(error, Error::Scene { quantity: "plan with unions", .. }), "{error}");
    for axis in 0..3 {
        let mut stiffness = [1.0; 3];
        stiffness[axis] = -1.0;
        let error = SpringGround::in_plan(mat(), stiffness).unwrap_err();
        assert!(matches!(error, Error::Input { value: -1.0, .. }), "{error}");
    }
}
