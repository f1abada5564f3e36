//! Buildings on bearings that slide and yield in any direction.

use basemat::interface::Bonded;
use basemat::motion::{FreeField, Triaxial, el_centro_1940};
use basemat::structure::{
    BiaxialSpring, Bilinear, BoucWen, FrictionPendulum, LeadRubber, PlanStorey, RigidBody,
    StoreyBuilding,
};
use basemat::{Error, Simulation};

use super::cells::{BED_PROPERTIES, BedProperties, CrossingPulses, SpringCells};

const MAT_SIDE: f64 = 9.0;
const BEARING_WEIGHT: f64 = 2.0e6;
const UPPER_STOREY: PlanStorey = PlanStorey {
    height: 3.0,
    mass: 0.8e5,
    inertia: [4.0e5, 4.0e5, 8.0e5],
    mass_center: [0.0; 2],
    stiffness: [1.0e8, 1.0e8, 2.0e9],
    stiffness_center: [0.0; 2],
    damping: [0.0; 3],
};

/// A slab on bearings, and a storey on it.
fn isolated_building(stiffness_center: [f64; 2]) -> StoreyBuilding {
    let slab = PlanStorey { height: 0.6, mass: 1.2e5, stiffness_center, ..UPPER_STOREY };
    let mat = RigidBody::cuboid([MAT_SIDE, MAT_SIDE, 1.0], 2400.0).unwrap();
    StoreyBuilding::new(mat, &[slab, UPPER_STOREY]).unwrap()
}

fn simulation(
    building: StoreyBuilding,
    bed: BedProperties,
    motion: impl FreeField + 'static,
) -> Simulation {
    Simulation::builder(4e-3)
        .structure(building)
        .ground(SpringCells::under([MAT_SIDE; 2], [0.0; 2], [3, 3], bed))
        .interface(Bonded)
        .motion(motion)
        .build()
        .unwrap()
}

/// The law of a bearing that yields at 40 kN.
fn bilinear() -> Bilinear {
    Bilinear::new(4.0e7, 4.0e4, 0.05).unwrap()
}

/// The inertia of the floors is the force of the bearings, which are led along the same drifts outside the run.
#[test]
fn bearings_carry_the_floors_above() {
    let bouc_wen = BoucWen::new(2.0e7, 2.0e4, 0.05).unwrap().coupled().unwrap();
    let laws: [(BiaxialSpring, usize); 3] = [
        (FrictionPendulum::new(BEARING_WEIGHT, 1.0, 0.01).unwrap().coupled(), 3),
        (LeadRubber::from_strength(2.0e6, 2.0e4).unwrap().coupled(), 3),
        (bouc_wen, 5),
    ];
    for (mut spring, variables) in laws {
        let building = isolated_building([0.4, -0.3]).with_biaxial_law(0, spring.clone()).unwrap();
        let drifts = building.drift(0).unwrap();
        let shears = building.shear(0).unwrap();
        let mut simulation =
            simulation(building, BED_PROPERTIES, CrossingPulses { quarter_turns: 0 });
        let mut start = [0.0; 2];
        let mut max_force = 0.0_f64;
        let mut max_lag = 0.0_f64;
        for _ in 0..250 {
            let state = simulation.step().unwrap();
            let end = [0, 1].map(|k| drifts[k].value(state.displacement()));
            let midstep_drift = [0, 1].map(|k| 0.5 * (start[k] + end[k]));
            let force = spring.response(midstep_drift).force;
            for k in 0..2 {
                let computed = shears[k].value(&[], &[], state.acceleration());
                assert!((computed - force[k]).abs() < 1e-8 * 2.0e4, "{computed} {force:?}");
            }
            max_force = max_force.max(force[0].hypot(force[1]));
            let cross_product = (force[0] * end[1] - force[1] * end[0]).abs();
            let lag = cross_product / (1.0 + force[0].hypot(force[1]) * end[0].hypot(end[1]));
            max_lag = max_lag.max(lag);
            spring.commit(end);
            start = end;
        }
        assert_eq!(spring.save().len(), variables);
        let balance = simulation.state().energy_balance;
        let expected_hysteresis = spring.energy(start).dissipated;
        assert!(
            (balance.hysteresis / expected_hysteresis - 1.0).abs() < 1e-9,
            "{} {expected_hysteresis}",
            balance.hysteresis
        );
        let run = simulation.run(1, |_| {}).unwrap();
        assert!(run.energy_error < 1e-9, "{}", run.energy_error);
        // The bearings yield, and the force lags behind the drift in direction.
        assert!(max_force > 2.0e4 && max_lag > 0.3, "{max_force} {max_lag}");
        assert!(balance.algorithmic.abs() < 0.05 * balance.hysteresis, "{balance:?}");
    }
}

/// An isotropic building on bearings, shaken obliquely, moves along the line of the motion as if shaken along x on
/// uniaxial bearings.
#[test]
fn an_oblique_motion_is_a_motion_along_an_axis() {
    let bed = BedProperties { stiffness: [3.0e7, 2.0e7, 2.0e7], dashpot: [6.0e5, 3.0e5, 3.0e5] };
    let record = el_centro_1940().scaled(2.0).unwrap();
    let uniaxial = isolated_building([0.0; 2])
        .with_law(0, StoreyBuilding::DIRECTION_ALONG, bilinear())
        .unwrap();
    let drifts = uniaxial.drift(0).unwrap();
    let motion_along_x = Triaxial { x: Some(record.clone()), ..Triaxial::default() };
    let mut uniaxial_simulation = simulation(uniaxial, bed, motion_along_x);
    let biaxial = isolated_building([0.0; 2]).with_biaxial_law(0, bilinear().coupled()).unwrap();
    let oblique_motion = Triaxial {
        x: Some(record.scaled(0.6).unwrap()),
        y: Some(record.scaled(0.8).unwrap()),
        ..Triaxial::default()
    };
    let mut biaxial_simulation = simulation(biaxial, bed, oblique_motion);
    let mut max_drift = 0.0_f64;
    for _ in 0..400 {
        let expected = drifts[0].value(uniaxial_simulation.step().unwrap().displacement());
        let state = biaxial_simulation.step().unwrap();
        let computed = [0, 1].map(|k| drifts[k].value(state.displacement()));
        let error = (computed[0] - 0.6 * expected).hypot(computed[1] - 0.8 * expected);
        assert!(error < 1e-10, "{computed:?} {expected}");
        max_drift = max_drift.max(expected.abs());
    }
    let dissipated_energies =
        [uniaxial_simulation, biaxial_simulation].map(|run| run.state().energy_balance.hysteresis);
    assert!(
        max_drift > 2e-3 && (dissipated_energies[1] / dissipated_energies[0] - 1.0).abs() < 1e-8,
        "{max_drift} {dissipated_energies:?}"
    );
}

#[test]
fn a_storey_has_one_law_in_each_direction() {
    let building = isolated_building([0.0; 2]);
    let error_of_a_missing_storey = building.clone().with_biaxial_law(2, bilinear().coupled());
    assert!(matches!(error_of_a_missing_storey, Err(Error::Index { index: 2, bound: 2, .. })));
    for direction in [StoreyBuilding::DIRECTION_ALONG, StoreyBuilding::DIRECTION_ACROSS] {
        let uniaxial = building.clone().with_law(0, direction, bilinear()).unwrap();
        let error_of_a_second_law = uniaxial.with_biaxial_law(0, bilinear().coupled());
        assert!(matches!(error_of_a_second_law, Err(Error::Scene { .. })));
        let biaxial = building.clone().with_biaxial_law(0, bilinear().coupled()).unwrap();
        assert!(matches!(biaxial.with_law(0, direction, bilinear()), Err(Error::Scene { .. })));
    }
    let biaxial = building.with_biaxial_law(0, bilinear().coupled()).unwrap();
    assert!(biaxial.with_law(0, StoreyBuilding::DIRECTION_TWIST, bilinear()).is_ok());
}
