//! GOAL: SV and P waves that come at an angle reach the surface of layered ground as they should.
//! SCENE: elastic and damped layers on rock, angles on both sides of the critical ones.
//! REFERENCE: vertical columns, plane waves of a half-plane, all waves of a layer solved at once,
//! the energy that a surface load radiates, integrals over frequency.

use std::f64::consts::TAU;

use basemat::motion::{FreeField, PlaneWave, Record};
use basemat::site::{ControlPoint, InclinedControl, InclinedWave, SoilColumn, VerticalWave};
use basemat::soil::SoilError;
use basemat::soil::{Elastic, Hysteretic, KelvinVoigt, Relaxation, SoilProfile};
use basemat::{Complex, Error, Result, Soil, unobserved};

use basemat_problems::profiles::{constant_q, one_layer, rock, soft, two_layers};

const BOTH: [fn(SoilProfile, f64) -> Result<InclinedWave>; 2] = [InclinedWave::sv, InclinedWave::p];

#[test]
fn vertical_incidence_is_the_column() {
    let mut worst = 0.0_f64;
    for profile in [two_layers(Elastic, Elastic), two_layers(constant_q(0.05), constant_q(0.02))] {
        for (make, wave) in BOTH.into_iter().zip([VerticalWave::Shear, VerticalWave::Pressure]) {
            let column = SoilColumn::new(profile.clone(), wave).unwrap();
            let inclined = make(profile.clone(), 0.0).unwrap();
            let (along, control) = match wave {
                VerticalWave::Shear => (0, InclinedControl::OutcropHorizontal),
                VerticalWave::Pressure => (1, InclinedControl::OutcropVertical),
            };
            for frequency in [0.0, 0.3, 2.0, 6.25, 17.0, 80.0] {
                let wanted = column.transfer(ControlPoint::Outcrop, frequency).unwrap();
                let found = inclined.transfer(control, frequency).unwrap();
                let incident = inclined.transfer(InclinedControl::Incident, frequency).unwrap();
                worst = worst.max((found[along] - wanted).abs() / wanted.abs());
                worst = worst.max((incident[along] - wanted * 2.0).abs() / wanted.abs());
                worst = worst.max(found[1 - along].abs());
            }
            let motion: Vec<f64> = (0..900).map(|i| (0.3 * f64::from(i)).sin()).collect();
            let wanted =
                column.to_surface(ControlPoint::Outcrop, 0.01, &motion, &mut unobserved).unwrap();
            let found = inclined.to_surface(control, 0.01, &motion, &mut unobserved).unwrap();
            for (a, b) in found[along].samples.iter().zip(&wanted.samples) {
                worst = worst.max((a - b).abs());
            }
        }
    }
    println!("{worst:e}");
    assert!(worst < 1e-10, "{worst:e}");
}

/// Layers of the base's own soil only take time, on both sides of the critical angle (35° for SV).
#[test]
fn equal_layers_are_a_half_plane() {
    let rock = rock();
    let layered = SoilProfile::on_half_plane(rock).with_layer(rock, 7.0).unwrap();
    let layered = layered.with_layer(rock, 30.0).unwrap();
    let (mut worst, mut late) = (0.0_f64, 0.0_f64);
    for (shear, make) in [true, false].into_iter().zip(BOTH) {
        let plane = if shear { PlaneWave::sv } else { PlaneWave::p };
        let speed = if shear { rock.shear_wave_speed() } else { rock.pressure_wave_speed() };
        for angle in [-80.0_f64, -20.0, 0.1, 25.0, 34.0, 35.2, 35.4, 36.0, 50.0, 65.0, 89.0] {
            let angle = angle.to_radians();
            let wave = make(layered.clone(), angle).unwrap();
            let plane = plane(rock, angle).unwrap();
            assert_eq!(wave.apparent_velocity(), plane.apparent_velocity());
            for frequency in [0.01, 1.0, 9.0, 40.0] {
                let found = wave.transfer(InclinedControl::Incident, frequency).unwrap();
                let delay = -TAU * frequency * 37.0 * angle.cos() / speed;
                for (found, [re, im]) in found.iter().zip(plane.amplification()) {
                    let wanted = Complex::new(re, -im) * Complex::new(0.0, delay).exp();
                    worst = worst.max((*found - wanted).abs());
                    late = late.max(im.abs());
                }
            }
        }
    }
    println!("{worst:e}");
    assert!(late > 1.0 && worst < 1e-10, "{worst:e}");
}

/// Where a wave grazes a layer up and down are one wave: exactly at its critical slowness.
#[test]
fn critical_angles_of_layers_are_regular() {
    let rock = rock();
    let layered = SoilProfile::on_half_plane(rock).with_layer(rock, 7.0).unwrap();
    let critical = (rock.shear_wave_speed() / rock.pressure_wave_speed()).asin();
    let mut worst = 0.0_f64;
    for angle in [critical, critical + 1e-13, critical - 1e-11, critical + 1e-10] {
        let found = InclinedWave::sv(layered.clone(), angle).unwrap();
        let found = found.transfer(InclinedControl::OutcropHorizontal, 3.0).unwrap();
        let bare = InclinedWave::sv(SoilProfile::on_half_plane(rock), angle).unwrap();
        let bare = bare.transfer(InclinedControl::OutcropHorizontal, 3.0).unwrap();
        let delay = -TAU * 3.0 * 7.0 * angle.cos() / rock.shear_wave_speed();
        for (a, b) in found.iter().zip(bare) {
            worst = worst.max((*a - b * Complex::new(0.0, delay).exp()).abs() / bare[0].abs());
        }
    }
    println!("{worst:e}");
    assert!(worst < 1e-9, "{worst:e}");
}

/// A wave d e^(s(t − px − qz)): displacements (x, z) and stresses (xz, zz)/s at depth z, by
/// Hooke's law, up to the factor of t and x.
fn wave(
    lame: [Complex; 2],
    d: [Complex; 2],
    p: f64,
    q: Complex,
    s: Complex,
    z: f64,
) -> [Complex; 4] {
    let [lambda, mu] = lame;
    let size = -(d[0] * p + q * d[1]);
    let shear = -(mu * (q * d[0] + d[1] * p));
    let normal = lambda * size - mu * q * d[1] * 2.0;
    let phase = (s * q * -z).exp();
    [d[0], d[1], shear, normal].map(|x| x * phase)
}

/// P and SV, down and up, of a soil.
struct Waves {
    lame: [Complex; 2],
    p: f64,
    /// Of P and SV.
    slownesses: [Complex; 2],
    /// 1/c of P and SV.
    totals: [Complex; 2],
}

impl Waves {
    fn new(soil: Soil, law: &dyn Relaxation, p: f64, s: Complex) -> Self {
        let mu = law.modulus(s) * soil.shear_modulus();
        let lambda = mu * (2.0 * soil.poisson() / (1.0 - 2.0 * soil.poisson()));
        let totals =
            [lambda + mu * 2.0, mu].map(|modulus| (Complex::real(soil.density()) / modulus).sqrt());
        let slownesses = totals.map(|total| {
            let root = (total * total - Complex::real(p * p)).sqrt();
            if (s * root).re < -1e-12 * (s * root).abs() { -root } else { root }
        });
        Self { lame: [lambda, mu], p, slownesses, totals }
    }

    /// P or SV of unit length at depth z, whose origin is at that depth where it has it.
    fn at(&self, shear: bool, up: bool, s: Complex, z: f64) -> [Complex; 4] {
        let kind = usize::from(shear);
        let q = if up { -self.slownesses[kind] } else { self.slownesses[kind] };
        // Along (p, q), or across it and to the right.
        let (x, down) = if shear {
            (self.slownesses[1], Complex::real(self.p))
        } else {
            (Complex::real(self.p), q)
        };
        let down = if shear && !up { -down } else { down };
        let d = [x, down].map(|x| x / self.totals[kind]);
        wave(self.lame, d, self.p, q, s, z)
    }
}

/// Gauss's elimination with pivots.
fn solve(mut matrix: Vec<Vec<Complex>>) -> Vec<Complex> {
    let n = matrix.len();
    for k in 0..n {
        let pivot =
            (k..n).max_by(|&i, &j| matrix[i][k].abs().total_cmp(&matrix[j][k].abs())).unwrap();
        matrix.swap(k, pivot);
        for i in (0..n).filter(|&i| i != k) {
            let factor = matrix[i][k] / matrix[k][k];
            for j in k..=n {
                let change = factor * matrix[k][j];
                matrix[i][j] = matrix[i][j] - change;
            }
        }
    }
    (0..n).map(|i| matrix[i][n] / matrix[i][i]).collect()
}

/// Six waves of one layer on a half-plane: four in the layer, two that leave. Surface displacements
/// (x, up) under surface stresses (xz, zz)/s and an incident wave at the depth of the base.
fn surface(
    [upper, lower]: [&Waves; 2],
    height: f64,
    s: Complex,
    load: [Complex; 2],
    incident: Option<bool>,
) -> [Complex; 2] {
    // Of waves that go up the origin is at the layer's bottom.
    let inside = |z: f64| {
        [(false, false), (true, false), (false, true), (true, true)]
            .map(|(shear, up)| upper.at(shear, up, s, if up { z - height } else { z }))
    };
    let (top, bottom) = (inside(0.0), inside(height));
    let below = [false, true].map(|shear| lower.at(shear, false, s, 0.0));
    let given = incident.map_or([Complex::default(); 4], |shear| lower.at(shear, true, s, 0.0));
    // Stresses are of the soil's size: rows alike.
    let size = upper.lame[1].abs() * upper.totals[1].abs();
    let mut matrix = vec![];
    for row in 2..4 {
        let mut line: Vec<_> = top.iter().map(|wave| wave[row] * (1.0 / size)).collect();
        line.extend([Complex::default(); 2]);
        line.push(load[row - 2] * (1.0 / size));
        matrix.push(line);
    }
    for row in 0..4 {
        let scale = if row < 2 { 1.0 } else { 1.0 / size };
        let mut line: Vec<_> = bottom.iter().map(|wave| wave[row] * scale).collect();
        line.extend(below.iter().map(|wave| wave[row] * -scale));
        line.push(given[row] * scale);
        matrix.push(line);
    }
    let amplitudes = solve(matrix);
    let mut found = [Complex::default(); 2];
    for (wave, amplitude) in top.iter().zip(&amplitudes) {
        found[0] += wave[0] * *amplitude;
        found[1] += -(wave[1] * *amplitude);
    }
    found
}

#[test]
fn one_layer_is_all_its_waves_at_once() {
    let height = 6.0;
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for [above, below] in [[soft(), rock()], [rock(), soft()]] {
        for (profile, [upper, lower]) in one_layer(above, below, height) {
            for (shear, make) in [true, false].into_iter().zip(BOTH) {
                for angle in [-50.0_f64, 3.0, 12.0, 25.0, 40.0, 60.0, 85.0] {
                    let found = make(profile.clone(), angle.to_radians()).unwrap();
                    let p = 1.0 / found.apparent_velocity();
                    for frequency in [0.2, 1.7, 6.0, 14.0, 33.0] {
                        let s = Complex::new(0.0, TAU * frequency);
                        let waves =
                            [Waves::new(above, &*upper, p, s), Waves::new(below, &*lower, p, s)];
                        let free = [Complex::default(); 2];
                        let pair = [&waves[0], &waves[1]];
                        let wanted = surface(pair, height, s, free, Some(shear));
                        let found = found.transfer(InclinedControl::Incident, frequency).unwrap();
                        let size = wanted[0].abs().max(wanted[1].abs());
                        for (a, b) in found.iter().zip(wanted) {
                            worst = worst.max((*a - b).abs() / size);
                        }
                        largest = largest.max(size);
                    }
                }
            }
        }
    }
    println!("{worst:e}, largest motion {largest}");
    assert!(worst < 1e-10 && largest > 4.0, "{worst:e} {largest}");
}

/// Reciprocity and energy: a surface load e^(iω(t − px)) radiates into the rock, elastic, what incident
/// waves of this p say, −Im C = Σ |T|²/(4ρω c² q) over P and SV.
#[test]
fn incident_waves_say_how_much_a_surface_load_radiates() {
    let (soil, rock, height) = (soft(), rock(), 6.0);
    let profile = SoilProfile::on_half_plane(rock).with_layer(soil, height).unwrap();
    let mut worst = 0.0_f64;
    for sine in [0.0_f64, 0.2, 0.6, 0.97] {
        let p = sine / rock.pressure_wave_speed();
        let angles = [rock.shear_wave_speed(), rock.pressure_wave_speed()].map(|c| (p * c).asin());
        for frequency in [0.5, 3.0, 6.0, 19.0] {
            let s = Complex::new(0.0, TAU * frequency);
            let waves = [soil, rock].map(|soil| Waves::new(soil, &Elastic, p, s));
            let mut radiated = [0.0; 2];
            for (kind, make) in BOTH.into_iter().enumerate() {
                let wave = make(profile.clone(), angles[kind]).unwrap();
                let found = wave.transfer(InclinedControl::Incident, frequency).unwrap();
                let [q, total] =
                    [waves[1].slownesses, waves[1].totals].map(|list| list[1 - kind].re);
                for (sum, t) in radiated.iter_mut().zip(found) {
                    *sum += t.abs().powi(2) * total * total / (4.0 * rock.density() * s.im * q);
                }
            }
            for (index, radiated) in radiated.into_iter().enumerate() {
                // A unit stress, −σ on the surface; the vertical one up.
                let mut load = [Complex::default(); 2];
                let sign = if index == 0 { -1.0 } else { 1.0 };
                load[index] = s.inverse() * sign;
                let [x, up] = surface([&waves[0], &waves[1]], height, s, load, None);
                let compliance = if index == 0 { x } else { up };
                worst = worst.max((radiated / -compliance.im - 1.0).abs());
            }
        }
    }
    println!("{worst:e}");
    assert!(worst < 1e-10, "{worst:e}");
}

/// Cut into many, layers stay what they are, where e^(αh) would leave the range of f64 too; the
/// surface of long waves is the outcrop.
#[test]
fn thin_slices_high_frequencies_and_long_waves() {
    let stiff = Soil::from_shear_wave_speed(900.0, 0.2, 2300.0).unwrap();
    let base = |law| SoilProfile::on_half_plane(soft()).with_bedrock_damping(law);
    let whole =
        base(constant_q(0.02)).with_layer(stiff, 60.0).unwrap().with_damping(constant_q(0.01));
    let mut cut = base(constant_q(0.02));
    for _ in 0..40 {
        cut = cut.with_layer(stiff, 1.5).unwrap().with_damping(constant_q(0.01));
    }
    for make in BOTH {
        for angle in [0.2_f64, 0.7, 1.3] {
            let [whole, cut] = [&whole, &cut].map(|x| make(x.clone(), angle).unwrap());
            for frequency in [0.5, 5.0, 40.0, 5000.0] {
                let control = InclinedControl::Incident;
                let [a, b] = [&whole, &cut].map(|x| x.transfer(control, frequency).unwrap());
                let size = a[0].abs().max(a[1].abs());
                for (a, b) in a.into_iter().zip(b) {
                    let error = (a - b).abs() / size.max(f64::MIN_POSITIVE);
                    assert!(error < 1e-9, "{angle} {frequency}: {error:e} of {size:e}");
                }
            }
            // Against the bare base at the same, static moduli; layers are 46 times as stiff.
            let bare = make(base(constant_q(0.02)), angle).unwrap();
            let control = InclinedControl::Incident;
            let [a, b] = [&cut, &bare].map(|x| x.transfer(control, 1e-9).unwrap());
            for (a, b) in a.into_iter().zip(b) {
                assert!((a - b).abs() < 1e-6, "{a:?} {b:?}");
            }
        }
    }
}

fn ricker(t: f64) -> f64 {
    let a = ((t - 1.5) / 0.2).powi(2);
    (1.0 - 2.0 * a) * (-a).exp()
}

/// Its transform ∫ f e^(−iωt) dt.
fn ricker_transform(omega: f64) -> Complex {
    let size = 0.5 * std::f64::consts::PI.sqrt() * 0.2 * (0.2 * omega).powi(2);
    Complex::new(0.0, -1.5 * omega).exp() * (size * (-(0.1 * omega).powi(2)).exp())
}

/// Time series are integrals over real frequencies.
#[test]
fn motions_in_time_are_integrals_over_frequency() {
    let profile = two_layers(constant_q(0.05), constant_q(0.02));
    let (dt, count) = (0.01, 1200);
    let motion: Vec<f64> = (0..count).map(|i| ricker(dt * i as f64)).collect();
    let cases = [
        (BOTH[0], 25.0_f64, InclinedControl::OutcropHorizontal),
        (BOTH[0], -20.0, InclinedControl::OutcropVertical),
        (BOTH[1], 60.0, InclinedControl::Incident),
    ];
    let mut worst = 0.0_f64;
    for (make, angle, control) in cases {
        let wave = make(profile.clone(), angle.to_radians()).unwrap();
        let found = wave.to_surface(control, dt, &motion, &mut unobserved).unwrap();
        // The trapezium rule: what it finds comes again every 2π/step = 63 s.
        let step = 0.1;
        let spectrum: Vec<_> = (1..1000)
            .map(|l| {
                let omega = step * f64::from(l);
                let [x, up] = wave.transfer(control, omega / TAU).unwrap();
                (omega, [x, up].map(|t| t * ricker_transform(omega)))
            })
            .collect();
        for i in (0..count).step_by(37) {
            let t = dt * i as f64;
            for component in 0..2 {
                let terms = spectrum.iter().map(|(omega, values)| {
                    (values[component] * Complex::new(0.0, omega * t).exp()).re
                });
                let wanted = terms.sum::<f64>() * step / std::f64::consts::PI;
                worst = worst.max((found[component].samples[i] - wanted).abs());
            }
        }
    }
    println!("{worst:e}");
    assert!(worst < 1e-7, "{worst:e}");
}

/// A free field runs along x with what the motion of its origin is.
#[test]
fn fields_run_along_the_surface() {
    let samples: Vec<f64> = (0..800).map(|i| ricker(0.01 * f64::from(i))).collect();
    let record = Record::new(0.01, samples.clone()).unwrap();
    let wave = InclinedWave::p(two_layers(constant_q(0.05), Elastic), -0.8).unwrap();
    let control = InclinedControl::OutcropVertical;
    let field = wave.field(control, &record, 4.0).unwrap();
    let [x, up] = wave.to_surface(control, 0.01, &samples, &mut unobserved).unwrap();
    let [x, up] = [x, up].map(|motion| Record::new(0.01, motion.samples).unwrap());
    for (place, time) in [(4.0, 1.6), (0.0, 1.7), (-6.0, 1.75)] {
        let then = time - (place - 4.0) / wave.apparent_velocity();
        assert!((place - 4.0) / wave.apparent_velocity() >= 0.0);
        let wanted = [x.at(then).displacement, up.at(then).displacement];
        let found = field.displacement(place, time);
        assert!((found[0] - wanted[0]).abs() + (found[1] - wanted[1]).abs() < 1e-14);
        assert!(found[0].abs() > 1e-4 && found[1].abs() > 1e-3, "{found:?}");
    }
}

#[test]
fn bad_waves_are_refused() {
    let elastic = two_layers(Elastic, Elastic);
    for make in BOTH {
        for angle in [f64::NAN, f64::INFINITY, 1.6, -1.58, std::f64::consts::FRAC_PI_2] {
            let found = make(elastic.clone(), angle);
            assert!(matches!(found, Err(Error::Input { .. })), "{angle} {found:?}");
        }
        let rigid = SoilProfile::on_rigid_bedrock().with_layer(soft(), 3.0).unwrap();
        let found = make(rigid, 0.2).unwrap_err();
        assert!(matches!(found, Error::Scene { quantity: "inclined wave", .. }), "{found}");
        let wave = make(elastic.clone(), 0.3).unwrap();
        let control = InclinedControl::Incident;
        for frequency in [-1.0, f64::NAN, f64::INFINITY] {
            assert!(wave.transfer(control, frequency).is_err());
        }
        for (step, motion) in [
            (0.0, vec![1.0]),
            (f64::NAN, vec![1.0]),
            (-0.1, vec![1.0]),
            (0.1, vec![]),
            (0.1, vec![f64::NAN]),
            (1e-320, vec![1.0]),
            (1e300, vec![1.0, 2.0]),
        ] {
            let found = wave.to_surface(control, step, &motion, &mut unobserved);
            assert!(found.is_err() || step == 1e300, "{step} {motion:?}");
        }
        let record = Record::new(0.01, vec![0.0, 1.0, 0.0]).unwrap();
        assert!(wave.field(control, &record, f64::NAN).is_err());
        let hysteretic = two_layers(Hysteretic::new(0.05).unwrap(), Elastic);
        let found = make(hysteretic, 0.3)
            .unwrap()
            .to_surface(control, 0.01, &[1.0], &mut unobserved)
            .unwrap_err();
        assert!(matches!(found, Error::Soil(SoilError::NotCausal { layer: 1, .. })));
    }
    // A component that the outcrop hardly has cannot be prescribed.
    for (wave, control) in [
        (InclinedWave::sv(elastic.clone(), 0.0).unwrap(), InclinedControl::OutcropVertical),
        (InclinedWave::p(elastic.clone(), 0.0).unwrap(), InclinedControl::OutcropHorizontal),
    ] {
        assert!(matches!(wave.transfer(control, 1.0), Err(Error::Input { .. })));
        assert!(wave.to_surface(control, 0.01, &[1.0], &mut unobserved).is_err());
    }
    // The rock's critical angle of 35.3°, and fronts without a limit to their speed.
    let control = InclinedControl::OutcropHorizontal;
    let beyond = InclinedWave::sv(elastic, 36.0_f64.to_radians()).unwrap();
    assert!(beyond.transfer(control, 1.0).is_ok());
    let found = beyond.to_surface(control, 0.01, &[1.0, 0.0], &mut unobserved).unwrap_err();
    assert!(matches!(found, Error::Soil(SoilError::BeyondCritical { layer: 3, .. })), "{found}");
    let stiffening = two_layers(Elastic, KelvinVoigt::with_ratio(0.05, 1.0).unwrap());
    let found = InclinedWave::sv(stiffening, 0.4).unwrap();
    assert!(found.to_surface(control, 0.01, &[1.0, 0.0], &mut unobserved).is_err());
}

/// Whatever the scales: finite numbers or a typed error.
#[test]
fn extreme_scales_give_finite_numbers_or_errors() {
    let (mut finite, mut refused) = (0, 0);
    for modulus in [1e-150, 1.0, 1e150] {
        for thickness in [1e-200, 1.0, 1e200] {
            for poisson in [-0.99, 0.0, 0.4999] {
                let layer = Soil::new(modulus, poisson, 1.0).unwrap();
                let profile = SoilProfile::on_half_plane(Soil::new(1.0, 0.3, 1.0).unwrap())
                    .with_layer(layer, thickness)
                    .unwrap();
                for make in BOTH {
                    for angle in [1e-14 - std::f64::consts::FRAC_PI_2, -1e-300, 0.0, 0.3, 1.2] {
                        let wave = make(profile.clone(), angle).unwrap();
                        for frequency in [0.0, 1e-300, 1.0, 1e300, f64::MAX] {
                            match wave.transfer(InclinedControl::Incident, frequency) {
                                Ok(found) => {
                                    assert!(found.iter().all(|x| x.abs().is_finite()));
                                    finite += 1;
                                }
                                Err(_) => refused += 1,
                            }
                        }
                        let motion = wave.to_surface(
                            InclinedControl::Incident,
                            0.01,
                            &[0.0, 1.0],
                            &mut unobserved,
                        );
                        assert!(
                            motion
                                .iter()
                                .flatten()
                                .flat_map(|motion| &motion.samples)
                                .all(|x| x.is_finite())
                        );
                    }
                }
            }
        }
    }
    println!("{finite} finite, {refused} refused");
    assert!(finite > 500 && refused > 0);
}
