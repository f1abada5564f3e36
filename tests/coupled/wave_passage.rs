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

const BASE_HALF_WIDTH: f64 = 4.0;
const CIRCULAR_FREQUENCY: f64 = 20.0;

/// Base shear of a block that uplifts and slides.
fn base_shear(motion: impl FreeField + 'static) -> Vec<f64> {
    let soil = Soil::new(8e7, 0.3, 1900.0).unwrap();
    let mut simulation = Simulation::builder(0.01)
        .structure(RigidBlock::new(2.0 * BASE_HALF_WIDTH, 14.0, 800.0).unwrap())
        .ground(
            ElasticGround::new(soil, Strip::uniform(-BASE_HALF_WIDTH..BASE_HALF_WIDTH, 8).unwrap())
                .unwrap(),
        )
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

/// Largest difference of two series over the largest value of the first.
fn relative_difference(reference: &[f64], series: &[f64]) -> f64 {
    let max_magnitude = reference.iter().fold(0.0_f64, |max, value| max.max(value.abs()));
    let pairs = reference.iter().zip(series);
    pairs.fold(0.0_f64, |max, (a, b)| max.max((a - b).abs())) / max_magnitude
}

/// Fast and steep waves tend to vertical incidence; slow and flat ones differ.
#[test]
fn fast_waves_are_vertical_incidence() {
    let record = el_centro_1940();
    let soil = Soil::new(8e7, 0.3, 1900.0).unwrap();
    let vertical = base_shear(record.clone());
    for (velocity, is_fast) in [(1e10, true), (200.0, false)] {
        let wave = TravellingWave::new(record.clone(), velocity, -BASE_HALF_WIDTH).unwrap();
        let difference = relative_difference(&vertical, &base_shear(wave));
        assert!(if is_fast { difference < 1e-4 } else { difference > 0.05 }, "{velocity}");
    }
    for (angle, is_steep) in [(1e-8, true), (0.4, false)] {
        let wave = PlaneWave::sv(soil, angle).unwrap();
        let field = wave.field_from_horizontal(&record, -BASE_HALF_WIDTH).unwrap();
        let difference = relative_difference(&vertical, &base_shear(field));
        assert!(if is_steep { difference < 1e-4 } else { difference > 0.05 }, "{angle}");
    }
}

/// A wave packet of unit amplitude, nearly harmonic at its middle.
fn wave_packet(time: f64) -> f64 {
    (-((time - 3.6) / 1.2).powi(2)).exp() * (CIRCULAR_FREQUENCY * (time - 3.6)).cos()
}

/// Mean of the free field over the base, and its rotation by the first moment, by the midpoint rule.
fn base_averages(time: f64, velocity: f64, origin: f64) -> [f64; 3] {
    // Far more points than springs.
    let count = 1000;
    let mut averages = [0.0; 3];
    for k in 0..count {
        let x = BASE_HALF_WIDTH * (f64::from(2 * k + 1) / f64::from(count) - 1.0);
        let value = wave_packet(time - (x - origin) / velocity) / f64::from(count);
        averages[0] += 0.02 * value;
        averages[1] += 0.01 * value;
        averages[2] += 0.01 * value * 3.0 * x / (BASE_HALF_WIDTH * BASE_HALF_WIDTH);
    }
    averages
}

/// A weightless rigid base on even springs moves by the mean of the free field.
///
/// It turns by the first moment, 3/(2b³) ∫ x u dx. In a harmonic wave the mean is sin κ/κ of its amplitude, and the
/// rotation is 3 (sin κ − κ cos κ)/(κ² b), κ = ωb/c.
#[test]
fn a_light_rigid_base_averages_the_wave() {
    for velocity in [40.0, 120.0, -60.0] {
        let kappa = CIRCULAR_FREQUENCY * BASE_HALF_WIDTH / velocity;
        let field =
            FreeFieldFn::new(|_, time| [0.02 * wave_packet(time), 0.01 * wave_packet(time)]);
        let origin = if velocity > 0.0 { -BASE_HALF_WIDTH } else { BASE_HALF_WIDTH };
        let wave = TravellingWave::new(field, velocity, origin).unwrap();
        let mut simulation = Simulation::builder(0.005)
            .structure(RigidBlock::new(2.0 * BASE_HALF_WIDTH, 0.1, 1.0).unwrap())
            .ground(SpringGround::new(-BASE_HALF_WIDTH..BASE_HALF_WIDTH, 64, 4e7, 2e7).unwrap())
            .interface(Bonded)
            .motion(wave)
            .build()
            .unwrap();
        let scales = [0.02, 0.01, 0.01 / BASE_HALF_WIDTH];
        let mut peaks = [0.0_f64; 3];
        simulation
            .run(1400, |state| {
                let displacement = state.absolute_displacement();
                let averages = base_averages(state.time, velocity, origin);
                for k in 0..3 {
                    let error = (displacement[k] - averages[k]).abs();
                    assert!(error < 2e-3 * scales[k], "{velocity}: {displacement:?} {averages:?}");
                    peaks[k] = peaks[k].max(displacement[k].abs());
                }
            })
            .unwrap();
        let translation = (kappa.sin() / kappa).abs();
        let rotation = 3.0 * (kappa.sin() - kappa * kappa.cos()).abs() / (kappa * kappa);
        let expected = [0.02 * translation, 0.01 * translation, 0.01 * rotation / BASE_HALF_WIDTH];
        for (peak, expected) in peaks.iter().zip(expected) {
            assert!((peak / expected - 1.0).abs() < 0.02, "{velocity}: {peak} {expected}");
        }
    }
}
