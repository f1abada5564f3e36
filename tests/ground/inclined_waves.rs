//! GOAL: SV and P waves at an angle move the surface of layered ground correctly.
//! SCENE: elastic and damped layers on rock, angles on both sides of the critical ones.
//! REFERENCE: vertical columns, plane waves of a half-plane, all waves of a layer solved at once,
//! the energy that a surface load radiates, integrals over frequency.

use std::f64::consts::{PI, TAU};

use basemat::motion::{FreeField, PlaneWave, Record};
use basemat::site::{ControlPoint, InclinedControl, InclinedWave, SoilColumn, VerticalWave};
use basemat::soil::{Elastic, SoilProfile};
use basemat::{Complex, Soil, unobserved};

use super::inclined_wave_reference::{BODY_WAVES, BodyWave, LayerOnHalfPlane, SoilWaves, inclined};
use basemat_problems::profiles::{constant_q, one_layer, rock, soft, two_layers};

/// GOAL: at an angle of zero SV and P waves are those of the column.
#[test]
fn vertical_waves_are_those_of_the_column() {
    let mut largest_error = 0.0_f64;
    for profile in [two_layers(Elastic, Elastic), two_layers(constant_q(0.05), constant_q(0.02))] {
        for (wave, vertical, component, control) in [
            (BodyWave::Sv, VerticalWave::Shear, 0, InclinedControl::OutcropHorizontal),
            (BodyWave::P, VerticalWave::Pressure, 1, InclinedControl::OutcropVertical),
        ] {
            let column = SoilColumn::new(profile.clone(), vertical).unwrap();
            let inclined_wave = inclined(wave, profile.clone(), 0.0).unwrap();
            for frequency in [0.0, 0.3, 2.0, 6.25, 17.0, 80.0] {
                let expected = column.transfer(ControlPoint::Outcrop, frequency).unwrap();
                let computed = inclined_wave.transfer(control, frequency).unwrap();
                let incident =
                    inclined_wave.transfer(InclinedControl::Incident, frequency).unwrap();
                for error in [computed[component] - expected, incident[component] - expected * 2.0]
                {
                    largest_error = largest_error.max(error.abs() / expected.abs());
                }
                largest_error = largest_error.max(computed[1 - component].abs());
            }
            let motion: Vec<f64> = (0..900).map(|i| (0.3 * f64::from(i)).sin()).collect();
            let expected =
                column.to_surface(ControlPoint::Outcrop, 0.01, &motion, &mut unobserved).unwrap();
            let computed =
                inclined_wave.to_surface(control, 0.01, &motion, &mut unobserved).unwrap();
            for (a, b) in computed[component].samples.iter().zip(&expected.samples) {
                largest_error = largest_error.max((a - b).abs());
            }
        }
    }
    println!("{largest_error:e}");
    assert!(largest_error < 1e-10, "{largest_error:e}");
}

/// GOAL: layers of the base's soil only delay the waves, on both sides of the critical angle (35° for SV).
#[test]
fn equal_layers_are_a_half_plane() {
    let rock = rock();
    let layered = SoilProfile::on_half_plane(rock).with_layer(rock, 7.0).unwrap();
    let layered = layered.with_layer(rock, 30.0).unwrap();
    let mut largest_error = 0.0_f64;
    let mut largest_phase = 0.0_f64;
    for wave in BODY_WAVES {
        let speed = match wave {
            BodyWave::Sv => rock.shear_wave_speed(),
            BodyWave::P => rock.pressure_wave_speed(),
        };
        for angle in [-80.0_f64, -20.0, 0.1, 25.0, 34.0, 35.2, 35.4, 36.0, 50.0, 65.0, 89.0] {
            let angle = angle.to_radians();
            let inclined_wave = inclined(wave, layered.clone(), angle).unwrap();
            let plane = match wave {
                BodyWave::Sv => PlaneWave::sv(rock, angle).unwrap(),
                BodyWave::P => PlaneWave::p(rock, angle).unwrap(),
            };
            assert_eq!(inclined_wave.apparent_velocity(), plane.apparent_velocity());
            for frequency in [0.01, 1.0, 9.0, 40.0] {
                let computed =
                    inclined_wave.transfer(InclinedControl::Incident, frequency).unwrap();
                let delay = -TAU * frequency * 37.0 * angle.cos() / speed;
                for (computed, [re, im]) in computed.iter().zip(plane.amplification()) {
                    let expected = Complex::new(re, -im) * Complex::new(0.0, delay).exp();
                    largest_error = largest_error.max((*computed - expected).abs());
                    largest_phase = largest_phase.max(im.abs());
                }
            }
        }
    }
    println!("{largest_error:e}");
    assert!(largest_phase > 1.0 && largest_error < 1e-10, "{largest_error:e}");
}

/// GOAL: at the critical slowness of a layer, where upward and downward wave coincide, results are regular.
#[test]
fn critical_angles_of_layers_are_regular() {
    let rock = rock();
    let layered = SoilProfile::on_half_plane(rock).with_layer(rock, 7.0).unwrap();
    let critical = (rock.shear_wave_speed() / rock.pressure_wave_speed()).asin();
    let control = InclinedControl::OutcropHorizontal;
    let mut largest_error = 0.0_f64;
    for angle in [critical, critical + 1e-13, critical - 1e-11, critical + 1e-10] {
        let wave = InclinedWave::sv(layered.clone(), angle).unwrap();
        let computed = wave.transfer(control, 3.0).unwrap();
        let without_layer = InclinedWave::sv(SoilProfile::on_half_plane(rock), angle).unwrap();
        let at_base = without_layer.transfer(control, 3.0).unwrap();
        let delay = -TAU * 3.0 * 7.0 * angle.cos() / rock.shear_wave_speed();
        for (a, b) in computed.iter().zip(at_base) {
            let error = (*a - b * Complex::new(0.0, delay).exp()).abs() / at_base[0].abs();
            largest_error = largest_error.max(error);
        }
    }
    println!("{largest_error:e}");
    assert!(largest_error < 1e-9, "{largest_error:e}");
}

/// GOAL: one layer, softer or stiffer than its base, is right at many angles and frequencies.
/// REFERENCE: all its waves solved at once.
#[test]
fn one_layer_agrees_with_all_its_waves_solved_at_once() {
    let height = 6.0;
    let mut largest_error = 0.0_f64;
    let mut max_value = 0.0_f64;
    for [above, below] in [[soft(), rock()], [rock(), soft()]] {
        for (profile, laws) in one_layer(above, below, height) {
            for wave in BODY_WAVES {
                for angle in [-50.0_f64, 3.0, 12.0, 25.0, 40.0, 60.0, 85.0] {
                    let inclined_wave =
                        inclined(wave, profile.clone(), angle.to_radians()).unwrap();
                    let p = 1.0 / inclined_wave.apparent_velocity();
                    for frequency in [0.2, 1.7, 6.0, 14.0, 33.0] {
                        let s = Complex::new(0.0, TAU * frequency);
                        let layer = SoilWaves::new(above, &*laws[0], p, s);
                        let base = SoilWaves::new(below, &*laws[1], p, s);
                        let reference = LayerOnHalfPlane { layer, base, height, s };
                        let expected = reference.surface([Complex::default(); 2], Some(wave));
                        let computed =
                            inclined_wave.transfer(InclinedControl::Incident, frequency).unwrap();
                        let size = expected[0].abs().max(expected[1].abs());
                        for (a, b) in computed.iter().zip(expected) {
                            largest_error = largest_error.max((*a - b).abs() / size);
                        }
                        max_value = max_value.max(size);
                    }
                }
            }
        }
    }
    println!("{largest_error:e}, largest motion {max_value}");
    assert!(largest_error < 1e-10 && max_value > 4.0, "{largest_error:e} {max_value}");
}

/// GOAL: reciprocity and energy: incident waves of slowness p determine what a surface load e^(iω(t − px)) radiates.
/// REFERENCE: −Im C = Σ |T|²/(4ρω c² q) over P and SV, in elastic rock.
#[test]
fn incident_waves_determine_the_radiation_of_a_surface_load() {
    let rock = rock();
    let height = 6.0;
    let profile = SoilProfile::on_half_plane(rock).with_layer(soft(), height).unwrap();
    let mut largest_error = 0.0_f64;
    for sine in [0.0_f64, 0.2, 0.6, 0.97] {
        let p = sine / rock.pressure_wave_speed();
        for frequency in [0.5, 3.0, 6.0, 19.0] {
            let s = Complex::new(0.0, TAU * frequency);
            let layer = SoilWaves::new(soft(), &Elastic, p, s);
            let base = SoilWaves::new(rock, &Elastic, p, s);
            let reference = LayerOnHalfPlane { layer, base, height, s };
            let mut radiated = [0.0; 2];
            for (wave, kind, speed) in [
                (BodyWave::Sv, 1, rock.shear_wave_speed()),
                (BodyWave::P, 0, rock.pressure_wave_speed()),
            ] {
                let inclined_wave = inclined(wave, profile.clone(), (p * speed).asin()).unwrap();
                let transfer =
                    inclined_wave.transfer(InclinedControl::Incident, frequency).unwrap();
                let q = reference.base.vertical_slownesses[kind].re;
                let total = reference.base.total_slownesses[kind].re;
                for (sum, t) in radiated.iter_mut().zip(transfer) {
                    *sum += t.abs().powi(2) * total * total / (4.0 * rock.density() * s.im * q);
                }
            }
            for (component, radiated) in radiated.into_iter().enumerate() {
                // A unit stress −σ on the surface; the vertical one acts upwards.
                let mut load = [Complex::default(); 2];
                let sign = if component == 0 { -1.0 } else { 1.0 };
                load[component] = s.inverse() * sign;
                let compliance = reference.surface(load, None)[component];
                largest_error = largest_error.max((radiated / -compliance.im - 1.0).abs());
            }
        }
    }
    println!("{largest_error:e}");
    assert!(largest_error < 1e-10, "{largest_error:e}");
}

/// A soft, slightly damped half-plane.
fn soft_half_plane() -> SoilProfile {
    SoilProfile::on_half_plane(soft()).with_bedrock_damping(constant_q(0.02))
}

/// GOAL: a layer cut into slices has the same motion, also where e^(αh) would overflow; it does not affect long waves.
#[test]
fn slices_change_nothing_and_layers_do_not_affect_long_waves() {
    let control = InclinedControl::Incident;
    let stiff_soil = Soil::from_shear_wave_speed(900.0, 0.2, 2300.0).unwrap();
    let single_layer = soft_half_plane()
        .with_layer(stiff_soil, 60.0)
        .unwrap()
        .with_damping(constant_q(0.01));
    let mut sliced = soft_half_plane();
    for _ in 0..40 {
        sliced = sliced.with_layer(stiff_soil, 1.5).unwrap().with_damping(constant_q(0.01));
    }
    for wave in BODY_WAVES {
        for angle in [0.2_f64, 0.7, 1.3] {
            let whole_wave = inclined(wave, single_layer.clone(), angle).unwrap();
            let sliced_wave = inclined(wave, sliced.clone(), angle).unwrap();
            for frequency in [0.5, 5.0, 40.0, 5000.0] {
                let expected = whole_wave.transfer(control, frequency).unwrap();
                let computed = sliced_wave.transfer(control, frequency).unwrap();
                let size = expected[0].abs().max(expected[1].abs());
                for (a, b) in expected.into_iter().zip(computed) {
                    let error = (a - b).abs() / size.max(f64::MIN_POSITIVE);
                    assert!(error < 1e-9, "{angle} {frequency}: {error:e} of {size:e}");
                }
            }
            // At the same static moduli the bare base has the same motion, although layers are 46 times as stiff.
            let base_wave = inclined(wave, soft_half_plane(), angle).unwrap();
            let computed = sliced_wave.transfer(control, 1e-9).unwrap();
            let expected = base_wave.transfer(control, 1e-9).unwrap();
            for (a, b) in computed.into_iter().zip(expected) {
                assert!((a - b).abs() < 1e-6, "{a:?} {b:?}");
            }
        }
    }
}

fn ricker(t: f64) -> f64 {
    let a = ((t - 1.5) / 0.2).powi(2);
    (1.0 - 2.0 * a) * (-a).exp()
}

/// Transform ∫ f e^(−iωt) dt of the Ricker pulse.
fn ricker_transform(omega: f64) -> Complex {
    let size = 0.5 * PI.sqrt() * 0.2 * (0.2 * omega).powi(2);
    Complex::new(0.0, -1.5 * omega).exp() * (size * (-(0.1 * omega).powi(2)).exp())
}

/// GOAL: time series are integrals over real frequencies.
/// REFERENCE: the trapezium rule, whose result repeats every 2π/Δω = 63 s.
#[test]
fn motions_in_time_are_integrals_over_frequency() {
    let profile = two_layers(constant_q(0.05), constant_q(0.02));
    let time_step = 0.01;
    let frequency_step = 0.1;
    let motion: Vec<f64> = (0..1200).map(|i| ricker(time_step * f64::from(i))).collect();
    let mut largest_error = 0.0_f64;
    for (wave, angle, control) in [
        (BodyWave::Sv, 25.0_f64, InclinedControl::OutcropHorizontal),
        (BodyWave::Sv, -20.0, InclinedControl::OutcropVertical),
        (BodyWave::P, 60.0, InclinedControl::Incident),
    ] {
        let inclined_wave = inclined(wave, profile.clone(), angle.to_radians()).unwrap();
        let computed =
            inclined_wave.to_surface(control, time_step, &motion, &mut unobserved).unwrap();
        let spectrum: Vec<(f64, [Complex; 2])> = (1..1000)
            .map(|l| {
                let omega = frequency_step * f64::from(l);
                let transfer = inclined_wave.transfer(control, omega / TAU).unwrap();
                (omega, transfer.map(|t| t * ricker_transform(omega)))
            })
            .collect();
        for i in (0..motion.len()).step_by(37) {
            let t = time_step * i as f64;
            for component in 0..2 {
                let terms = spectrum.iter().map(|(omega, values)| {
                    (values[component] * Complex::new(0.0, omega * t).exp()).re
                });
                let expected = terms.sum::<f64>() * frequency_step / PI;
                let error = (computed[component].samples[i] - expected).abs();
                largest_error = largest_error.max(error);
            }
        }
    }
    println!("{largest_error:e}");
    assert!(largest_error < 1e-7, "{largest_error:e}");
}

/// GOAL: a free field travels along x with the motion of its origin.
#[test]
fn fields_travel_along_the_surface() {
    let samples: Vec<f64> = (0..800).map(|i| ricker(0.01 * f64::from(i))).collect();
    let record = Record::new(0.01, samples.clone()).unwrap();
    let wave = InclinedWave::p(two_layers(constant_q(0.05), Elastic), -0.8).unwrap();
    let control = InclinedControl::OutcropVertical;
    let field = wave.field(control, &record, 4.0).unwrap();
    let surface = wave
        .to_surface(control, 0.01, &samples, &mut unobserved)
        .unwrap()
        .map(|motion| Record::new(0.01, motion.samples).unwrap());
    for (x, time) in [(4.0, 1.6), (0.0, 1.7), (-6.0, 1.75)] {
        let delay = (x - 4.0) / wave.apparent_velocity();
        assert!(delay >= 0.0);
        let expected = surface.each_ref().map(|record| record.at(time - delay).displacement);
        let computed = field.displacement(x, time);
        let error = (computed[0] - expected[0]).abs() + (computed[1] - expected[1]).abs();
        assert!(error < 1e-14);
        assert!(computed[0].abs() > 1e-4 && computed[1].abs() > 1e-3, "{computed:?}");
    }
}
