//! GOAL: motion and tractions around a trench under waves that travel along the surface.
//! SCENE: SV and P waves at an angle in a half-plane; a vertical wave in damped layers.
//! REFERENCE: the momentum of the soil in closed form; the vertical wave's motion.

use approx::assert_abs_diff_eq;
use basemat::bem::ContactElement;
use basemat::bem::embedded::{Trench, TrenchElements, TrenchGround};
use basemat::motion::{FreeField, PlaneWave, Record, RickerDisplacement, TravellingWave};
use basemat::site::{InclinedControl, InclinedWave, TrenchMotion};
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::{Soil, unobserved};

const SHEAR_WAVE_SPEED: f64 = 200.0;
const TIME_STEP: f64 = 0.005;

fn soil() -> Soil {
    Soil::from_shear_wave_speed(SHEAR_WAVE_SPEED, 0.3, 1900.0).unwrap()
}

fn elements() -> TrenchElements {
    Trench::new(-4.0..6.0, 5.0).unwrap().elements(8, 6).unwrap()
}

/// A pulse of some four hertz with rest before and after.
fn pulse() -> Record {
    let accelerations = (0..400).map(|k| {
        let time = TIME_STEP * f64::from(k) - 1.0;
        let second_difference = pulse_displacement(time + TIME_STEP)
            - 2.0 * pulse_displacement(time)
            + pulse_displacement(time - TIME_STEP);
        second_difference / TIME_STEP.powi(2)
    });
    Record::new(TIME_STEP, accelerations.collect()).unwrap()
}

fn pulse_displacement(time: f64) -> f64 {
    (25.0 * time).sin() * (-(time / 0.12).powi(2)).exp()
}

fn motion(profile: impl Into<SoilProfile>, wave: &TravellingWave) -> TrenchMotion {
    let ground = TrenchGround::new(profile, elements()).unwrap();
    TrenchMotion::travelling(&ground, wave, &mut unobserved).unwrap()
}

/// Vector to the right and up from its normal and tangential components.
fn vector(element: &ContactElement, components: [f64; 2]) -> [f64; 2] {
    let normal = element.directions()[0];
    let tangent = element.directions()[1];
    [0, 2].map(|k| components[0] * normal[k] + components[1] * tangent[k])
}

/// Force and motion at the faces of the trench, to the right and up.
struct FaceMotion {
    /// Force of the impulses on the soil.
    force: [f64; 2],
    /// Mean displacement of the base.
    base: [f64; 2],
}

fn at_faces(motion: &TrenchMotion, time: f64) -> FaceMotion {
    let elements = elements().elements();
    let count = elements.len();
    let mut displacement = vec![0.0; 2 * count];
    let mut impulse = vec![0.0; 2 * count];
    assert!(motion.at_faces(&elements, time, &mut displacement, &mut impulse));
    let mut force = [0.0; 2];
    let mut base = [0.0; 2];
    let mut width = 0.0;
    for (e, element) in elements.iter().enumerate() {
        let length = element.length();
        add_scaled(&mut force, length, vector(element, [impulse[e], impulse[count + e]]));
        if element.directions()[0][2] < -0.5 {
            let displacement = vector(element, [displacement[e], displacement[count + e]]);
            add_scaled(&mut base, length, displacement);
            width += length;
        }
    }
    FaceMotion { force, base: base.map(|sum| sum / width) }
}

fn add_scaled(sum: &mut [f64; 2], factor: f64, vector: [f64; 2]) {
    for (sum, component) in sum.iter_mut().zip(vector) {
        *sum += factor * component;
    }
}

/// Motion of a point of the soil, to the right and up.
struct PointMotion {
    displacement: [f64; 2],
    velocity: [f64; 2],
}

/// Vertical slowness √(c⁻² − p²) of a wave of speed c and horizontal slowness p.
fn vertical_slowness(speed: f64, p: f64) -> f64 {
    (speed.powi(-2) - p * p).sqrt()
}

/// Closed form of the motion at depth z of a half-plane: P and S waves, up and down, of the surface's records.
fn below(wave: &PlaneWave, record: &Record, x: f64, z: f64, time: f64) -> PointMotion {
    let p = 1.0 / wave.apparent_velocity();
    let a = vertical_slowness(soil().pressure_wave_speed(), p);
    let b = vertical_slowness(SHEAR_WAVE_SPEED, p);
    let [[right, _], [up, _]] = wave.amplification();
    let g = b * b - p * p;
    let even_factor = SHEAR_WAVE_SPEED.powi(2) / b;
    let odd_factor = SHEAR_WAVE_SPEED.powi(2) / a * up / right;
    let mut motion = PointMotion { displacement: [0.0; 2], velocity: [0.0; 2] };
    for sign in [1.0, -1.0] {
        let pressure = 0.5 * (2.0 * p * b * even_factor + sign * g * odd_factor);
        let shear = 0.5 * (g * even_factor - sign * 2.0 * a * p * odd_factor);
        let by_pressure = record.at(time - p * (x + 4.0) + sign * a * z);
        let by_shear = record.at(time - p * (x + 4.0) + sign * b * z);
        for (sum, potentials) in [
            (&mut motion.displacement, [by_pressure.displacement, by_shear.displacement]),
            (&mut motion.velocity, [by_pressure.velocity, by_shear.velocity]),
        ] {
            let p_wave = pressure * potentials[0];
            let s_wave = shear * potentials[1];
            sum[0] += p * p_wave + b * s_wave;
            sum[1] += sign * (a * p_wave - p * s_wave);
        }
    }
    motion
}

/// Midpoints of equal parts of the interval from 0 to 1.
fn unit_midpoints(count: usize) -> impl Iterator<Item = f64> {
    (0..count).map(move |k| (k as f64 + 0.5) / count as f64)
}

/// Force and motion of the free field of the soil in place of the trench: minus its momentum, and the motion at the
/// base.
fn free_field_at_faces(wave: &PlaneWave, record: &Record, time: f64) -> FaceMotion {
    let mass = 1900.0 * 50.0 / 3200.0;
    let mut momentum = [0.0; 2];
    let mut base = [0.0; 2];
    for x in unit_midpoints(80).map(|fraction| 10.0 * fraction - 4.0) {
        for z in unit_midpoints(40).map(|fraction| 5.0 * fraction) {
            add_scaled(&mut momentum, mass, below(wave, record, x, z, time).velocity);
        }
        let displacement = below(wave, record, x, 5.0, time).displacement;
        base = [base[0] + displacement[0] / 80.0, base[1] + displacement[1] / 80.0];
    }
    FaceMotion { force: momentum.map(|component| -component), base }
}

/// GOAL: soil in place of the trench moves as the free field: its momentum is the impulse of the tractions on it.
#[test]
fn tractions_are_the_momentum_of_the_soil_within() {
    let record = pulse();
    for wave in [PlaneWave::sv(soil(), 0.4).unwrap(), PlaneWave::p(soil(), 0.7).unwrap()] {
        let field = wave.field_from_horizontal(&record, -4.0).unwrap();
        let motion = motion(soil(), &field);
        let times: Vec<f64> = (0..40).map(|step| 0.85 + 0.01 * f64::from(step)).collect();
        let expected: Vec<FaceMotion> =
            times.iter().map(|time| free_field_at_faces(&wave, &record, *time)).collect();
        let mut largest_force = 0.0_f64;
        let mut largest_base = 0.0_f64;
        for expected in &expected {
            for k in 0..2 {
                largest_force = largest_force.max(expected.force[k].abs());
                largest_base = largest_base.max(expected.base[k].abs());
            }
        }
        for (time, expected) in times.iter().zip(expected) {
            let computed = at_faces(&motion, *time);
            for k in 0..2 {
                assert_abs_diff_eq!(
                    computed.force[k],
                    expected.force[k],
                    epsilon = 2e-3 * largest_force
                );
                assert_abs_diff_eq!(
                    computed.base[k],
                    expected.base[k],
                    epsilon = 1e-3 * largest_base
                );
            }
        }
    }
}

/// GOAL: in damped layers, a wave at no angle is the vertical one with the same motion of the surface.
#[test]
fn a_vertical_travelling_wave_is_the_vertical_one() {
    let rock = Soil::from_shear_wave_speed(600.0, 0.25, 2200.0).unwrap();
    let law = GeneralizedMaxwell::constant_q(0.04, [0.1, 40.0], 1.0).unwrap();
    let profile =
        SoilProfile::on_half_plane(rock).with_layer(soil(), 3.0).unwrap().with_damping(law);
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
    let mut largest_force = 0.0_f64;
    let mut largest_base = 0.0_f64;
    for step in 0..50 {
        let time = 0.8 + 0.01 * f64::from(step);
        let computed = at_faces(&travelling, time);
        let expected = at_faces(&vertical, time);
        largest_force = largest_force.max(expected.force[0].abs());
        largest_base = largest_base.max(expected.base[0].abs());
        for k in 0..2 {
            let force_limit = 2e-4 * largest_force;
            assert_abs_diff_eq!(computed.force[k], expected.force[k], epsilon = force_limit);
            let base_limit = 2e-4 * largest_base;
            assert_abs_diff_eq!(computed.base[k], expected.base[k], epsilon = base_limit);
        }
    }
    assert!(largest_force > 0.0);
}

/// GOAL: waves across the plane, or without records, are errors.
#[test]
fn other_waves_are_errors() {
    let field = PlaneWave::sv(soil(), 0.3).unwrap().field_from_horizontal(&pulse(), -4.0).unwrap();
    let ground = TrenchGround::new(soil(), elements()).unwrap();
    let oblique = field.with_azimuth(0.5).unwrap();
    assert!(TrenchMotion::travelling(&ground, &oblique, &mut unobserved).is_err());
    let pulse = RickerDisplacement::new(0.1, 0.1, 1.0).unwrap();
    let without_record = TravellingWave::new(pulse, 500.0, -4.0).unwrap();
    assert!(TrenchMotion::travelling(&ground, &without_record, &mut unobserved).is_err());
}
