//! Coefficient α of the uplift law of nuclear practice, and loops under El Centro.
//!
//! The law gives M/(N L) and the contact for each rotation from α alone. α of a mat is fitted to its moments under a
//! static moment, from the uplift to a contact of two fifths.

use basemat::bem::plan::Plan;
use basemat::bem::{ElasticGround, Grading, SpringGround, Strip};
use basemat::coupled::{Load, SimulationBuilder};
use basemat::interface::Coulomb;
use basemat::motion::{STANDARD_GRAVITY, Triaxial, el_centro_1940};
use basemat::reference::UpliftLaw;
use basemat::structure::{RigidBlock, RigidBody};
use basemat::{Simulation, Soil};
use plotters::prelude::SeriesLabelPosition;

use super::outcome::{ValidationCase, ValidationCheck, ValidationOutcome, worse};
use crate::AnyError;
use crate::figure::{CURVE_BLUE, CURVE_ORANGE, CURVE_RED, Figure, FigurePanel};
use basemat_problems::series::nearest_integer;

pub(crate) const VALIDATION_CASE: ValidationCase = ValidationCase {
    name: "uplift_law",
    title: "Uplift law of nuclear practice",
    reference: "M/M₀ = α/2 − (α/2 − 1)(θ₀/θ)^(2/(α−2)), M₀ = N L/α, contact (θ₀/θ)^(2/(α−2)); exact on springs (α = 6) and for a smooth strip (α = 4)",
    settings: "bodies 10 m × 20 m of 500 kg/m³; static: 40 elements, mats of 24 cells along the motion, ν = 1/3; El Centro: its first 12 s, springs, 16 graded elements, square of 8 cells, 200 m/s, Δt = 5 ms; without friction a moment of the record in its place",
    run,
};

/// Half the length along the motion, height of the body, m; mean density, kg/m³.
const HALF_LENGTH: f64 = 5.0;
const BODY_HEIGHT: f64 = 20.0;
const MASS_DENSITY: f64 = 500.0;
/// Moments over N L, the first without uplift.
const MOMENT_RATIOS: [f64; 9] = [0.02, 0.25, 0.28, 0.31, 0.34, 0.37, 0.4, 0.42, 0.44];
const SMALLEST_CONTACT: f64 = 0.4;
const TIME_STEP: f64 = 0.005;
/// Duration of a run, s.
const RUN_DURATION: f64 = 12.0;

/// Base and ground of the body.
#[derive(Debug, Clone, Copy, PartialEq)]
enum BodyBase {
    Springs,
    Strip,
    Square,
    Oblong,
    Disc,
}

impl BodyBase {
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
        if self.is_in_plane() { RigidBlock::ROTATION_DOF } else { 4 }
    }

    /// Body on its ground, and its mass, kg or kg/m, for `count` elements or cells along the motion.
    fn scene(self, count: usize, friction: f64) -> Result<(SimulationBuilder, f64), AnyError> {
        let soil = Soil::from_shear_wave_speed(200.0, 1.0 / 3.0, 1900.0)?;
        let builder = Simulation::builder(TIME_STEP).interface(Coulomb::new(friction)?);
        if self.is_in_plane() {
            let builder =
                builder.structure(RigidBlock::new(2.0 * HALF_LENGTH, BODY_HEIGHT, MASS_DENSITY)?);
            let mass = 2.0 * HALF_LENGTH * BODY_HEIGHT * MASS_DENSITY;
            return Ok(if self == Self::Springs {
                // The rocking stiffness of the frictionless strip.
                let stiffness = 0.75 * std::f64::consts::PI * soil.shear_modulus() / HALF_LENGTH;
                (
                    builder.ground(SpringGround::new(
                        -HALF_LENGTH..HALF_LENGTH,
                        count,
                        stiffness,
                        stiffness,
                    )?),
                    mass,
                )
            } else {
                let strip = Strip::new(-HALF_LENGTH..HALF_LENGTH, count, Grading::Cosine)?;
                (builder.ground(ElasticGround::new(soil, strip)?), mass)
            });
        }
        let (plan, body) = match self {
            Self::Disc => (
                Plan::disc([0.0; 2], HALF_LENGTH, count)?,
                RigidBody::cylinder(HALF_LENGTH, BODY_HEIGHT, MASS_DENSITY)?,
            ),
            Self::Oblong => (
                Plan::rectangle(
                    -HALF_LENGTH..HALF_LENGTH,
                    -0.5 * HALF_LENGTH..0.5 * HALF_LENGTH,
                    count / 2,
                )?,
                RigidBody::cuboid([2.0 * HALF_LENGTH, HALF_LENGTH, BODY_HEIGHT], MASS_DENSITY)?,
            ),
            _ => (
                Plan::rectangle(-HALF_LENGTH..HALF_LENGTH, -HALF_LENGTH..HALF_LENGTH, count)?,
                RigidBody::cuboid(
                    [2.0 * HALF_LENGTH, 2.0 * HALF_LENGTH, BODY_HEIGHT],
                    MASS_DENSITY,
                )?,
            ),
        };
        let mass = body.total_mass();
        Ok((builder.structure(body).ground(ElasticGround::in_plan(soil, plan)?), mass))
    }

    /// Rotation (rad) and fraction in contact under a static moment, over N L.
    fn at_rest(self, count: usize, friction: f64, moment: f64) -> Result<[f64; 2], AnyError> {
        let (builder, mass) = self.scene(count, friction)?;
        let push = moment * 2.0 * HALF_LENGTH * STANDARD_GRAVITY * mass;
        let simulation = builder.load(Load::constant(self.rotation(), push)).build()?;
        let rotation = simulation.static_displacement()[self.rotation()];
        Ok([rotation.abs(), 1.0 - simulation.state().uplifted_fraction])
    }

    /// Rotation (rad) under a moment of N L without uplift.
    fn compliance(self, count: usize, friction: f64) -> Result<f64, AnyError> {
        Ok(self.at_rest(count, friction, MOMENT_RATIOS[0])?[0] / MOMENT_RATIOS[0])
    }
}

/// Sum of squares of the law's errors at the points (M/(N L), rotation) with uplift, from the stiffness.
fn misfit(alpha: f64, compliance: f64, points: &[[f64; 3]]) -> Result<f64, AnyError> {
    let law = UpliftLaw::new(alpha)?;
    let mut sum = 0.0;
    for &[moment, rotation, _] in points {
        sum += (law.moment_ratio(rotation * alpha / compliance)? / alpha - moment).powi(2);
    }
    Ok(sum)
}

/// α of a base, and the largest errors of M/(N L) and of the contact.
struct FittedLaw {
    alpha: f64,
    moment_error: f64,
    contact_error: f64,
}

fn fitted(base: BodyBase, count: usize, friction: f64) -> Result<FittedLaw, AnyError> {
    let compliance = base.compliance(count, friction)?;
    let mut points = Vec::new();
    for &moment in &MOMENT_RATIOS[1..] {
        let [rotation, contact] = base.at_rest(count, friction, moment)?;
        if contact < 1.0 && contact > SMALLEST_CONTACT {
            points.push([moment, rotation, contact]);
        }
    }
    // The misfit has one minimum in this interval.
    let mut low = 3.0;
    let mut high = 8.0;
    for _ in 0..60 {
        let a = low + (high - low) / 3.0;
        let b = high - (high - low) / 3.0;
        if misfit(a, compliance, &points)? < misfit(b, compliance, &points)? {
            high = b;
        } else {
            low = a;
        }
    }
    let law = UpliftLaw::new(low)?;
    let mut best_law = FittedLaw { alpha: low, moment_error: 0.0, contact_error: 0.0 };
    for [moment, rotation, contact] in points {
        let ratio = rotation * low / compliance;
        let moment_error = (law.moment_ratio(ratio)? / low - moment).abs();
        let contact_error = (law.contact_ratio(ratio)? - contact).abs();
        best_law.moment_error = worse(best_law.moment_error, moment_error);
        best_law.contact_error = worse(best_law.contact_error, contact_error);
    }
    Ok(best_law)
}

/// θ/θ₀, M/(N L) and the force on the soil over the weight N in the middle of each step under El Centro.
///
/// Without friction the motion does not cause rocking, so that the moment m h a of the record acts in its place.
fn loops(
    base: BodyBase,
    count: usize,
    friction: f64,
    alpha: f64,
) -> Result<Vec<[f64; 3]>, AnyError> {
    let record = el_centro_1940().trimmed(0.0, RUN_DURATION)?;
    let (builder, mass) = base.scene(count, friction)?;
    let builder = if friction == 0.0 {
        builder.load(Load::record(base.rotation(), &record, 0.5 * BODY_HEIGHT * mass))
    } else if base.is_in_plane() {
        builder.motion(record)
    } else {
        builder.motion(Triaxial { x: Some(record), ..Triaxial::default() })
    };
    let mut simulation = builder.build()?;
    let weight = STANDARD_GRAVITY * mass;
    let unit = base.compliance(count, friction)? / alpha;
    let mut points = Vec::new();
    let mut before = 0.0;
    let run = simulation.run(nearest_integer(RUN_DURATION / TIME_STEP), |state| {
        let rotation = 0.5 * (state.base_rotation + before);
        before = state.base_rotation;
        points.push([
            rotation / unit,
            state.base_moment / (2.0 * HALF_LENGTH * weight),
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

/// Checks of a base under El Centro: largest rotation, and errors of M/(N L) beyond the uplift.
///
/// N is the weight, or the force on the soil at each time.
fn shaken(
    name: &str,
    law: UpliftLaw,
    alpha: f64,
    points: &[[f64; 3]],
    limits: [f64; 4],
) -> Result<Vec<ValidationCheck>, AnyError> {
    let mut squares = [0.0; 2];
    let mut count = 0.0;
    let mut largest_error = 0.0;
    let mut largest_rotation = 0.0_f64;
    let mut error_at_largest_rotation = 0.0;
    for &[rotation, moment, force] in points.iter().filter(|point| point[0].abs() > 1.0) {
        let error = (moment - law_at(law, alpha, rotation)?).abs();
        // Both M₀ and θ₀ are proportional to the force.
        let by_force =
            if force > 1e-6 { force * law_at(law, alpha, rotation / force)? } else { 0.0 };
        squares[0] += error * error;
        squares[1] += (moment - by_force).powi(2);
        count += 1.0;
        largest_error = worse(largest_error, error);
        if rotation.abs() > largest_rotation {
            largest_rotation = rotation.abs();
            error_at_largest_rotation = error;
        }
    }
    let name = format!("El Centro, {name}");
    let errors = [
        ("error of M/(N L) beyond θ₀, rms", (squares[0] / count).sqrt()),
        ("the same, largest", largest_error),
        ("the same, at the largest θ", error_at_largest_rotation),
        ("the same, rms, N at each time", (squares[1] / count).sqrt()),
    ];
    let mut checks = vec![ValidationCheck::within(
        format!("{name}: largest θ/θ₀"),
        largest_rotation,
        1.5..=40.0,
    )];
    for ((label, error), limit) in errors.into_iter().zip(limits) {
        checks.push(ValidationCheck::below(format!("{name}: {label}"), error, limit));
    }
    Ok(checks)
}

fn friction_name(friction: f64) -> &'static str {
    if friction == 0.0 { "no friction" } else { "infinite friction" }
}

/// Checks of α under a static moment.
fn at_rest(short: bool) -> Result<Vec<ValidationCheck>, AnyError> {
    // α, and limits of its error, of the errors of M/(N L) and of the contact.
    let cases = [
        (BodyBase::Springs, 0.0, 6.0, [1e-2, 3e-4, 1.5e-2]),
        (BodyBase::Strip, 0.0, 4.0, [5e-3, 3e-4, 2.5e-2]),
        (BodyBase::Square, 0.0, 4.40, [2e-2, 2e-3, 4e-2]),
        (BodyBase::Square, f64::INFINITY, 4.42, [2e-2, 2e-3, 3e-2]),
        (BodyBase::Oblong, 0.0, 4.58, [2e-2, 2e-3, 3e-2]),
        (BodyBase::Disc, 0.0, 5.52, [2e-2, 2e-3, 0.12]),
        (BodyBase::Disc, f64::INFINITY, 5.54, [2e-2, 2e-3, 0.12]),
    ];
    let mut checks = Vec::new();
    for (base, friction, alpha, limits) in &cases[..if short { 3 } else { cases.len() }] {
        let cells = if short { 8 } else { 24 };
        let count = if base.is_in_plane() { 40 } else { cells };
        let fitted = fitted(*base, count, *friction)?;
        let name = format!("static, {}, {}", base.name(), friction_name(*friction));
        let close_range = alpha - limits[0]..=alpha + limits[0];
        checks.push(ValidationCheck::within(format!("{name}: α"), fitted.alpha, close_range));
        let label = format!("{name}: largest error of M/(N L)");
        checks.push(ValidationCheck::below(label, fitted.moment_error, limits[1]));
        let label = format!("{name}: of the contact");
        checks.push(ValidationCheck::below(label, fitted.contact_error, limits[2]));
    }
    Ok(checks)
}

fn run(short: bool) -> Result<ValidationOutcome, AnyError> {
    let mut checks = at_rest(short)?;
    // Limits with infinite friction and without.
    let cases = [
        (BodyBase::Springs, 40, 6.0, [[0.2, 0.45, 0.32, 3e-3], [0.34, 0.9, 0.6, 5e-3]]),
        (BodyBase::Strip, 16, 4.0, [[4.5e-2, 0.18, 0.1, 3.6e-2], [5e-2, 0.16, 2.5e-2, 4.3e-2]]),
        (BodyBase::Square, 8, 4.40, [[3.5e-2, 0.2, 9e-2, 2.8e-2], [5e-2, 0.155, 1e-2, 3.7e-2]]),
    ];
    let mut panels = Vec::new();
    for (base, count, alpha, limits) in cases {
        let law = UpliftLaw::new(alpha)?;
        let mut panel =
            FigurePanel::new("θ/θ₀", &format!("M/(N L) ({}, α = {alpha})", base.name()))
                .legend(SeriesLabelPosition::LowerRight)
                .room(0.1, 0.05);
        let mut max_factor = 1.0_f64;
        for ((friction, color), limits) in
            [(f64::INFINITY, CURVE_BLUE), (0.0, CURVE_ORANGE)].into_iter().zip(limits)
        {
            let points = loops(base, count, friction, alpha)?;
            let name = format!("{}, {}", base.name(), friction_name(friction));
            checks.extend(shaken(&name, law, alpha, &points, limits)?);
            max_factor = points
                .iter()
                .fold(max_factor, |max_factor, point| worse(max_factor, point[0].abs()));
            let points = points.into_iter().map(|point| (point[0], point[1])).collect();
            panel = panel.line(friction_name(friction), color, points);
        }
        let rotations = (-200..=200).map(|k| max_factor * f64::from(k) / 200.0);
        let curve = rotations.map(|rotation| Ok((rotation, law_at(law, alpha, rotation)?)));
        panels.push(panel.reference("the law", CURVE_RED, curve.collect::<basemat::Result<_>>()?));
    }
    let title = "Base moment and rotation of a body of 10 m × 20 m under El Centro";
    Ok(ValidationOutcome { checks, figure: Figure::new(title, 3, panels) })
}
