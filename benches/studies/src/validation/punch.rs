//! Static contact of a rigid punch under an eccentric load, frictionless and bonded.

use std::f64::consts::PI;

use basemat::bem::{ContactElement, ElasticGround, Grading, Ground, Strip};
use basemat::interface::{Bonded, Coulomb};
use basemat::structure::{RigidBlock, Structure};
use basemat::{Simulation, Soil};
use plotters::prelude::SeriesLabelPosition;

use super::outcome::{ValidationCase, ValidationCheck, ValidationOutcome, worse};
use crate::AnyError;
use crate::figure::{CURVE_BLUE, CURVE_GREEN, CURVE_RED, Figure, FigurePanel};
use basemat_problems::table;
use basemat_problems::wrapped::StructureWithForce;

pub(crate) const VALIDATION_CASE: ValidationCase = ValidationCase {
    name: "punch",
    title: "Partial uplift of a punch",
    reference: "inclined punch in closed form (Muskhelishvili; Johnson), and its table",
    settings: "10, 20, 40 cosine-graded elements, static, frictionless or glued, ν = 0 and 1/3",
    run,
};

/// Eccentricities; half width, load and shear modulus are 1.
const LOAD_ECCENTRICITIES: [f64; 4] = [0.3, 0.6, 0.75, 0.9];

/// Rigid block under a constant clockwise moment.
fn tilted(moment: f64) -> basemat::Result<impl Structure> {
    let structure = RigidBlock::new(2.0, 1.0, 0.5)?;
    Ok(StructureWithForce {
        structure,
        along: RigidBlock::ROTATION_DOF.into(),
        force: move |_| -moment,
    })
}

/// Clockwise tilt, length of contact, and pressure of every element.
struct PunchState {
    tilt: f64,
    length: f64,
    pressure: Vec<(ContactElement, f64)>,
}

fn punch(poisson: f64, eccentricity: f64, elements: usize) -> Result<PunchState, AnyError> {
    let soil = Soil::new(1.0, poisson, 1.0)?;
    let strip = Strip::new(-1.0..1.0, elements, Grading::Cosine)?;
    let ground = ElasticGround::new(soil, strip)?;
    let elements = ground.elements().to_vec();
    let simulation = Simulation::builder(0.1)
        .structure(tilted(eccentricity)?)
        .ground(ground)
        .interface(Coulomb::new(0.0)?)
        .gravity(1.0)
        .build()?;
    let state = simulation.state();
    Ok(PunchState {
        tilt: -simulation.static_displacement()[RigidBlock::ROTATION_DOF],
        length: 2.0 * (1.0 - state.uplifted_fraction),
        pressure: elements
            .into_iter()
            .zip(state.contact.iter().map(|element| element.pressure))
            .collect(),
    })
}

struct ExactPunch {
    tilt: f64,
    length: f64,
}

/// Tilt of the frictionless punch and length of its contact.
///
/// With full contact (e ≤ ½) the pressure is (1 + 2ex)/(π√(1−x²)). Beyond, contact is over L = 4(1−e) at the right edge.
fn exact(poisson: f64, eccentricity: f64) -> ExactPunch {
    let unit = (1.0 - poisson) / PI;
    if eccentricity <= 0.5 {
        ExactPunch { tilt: 2.0 * eccentricity * unit, length: 2.0 }
    } else {
        ExactPunch { tilt: unit / (2.0 * (1.0 - eccentricity)), length: 4.0 * (1.0 - eccentricity) }
    }
}

/// Load to the left of x under a punch that has lifted: ∫ (2/πL) √(u/(L−u)) du.
fn load_left_of(eccentricity: f64, x: f64) -> f64 {
    let length = 4.0 * (1.0 - eccentricity);
    let u = (x - 1.0 + length).clamp(0.0, length);
    2.0 / (PI * length) * (length * (u / length).sqrt().asin() - (u * (length - u)).sqrt())
}

/// Tilt (clockwise) and sideways motion (to the right) of the bonded strip under a clockwise moment of 1.
///
/// The first pair is computed. The second is in closed form with ε = ln(3−4ν)/(2π), θ = 2(1−ν)/((1+4ε²)πμb²) and
/// u = 2εbθ.
fn bonded_strip(poisson: f64, elements: usize) -> Result<[[f64; 2]; 2], AnyError> {
    let soil = Soil::new(1.0, poisson, 1.0)?;
    let strip = Strip::new(-1.0..1.0, elements, Grading::Cosine)?;
    let simulation = Simulation::builder(0.1)
        .structure(tilted(1.0)?)
        .ground(ElasticGround::new(soil, strip)?)
        .interface(Bonded)
        .gravity(1.0)
        .build()?;
    let u = simulation.static_displacement();
    let exponent = (3.0 - 4.0 * poisson).ln() / (2.0 * PI);
    let tilt = 2.0 * (1.0 - poisson) / ((1.0 + 4.0 * exponent * exponent) * PI);
    let computed = [-u[RigidBlock::ROTATION_DOF], u[RigidBlock::HORIZONTAL_DOF]];
    Ok([computed, [tilt, 2.0 * exponent * tilt]])
}

fn run(_short: bool) -> Result<ValidationOutcome, AnyError> {
    let limits = [1e-3, 1.2e-3, 2.5e-3, 7.2e-3];
    let mut checks = Vec::new();
    let mut order = [f64::INFINITY, 0.0_f64];
    let mut edge = 0.0_f64;
    let mut table_error = 0.0_f64;
    let rows =
        table("halfplane_tilted_punch.csv").rows(["nu", "f", "e", "theta", "contact_length"]);
    for (e, limit) in LOAD_ECCENTRICITIES.into_iter().zip(limits) {
        let mut max_error = 0.0_f64;
        for poisson in [0.0, 1.0 / 3.0] {
            let exact = exact(poisson, e);
            let mut errors = [0.0; 3];
            for (error, elements) in errors.iter_mut().zip([10, 20, 40]) {
                let computed = punch(poisson, e, elements)?;
                *error = (computed.tilt / exact.tilt - 1.0).abs();
                let max_element = PI / elements as f64;
                edge = worse(edge, (computed.length - exact.length).abs() / max_element);
            }
            max_error = worse(max_error, errors[2]);
            let slope = (errors[1] / errors[2]).log2();
            order = [order[0].min(slope), order[1].max(slope)];
            // Error of this closed form against the table.
            for [nu, friction, eccentricity, theta, contact] in &rows {
                let is_case = (nu - poisson).abs() < 1e-9 && (eccentricity - e).abs() < 1e-9;
                if *friction == 0.0 && is_case {
                    let error = worse(
                        (theta / exact.tilt - 1.0).abs(),
                        (contact / exact.length - 1.0).abs(),
                    );
                    table_error = worse(table_error, error);
                }
            }
        }
        checks.push(ValidationCheck::below(
            format!("tilt at e = {e} b, 40 elements, relative"),
            max_error,
            limit,
        ));
    }
    checks.push(ValidationCheck::within(
        "order in the element size, smallest",
        order[0],
        1.9..=2.2,
    ));
    checks.push(ValidationCheck::within("order in the element size, largest", order[1], 1.9..=2.2));
    checks.push(ValidationCheck::below("edge of contact, off by elements", edge, 1.0));
    checks.push(ValidationCheck::below("closed form against the table", table_error, 1e-9));
    let pressed_punch = punch(0.0, 0.75, 40)?;
    let misplaced_force: f64 = pressed_punch
        .pressure
        .iter()
        .map(|(element, pressure)| {
            let expected = load_left_of(0.75, element.right()) - load_left_of(0.75, element.left());
            (pressure * element.length() - expected).abs()
        })
        .sum();
    checks.push(ValidationCheck::below(
        "pressure at e = 0.75 b, misplaced part of the load",
        misplaced_force,
        1e-2,
    ));
    let mut max_error = [0.0_f64; 2];
    for poisson in [0.0, 1.0 / 3.0] {
        let [computed, expected] = bonded_strip(poisson, 40)?;
        for k in 0..2 {
            max_error[k] = worse(max_error[k], (computed[k] / expected[k] - 1.0).abs());
        }
    }
    let names =
        ["glued strip: tilt under a moment, relative", "glued strip: sideways motion, relative"];
    checks.extend(ValidationCheck::list(&names, &max_error, &[1.2e-3, 1e-3]));
    Ok(ValidationOutcome { checks, figure: figure(&pressed_punch)? })
}

fn figure(pressed: &PunchState) -> Result<Figure, AnyError> {
    // Tilts over that at which the punch starts to lift, θ₀ = (1−ν)N/(πμb).
    let unit = 1.0 / PI;
    let curve = (1..=97).map(|k| 0.01 * f64::from(k));
    let curve = curve.map(|e| (exact(0.0, e).tilt / unit, e)).collect();
    let bonded = (0..=100).map(|k| 0.02 * f64::from(k)).map(|tilt| (tilt, 0.5 * tilt)).collect();
    let mut left = FigurePanel::new("tilt θ/θ₀, θ₀ = (1−ν)N/(πμb)", "moment M/(N b)")
        .legend(SeriesLabelPosition::LowerRight)
        .dashed("without uplift", CURVE_GREEN, bonded)
        .reference("closed form", CURVE_RED, curve);
    for (elements, name, color) in
        [(10, "basemat, 10 elements", CURVE_GREEN), (40, "40 elements", CURVE_BLUE)]
    {
        let mut points = Vec::new();
        for e in [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.93] {
            points.push((punch(0.0, e, elements)?.tilt / unit, e));
        }
        left = left.circles(name, color, points);
    }
    left = left.room(0.02, 0.08);
    let expected = (0..=970)
        .map(|k| 1e-3 * f64::from(k))
        .map(|x| (x, 2.0 / PI * (x / (1.0 - x)).sqrt()))
        .collect();
    let computed = pressed
        .pressure
        .iter()
        .map(|(element, pressure)| (0.5 * (element.left() + element.right()), *pressure))
        .filter(|(x, _)| *x < 0.97);
    let right = FigurePanel::new("place under the punch, x/b", "pressure p b/N, e = 0.75 b")
        .legend(SeriesLabelPosition::UpperLeft)
        .reference("closed form: contact over 0 ≤ x ≤ b", CURVE_RED, expected)
        .circles("basemat, 40 elements", CURVE_BLUE, computed.collect());
    let title = "Rigid frictionless punch of half width b under a load N at eccentricity e = M/N";
    Ok(Figure::new(title, 2, vec![left, right]))
}
