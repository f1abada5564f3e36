//! GOAL: floor response spectra and their broadening are right.
//! SCENE: a light block on stiff ground; a triangular peak.
//! REFERENCE: the spectrum of the ground; the wording of the guide.

use basemat::bem::{ElasticGround, Strip};
use basemat::coupled::Probe;
use basemat::interface::Bonded;
use basemat::motion::{SpectralOrdinate, el_centro_1940};
use basemat::results::{Recorder, broadened, log_spaced};
use basemat::structure::RigidBlock;
use basemat::{Simulation, Soil, unobserved};

/// A light block bonded to stiff ground moves with the ground, and has its response spectrum.
#[test]
fn floors_of_a_light_rigid_block_move_as_the_ground() {
    let ground = ElasticGround::new(
        Soil::new(2e9, 0.3, 2000.0).unwrap(),
        Strip::uniform(-2.0..2.0, 4).unwrap(),
    );
    let block = RigidBlock::new(4.0, 1.0, 10.0).unwrap();
    let top = block.horizontal_at(1.0);
    let mut simulation = Simulation::builder(0.01)
        .structure(block)
        .ground(ground.unwrap())
        .interface(Bonded)
        .motion(el_centro_1940())
        .probe(Probe::acceleration("top", top))
        .build()
        .unwrap();
    let mut time_series = Recorder::new().start(&simulation).unwrap();
    let run = simulation.run(1500, |state| time_series.record(state)).unwrap();
    assert_eq!(run.steps, 1500);
    let periods = log_spaced(0.2, 3.0, 12).unwrap();
    let floor = time_series.floor_spectrum("top", &periods, 0.05).unwrap();
    let ground = el_centro_1940().response_spectrum(&periods, 0.05, &mut unobserved).unwrap();
    for (floor, ground) in floor.iter().zip(&ground) {
        let ratio = floor.pseudo_acceleration / ground.pseudo_acceleration;
        assert!((ratio - 1.0).abs() < 0.02, "T = {}: {ratio}", floor.period);
    }
    let record = time_series.acceleration_record("top").unwrap();
    assert_eq!(record.accelerations(), time_series.probe("top").unwrap());
}

fn ordinate(period: f64, value: f64) -> SpectralOrdinate {
    SpectralOrdinate {
        period,
        displacement: value,
        pseudo_velocity: 2.0 * value,
        pseudo_acceleration: 3.0 * value,
        acceleration: 4.0 * value,
    }
}

/// A triangle of height three over ln T, its top at f_j = 1 Hz.
fn triangle(period: f64) -> f64 {
    3.0 - period.ln().abs()
}

/// As in the guide, the peak at f_j extends from 0.85 f_j to 1.15 f_j, and every point of its slopes is shifted like
/// the peak.
#[test]
fn broadened_peaks_are_plateaus() {
    let periods = log_spaced(0.1, 10.0, 401).unwrap();
    let spectrum: Vec<_> = periods.iter().map(|&t| ordinate(t, triangle(t))).collect();
    for (broadened_point, &period) in broadened(&spectrum, 0.15).unwrap().iter().zip(&periods) {
        let frequency = 1.0 / period;
        let expected = if (0.85..=1.15).contains(&frequency) {
            3.0
        } else if frequency < 0.85 {
            // The peak at the frequency f has moved to 0.85 f.
            triangle(0.85 / frequency)
        } else {
            triangle(1.15 / frequency)
        };
        assert!((broadened_point.displacement - expected).abs() < 1e-12, "{frequency}");
        assert_eq!(broadened_point.acceleration, 4.0 * broadened_point.displacement);
    }
    // A peak at one period extends over the same range.
    let mut single_peak: Vec<_> = periods.iter().map(|&t| ordinate(t, 0.0)).collect();
    let spike = 200;
    single_peak[spike] = ordinate(periods[spike], 1.0);
    for (broadened_point, &period) in broadened(&single_peak, 0.15).unwrap().iter().zip(&periods) {
        let fraction = periods[spike] / period;
        if (0.851..1.149).contains(&fraction) {
            assert_eq!(broadened_point.displacement, 1.0, "{fraction}");
        } else if !(0.83..1.17).contains(&fraction) {
            assert_eq!(broadened_point.displacement, 0.0, "{fraction}");
        }
    }
    assert_eq!(broadened(&spectrum, 0.0).unwrap(), spectrum);
    assert!(broadened(&[], 0.15).unwrap().is_empty());
    for fraction in [-0.1, 1.0, f64::NAN, f64::INFINITY] {
        assert!(broadened(&spectrum, fraction).is_err());
    }
    assert!(broadened(&[spectrum[1], spectrum[0]], 0.1).is_err());
    assert!(broadened(&[ordinate(f64::NAN, 1.0)], 0.1).is_err());
}
