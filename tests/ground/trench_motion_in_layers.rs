//! GOAL: waves at the faces of a trench are those of the profile, at every depth of every layer.
//! SCENE: trenches that end in, at or below layers; vertical, inclined and Rayleigh waves, with and without damping.
//! REFERENCE: the half-plane, for layers of its soil; waves up and down in time, and transfer functions, through layers.

use std::f64::consts::{PI, TAU};

use basemat::bem::embedded::{Trench, TrenchElements, TrenchGround};
use basemat::motion::{FreeField, PlaneWave, Record, TravellingWave, VerticalIncidence};
use basemat::site::TrenchMotion;
use basemat::soil::{Elastic, GeneralizedMaxwell, Relaxation, SoilProfile};
use basemat::{Complex, Soil, unobserved};

const DEPTH: f64 = 5.0;
const WALL: usize = 6;
/// Number of elements of the base.
const BASE: usize = 2;
/// Rate of the pulse, 1/s, and its middle, s.
const RATE: f64 = 25.0;
const MIDDLE: f64 = 1.0;

fn elements() -> TrenchElements {
    Trench::new(-4.0..6.0, DEPTH).unwrap().elements(BASE, WALL).unwrap()
}

fn soil(speed: f64, poisson: f64, density: f64) -> Soil {
    Soil::from_shear_wave_speed(speed, poisson, density).unwrap()
}

/// (1 − 2x²) exp(−x²), the displacement of the surface.
fn pulse(time: f64) -> f64 {
    let square = (RATE * (time - MIDDLE)).powi(2);
    (1.0 - 2.0 * square) * (-square).exp()
}

fn record(step: f64) -> Record {
    let second = |time: f64| {
        let square = (RATE * (time - MIDDLE)).powi(2);
        RATE * RATE * (-6.0 + square * (24.0 - 8.0 * square)) * (-square).exp()
    };
    Record::from_fn(step, 2.0, second).unwrap()
}

/// Displacements and impulses at all elements, normal components first.
fn at_faces(motion: &TrenchMotion, time: f64) -> [Vec<f64>; 2] {
    let elements = elements().elements();
    let mut found = [vec![0.0; 2 * elements.len()], vec![0.0; 2 * elements.len()]];
    let [moved, impulse] = &mut found;
    assert!(motion.at_faces(&elements, time, moved, impulse));
    found
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

fn same_soil_changes_nothing<L: Relaxation + Clone + 'static>(damping: &L) {
    let soil = soil(200.0, 0.3, 1900.0);
    let record = record(0.005);
    let sv = PlaneWave::sv(soil, 0.4).unwrap().field_from_horizontal(&record, -4.0).unwrap();
    let p = PlaneWave::p(soil, -0.7).unwrap().field_from_horizontal(&record, 6.0).unwrap();
    let surface = PlaneWave::rayleigh(soil).field_from_horizontal(&record, -4.0).unwrap();
    let both = VerticalIncidence { horizontal: Some(record.clone()), vertical: Some(record) };
    let travelling = |ground: &TrenchGround, wave: &TravellingWave| {
        TrenchMotion::travelling(ground, wave, &mut unobserved).unwrap()
    };
    let motions = |layers: &[f64]| -> Vec<TrenchMotion> {
        let ground = layered(soil, damping, layers);
        let vertical = TrenchMotion::new(&ground, both.clone(), &mut unobserved).unwrap();
        let waves = [&sv, &p, &surface].map(|wave| travelling(&ground, wave));
        std::iter::once(vertical).chain(waves).collect()
    };
    let wanted = motions(&[]);
    let thicknesses: [&[f64]; 5] =
        [&[0.5], &[DEPTH], &[2.0 * DEPTH], &[0.7, 0.4, 2.1, 1.8, 3.0], &[0.3; 18]];
    for layers in thicknesses {
        for (kind, (found, wanted)) in motions(layers).iter().zip(&wanted).enumerate() {
            let [mut apart, mut largest] = [[0.0_f64; 2]; 2];
            for step in 0..25 {
                let time = 0.85 + 0.013 * f64::from(step);
                let pairs = at_faces(found, time).into_iter().zip(at_faces(wanted, time));
                for (k, (found, wanted)) in pairs.enumerate() {
                    for (found, wanted) in found.iter().zip(&wanted) {
                        apart[k] = apart[k].max((found - wanted).abs());
                        largest[k] = largest[k].max(wanted.abs());
                    }
                }
            }
            for k in 0..2 {
                let error = apart[k] / largest[k];
                assert!(error < 1e-10, "layers {layers:?}, wave {kind}, number {k}: {error:e}");
            }
        }
    }
}

#[test]
fn a_layer_of_the_same_soil_changes_nothing() {
    same_soil_changes_nothing(&Elastic);
}

#[test]
fn a_layer_of_the_same_damped_soil_changes_nothing() {
    same_soil_changes_nothing(&GeneralizedMaxwell::constant_q(0.04, [0.1, 40.0], 1.0).unwrap());
}

struct Layer {
    soil: Soil,
    thickness: f64,
}

fn layers() -> [Layer; 3] {
    [
        Layer { soil: soil(120.0, 0.35, 1600.0), thickness: 1.3 },
        Layer { soil: soil(260.0, 0.25, 2000.0), thickness: 2.6 },
        Layer { soil: soil(500.0, 0.3, 2200.0), thickness: f64::INFINITY },
    ]
}

/// The layer at a depth, and the depth below its top.
fn layer_at(depth: f64) -> (usize, f64) {
    let mut below = depth;
    for (k, layer) in layers().iter().enumerate() {
        if below <= layer.thickness {
            return (k, below);
        }
        below -= layer.thickness;
    }
    unreachable!("the last layer has no end")
}

/// Mean over each level of a pair of functions of depth, and the pair at the base.
fn levels(at: impl Fn(f64) -> [f64; 3]) -> Vec<[f64; 3]> {
    // The stress on a vertical plane jumps where the soil changes.
    const POINTS: usize = 2000;
    let ends = |e: usize| {
        let own = elements().elements()[e];
        let [middle, half] = [-own.center()[2], 0.5 * own.length()];
        [middle - half, middle + half]
    };
    let mut found = vec![];
    for e in 0..WALL {
        let [top, bottom] = ends(e);
        let mut sum = [0.0; 3];
        for k in 0..POINTS {
            let depth = top + (bottom - top) * (k as f64 + 0.5) / POINTS as f64;
            for (sum, value) in sum.iter_mut().zip(at(depth)) {
                *sum += value / POINTS as f64;
            }
        }
        found.push(sum);
    }
    found.push(at(DEPTH));
    found
}

/// Largest error of motion and impulses over their largest values, at the levels of the left wall and the base.
///
/// `wanted` at a time and depth: displacement to the right or up, impulse of the stress of the wave, and impulse of the
/// stress on a vertical plane.
fn error(motion: &TrenchMotion, is_shear: bool, wanted: impl Fn(f64, f64) -> [f64; 3]) -> f64 {
    let count = 2 * WALL + BASE;
    let [mut apart, mut largest] = [[0.0_f64; 2]; 2];
    for step in 0..24 {
        let time = 0.85 + 0.015 * f64::from(step);
        let [moved, impulse] = at_faces(motion, time);
        for (e, [displacement, stress, sideways]) in
            levels(|depth| wanted(time, depth)).into_iter().enumerate()
        {
            // Normals lead into the soil: to the left at the wall, down at the base; the wall's tangent leads down.
            let pairs = match (is_shear, e == WALL) {
                (true, false) => [(-moved[e], displacement), (impulse[count + e], stress)],
                (true, true) => [(moved[count + e], displacement), (-impulse[count + e], stress)],
                (false, false) => [(-moved[count + e], displacement), (impulse[e], sideways)],
                (false, true) => [(-moved[e], displacement), (impulse[e], stress)],
            };
            for (k, (found, wanted)) in pairs.into_iter().enumerate() {
                apart[k] = apart[k].max((found - wanted).abs());
                largest[k] = largest[k].max(wanted.abs());
            }
        }
    }
    (apart[0] / largest[0]).max(apart[1] / largest[1])
}

/// Displacement and impulse of the stress at a depth: waves up and down in each layer, of the ones in the layer above.
fn waves(time: f64, layer: usize, below: f64, is_shear: bool) -> [f64; 2] {
    let Layer { soil, .. } = layers()[layer];
    let speed = if is_shear { soil.shear_wave_speed() } else { soil.pressure_wave_speed() };
    let impedance = soil.density() * speed;
    // Displacement and impulse at the top of the layer.
    let at_top = |time: f64| match layer {
        0 => [pulse(time), 0.0],
        _ => waves(time, layer - 1, layers()[layer - 1].thickness, is_shear),
    };
    let [earlier, later] = [at_top(time + below / speed), at_top(time - below / speed)];
    let up = 0.5 * (earlier[0] + earlier[1] / impedance);
    let down = 0.5 * (later[0] - later[1] / impedance);
    [up + down, impedance * (up - down)]
}

/// Undamped layers: each sends the waves of its top down and up again, in time.
#[test]
fn vertical_waves_in_layers_are_waves_up_and_down() {
    let [upper, middle, rock] = layers();
    let profile = SoilProfile::on_half_plane(rock.soil)
        .with_layer(upper.soil, upper.thickness)
        .and_then(|profile| profile.with_layer(middle.soil, middle.thickness))
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
        let found = error(&motion, is_shear, |time, depth| {
            let (layer, below) = layer_at(depth);
            let [displacement, impulse] = waves(time, layer, below, is_shear);
            let poisson = layers()[layer].soil.poisson();
            [displacement, impulse, poisson / (1.0 - poisson) * impulse]
        });
        assert!(found < 2e-4, "shear waves {is_shear}: {found:e}");
    }
}

/// Damped layers on rock: the sum over frequencies of transfer functions of the surface's motion.
#[test]
fn damped_vertical_waves_in_layers_follow_their_transfer_functions() {
    const PERIOD: f64 = 6.0;
    let laws = [0.06, 0.03, 0.01]
        .map(|ratio| GeneralizedMaxwell::constant_q(ratio, [0.1, 40.0], 1.0).unwrap());
    let [upper, middle, rock] = layers();
    let [of_upper, of_middle, of_rock] = laws.clone();
    let profile = SoilProfile::on_half_plane(rock.soil)
        .with_bedrock_damping(of_rock)
        .with_layer(upper.soil, upper.thickness)
        .unwrap()
        .with_damping(of_upper)
        .with_layer(middle.soil, middle.thickness)
        .unwrap()
        .with_damping(of_middle);
    let ground = TrenchGround::new(profile, elements()).unwrap();
    // Displacement and stress at a depth per unit motion of the surface, at iω.
    let transfer = |s: Complex, depth: f64| {
        let (last, below) = layer_at(depth);
        let [mut moved, mut stress] = [Complex::real(1.0), Complex::default()];
        for (k, layer) in layers().iter().enumerate().take(last + 1) {
            let height = if k == last { below } else { layer.thickness };
            let modulus = laws[k].modulus(s) * Complex::real(layer.soil.shear_modulus());
            let slowness = s * (Complex::real(layer.soil.density()) / modulus).sqrt();
            let [up, down] = [height, -height].map(|z| (slowness * Complex::real(z)).exp());
            let [even, odd] = [(up + down) * 0.5, (up - down) * 0.5];
            let stiffness = modulus * slowness;
            (moved, stress) =
                (moved * even + stress * odd / stiffness, moved * odd * stiffness + stress * even);
        }
        [moved, stress / s]
    };
    // Spectrum of the pulse.
    let spectrum = |omega: f64| {
        let size = PI.sqrt() / RATE * 0.5 * (omega / RATE).powi(2);
        size * (-(0.5 * omega / RATE).powi(2)).exp()
    };
    let step = TAU / PERIOD;
    let found = {
        let motion = VerticalIncidence { horizontal: Some(record(0.001)), vertical: None };
        let motion = TrenchMotion::new(&ground, motion, &mut unobserved).unwrap();
        error(&motion, true, |time, depth| {
            let mut sum = [0.0; 2];
            for k in 1..260 {
                let omega = step * f64::from(k);
                let turned = Complex::new(0.0, omega * (time - MIDDLE)).exp();
                let of_wave = transfer(Complex::new(0.0, omega), depth);
                for (sum, value) in sum.iter_mut().zip(of_wave) {
                    *sum += step / PI * spectrum(omega) * (value * turned).re;
                }
            }
            [sum[0], sum[1], 0.0]
        })
    };
    assert!(found < 5e-4, "{found:e}");
}
