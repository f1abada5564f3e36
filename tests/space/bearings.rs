//! Buildings on bearings that slide and yield in any direction.

use basemat::interface::Bonded;
use basemat::motion::{FreeField, Triaxial, el_centro_1940};
use basemat::structure::{
    BiaxialSpring, Bilinear, BoucWen, FrictionPendulum, LeadRubber, PlanStorey, RigidBody,
    StoreyBuilding,
};
use basemat::{Error, Simulation};

use super::cells::{BED, Bed, Cells, Waves};

const SIDE: f64 = 9.0;
const WEIGHT: f64 = 2.0e6;
const ABOVE: PlanStorey = PlanStorey {
    height: 3.0,
    mass: 0.8e5,
    inertia: [4.0e5, 4.0e5, 8.0e5],
    mass_center: [0.0; 2],
    stiffness: [1.0e8, 1.0e8, 2.0e9],
    stiffness_center: [0.0; 2],
    damping: [0.0; 3],
};

/// A slab on bearings, and a storey on it.
fn isolated(stiffness_center: [f64; 2]) -> StoreyBuilding {
    let slab = PlanStorey { height: 0.6, mass: 1.2e5, stiffness_center, ..ABOVE };
    let mat = RigidBody::cuboid([SIDE, SIDE, 1.0], 2400.0).unwrap();
    StoreyBuilding::new(mat, &[slab, ABOVE]).unwrap()
}

fn simulation(own: StoreyBuilding, bed: Bed, motion: impl FreeField + 'static) -> Simulation {
    Simulation::builder(4e-3)
        .structure(own)
        .ground(Cells::under([SIDE; 2], [0.0; 2], [3, 3], bed))
        .interface(Bonded)
        .motion(motion)
        .build()
        .unwrap()
}

/// The inertia of the floors is the force of the bearings, led along the same drifts outside the run.
#[test]
fn bearings_carry_the_floors_above() {
    let bouc_wen = BoucWen::new(2.0e7, 2.0e4, 0.05).unwrap().coupled().unwrap();
    let laws: [(BiaxialSpring, usize); 3] = [
        (FrictionPendulum::new(WEIGHT, 1.0, 0.01).unwrap().coupled(), 3),
        (LeadRubber::from_strength(2.0e6, 2.0e4).unwrap().coupled(), 3),
        (bouc_wen, 5),
    ];
    for (mut spring, variables) in laws {
        let own = isolated([0.4, -0.3]).with_biaxial_law(0, spring.clone()).unwrap();
        let (drifts, shears) = (own.drift(0).unwrap(), own.shear(0).unwrap());
        let mut simulation = simulation(own, BED, Waves { quarters: 0 });
        let (mut before, mut most, mut lag) = ([0.0; 2], 0.0_f64, 0.0_f64);
        for _ in 0..250 {
            let state = simulation.step().unwrap();
            let now = [0, 1].map(|k| drifts[k].value(state.displacement()));
            let middle = [0, 1].map(|k| 0.5 * (before[k] + now[k]));
            let force = spring.response(middle).force;
            for k in 0..2 {
                let found = shears[k].value(&[], &[], state.acceleration());
                assert!((found - force[k]).abs() < 1e-8 * 2.0e4, "{found} {force:?}");
            }
            most = most.max(force[0].hypot(force[1]));
            let turn = (force[0] * now[1] - force[1] * now[0]).abs();
            lag = lag.max(turn / (1.0 + force[0].hypot(force[1]) * now[0].hypot(now[1])));
            spring.commit(now);
            before = now;
        }
        assert_eq!(spring.save().len(), variables);
        let balance = simulation.state().energy_balance;
        let lost = spring.energy(before).dissipated;
        assert!((balance.hysteresis / lost - 1.0).abs() < 1e-9, "{} {lost}", balance.hysteresis);
        let run = simulation.run(1, |_| {}).unwrap();
        assert!(run.energy_error < 1e-9, "{}", run.energy_error);
        // Beyond the limit, and not along a line.
        assert!(most > 2.0e4 && lag > 0.3, "{most} {lag}");
        assert!(balance.algorithmic.abs() < 0.05 * balance.hysteresis, "{balance:?}");
    }
}

/// An isotropic building on bearings, shaken obliquely, moves along the line of the motion as if shaken along x on
/// uniaxial bearings.
#[test]
fn an_oblique_motion_is_a_motion_along_an_axis() {
    let bed = Bed { stiffness: [3.0e7, 2.0e7, 2.0e7], dashpot: [6.0e5, 3.0e5, 3.0e5] };
    let record = el_centro_1940().scaled(2.0).unwrap();
    let law = || Bilinear::new(4.0e7, 4.0e4, 0.05).unwrap();
    let along = isolated([0.0; 2]).with_law(0, StoreyBuilding::ALONG, law()).unwrap();
    let drifts = along.drift(0).unwrap();
    let motion = Triaxial { x: Some(record.clone()), ..Triaxial::default() };
    let mut straight = simulation(along, bed, motion);
    let oblique = isolated([0.0; 2]).with_biaxial_law(0, law().coupled()).unwrap();
    let [x, y] = [0.6, 0.8].map(|part| Some(record.scaled(part).unwrap()));
    let mut oblique = simulation(oblique, bed, Triaxial { x, y, ..Triaxial::default() });
    let mut most = 0.0_f64;
    for _ in 0..400 {
        let expected = drifts[0].value(straight.step().unwrap().displacement());
        let state = oblique.step().unwrap();
        let found = [0, 1].map(|k| drifts[k].value(state.displacement()));
        let error = (found[0] - 0.6 * expected).hypot(found[1] - 0.8 * expected);
        assert!(error < 1e-10, "{found:?} {expected}");
        most = most.max(expected.abs());
    }
    let lost = [straight, oblique].map(|run| run.state().energy_balance.hysteresis);
    assert!(most > 2e-3 && (lost[1] / lost[0] - 1.0).abs() < 1e-8, "{most} {lost:?}");
}

#[test]
fn a_storey_has_one_law_in_each_direction() {
    let own = || isolated([0.0; 2]);
    let law = || Bilinear::new(4.0e7, 4.0e4, 0.05).unwrap();
    let beyond = own().with_biaxial_law(2, law().coupled());
    assert!(matches!(beyond, Err(Error::Index { index: 2, bound: 2, .. })));
    for direction in [StoreyBuilding::ALONG, StoreyBuilding::ACROSS] {
        let first = own().with_law(0, direction, law()).unwrap();
        assert!(matches!(first.with_biaxial_law(0, law().coupled()), Err(Error::Scene { .. })));
        let first = own().with_biaxial_law(0, law().coupled()).unwrap();
        assert!(matches!(first.with_law(0, direction, law()), Err(Error::Scene { .. })));
    }
    let both = own().with_biaxial_law(0, law().coupled()).unwrap();
    assert!(both.with_law(0, StoreyBuilding::TWIST, law()).is_ok());
}
