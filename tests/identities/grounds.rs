//! Grounds, laws and motions of scenes in any view.

use std::cell::RefCell;
use std::f64::consts::TAU;

use basemat::bem::embedded::{Trench, TrenchElements, TrenchGround};
use basemat::bem::layered::Stages;
use basemat::bem::{ElasticGround, Ground, SharedKernels, SpringGround};
use basemat::interface::{
    Bonded, Cohesive, Coulomb, CyclicYielding, EarthPressure, InterfaceLaw, SlipSense, ThinLayer,
    VariableFriction, Yielding,
};
use basemat::motion::{
    AtRest, FreeField, FreeFieldFn, PlaneWave, Record, RickerDisplacement, TravellingWave,
    Triaxial, VerticalIncidence,
};
use basemat::site::TrenchMotion;
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::structure::Structure;
use basemat::{Result, Soil, unobserved};

use super::numbers::{Numbers, RUN_STEPS, SOIL_DENSITY};
use super::parts::{Choice, GroundPart, LawPart, MotionPart, Space};
use super::structures::trench_depth;
use super::view::View;

thread_local! {
    /// Convolution weights of the mats and trenches of a scene, which its views share where their numbers are equal.
    static KERNELS: RefCell<SharedKernels> = RefCell::default();
}

/// Removes the weights of the last scene.
pub(crate) fn clear_shared_kernels() {
    KERNELS.replace(SharedKernels::default());
}

/// Elements of a strip.
pub(crate) const STRIP_ELEMENTS: usize = 6;
/// Cells along the shorter side of a mat.
pub(crate) const MAT_CELLS: usize = 4;

/// A damped layer of the soil on rock.
fn layers(numbers: &Numbers, view: &View) -> Result<SoilProfile> {
    let frame = &view.frame;
    let rock = Soil::new(5.0 * numbers.modulus * frame.pressure(), 0.3, 2200.0 * frame.density())?;
    let band = [0.1 / frame.time, 30.0 / frame.time];
    let damping = GeneralizedMaxwell::constant_q(0.04, band, 1.0 / frame.time)?;
    let depth = numbers.sides[0] * (0.5 + numbers.depth) * frame.length;
    let profile = SoilProfile::on_half_plane(rock).with_layer(numbers.soil(view), depth)?;
    Ok(profile.with_damping(damping))
}

pub(crate) fn profile(choice: &Choice, numbers: &Numbers, view: &View) -> Result<SoilProfile> {
    match choice.ground {
        GroundPart::Layers => layers(numbers, view),
        _ => Ok(numbers.soil(view).into()),
    }
}

/// Elements of the trench under the middle of the scene.
pub(crate) fn trench(numbers: &Numbers, view: &View) -> Result<TrenchElements> {
    let center = view.surface_point([0.0; 2])[0];
    let half_width = 0.5 * numbers.sides[0] * view.frame.length;
    let depth = trench_depth(numbers) * view.frame.length;
    Trench::new(center - half_width..center + half_width, depth)?.elements(2, 2)
}

/// Stages of a scene, fixed because the automatic choice depends on a frequency in hertz and thus on units.
fn stages(choice: &Choice) -> Stages {
    if choice.seed.is_multiple_of(3) { Stages::Three } else { Stages::Two }
}

/// The ground of a choice under its structure.
pub(crate) fn ground(
    choice: &Choice,
    numbers: &Numbers,
    structure: &dyn Structure,
    view: &View,
) -> Result<Box<dyn Ground>> {
    let frame = &view.frame;
    if choice.space == Space::Trench {
        let profile = profile(choice, numbers, view)?;
        let ground = TrenchGround::new(profile, trench(numbers, view)?)?;
        let ground = ground.with_stages(stages(choice));
        return Ok(Box::new(KERNELS.with_borrow(|kernels| ground.with_shared_kernels(kernels))));
    }
    let count = if choice.space == Space::Plan { MAT_CELLS } else { STRIP_ELEMENTS };
    if choice.ground == GroundPart::Springs {
        let stiffness = numbers.modulus * frame.pressure() / (numbers.sides[0] * frame.length);
        let speed = (numbers.modulus / SOIL_DENSITY).sqrt() * frame.length / frame.time;
        let dashpot = SOIL_DENSITY * frame.density() * speed;
        let bed = SpringGround::under(structure, count, 2.0 * stiffness, 1.5 * stiffness)?;
        return Ok(Box::new(bed.with_dashpots(2.0 * dashpot, dashpot)?));
    }
    let profile = profile(choice, numbers, view)?;
    let mut ground = ElasticGround::under(profile, structure, count)?;
    if choice.ground == GroundPart::Layers {
        ground = ground.with_stages(stages(choice));
    }
    if choice.space == Space::Plane {
        return Ok(Box::new(ground));
    }
    Ok(Box::new(KERNELS.with_borrow(|kernels| ground.with_shared_kernels(kernels))))
}

/// The law of a choice, for any element of its base.
pub(crate) fn law(kind: LawPart, numbers: &Numbers, view: &View) -> Result<Box<dyn InterfaceLaw>> {
    let frame = &view.frame;
    let friction = numbers.friction;
    let pressure = numbers.pressure() * frame.pressure();
    let stiffness = numbers.modulus * frame.pressure() / (0.05 * numbers.sides[0] * frame.length);
    Ok(match kind {
        LawPart::Bonded => Box::new(Bonded),
        LawPart::Friction => Box::new(Coulomb::new(friction)?),
        LawPart::Tension => {
            Box::new(Coulomb::new(friction)?.with_tensile_strength(0.3 * pressure)?)
        }
        LawPart::Cohesive => Box::new(Cohesive::new(0.3 * pressure, 0.5 * pressure, friction)?),
        LawPart::Yielding => Box::new(Yielding::new(4.0 * pressure, friction)?),
        LawPart::Cyclic => {
            let settlement = pressure / stiffness;
            let law = CyclicYielding::new(4.0 * pressure, settlement, friction)?;
            let law = law.with_elastic_range(0.2)?.with_depth_gradient(stiffness)?;
            Box::new(law)
        }
        // The active pressure is zero, so that the law suits the base, too.
        LawPart::Earth => Box::new(EarthPressure::new(0.0, 6.0 * pressure, friction)?),
        LawPart::Layer => {
            let layer = ThinLayer::from_stiffness(stiffness, 0.5 * stiffness, friction)?;
            Box::new(layer.with_debonded_ratio(0.0)?.with_slip_sense(SlipSense::Inelastic))
        }
        LawPart::Varying => {
            let speed = 0.05 * frame.length / frame.time;
            Box::new(VariableFriction::new(move |start| {
                friction * (0.8 + 0.2 * (-start.slip_rate.abs() / speed).exp())
            }))
        }
    })
}

/// Axis and sign in the view of an axis of the scene.
fn axis_in_view(view: &View, axis: usize) -> (usize, f64) {
    let mut unit = [0.0; 3];
    unit[axis] = 1.0;
    let in_view = view.vector(unit);
    let axis = in_view.iter().position(|part| *part != 0.0).unwrap_or(axis);
    (axis, in_view[axis])
}

/// The record of a peak (m/s²) in the view's units.
pub(crate) fn record(numbers: &Numbers, peak: f64, view: &View) -> Result<Record> {
    let scale = peak * view.frame.acceleration();
    let samples = (0..=RUN_STEPS).map(|k| scale * numbers.shape(k as f64 * numbers.time_step));
    Record::new(numbers.time_step * view.frame.time, samples.collect())
}

/// A wave over the soil, in the direction and with the strongest motion as the view has them.
fn wave(
    kind: MotionPart,
    choice: &Choice,
    numbers: &Numbers,
    view: &View,
) -> Result<TravellingWave> {
    let soil = numbers.soil(view);
    let in_plan = choice.space == Space::Plan;
    let azimuth = if in_plan { numbers.azimuth } else { 0.0 };
    let direction = [azimuth.cos(), azimuth.sin(), 0.0];
    let distance = -0.5 * numbers.sides[0].hypot(if in_plan { numbers.sides[1] } else { 0.0 });
    let first = view.surface_point([distance * direction[0], distance * direction[1]]);
    let direction = view.vector(direction);
    let is_forward = in_plan || direction[0] > 0.0;
    let origin = if in_plan { direction[0] * first[0] + direction[1] * first[1] } else { first[0] };
    let angle = numbers.angle;
    let mut plane_wave = match kind {
        MotionPart::Pressure => PlaneWave::p(soil, angle)?,
        MotionPart::Across => PlaneWave::sh(soil, angle)?,
        _ => PlaneWave::sv(soil, angle)?,
    };
    if !is_forward {
        plane_wave = plane_wave.reversed();
    }
    let wave = match kind {
        MotionPart::Pressure => {
            plane_wave.field_from_vertical(&record(numbers, numbers.peaks[2], view)?, origin)?
        }
        MotionPart::Across => {
            // Mirrored, a motion to the left of the direction is one to the right.
            let peak = view.frame.sign() * numbers.peaks[0];
            plane_wave.field_from_across(&record(numbers, peak, view)?, origin)?
        }
        _ => {
            let peak = if is_forward { numbers.peaks[0] } else { -numbers.peaks[0] };
            plane_wave.field_from_horizontal(&record(numbers, peak, view)?, origin)?
        }
    };
    if in_plan { wave.with_azimuth(direction[1].atan2(direction[0])) } else { Ok(wave) }
}

/// Pulse of displacements along x (m) at a time, in SI units.
fn displacement(numbers: &Numbers, time: f64) -> f64 {
    let rate = TAU * numbers.waves / numbers.duration();
    numbers.peaks[0] / (rate * rate) * numbers.shape(time)
}

/// The free field of a choice.
pub(crate) fn motion(
    choice: &Choice,
    numbers: &Numbers,
    view: &View,
) -> Result<Box<dyn FreeField>> {
    let frame = view.frame;
    let record = |peak: f64| record(numbers, peak, view);
    let along = frame.sign() * numbers.peaks[0];
    Ok(match choice.motion {
        MotionPart::Record => Box::new(record(along)?),
        MotionPart::Vertical => Box::new(VerticalIncidence {
            horizontal: Some(record(along)?),
            vertical: Some(record(numbers.peaks[2])?),
        }),
        MotionPart::Function => {
            let numbers = *numbers;
            Box::new(FreeFieldFn::new(move |_, time| {
                let u = frame.length * displacement(&numbers, time / frame.time);
                [frame.sign() * u, 0.3 * u]
            }))
        }
        MotionPart::Pulse => {
            let duration = numbers.duration() * frame.time;
            let rate = 14.0 / numbers.duration();
            let amplitude = frame.sign() * numbers.peaks[0] / (6.0 * rate * rate) * frame.length;
            Box::new(RickerDisplacement::new(amplitude, duration / 14.0, 0.4 * duration)?)
        }
        MotionPart::Inclined | MotionPart::Pressure | MotionPart::Across => {
            Box::new(wave(choice.motion, choice, numbers, view)?)
        }
        MotionPart::Triaxial => {
            let up = Some(record(numbers.peaks[2])?);
            let mut motion = Triaxial { x: None, y: None, up };
            for axis in 0..2 {
                let (axis_in_view, sign) = axis_in_view(view, axis);
                let record = Some(record(sign * numbers.peaks[axis])?);
                if axis_in_view == 0 {
                    motion.x = record;
                } else {
                    motion.y = record;
                }
            }
            Box::new(motion)
        }
        MotionPart::Loads => Box::new(AtRest),
        MotionPart::Below => {
            let ground = trench_ground(choice, numbers, view)?;
            // Waves reach the base before the surface.
            let travel = trench_depth(numbers) / (numbers.modulus / SOIL_DENSITY).sqrt();
            let horizontal = Some(record(along)?.padded(1.5 * travel * frame.time, 0.0)?);
            let surface = VerticalIncidence { horizontal, vertical: None };
            Box::new(TrenchMotion::new(&ground, surface, &mut unobserved)?)
        }
        MotionPart::BelowInclined => {
            let ground = trench_ground(choice, numbers, view)?;
            let wave = wave(MotionPart::Inclined, choice, numbers, view)?;
            Box::new(TrenchMotion::travelling(&ground, &wave, &mut unobserved)?)
        }
    })
}

fn trench_ground(choice: &Choice, numbers: &Numbers, view: &View) -> Result<TrenchGround> {
    TrenchGround::new(profile(choice, numbers, view)?, trench(numbers, view)?)
}
