//! GOAL: a layer of the same soil as below it changes nothing.
//! SCENE: strips, mats and trenches, in frequency and time, under waves from below at any angle.
//! REFERENCE: the half-plane or half-space.

use basemat::bem::embedded::{Trench, TrenchElements, TrenchGround};
use basemat::bem::layered::{Stages, StripContact};
use basemat::bem::plan::{Plan, impedances_in_plan};
use basemat::bem::{ElasticGround, Ground, Strip};
use basemat::motion::{FreeField, PlaneWave, Record, VerticalIncidence};
use basemat::site::{InclinedControl, InclinedWave, TrenchMotion};
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::{Complex, Result, Soil, unobserved};
use basemat_problems::random::Random;

use super::tally::{IdentityTally, scenes};

/// A random soil, and the same soil in one or two layers upon itself, with the same damping.
struct UniformSite {
    half_space: SoilProfile,
    layered: SoilProfile,
    /// Shear wave speed, m/s.
    speed: f64,
    soil: Soil,
    is_damped: bool,
}

impl UniformSite {
    /// Layers of 0.2 to 3 times the `length`, with damping by chance.
    fn draw(random: &mut Random, length: f64) -> Self {
        Self::with_layers(random, |random| {
            let count = random.pick(&[1, 2]);
            (0..count).map(|_| length * random.log_within(0.2, 3.0)).collect()
        })
    }

    /// Layers of these thicknesses, with damping by chance.
    fn with_layers(random: &mut Random, thicknesses: impl FnOnce(&mut Random) -> Vec<f64>) -> Self {
        let speed = random.log_within(100.0, 400.0);
        let poisson = random.within(0.1, 0.45);
        let soil = Soil::from_shear_wave_speed(speed, poisson, random.within(1600.0, 2100.0));
        let soil = soil.unwrap();
        let damping = GeneralizedMaxwell::constant_q(0.04, [0.05, 50.0], 1.0).unwrap();
        let is_damped = random.chance(0.5);
        let mut half_space = SoilProfile::on_half_plane(soil);
        if is_damped {
            half_space = half_space.with_bedrock_damping(damping.clone());
        }
        let mut layered = half_space.clone();
        for thickness in thicknesses(random) {
            layered = layered.with_layer(soil, thickness).unwrap();
            if is_damped {
                layered = layered.with_damping(damping.clone());
            }
        }
        Self { half_space, layered, speed, soil, is_damped }
    }

    fn profiles(&self) -> [SoilProfile; 2] {
        [self.half_space.clone(), self.layered.clone()]
    }
}

/// Largest difference of two lists, relative to the largest number of both.
fn relative_difference(one: &[f64], other: &[f64]) -> f64 {
    assert_eq!(one.len(), other.len());
    let scale = one.iter().chain(other).fold(0.0, |scale: f64, value| scale.max(value.abs()));
    let pairs = one.iter().zip(other);
    let max_magnitude = pairs.fold(0.0, |max_magnitude: f64, (a, b)| {
        let difference = (a - b).abs();
        if difference.is_nan() { f64::NAN } else { max_magnitude.max(difference) }
    });
    if max_magnitude == 0.0 { 0.0 } else { max_magnitude / scale }
}

/// Real and imaginary parts of complex numbers, one after the other.
fn real_and_imaginary_parts(values: &[Complex]) -> Vec<f64> {
    values.iter().flat_map(|value| [value.re, value.im]).collect()
}

/// GOAL: inclined waves in frequency are equal up to their delay.
#[test]
fn waves_from_below_at_any_angle() {
    let mut tally = IdentityTally::new("layer of the same soil: waves in frequency");
    let mut random = Random(711);
    for number in 0..scenes(40, 400) {
        let site = UniformSite::draw(&mut random, 10.0);
        let angle = random.within(-1.2, 1.2);
        // At most one wavelength in the thickest layers.
        let frequency = random.log_within(0.02, 1.0) * site.speed / 60.0;
        // A damped base has the slowness of its elastic constants: its outcrop is another reference.
        if site.is_damped {
            continue;
        }
        let control =
            random.pick(&[InclinedControl::OutcropHorizontal, InclinedControl::OutcropVertical]);
        let kind = random.pick(&["SV", "P", "SH"]);
        tally.scene(&["layers", kind]);
        let transfers = site.profiles().map(|profile| {
            let wave = match kind {
                "SV" => InclinedWave::sv(profile, angle),
                "P" => InclinedWave::p(profile, angle),
                _ => InclinedWave::sh(profile, angle),
            };
            wave.and_then(|wave| wave.transfer(control, frequency))
        });
        let place = format!("{number}: {kind} at {angle:.3}, {frequency:.3} Hz");
        tally.compare(&place, transfers, |tally, one, other| {
            // The wave reaches the surface later than its outcrop: both components by one factor.
            let scale = one[0].abs().hypot(one[1].abs());
            let other_scale = other[0].abs().hypot(other[1].abs());
            let determinant = (other[0] * one[1] - other[1] * one[0]).abs();
            tally.within(&place, determinant / (scale * other_scale), 1e-9);
            tally.within(&place, (other_scale / scale - 1.0).abs(), 1e-9);
        });
    }
    tally.close(0.5);
}

/// Impedances of a strip, a mat or a trench on a profile, in Hz and m.
fn impedance_numbers(
    profile: SoilProfile,
    kind: &str,
    contact: StripContact,
    frequency: f64,
    half_width: f64,
    depth: f64,
) -> Result<Vec<f64>> {
    match kind {
        "half-plane" => {
            let strip = Strip::graded(-half_width..half_width, 5)?;
            let ground = ElasticGround::new(profile, strip)?;
            let impedance = ground.impedances(&[frequency], contact, &mut unobserved)?[0];
            Ok(real_and_imaginary_parts(&[impedance.horizontal, impedance.vertical]))
        }
        "mat" => {
            let y = 0.7 * half_width;
            let plan = Plan::rectangle(-half_width..half_width, -y..y, 6)?;
            let impedances =
                impedances_in_plan(&profile, &plan, &[frequency], contact, &mut unobserved)?;
            let matrix = impedances[0].matrix;
            Ok(real_and_imaginary_parts(&[matrix[0][0], matrix[1][1], matrix[2][2]]))
        }
        _ => {
            let elements = Trench::new(-half_width..half_width, depth)?.elements(4, 3)?;
            let ground = TrenchGround::new(profile, elements)?;
            let impedance = ground.impedances(&[frequency], &mut unobserved)?[0];
            let motion = ground.kinematic_motions(&[frequency], &mut unobserved)?[0];
            let scale = 1.0 / impedance.horizontal.abs();
            Ok(real_and_imaginary_parts(&[
                impedance.horizontal * scale,
                impedance.vertical * scale,
                motion.horizontal,
                motion.vertical,
            ]))
        }
    }
}

/// GOAL: impedances of the same elements, with wavenumber integrals of layers, are equal.
#[test]
fn impedances_of_strips_mats_and_trenches() {
    let mut tally = IdentityTally::new("layer of the same soil: impedances");
    let mut random = Random(712);
    for number in 0..scenes(6, 60) {
        let half = random.log_within(1.0, 5.0);
        let site = UniformSite::draw(&mut random, half);
        let frequency = random.within(0.3, 2.0) * site.speed / (std::f64::consts::TAU * half);
        let kind = ["half-plane", "mat", "trench"][number % 3];
        let contact = random.pick(&[StripContact::Bonded, StripContact::Relaxed]);
        let depth = half * random.within(0.3, 1.5);
        tally.scene(&["layers", kind]);
        let impedances = site
            .profiles()
            .map(|profile| impedance_numbers(profile, kind, contact, frequency, half, depth));
        let place = format!("{number}: {kind}, half width {half:.2}, {frequency:.2} Hz");
        // Finite elements of a trench divide the layers in another way.
        let limit = if kind == "trench" { 2e-3 } else { 1e-6 };
        tally.compare(&place, impedances, |tally, one, other| {
            tally.within(&place, relative_difference(&one, &other), limit);
        });
    }
    tally.close(0.5);
}

const CONVOLUTION_STEPS: usize = 8;

/// Step compliance of a ground, and its displacements after each step by the tractions so far.
///
/// `traction`: of a step and a component.
fn step_responses(
    ground: &mut dyn Ground,
    time_step: f64,
    steps: usize,
    mut traction: impl FnMut(usize, usize) -> f64,
) -> Result<[Vec<f64>; 2]> {
    ground.prepare(time_step, Some(steps), &mut unobserved)?;
    let size = ground.elements().len() * ground.elements()[0].directions().len();
    let mut compliance = vec![0.0; size * size];
    ground.step_compliance(&mut compliance)?;
    let mut displacements = Vec::new();
    for step in 1..steps {
        let tractions: Vec<f64> = (0..size).map(|component| traction(step, component)).collect();
        ground.commit(&tractions);
        let mut history = vec![0.0; size];
        ground.history(&mut history)?;
        displacements.extend(history);
    }
    Ok([compliance, displacements])
}

/// Random tractions in each step, which excite the shortest waves of the convolution.
fn random_tractions(seed: u64) -> impl FnMut(usize, usize) -> f64 {
    let mut random = Random(seed);
    move |_, _| random.within(-1.0, 1.0)
}

/// GOAL: step compliances and convolutions of strips and mats are equal.
#[test]
fn steps_of_strips_and_mats() {
    let mut tally = IdentityTally::new("layer of the same soil: convolution weights");
    let mut random = Random(713);
    for number in 0..scenes(2, 40) {
        let half = random.log_within(1.0, 5.0);
        let site = UniformSite::draw(&mut random, half);
        let step = random.log_within(0.1, 0.6) * half / site.speed;
        let stages = random.pick(&[Stages::Two, Stages::Three]);
        let kind = ["half-plane", "mat"][number % 2];
        tally.scene(&["layers", kind]);
        let responses = site.profiles().map(|profile| {
            let ground = if kind == "mat" {
                let plan = Plan::rectangle(-half..half, -0.7 * half..0.7 * half, 3)?;
                ElasticGround::in_plan(profile, plan)?
            } else {
                ElasticGround::new(profile, Strip::graded(-half..half, 3)?)?
            };
            // Without stages the half-plane has its closed form.
            let mut ground = ground.with_stages(stages);
            let tractions = random_tractions(number as u64);
            Ok(step_responses(&mut ground, step, CONVOLUTION_STEPS, tractions)?.concat())
        });
        let place = format!("{number}: {kind}, half width {half:.2}, step {step:.4}");
        tally.compare(&place, responses, |tally, one, other| {
            tally.within(&place, relative_difference(&one, &other), 1e-6);
        });
    }
    tally.close(0.5);
}

/// Steps over which smooth tractions grow and fade.
const SMOOTH_STEPS: usize = 60;

/// GOAL: convolutions around trenches, whose finite elements end at interfaces, are equal or differ by the mesh's error.
///
/// Where interfaces lie on lines of the mesh, the meshes are equal, and so are the responses to any tractions. Elsewhere
/// they differ by the error of the mesh. Waves of single steps are shorter than its elements, which are as long as the
/// contact elements: the step compliance differs by per cents. Tractions that grow and fade over many steps excite waves
/// that the mesh resolves, and leave the error at the corners of the trench, as in frequency.
#[test]
fn steps_around_trenches() {
    let mut tally =
        IdentityTally::new("layer of the same soil: convolution weights around trenches");
    let mut random = Random(715);
    for number in 0..scenes(2, 40) {
        let half = random.log_within(1.0, 5.0);
        let on_lines = number % 2 == 0;
        // Halves of the walls are longer than the elements that the far columns join.
        let depth = half * if on_lines { random.within(0.9, 1.5) } else { random.within(0.3, 1.5) };
        let site = if on_lines {
            let middle = 0.5 * depth;
            let cuts = [vec![middle], vec![depth], vec![middle, middle]];
            UniformSite::with_layers(&mut random, |random| cuts[random.pick(&[0, 1, 2])].clone())
        } else {
            UniformSite::draw(&mut random, half)
        };
        let step = random.log_within(0.1, 0.2) * half / site.speed;
        let stages = random.pick(&[Stages::Two, Stages::Three]);
        tally.scene(&["layers", "trench"]);
        let amplitude: Vec<f64> = (0..20).map(|_| random.within(-1.0, 1.0)).collect();
        let responses = site.profiles().map(|profile| {
            let trench = Trench::new(-half..half, depth)?;
            let elements = if on_lines { trench.elements(2, 2)? } else { trench.elements(4, 3)? };
            let mut ground = TrenchGround::new(profile, elements)?.with_stages(stages);
            if on_lines {
                let tractions = random_tractions(number as u64);
                let responses = step_responses(&mut ground, step, CONVOLUTION_STEPS, tractions)?;
                return Ok(responses.concat());
            }
            let [_, displacements] =
                step_responses(&mut ground, step, SMOOTH_STEPS, |step, component| {
                    let phase = std::f64::consts::PI * step as f64 / SMOOTH_STEPS as f64;
                    amplitude[component] * phase.sin().powi(2)
                })?;
            Ok(displacements)
        });
        let interfaces = if on_lines { "on lines" } else { "anywhere" };
        let place = format!(
            "{number}: interfaces {interfaces}, half width {half:.2}, depth {depth:.2}, step {step:.4}"
        );
        let limit = if on_lines { 1e-9 } else { 2e-3 };
        tally.compare(&place, responses, |tally, one, other| {
            tally.within(&place, relative_difference(&one, &other), limit);
        });
    }
    tally.close(0.5);
}

/// A pulse of acceleration that ends at rest.
fn record(random: &mut Random, time: f64) -> Record {
    let rate = random.within(0.5, 2.0) / time;
    let duration = 24.0 / rate;
    Record::from_fn(0.08 / rate, duration, |t: f64| {
        let x = rate * t - 12.0;
        (-x * x).exp() * (-6.0 + 24.0 * x * x - 8.0 * x.powi(4))
    })
    .unwrap()
}

/// Displacements and impulses at all faces, at times over a record.
fn at_faces(motion: &TrenchMotion, elements: &TrenchElements, end: f64) -> [Vec<f64>; 2] {
    let faces = elements.elements();
    let size = 2 * faces.len();
    let mut displacements = Vec::new();
    let mut impulses = Vec::new();
    for k in 0..48 {
        let mut displacement = vec![0.0; size];
        let mut impulse = vec![0.0; size];
        let time = end * f64::from(k) / 47.0;
        assert!(motion.at_faces(&faces, time, &mut displacement, &mut impulse));
        displacements.extend(displacement);
        impulses.extend(impulse);
    }
    [displacements, impulses]
}

/// Error of the transform of a record, whose length layers change.
const TRANSFORM_ERROR: f64 = 1e-5;

/// GOAL: motions and tractions of the soil at the faces of a trench are equal.
#[test]
fn waves_at_the_faces_of_trenches() {
    let mut tally = IdentityTally::new("layer of the same soil: waves at the faces of trenches");
    let mut random = Random(714);
    for number in 0..scenes(12, 240) {
        let half = random.log_within(1.0, 6.0);
        let depth = half * random.within(0.3, 1.5);
        let site = UniformSite::draw(&mut random, depth);
        let kind = ["vertical waves", "SV", "P", "Rayleigh"][number % 4];
        // Short surface waves do not reach the base.
        let period_factor = if kind == "Rayleigh" { 4.0 } else { 1.0 };
        let record = record(&mut random, period_factor * depth / site.speed);
        tally.scene(&["trench", "layers", kind]);
        let angle = random.within(0.05, 0.5);
        let elements = Trench::new(-half..half, depth).unwrap().elements(4, 3).unwrap();
        let motions = site.profiles().map(|profile| {
            let ground = TrenchGround::new(profile, elements.clone())?;
            let soil = site.soil;
            let motion = if kind == "vertical waves" {
                let vertical = Some(record.scaled(0.6)?);
                let surface = VerticalIncidence { horizontal: Some(record.clone()), vertical };
                TrenchMotion::new(&ground, surface, &mut unobserved)?
            } else {
                let wave = match kind {
                    "SV" => PlaneWave::sv(soil, angle)?.field_from_horizontal(&record, -half)?,
                    "P" => PlaneWave::p(soil, angle)?.field_from_vertical(&record, -half)?,
                    _ => PlaneWave::rayleigh(soil).field_from_horizontal(&record, -half)?,
                };
                TrenchMotion::travelling(&ground, &wave, &mut unobserved)?
            };
            Ok(at_faces(&motion, &elements, record.duration()))
        });
        let place = format!("{number}: {kind}, half width {half:.2}, depth {depth:.2}");
        tally.compare(&place, motions, |tally, one, other| {
            for (k, name) in ["motion", "impulse"].into_iter().enumerate() {
                let difference = relative_difference(&one[k], &other[k]);
                tally.within(&format!("{name}, {place}"), difference, TRANSFORM_ERROR);
            }
        });
    }
    tally.close(0.5);
}
