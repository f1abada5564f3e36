//! Uplift law of nuclear practice: its coefficient α for mats under a static moment, and loops under El Centro beside it.
//!
//! The law says M/(N L) and the contact for each rotation from α alone. α of a mat is the one whose moments are nearest
//! to its own, from the uplift to a contact of two fifths.

use basemat::bem::plan::Plan;
use basemat::bem::{ElasticGround, Grading, SpringGround, Strip};
use basemat::coupled::{Load, SimulationBuilder};
use basemat::interface::Coulomb;
use basemat::motion::{STANDARD_GRAVITY, Triaxial, el_centro_1940};
use basemat::reference::UpliftLaw;
use basemat::structure::{RigidBlock, RigidBody};
use basemat::{Simulation, Soil};
use plotters::prelude::SeriesLabelPosition;

use super::outcome::{Case, Check, Outcome, worse};
use crate::AnyError;
use crate::figure::{BLUE, Figure, ORANGE, Panel, RED};
use basemat_problems::series::whole;

pub(crate) const CASE: Case = Case {
    name: "uplift_law",
    title: "Uplift law of nuclear practice",
    reference: "M/M₀ = α/2 − (α/2 − 1)(θ₀/θ)^(2/(α−2)), M₀ = N L/α, contact (θ₀/θ)^(2/(α−2)); exact on springs (α = 6) and for a smooth strip (α = 4)",
    settings: "bodies 10 m × 20 m of 500 kg/m³; static: 40 elements, mats of 24 cells along the motion, ν = 1/3; El Centro: its first 12 s, springs, 16 graded elements, square of 8 cells, 200 m/s, Δt = 5 ms; without friction a moment of the record in its place",
    run,
};

/// Half the length along the motion, height of the body, m; its density, kg/m³.
const HALF: f64 = 5.0;
const HEIGHT: f64 = 20.0;
const DENSITY: f64 = 500.0;
/// Moments over N L: the first without uplift, the others with.
const MOMENTS: [f64; 9] = [0.02, 0.25, 0.28, 0.31, 0.34, 0.37, 0.4, 0.42, 0.44];
const LEAST_CONTACT: f64 = 0.4;
const STEP: f64 = 0.005;
/// Length of the run, s.
const DURATION: f64 = 12.0;

/// What the body stands on.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Base {
    Springs,
    Strip,
    Square,
    Oblong,
    Disc,
}

impl Base {
    fn name(self) -> &'static str {
        match self {
            Self::Springs => "springs",
            Self::Strip => "strip",
            Self::Square => "square",
            Self::Oblong => "2 : 1 along the motion",
            Self::Disc => "disc",
        }
    }

    fn is_in_plane(self) -> bool {
        matches!(self, Self::Springs | Self::Strip)
    }

    /// Degree of freedom of the rotation in the plane of the motion.
    fn rotation(self) -> usize {
        if self.is_in_plane() { RigidBlock::ROTATION } else { 4 }
    }

    /// Body on its ground, and its mass, kg or kg/m; `count`: elements or cells along the motion.
    fn scene(self, count: usize, friction: f64) -> Result<(SimulationBuilder, f64), AnyError> {
        let soil = Soil::from_shear_wave_speed(200.0, 1.0 / 3.0, 1900.0)?;
        let builder = Simulation::builder(STEP).interface(Coulomb::new(friction)?);
        if self.is_in_plane() {
            let builder = builder.structure(RigidBlock::new(2.0 * HALF, HEIGHT, DENSITY)?);
            let mass = 2.0 * HALF * HEIGHT * DENSITY;
            return Ok(if self == Self::Springs {
                // The rocking stiffness of the smooth strip.
                let stiffness = 0.75 * std::f64::consts::PI * soil.shear_modulus() / HALF;
                (builder.ground(SpringGround::new(-HALF..HALF, count, stiffness, stiffness)?), mass)
            } else {
                let strip = Strip::new(-HALF..HALF, count, Grading::Cosine)?;
                (builder.ground(ElasticGround::new(soil, strip)?), mass)
            });
        }
        let (plan, body) = match self {
            Self::Disc => {
                (Plan::disc([0.0; 2], HALF, count)?, RigidBody::cylinder(HALF, HEIGHT, DENSITY)?)
            }
            Self::Oblong => (
                Plan::rectangle(-HALF..HALF, -0.5 * HALF..0.5 * HALF, count / 2)?,
                RigidBody::cuboid([2.0 * HALF, HALF, HEIGHT], DENSITY)?,
            ),
            _ => (
                Plan::rectangle(-HALF..HALF, -HALF..HALF, count)?,
                RigidBody::cuboid([2.0 * HALF, 2.0 * HALF, HEIGHT], DENSITY)?,
            ),
        };
        let mass = body.total_mass();
        Ok((builder.structure(body).ground(ElasticGround::in_plan(soil, plan)?), mass))
    }

    /// Rotation (rad) and share in contact under a static moment, over N L.
    fn rest(self, count: usize, friction: f64, moment: f64) -> Result<[f64; 2], AnyError> {
        let (builder, mass) = self.scene(count, friction)?;
        let push = moment * 2.0 * HALF * STANDARD_GRAVITY * mass;
        let simulation = builder.load(Load::constant(self.rotation(), push)).build()?;
        let rotation = simulation.static_displacement()[self.rotation()];
        Ok([rotation.abs(), 1.0 - simulation.state().uplifted_fraction])
    }

    /// Rotation (rad) under a moment of N L, if nothing lifts.
    fn compliance(self, count: usize, friction: f64) -> Result<f64, AnyError> {
        Ok(self.rest(count, friction, MOMENTS[0])?[0] / MOMENTS[0])
    }
}

/// Sum of squares of the law's errors at the points (M/(N L), rotation) with uplift, from the stiffness.
fn misfit(alpha: f64, compliance: f64, points: &[[f64; 3]]) -> Result<f64, AnyError> {
    let law = UpliftLaw::new(alpha)?;
    let error = |&[moment, rotation, _]: &[f64; 3]| -> Result<f64, AnyError> {
        Ok((law.moment_ratio(rotation * alpha / compliance)? / alpha - moment).powi(2))
    };
    points.iter().map(error).sum()
}

/// α of a base, and the largest errors of M/(N L) and of the contact.
fn fitted(base: Base, count: usize, friction: f64) -> Result<[f64; 3], AnyError> {
    let compliance = base.compliance(count, friction)?;
    let mut points = Vec::new();
    for &moment in &MOMENTS[1..] {
        let [rotation, contact] = base.rest(count, friction, moment)?;
        if contact < 1.0 && contact > LEAST_CONTACT {
            points.push([moment, rotation, contact]);
        }
    }
    // The misfit has one minimum between these.
    let (mut low, mut high) = (3.0, 8.0);
    for _ in 0..60 {
        let [a, b] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
        if misfit(a, compliance, &points)? < misfit(b, compliance, &points)? {
            high = b;
        } else {
            low = a;
        }
    }
    let law = UpliftLaw::new(low)?;
    let mut errors = [0.0_f64; 2];
    for [moment, rotation, contact] in points {
        let ratio = rotation * low / compliance;
        errors[0] = worse(errors[0], (law.moment_ratio(ratio)? / low - moment).abs());
        errors[1] = worse(errors[1], (law.contact_ratio(ratio)? - contact).abs());
    }
    Ok([low, errors[0], errors[1]])
}

/// θ/θ₀, M/(N L) and the force on the soil over the weight N in the middle of each step under El Centro; without friction,
/// which turns no motion into rocking, under the moment m h a of the record.
fn loops(base: Base, count: usize, friction: f64, alpha: f64) -> Result<Vec<[f64; 3]>, AnyError> {
    let record = el_centro_1940().trimmed(0.0, DURATION)?;
    let (builder, mass) = base.scene(count, friction)?;
    let builder = if friction == 0.0 {
        builder.load(Load::record(base.rotation(), &record, 0.5 * HEIGHT * mass))
    } else if base.is_in_plane() {
        builder.motion(record)
    } else {
        builder.motion(Triaxial { x: Some(record), ..Triaxial::default() })
    };
    let mut simulation = builder.build()?;
    let weight = STANDARD_GRAVITY * mass;
    let unit = base.compliance(count, friction)? / alpha;
    let (mut points, mut before) = (Vec::new(), 0.0);
    let run = simulation.run(whole(DURATION / STEP), |state| {
        let rotation = 0.5 * (state.base_rotation + before);
        before = state.base_rotation;
        points.push([
            rotation / unit,
            state.base_moment / (2.0 * HALF * weight),
            state.normal_force / weight,
        ]);
    })?;
    if run.energy_error > 1e-9 {
        return Err(format!("energy balance open by {:.1e}", run.energy_error).into());
    }
    Ok(points)
}

/// M/(N L) of the law at a rotation θ/θ₀ of either sign.
fn law_at(law: UpliftLaw, alpha: f64, rotation: f64) -> basemat::Result<f64> {
    Ok(law.moment_ratio(rotation.abs())?.copysign(rotation) / alpha)
}

/// Checks of a base under El Centro: largest rotation, and errors of M/(N L) beyond the uplift, with the weight as N and with
/// the force on the soil at each time.
fn shaken(
    name: &str,
    (law, alpha): (&UpliftLaw, f64),
    points: &[[f64; 3]],
    limits: [f64; 4],
) -> Result<Vec<Check>, AnyError> {
    let (mut squares, mut count, mut largest, mut top) = ([0.0; 2], 0.0, 0.0, [0.0_f64; 2]);
    for &[rotation, moment, force] in points.iter().filter(|point| point[0].abs() > 1.0) {
        let error = (moment - law_at(*law, alpha, rotation)?).abs();
        // Both M₀ and θ₀ are proportional to the force.
        let own = if force > 1e-6 { force * law_at(*law, alpha, rotation / force)? } else { 0.0 };
        squares[0] += error * error;
        squares[1] += (moment - own).powi(2);
        count += 1.0;
        largest = worse(largest, error);
        if rotation.abs() > top[0] {
            top = [rotation.abs(), error];
        }
    }
    let label = |what: &str| format!("El Centro, {name}: {what}");
    let [weight, own] = squares.map(|sum| (sum / count).sqrt());
    Ok(vec![
        Check::within(label("largest θ/θ₀"), top[0], 1.5..=40.0),
        Check::below(label("error of M/(N L) beyond θ₀, rms"), weight, limits[0]),
        Check::below(label("the same, largest"), largest, limits[1]),
        Check::below(label("the same, at the largest θ"), top[1], limits[2]),
        Check::below(label("the same, rms, N at each time"), own, limits[3]),
    ])
}

fn friction_of(friction: f64) -> &'static str {
    if friction == 0.0 { "no friction" } else { "infinite friction" }
}

/// Checks of α under a static moment.
fn at_rest(short: bool) -> Result<Vec<Check>, AnyError> {
    // α, and limits of its error, of the errors of M/(N L) and of the contact.
    let all = [
        (Base::Springs, 0.0, 6.0, [1e-2, 3e-4, 1.5e-2]),
        (Base::Strip, 0.0, 4.0, [5e-3, 3e-4, 2.5e-2]),
        (Base::Square, 0.0, 4.40, [2e-2, 2e-3, 4e-2]),
        (Base::Square, f64::INFINITY, 4.42, [2e-2, 2e-3, 3e-2]),
        (Base::Oblong, 0.0, 4.58, [2e-2, 2e-3, 3e-2]),
        (Base::Disc, 0.0, 5.52, [2e-2, 2e-3, 0.12]),
        (Base::Disc, f64::INFINITY, 5.54, [2e-2, 2e-3, 0.12]),
    ];
    let mut checks = Vec::new();
    for (base, friction, alpha, limits) in &all[..if short { 3 } else { all.len() }] {
        let cells = if short { 8 } else { 24 };
        let count = if base.is_in_plane() { 40 } else { cells };
        let [found, moment, contact] = fitted(*base, count, *friction)?;
        let name = format!("static, {}, {}", base.name(), friction_of(*friction));
        let near = alpha - limits[0]..=alpha + limits[0];
        checks.push(Check::within(format!("{name}: α"), found, near));
        checks.push(Check::below(format!("{name}: largest error of M/(N L)"), moment, limits[1]));
        checks.push(Check::below(format!("{name}: of the contact"), contact, limits[2]));
    }
    Ok(checks)
}

fn run(short: bool) -> Result<Outcome, AnyError> {
    let mut checks = at_rest(short)?;
    // Limits with infinite friction and without.
    let all = [
        (Base::Springs, 40, 6.0, [[0.2, 0.45, 0.32, 3e-3], [0.34, 0.9, 0.6, 5e-3]]),
        (Base::Strip, 16, 4.0, [[4.5e-2, 0.18, 0.1, 3.6e-2], [5e-2, 0.16, 2.5e-2, 4.3e-2]]),
        (Base::Square, 8, 4.40, [[3.5e-2, 0.2, 9e-2, 2.8e-2], [5e-2, 0.155, 1e-2, 3.7e-2]]),
    ];
    let mut panels = Vec::new();
    for (base, count, alpha, limits) in all {
        let law = UpliftLaw::new(alpha)?;
        let mut panel = Panel::new("θ/θ₀", &format!("M/(N L) ({}, α = {alpha})", base.name()))
            .legend(SeriesLabelPosition::LowerRight)
            .room(0.1, 0.05);
        let mut widest = 1.0_f64;
        for ((friction, color), limits) in
            [(f64::INFINITY, BLUE), (0.0, ORANGE)].into_iter().zip(limits)
        {
            let points = loops(base, count, friction, alpha)?;
            let name = format!("{}, {}", base.name(), friction_of(friction));
            checks.extend(shaken(&name, (&law, alpha), &points, limits)?);
            widest = points.iter().fold(widest, |most, point| worse(most, point[0].abs()));
            let points = points.into_iter().map(|point| (point[0], point[1])).collect();
            panel = panel.line(friction_of(friction), color, points);
        }
        let curve = (-200..=200).map(|k| widest * f64::from(k) / 200.0);
        let curve = curve.map(|at| Ok((at, law_at(law, alpha, at)?)));
        panels.push(panel.reference("the law", RED, curve.collect::<basemat::Result<_>>()?));
    }
    let title = "Base moment and rotation of a body of 10 m × 20 m under El Centro";
    Ok(Outcome { checks, figure: Figure::new(title, 3, panels) })
}
