//! GOAL: inclined waves out of range are errors, and extreme scales stay finite.
//! SCENE: angles, frequencies, motions and profiles without a solution; moduli and thicknesses over hundreds of decades.
//! REFERENCE: the typed error.

use std::f64::consts::FRAC_PI_2;

use basemat::motion::Record;
use basemat::site::{InclinedControl, InclinedWave};
use basemat::soil::{Elastic, Hysteretic, KelvinVoigt, SoilError, SoilProfile};
use basemat::{Error, Soil, unobserved};

use super::inclined_wave_reference::{BODY_WAVES, inclined};
use basemat_problems::profiles::{soft, two_layers};

/// GOAL: angles, frequencies, motions and profiles out of range give typed errors.
#[test]
fn invalid_waves_are_errors() {
    let elastic = two_layers(Elastic, Elastic);
    let control = InclinedControl::Incident;
    for wave in BODY_WAVES {
        for angle in [f64::NAN, f64::INFINITY, 1.6, -1.58, FRAC_PI_2] {
            let result = inclined(wave, elastic.clone(), angle);
            assert!(matches!(result, Err(Error::Input { .. })), "{angle} {result:?}");
        }
        let profile_on_rigid_bedrock =
            SoilProfile::on_rigid_bedrock().with_layer(soft(), 3.0).unwrap();
        let error = inclined(wave, profile_on_rigid_bedrock, 0.2).unwrap_err();
        assert!(matches!(error, Error::Scene { quantity: "inclined wave", .. }), "{error}");
        let inclined_wave = inclined(wave, elastic.clone(), 0.3).unwrap();
        for frequency in [-1.0, f64::NAN, f64::INFINITY] {
            assert!(inclined_wave.transfer(control, frequency).is_err());
        }
        for (time_step, motion) in [
            (0.0, vec![1.0]),
            (f64::NAN, vec![1.0]),
            (-0.1, vec![1.0]),
            (0.1, vec![]),
            (0.1, vec![f64::NAN]),
            (1e-320, vec![1.0]),
            (1e300, vec![1.0, 2.0]),
        ] {
            let outcome = inclined_wave.to_surface(control, time_step, &motion, &mut unobserved);
            assert!(outcome.is_err() || time_step == 1e300, "{time_step} {motion:?}");
        }
        let record = Record::new(0.01, vec![0.0, 1.0, 0.0]).unwrap();
        assert!(inclined_wave.field(control, &record, f64::NAN).is_err());
        let hysteretic = two_layers(Hysteretic::new(0.05).unwrap(), Elastic);
        let error = inclined(wave, hysteretic, 0.3)
            .unwrap()
            .to_surface(control, 0.01, &[1.0], &mut unobserved)
            .unwrap_err();
        assert!(matches!(error, Error::Soil(SoilError::NotCausal { layer: 1, .. })));
    }
}

/// GOAL: controls in whose direction the outcrop hardly moves, and motions beyond a critical angle or without a wave front,
/// are errors.
#[test]
fn waves_without_a_causal_motion_are_errors() {
    let elastic = two_layers(Elastic, Elastic);
    for (wave, control) in [
        (InclinedWave::sv(elastic.clone(), 0.0).unwrap(), InclinedControl::OutcropVertical),
        (InclinedWave::p(elastic.clone(), 0.0).unwrap(), InclinedControl::OutcropHorizontal),
    ] {
        assert!(matches!(wave.transfer(control, 1.0), Err(Error::Input { .. })));
        assert!(wave.to_surface(control, 0.01, &[1.0], &mut unobserved).is_err());
    }
    // The rock's critical angle is 35.3°. Waves of a Kelvin–Voigt soil have no largest speed, and so no front.
    let control = InclinedControl::OutcropHorizontal;
    let wave_beyond_critical_angle = InclinedWave::sv(elastic, 36.0_f64.to_radians()).unwrap();
    assert!(wave_beyond_critical_angle.transfer(control, 1.0).is_ok());
    let error = wave_beyond_critical_angle
        .to_surface(control, 0.01, &[1.0, 0.0], &mut unobserved)
        .unwrap_err();
    assert!(matches!(error, Error::Soil(SoilError::BeyondCritical { layer: 3, .. })), "{error}");
    let stiffening = two_layers(Elastic, KelvinVoigt::with_ratio(0.05, 1.0).unwrap());
    let wave = InclinedWave::sv(stiffening, 0.4).unwrap();
    assert!(wave.to_surface(control, 0.01, &[1.0, 0.0], &mut unobserved).is_err());
}

/// GOAL: extreme scales give finite numbers or a typed error.
#[test]
fn extreme_scales_give_finite_numbers_or_errors() {
    let control = InclinedControl::Incident;
    let mut finite_count = 0;
    let mut error_count = 0;
    for modulus in [1e-150, 1.0, 1e150] {
        for thickness in [1e-200, 1.0, 1e200] {
            for poisson in [-0.99, 0.0, 0.4999] {
                let layer = Soil::new(modulus, poisson, 1.0).unwrap();
                let profile = SoilProfile::on_half_plane(Soil::new(1.0, 0.3, 1.0).unwrap())
                    .with_layer(layer, thickness)
                    .unwrap();
                for wave in BODY_WAVES {
                    for angle in [1e-14 - FRAC_PI_2, -1e-300, 0.0, 0.3, 1.2] {
                        let inclined_wave = inclined(wave, profile.clone(), angle).unwrap();
                        for frequency in [0.0, 1e-300, 1.0, 1e300, f64::MAX] {
                            match inclined_wave.transfer(control, frequency) {
                                Ok(transfer) => {
                                    assert!(transfer.iter().all(|x| x.abs().is_finite()));
                                    finite_count += 1;
                                }
                                Err(_) => error_count += 1,
                            }
                        }
                        let outcome =
                            inclined_wave.to_surface(control, 0.01, &[0.0, 1.0], &mut unobserved);
                        for motion in outcome.iter().flatten() {
                            assert!(motion.samples.iter().all(|x| x.is_finite()));
                        }
                    }
                }
            }
        }
    }
    println!("{finite_count} finite, {error_count} errors");
    assert!(finite_count > 500 && error_count > 0);
}
