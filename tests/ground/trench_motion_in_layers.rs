//! GOAL: motions at the faces of a trench are those of the profile, at every depth of every layer.
//! SCENE: trenches that end in, at or below layers; vertical, inclined and Rayleigh waves, with and without damping.
//! REFERENCE: the half-plane, for layers of its soil; upward and downward waves in time, and transfer functions.

use std::f64::consts::{PI, TAU};

use basemat::bem::embedded::{Trench, TrenchElements, TrenchGround};
use basemat::motion::{FreeField, PlaneWave, Record, VerticalIncidence};
use basemat::site::TrenchMotion;
use basemat::soil::{Elastic, GeneralizedMaxwell, Relaxation, SoilProfile};
use basemat::{Complex, Soil, unobserved};

/// Depth of the trench, m.
const TRENCH_DEPTH: f64 = 5.0;
const WALL_ELEMENTS: usize = 6;
const BASE_ELEMENTS: usize = 2;
/// Inverse of the pulse's width, 1/s.
const PULSE_RATE: f64 = 25.0;
/// Middle of the pulse, s.
const PULSE_TIME: f64 = 1.0;

fn elements() -> TrenchElements {
    Trench::new(-4.0..6.0, TRENCH_DEPTH)
        .unwrap()
        .elements(BASE_ELEMENTS, WALL_ELEMENTS)
        .unwrap()
}

fn soil(speed: f64, poisson: f64, density: f64) -> Soil {
    Soil::from_shear_wave_speed(speed, poisson, density).unwrap()
}

/// (1 − 2x²) exp(−x²), the displacement of the surface.
fn pulse(time: f64) -> f64 {
    let square = (PULSE_RATE * (time - PULSE_TIME)).powi(2);
    (1.0 - 2.0 * square) * (-square).exp()
}

/// Second derivative of the pulse.
fn pulse_acceleration(time: f64) -> f64 {
    let square = (PULSE_RATE * (time - PULSE_TIME)).powi(2);
    PULSE_RATE * PULSE_RATE * (-6.0 + square * (24.0 - 8.0 * square)) * (-square).exp()
}

fn record(step: f64) -> Record {
    Record::from_fn(step, 2.0, pulse_acceleration).unwrap()
}

/// Displacements and impulses at all elements, normal components first.
fn at_faces(motion: &TrenchMotion, time: f64) -> [Vec<f64>; 2] {
    let elements = elements().elements();
    let mut displacement = vec![0.0; 2 * elements.len()];
    let mut impulse = vec![0.0; 2 * elements.len()];
    assert!(motion.at_faces(&elements, time, &mut displacement, &mut impulse));
    [displacement, impulse]
}

/// Largest differences of two quantities, relative to their largest expected values.
#[derive(Default)]
struct RelativeErrors {
    differences: [f64; 2],
    largest: [f64; 2],
}

impl RelativeErrors {
    fn add(&mut self, k: usize, computed: f64, expected: f64) {
        self.differences[k] = self.differences[k].max((computed - expected).abs());
        self.largest[k] = self.largest[k].max(expected.abs());
    }

    fn values(&self) -> [f64; 2] {
        [0, 1].map(|k| self.differences[k] / self.largest[k])
    }
}

fn layered<L: Relaxation + Clone + 'static>(
    soil: Soil,
    damping: &L,
    layers: &[f64],
) -> TrenchGround {
    let mut profile = SoilProfile::on_half_plane(soil).with_bedrock_damping(damping.clone());
    for thickness in layers {
        profile = profile.with_layer(soil, *thickness).unwrap().with_damping(damping.clone());
    }
    TrenchGround::new(profile, elements()).unwrap()
}

/// Motions by vertical, SV, P and Rayleigh waves.
fn motions_by_all_waves(soil: Soil, ground: &TrenchGround) -> Vec<TrenchMotion> {
    let record = record(0.005);
    let sv = PlaneWave::sv(soil, 0.4).unwrap().field_from_horizontal(&record, -4.0).unwrap();
    let p = PlaneWave::p(soil, -0.7).unwrap().field_from_horizontal(&record, 6.0).unwrap();
    let rayleigh = PlaneWave::rayleigh(soil).field_from_horizontal(&record, -4.0).unwrap();
    let vertical = VerticalIncidence { horizontal: Some(record.clone()), vertical: Some(record) };
    let mut motions = vec![TrenchMotion::new(ground, vertical, &mut unobserved).unwrap()];
    for wave in [sv, p, rayleigh] {
        motions.push(TrenchMotion::travelling(ground, &wave, &mut unobserved).unwrap());
    }
    motions
}

/// Compares layers of one soil with its half-plane.
fn check_layers_of_one_soil<L: Relaxation + Clone + 'static>(damping: &L) {
    let soil = soil(200.0, 0.3, 1900.0);
    let expected_motions = motions_by_all_waves(soil, &layered(soil, damping, &[]));
    let thicknesses: [&[f64]; 5] =
        [&[0.5], &[TRENCH_DEPTH], &[2.0 * TRENCH_DEPTH], &[0.7, 0.4, 2.1, 1.8, 3.0], &[0.3; 18]];
    for layers in thicknesses {
        let motions = motions_by_all_waves(soil, &layered(soil, damping, layers));
        for (wave, (motion, expected_motion)) in motions.iter().zip(&expected_motions).enumerate() {
            let mut errors = RelativeErrors::default();
            for step in 0..25 {
                let time = 0.85 + 0.013 * f64::from(step);
                let computed = at_faces(motion, time);
                let expected = at_faces(expected_motion, time);
                for k in 0..2 {
                    for (computed, expected) in computed[k].iter().zip(&expected[k]) {
                        errors.add(k, *computed, *expected);
                    }
                }
            }
            for (k, error) in errors.values().into_iter().enumerate() {
                assert!(error < 1e-10, "layers {layers:?}, wave {wave}, number {k}: {error:e}");
            }
        }
    }
}

/// GOAL: interfaces within one elastic soil change nothing.
#[test]
fn a_layer_of_the_same_soil_changes_nothing() {
    check_layers_of_one_soil(&Elastic);
}

/// GOAL: interfaces within one damped soil change nothing.
#[test]
fn a_layer_of_the_same_damped_soil_changes_nothing() {
    check_layers_of_one_soil(&GeneralizedMaxwell::constant_q(0.04, [0.1, 40.0], 1.0).unwrap());
}

/// A layer of the profile that damped and undamped waves pass.
struct ProfileLayer {
    soil: Soil,
    thickness: f64,
}

/// Two layers and the rock.
fn layers() -> [ProfileLayer; 3] {
    [
        ProfileLayer { soil: soil(120.0, 0.35, 1600.0), thickness: 1.3 },
        ProfileLayer { soil: soil(260.0, 0.25, 2000.0), thickness: 2.6 },
        ProfileLayer { soil: soil(500.0, 0.3, 2200.0), thickness: f64::INFINITY },
    ]
}

/// The layer at a depth, and the depth below its top.
fn layer_at(depth: f64) -> (usize, f64) {
    let mut below_top = depth;
    for (k, layer) in layers().iter().enumerate() {
        if below_top <= layer.thickness {
            return (k, below_top);
        }
        below_top -= layer.thickness;
    }
    unreachable!("the last layer has no end")
}

/// Displacement and stress impulses of a wave at a depth.
#[derive(Clone, Copy, Default)]
struct WaveAtDepth {
    /// Displacement to the right or up.
    displacement: f64,
    /// Impulse of the stress on a horizontal plane.
    impulse: f64,
    /// Impulse of the stress on a vertical plane.
    lateral_impulse: f64,
}

/// Number of points of the mean over an element. It is large, since the stress on a vertical plane jumps between soils.
const POINTS_PER_ELEMENT: usize = 2000;

/// Means over each element of the left wall, and the values at the base.
fn means_over_elements(wave_at: impl Fn(f64) -> WaveAtDepth) -> Vec<WaveAtDepth> {
    let mut means = vec![];
    for element in &elements().elements()[..WALL_ELEMENTS] {
        let middle = -element.center()[2];
        let half_length = 0.5 * element.length();
        let top = middle - half_length;
        let bottom = middle + half_length;
        let mut mean = WaveAtDepth::default();
        for k in 0..POINTS_PER_ELEMENT {
            let depth = top + (bottom - top) * (k as f64 + 0.5) / POINTS_PER_ELEMENT as f64;
            let wave = wave_at(depth);
            mean.displacement += wave.displacement / POINTS_PER_ELEMENT as f64;
            mean.impulse += wave.impulse / POINTS_PER_ELEMENT as f64;
            mean.lateral_impulse += wave.lateral_impulse / POINTS_PER_ELEMENT as f64;
        }
        means.push(mean);
    }
    means.push(wave_at(TRENCH_DEPTH));
    means
}

/// Largest error of displacements and impulses, relative to their largest values, at the left wall and the base.
///
/// `expected` is the wave at a time and depth.
fn largest_error(
    motion: &TrenchMotion,
    is_shear: bool,
    expected: impl Fn(f64, f64) -> WaveAtDepth,
) -> f64 {
    let count = 2 * WALL_ELEMENTS + BASE_ELEMENTS;
    let mut errors = RelativeErrors::default();
    for step in 0..24 {
        let time = 0.85 + 0.015 * f64::from(step);
        let [displacement, impulse] = at_faces(motion, time);
        let expected = means_over_elements(|depth| expected(time, depth));
        for (e, wave) in expected.into_iter().enumerate() {
            // Normals lead into the soil: to the left at the wall, down at the base; the wall's tangent leads down.
            let is_base = e == WALL_ELEMENTS;
            let computed = match (is_shear, is_base) {
                (true, false) => [-displacement[e], impulse[count + e]],
                (true, true) => [displacement[count + e], -impulse[count + e]],
                (false, false) => [-displacement[count + e], impulse[e]],
                (false, true) => [-displacement[e], impulse[e]],
            };
            let is_lateral = !is_shear && !is_base;
            errors.add(0, computed[0], wave.displacement);
            let impulse = if is_lateral { wave.lateral_impulse } else { wave.impulse };
            errors.add(1, computed[1], impulse);
        }
    }
    errors.values()[0].max(errors.values()[1])
}

/// Displacement and stress impulse at a depth of a layer, by upward and downward waves from its top.
fn upward_and_downward_waves(time: f64, layer: usize, below_top: f64, is_shear: bool) -> [f64; 2] {
    let soil = layers()[layer].soil;
    let speed = if is_shear { soil.shear_wave_speed() } else { soil.pressure_wave_speed() };
    let impedance = soil.density() * speed;
    let upward_motion = waves_at_top(time + below_top / speed, layer, is_shear);
    let downward_motion = waves_at_top(time - below_top / speed, layer, is_shear);
    let up = 0.5 * (upward_motion[0] + upward_motion[1] / impedance);
    let downward_amplitude = 0.5 * (downward_motion[0] - downward_motion[1] / impedance);
    [up + downward_amplitude, impedance * (up - downward_amplitude)]
}

/// Displacement and impulse of the stress at the top of a layer.
fn waves_at_top(time: f64, layer: usize, is_shear: bool) -> [f64; 2] {
    match layer {
        0 => [pulse(time), 0.0],
        _ => upward_and_downward_waves(time, layer - 1, layers()[layer - 1].thickness, is_shear),
    }
}

/// GOAL: vertical waves pass undamped layers.
/// REFERENCE: upward and downward waves in time, which follow in each layer from the motion of its top.
#[test]
fn vertical_waves_in_layers_are_upward_and_downward_waves() {
    let layers = layers();
    let profile = SoilProfile::on_half_plane(layers[2].soil)
        .with_layer(layers[0].soil, layers[0].thickness)
        .and_then(|profile| profile.with_layer(layers[1].soil, layers[1].thickness))
        .unwrap();
    let ground = TrenchGround::new(profile, elements()).unwrap();
    for is_shear in [true, false] {
        let record = record(0.0005);
        let motion = if is_shear {
            VerticalIncidence { horizontal: Some(record), vertical: None }
        } else {
            VerticalIncidence { horizontal: None, vertical: Some(record) }
        };
        let motion = TrenchMotion::new(&ground, motion, &mut unobserved).unwrap();
        let error = largest_error(&motion, is_shear, |time, depth| {
            let (layer, below_top) = layer_at(depth);
            let wave = upward_and_downward_waves(time, layer, below_top, is_shear);
            let poisson = layers[layer].soil.poisson();
            WaveAtDepth {
                displacement: wave[0],
                impulse: wave[1],
                lateral_impulse: poisson / (1.0 - poisson) * wave[1],
            }
        });
        assert!(error < 2e-4, "shear waves {is_shear}: {error:e}");
    }
}

/// Damping of the two layers and the rock.
fn damping_laws() -> [GeneralizedMaxwell; 3] {
    [0.06, 0.03, 0.01].map(|ratio| GeneralizedMaxwell::constant_q(ratio, [0.1, 40.0], 1.0).unwrap())
}

/// Displacement and impulse of the stress at a depth per unit motion of the surface, at s = iω.
fn transfer_to_depth(laws: &[GeneralizedMaxwell; 3], s: Complex, depth: f64) -> [Complex; 2] {
    let (last_layer, below_top) = layer_at(depth);
    let mut displacement = Complex::real(1.0);
    let mut stress = Complex::default();
    for (k, layer) in layers().iter().enumerate().take(last_layer + 1) {
        let height = if k == last_layer { below_top } else { layer.thickness };
        let modulus = laws[k].modulus(s) * Complex::real(layer.soil.shear_modulus());
        let slowness = s * (Complex::real(layer.soil.density()) / modulus).sqrt();
        let up = (slowness * Complex::real(height)).exp();
        let downward_factor = (slowness * Complex::real(-height)).exp();
        let cosh = (up + downward_factor) * 0.5;
        let sinh = (up - downward_factor) * 0.5;
        let stiffness = modulus * slowness;
        (displacement, stress) = (
            displacement * cosh + stress * sinh / stiffness,
            displacement * sinh * stiffness + stress * cosh,
        );
    }
    [displacement, stress / s]
}

/// Fourier transform of the pulse about its middle.
fn pulse_spectrum(omega: f64) -> f64 {
    let size = PI.sqrt() / PULSE_RATE * 0.5 * (omega / PULSE_RATE).powi(2);
    size * (-(0.5 * omega / PULSE_RATE).powi(2)).exp()
}

/// GOAL: vertical waves pass damped layers on rock.
/// REFERENCE: a Fourier sum of the transfer functions from the surface to each depth.
#[test]
fn damped_vertical_waves_in_layers_follow_their_transfer_functions() {
    /// Time after which the Fourier sum repeats, s.
    const FOURIER_PERIOD: f64 = 6.0;
    let laws = damping_laws();
    let layers = layers();
    let profile = SoilProfile::on_half_plane(layers[2].soil)
        .with_bedrock_damping(laws[2].clone())
        .with_layer(layers[0].soil, layers[0].thickness)
        .unwrap()
        .with_damping(laws[0].clone())
        .with_layer(layers[1].soil, layers[1].thickness)
        .unwrap()
        .with_damping(laws[1].clone());
    let ground = TrenchGround::new(profile, elements()).unwrap();
    let motion = VerticalIncidence { horizontal: Some(record(0.001)), vertical: None };
    let motion = TrenchMotion::new(&ground, motion, &mut unobserved).unwrap();
    let frequency_step = TAU / FOURIER_PERIOD;
    let error = largest_error(&motion, true, |time, depth| {
        let mut sum = [0.0; 2];
        for k in 1..260 {
            let omega = frequency_step * f64::from(k);
            let phase = Complex::new(0.0, omega * (time - PULSE_TIME)).exp();
            let transfer = transfer_to_depth(&laws, Complex::new(0.0, omega), depth);
            for (sum, value) in sum.iter_mut().zip(transfer) {
                *sum += frequency_step / PI * pulse_spectrum(omega) * (value * phase).re;
            }
        }
        WaveAtDepth { displacement: sum[0], impulse: sum[1], lateral_impulse: 0.0 }
    });
    assert!(error < 5e-4, "{error:e}");
}
