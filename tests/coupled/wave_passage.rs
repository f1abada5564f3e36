//! GOAL: kinematic interaction under waves that run along the surface.
//! SCENE: a block that uplifts and slides; a weightless rigid base on springs under a harmonic
//! wave.
//! REFERENCE: vertical incidence as the limit of infinite velocity; averages of the free field.

use basemat::bem::{ElasticGround, SpringGround, Strip};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::{
    FreeField, FreeFieldFn, PlaneWave, STANDARD_GRAVITY, TravellingWave, el_centro_1940,
};
use basemat::results::{Quantity, Recorder};
use basemat::structure::RigidBlock;
use basemat::{Simulation, Soil};

const HALF: f64 = 4.0;
const OMEGA: f64 = 20.0;

/// Base shear of a block that uplifts and slides.
fn shear(motion: impl FreeField + 'static) -> Vec<f64> {
    let soil = Soil::new(8e7, 0.3, 1900.0).unwrap();
    let mut simulation = Simulation::builder(0.01)
        .structure(RigidBlock::new(2.0 * HALF, 14.0, 800.0).unwrap())
        .ground(ElasticGround::new(soil, Strip::uniform(-HALF..HALF, 8).unwrap()).unwrap())
        .interface(Coulomb::new(0.35).unwrap())
        .motion(motion)
        .gravity(STANDARD_GRAVITY)
        .build()
        .unwrap();
    let mut time_series = Recorder::new().start(&simulation).unwrap();
    let run = simulation.run(400, |state| time_series.record(state)).unwrap();
    assert!(run.whole.uplift.count > 0 && !run.whole.sliding.events.is_empty());
    time_series.series(Quantity::BaseShear).to_vec()
}

/// Ever faster and ever steeper waves become vertical incidence; slow ones are something else.
#[test]
fn fast_waves_are_vertical_incidence() {
    let record = el_centro_1940();
    let soil = Soil::new(8e7, 0.3, 1900.0).unwrap();
    let vertical = shear(record.clone());
    let largest = vertical.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let away = |other: Vec<f64>| {
        let pairs = vertical.iter().zip(&other);
        pairs.fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())) / largest
    };
    let run = |velocity| TravellingWave::new(record.clone(), velocity, -HALF).unwrap();
    let inclined =
        |angle| PlaneWave::sv(soil, angle).unwrap().field_from_horizontal(&record, -HALF);
    assert!(away(shear(run(1e10))) < 1e-4);
    assert!(away(shear(inclined(1e-8).unwrap())) < 1e-4);
    assert!(away(shear(run(200.0))) > 0.05);
    assert!(away(shear(inclined(0.4).unwrap())) > 0.05);
}

/// A weightless rigid base on even springs moves by the mean of the free field and turns by its
/// first moment, 3/(2b³) ∫ x u dx. In a harmonic wave that is sin κ/κ of its amplitude, and
/// 3 (sin κ − κ cos κ)/(κ² b), κ = ωb/c.
#[test]
fn a_light_rigid_base_averages_the_wave() {
    let pulse = |t: f64| (-((t - 3.6) / 1.2).powi(2)).exp() * (OMEGA * (t - 3.6)).cos();
    for velocity in [40.0, 120.0, -60.0] {
        let kappa = OMEGA * HALF / velocity;
        let field = FreeFieldFn::new(move |_, t| [0.02 * pulse(t), 0.01 * pulse(t)]);
        let origin = if velocity > 0.0 { -HALF } else { HALF };
        let wave = TravellingWave::new(field, velocity, origin).unwrap();
        let mut simulation = Simulation::builder(0.005)
            .structure(RigidBlock::new(2.0 * HALF, 0.1, 1.0).unwrap())
            .ground(SpringGround::new(-HALF..HALF, 64, 4e7, 2e7).unwrap())
            .interface(Bonded)
            .motion(wave)
            .build()
            .unwrap();
        let mut peaks = [0.0_f64; 3];
        simulation
            .run(1400, |state| {
                // The averages by the midpoint rule, far finer than the springs.
                let count = 1000;
                let mut known = [0.0; 3];
                for k in 0..count {
                    let x = HALF * (f64::from(2 * k + 1) / f64::from(count) - 1.0);
                    let value = pulse(state.time - (x - origin) / velocity) / f64::from(count);
                    known[0] += 0.02 * value;
                    known[1] += 0.01 * value;
                    known[2] += 0.01 * value * 3.0 * x / (HALF * HALF);
                }
                for ((found, known), (peak, scale)) in state
                    .absolute_displacement()
                    .iter()
                    .zip(known)
                    .zip(peaks.iter_mut().zip([0.02, 0.01, 0.01 / HALF]))
                {
                    assert!((found - known).abs() < 2e-3 * scale, "{velocity}: {found} {known}");
                    *peak = peak.max(found.abs());
                }
            })
            .unwrap();
        // The pulse is nearly harmonic at its middle.
        let translation = (kappa.sin() / kappa).abs();
        let rotation = 3.0 * (kappa.sin() - kappa * kappa.cos()).abs() / (kappa * kappa);
        for (peak, known) in
            peaks.iter().zip([0.02 * translation, 0.01 * translation, 0.01 * rotation / HALF])
        {
            assert!((peak / known - 1.0).abs() < 0.02, "{velocity}: {peak} {known}");
        }
    }
}
