//! Motion around a trench under waves that run along the surface.

use approx::assert_abs_diff_eq;
use basemat::bem::ContactElement;
use basemat::bem::embedded::{Trench, TrenchElements, TrenchGround};
use basemat::motion::{FreeField, PlaneWave, Record, RickerDisplacement, TravellingWave};
use basemat::site::{InclinedControl, InclinedWave, TrenchMotion};
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::{Soil, unobserved};

const SHEAR: f64 = 200.0;
const STEP: f64 = 0.005;

fn soil() -> Soil {
    Soil::from_shear_wave_speed(SHEAR, 0.3, 1900.0).unwrap()
}

fn elements() -> TrenchElements {
    Trench::new(-4.0..6.0, 5.0).unwrap().elements(8, 6).unwrap()
}

/// A pulse of some four hertz with rest before and after.
fn pulse() -> Record {
    let at = |time: f64| (25.0 * time).sin() * (-(time / 0.12).powi(2)).exp();
    let second = |time: f64| (at(time + STEP) - 2.0 * at(time) + at(time - STEP)) / STEP.powi(2);
    Record::new(STEP, (0..400).map(|k| second(STEP * f64::from(k) - 1.0)).collect()).unwrap()
}

fn motion(profile: impl Into<SoilProfile>, wave: &TravellingWave) -> TrenchMotion {
    let ground = TrenchGround::new(profile, elements()).unwrap();
    TrenchMotion::travelling(&ground, wave, &mut unobserved).unwrap()
}

/// Vector to the right and up from its normal and tangential components.
fn vector(element: &ContactElement, components: [f64; 2]) -> [f64; 2] {
    let [normal, along] = [element.directions()[0], element.directions()[1]];
    [0, 2].map(|k| components[0] * normal[k] + components[1] * along[k])
}

/// Force of the impulses at the faces on the soil, and the mean motion of the base, to the right and up.
fn at_faces(motion: &TrenchMotion, time: f64) -> ([f64; 2], [f64; 2]) {
    let elements = elements().elements();
    let count = elements.len();
    let [mut moved, mut impulse] = [vec![0.0; 2 * count], vec![0.0; 2 * count]];
    assert!(motion.at_faces(&elements, time, &mut moved, &mut impulse));
    let (mut sum, mut base, mut width) = ([0.0; 2], [0.0; 2], 0.0);
    for (e, own) in elements.iter().enumerate() {
        let [right, up] = vector(own, [impulse[e], impulse[count + e]]);
        sum = [sum[0] + own.length() * right, sum[1] + own.length() * up];
        if own.directions()[0][2] < -0.5 {
            let [right, up] = vector(own, [moved[e], moved[count + e]]);
            base = [base[0] + own.length() * right, base[1] + own.length() * up];
            width += own.length();
        }
    }
    (sum, base.map(|own| own / width))
}

/// Closed form of the motion below a half-plane: P and S waves up and down, of the surface's records.
///
/// Displacement and velocity to the right and up at `[x, z]`, z the depth.
fn below(wave: &PlaneWave, record: &Record, [x, z]: [f64; 2], time: f64) -> [[f64; 2]; 2] {
    let p = 1.0 / wave.apparent_velocity();
    let vertical = |speed: f64| (speed.powi(-2) - p * p).sqrt();
    let (a, b) = (vertical(soil().pressure_wave_speed()), vertical(SHEAR));
    let [[right, _], [up, _]] = wave.amplification();
    let g = b * b - p * p;
    let (even, odd) = (SHEAR.powi(2) / b, SHEAR.powi(2) / a * up / right);
    let mut found = [[0.0; 2]; 2];
    for e in [1.0, -1.0] {
        let pressure = 0.5 * (2.0 * p * b * even + e * g * odd);
        let shear = 0.5 * (g * even - e * 2.0 * a * p * odd);
        let at = |eta: f64| record.at(time - p * (x + 4.0) + e * eta * z);
        let (by_pressure, by_shear) = (at(a), at(b));
        let moved = [by_pressure.displacement, by_shear.displacement];
        for (found, [one, other]) in
            found.iter_mut().zip([moved, [by_pressure.velocity, by_shear.velocity]])
        {
            let (one, other) = (pressure * one, shear * other);
            found[0] += p * one + b * other;
            found[1] += e * (a * one - p * other);
        }
    }
    found
}

/// Soil in place of the trench moves as the free field: its momentum is the impulse of the tractions on it.
#[test]
fn tractions_are_the_momentum_of_the_soil_within() {
    let record = pulse();
    let [sv, p] = [PlaneWave::sv(soil(), 0.4).unwrap(), PlaneWave::p(soil(), 0.7).unwrap()];
    for wave in [sv, p] {
        let field = wave.field_from_horizontal(&record, -4.0).unwrap();
        let motion = motion(soil(), &field);
        let rule = |n: usize| (0..n).map(move |k| (k as f64 + 0.5) / n as f64);
        let mut largest = [0.0_f64; 2];
        let mut checks = vec![];
        for step in 0..40 {
            let time = 0.85 + 0.01 * f64::from(step);
            let (mut momentum, mut base) = ([0.0; 2], [0.0; 2]);
            for x in rule(80).map(|own| 10.0 * own - 4.0) {
                for z in rule(40).map(|own| 5.0 * own) {
                    let [_, [right, up]] = below(&wave, &record, [x, z], time);
                    let mass = 1900.0 * 50.0 / 3200.0;
                    momentum = [momentum[0] + mass * right, momentum[1] + mass * up];
                }
                let [moved, _] = below(&wave, &record, [x, 5.0], time);
                base = [base[0] + moved[0] / 80.0, base[1] + moved[1] / 80.0];
            }
            let (force, found) = at_faces(&motion, time);
            for k in 0..2 {
                largest = [largest[0].max(momentum[k].abs()), largest[1].max(base[k].abs())];
            }
            checks.push((force, momentum, found, base));
        }
        for (force, momentum, found, base) in checks {
            for k in 0..2 {
                assert_abs_diff_eq!(force[k], -momentum[k], epsilon = 2e-3 * largest[0]);
                assert_abs_diff_eq!(found[k], base[k], epsilon = 1e-3 * largest[1]);
            }
        }
    }
}

/// In damped layers, a wave at no angle is the vertical one with the same motion of the surface.
#[test]
fn a_vertical_travelling_wave_is_the_vertical_one() {
    let rock = Soil::from_shear_wave_speed(600.0, 0.25, 2200.0).unwrap();
    let law = || GeneralizedMaxwell::constant_q(0.04, [0.1, 40.0], 1.0).unwrap();
    let profile =
        SoilProfile::on_half_plane(rock).with_layer(soil(), 3.0).unwrap().with_damping(law());
    let wave = InclinedWave::sv(profile.clone(), 0.0).unwrap();
    let surface = wave
        .surface_records(InclinedControl::OutcropHorizontal, &pulse(), &mut unobserved)
        .unwrap()
        .x
        .unwrap();
    let ground = TrenchGround::new(profile, elements()).unwrap();
    let vertical = TrenchMotion::new(&ground, surface.clone(), &mut unobserved).unwrap();
    let field = TravellingWave::new(surface, f64::INFINITY, -4.0).unwrap();
    let travelling = TrenchMotion::travelling(&ground, &field, &mut unobserved).unwrap();
    let mut largest = [0.0_f64; 2];
    for step in 0..50 {
        let time = 0.8 + 0.01 * f64::from(step);
        let ((force, base), (wanted, moved)) =
            (at_faces(&travelling, time), at_faces(&vertical, time));
        largest = [largest[0].max(wanted[0].abs()), largest[1].max(moved[0].abs())];
        for k in 0..2 {
            assert_abs_diff_eq!(force[k], wanted[k], epsilon = 2e-4 * largest[0]);
            assert_abs_diff_eq!(base[k], moved[k], epsilon = 2e-4 * largest[1]);
        }
    }
    assert!(largest[0] > 0.0);
}

/// Waves across the plane, without records, or slower than surface waves are refused.
#[test]
fn other_waves_are_refused() {
    let field = PlaneWave::sv(soil(), 0.3).unwrap().field_from_horizontal(&pulse(), -4.0).unwrap();
    let ground = TrenchGround::new(soil(), elements()).unwrap();
    let oblique = field.with_azimuth(0.5).unwrap();
    assert!(TrenchMotion::travelling(&ground, &oblique, &mut unobserved).is_err());
    let fading =
        TravellingWave::new(RickerDisplacement::new(0.1, 0.1, 1.0).unwrap(), 500.0, -4.0).unwrap();
    assert!(TrenchMotion::travelling(&ground, &fading, &mut unobserved).is_err());
}
