//! Contact in space by the measures of robotics: residuals of Signorini, Coulomb and maximum dissipation.

use basemat::bem::ElasticGround;
use basemat::bem::plan::Plan;
use basemat::interface::{ContactState, Coulomb, Mode};
use basemat::motion::{STANDARD_GRAVITY, Triaxial, el_centro_1940};
use basemat::structure::RigidBody;
use basemat::{Simulation, Soil};

use super::outcome::{ValidationCase, ValidationCheck, ValidationOutcome, worse};
use crate::AnyError;
use crate::artificial_motion::artificial_motion;
use crate::figure::{CURVE_BLUE, CURVE_GREEN, CURVE_RED, Figure, FigurePanel};
use basemat_problems::series::nearest_integer;

pub(crate) const VALIDATION_CASE: ValidationCase = ValidationCase {
    name: "cone",
    title: "Contact conditions of every element and step in plan",
    reference: "Signorini's conditions, Coulomb's cone and the principle of maximum dissipation, from pressures, shears, gaps and slips alone",
    settings: "bodies of 10 m × 8 m on 8 × 10 cells, c_S = 200 m/s, Δt = 5 ms, 10 s of El Centro and two artificial motions",
    run,
};

/// A body and its friction.
struct ConeScene {
    name: &'static str,
    height: f64,
    friction: f64,
    /// Largest acceleration along x, y and up, m/s².
    peaks: [f64; 3],
}

const CONE_SCENES: [ConeScene; 3] = [
    ConeScene { name: "low, slides", height: 4.0, friction: 0.3, peaks: [5.0, 4.0, 2.0] },
    ConeScene { name: "tall, lifts", height: 16.0, friction: 0.8, peaks: [4.0, 3.0, 2.0] },
    ConeScene { name: "low, thrown", height: 6.0, friction: 0.2, peaks: [8.0, 8.0, 11.0] },
];

/// Violations of one element in one step, over the mean pressure p₀ and the settlement s₀ of its unit.
///
/// They are tension; penetration; pressure × gap; shear above μp; friction work below the work of μp against the slip.
fn violations(
    element: &ContactState,
    before: &ContactState,
    friction: f64,
    pressure: f64,
    settlement: f64,
) -> [f64; 5] {
    let shear = element.shear.hypot(element.shear_across);
    let slip = [element.slip - before.slip, element.slip_across - before.slip_across];
    let bound = friction * element.pressure;
    let work = element.shear * slip[0] + element.shear_across * slip[1];
    [
        (-element.pressure).max(0.0) / pressure,
        (-element.gap).max(0.0) / settlement,
        (element.pressure * element.gap).abs() / (pressure * settlement),
        (shear - bound).max(0.0) / pressure,
        (bound * slip[0].hypot(slip[1]) - work).abs() / (pressure * settlement),
    ]
}

/// Violations of a march.
struct ConeMarch {
    /// Largest of each violation in every tenth of a second.
    series: Vec<[f64; 5]>,
    /// Fractions of elements and steps.
    open: f64,
    sliding: f64,
}

impl ConeMarch {
    /// Largest of a violation over the march.
    fn worst(&self, violation: usize) -> f64 {
        self.series.iter().fold(0.0, |worst, interval| worse(worst, interval[violation]))
    }

    fn curve(&self, violation: usize) -> Vec<(f64, f64)> {
        let intervals = self.series.iter().enumerate();
        intervals
            .map(|(n, interval)| (0.1 * n as f64, interval[violation].max(1e-20)))
            .collect()
    }
}

fn march(scene: &ConeScene, duration: f64) -> Result<ConeMarch, AnyError> {
    let step = 0.005;
    let soil = Soil::from_shear_wave_speed(200.0, 1.0 / 3.0, 1900.0)?;
    let body = RigidBody::cuboid([10.0, 8.0, scene.height], 1500.0)?;
    let pressure = 1500.0 * scene.height * STANDARD_GRAVITY;
    // The order of magnitude of the settlement under an even load.
    let settlement = pressure * 8.0 * (1.0 - soil.poisson()) / (2.0 * soil.shear_modulus());
    let motion = Triaxial {
        x: Some(el_centro_1940().scaled_to_peak(scene.peaks[0])?),
        y: Some(artificial_motion(2.5, 21)?.scaled_to_peak(scene.peaks[1])?),
        up: Some(artificial_motion(5.0, 22)?.scaled_to_peak(scene.peaks[2])?),
    };
    let mut simulation = Simulation::builder(step)
        .structure(body)
        .ground(ElasticGround::in_plan(soil, Plan::rectangle(-5.0..5.0, -4.0..4.0, 8)?)?)
        .interface(Coulomb::new(scene.friction)?)
        .motion(motion)
        .build()?;
    let mut before = simulation.state().contact.clone();
    let mut worst = [0.0_f64; 5];
    let mut series = Vec::new();
    let mut open = 0.0;
    let mut sliding = 0.0;
    let mut total = 0.0;
    for n in 1..=nearest_integer(duration / step) {
        let state = simulation.step()?;
        for (element, before) in state.contact.iter().zip(&before) {
            let residuals = violations(element, before, scene.friction, pressure, settlement);
            worst = std::array::from_fn(|k| worse(worst[k], residuals[k]));
        }
        total += state.modes.len() as f64;
        open += state.modes.iter().filter(|mode| **mode == Mode::Open).count() as f64;
        sliding += state.modes.iter().filter(|mode| mode.is_slip()).count() as f64;
        before.copy_from_slice(&state.contact);
        if n % 20 == 0 {
            series.push(worst);
            worst = [0.0; 5];
        }
    }
    Ok(ConeMarch { series, open: open / total, sliding: sliding / total })
}

fn run(short: bool) -> Result<ValidationOutcome, AnyError> {
    let names = [
        "tension over the mean pressure p₀",
        "penetration over the settlement s₀",
        "pressure × gap over p₀ s₀",
        "shear above μp over p₀",
        "friction work short of the largest, over p₀ s₀",
    ];
    let mut checks = Vec::new();
    let mut panels = Vec::new();
    for scene in &CONE_SCENES {
        let march = march(scene, if short { 4.0 } else { 10.0 })?;
        for (k, name) in names.into_iter().enumerate() {
            checks.push(ValidationCheck::below(
                format!("{}: {name}", scene.name),
                march.worst(k),
                1e-11,
            ));
        }
        let name = format!("{}: part of elements and steps that", scene.name);
        checks.push(ValidationCheck::within(format!("{name} are open"), march.open, 0.0..=0.9));
        checks.push(ValidationCheck::within(format!("{name} slide"), march.sliding, 0.001..=0.9));
        panels.push(
            FigurePanel::new("time, s", &format!("worst residual ({})", scene.name))
                .logarithmic()
                .room(0.05, 0.4)
                .line("Signorini: pressure × gap", CURVE_BLUE, march.curve(2))
                .line("Coulomb: shear above μp", CURVE_GREEN, march.curve(3))
                .line("maximum dissipation", CURVE_RED, march.curve(4)),
        );
    }
    let title =
        "Residuals of the contact conditions in plan, three bodies shaken in three directions";
    Ok(ValidationOutcome { checks, figure: Figure::new(title, 3, panels) })
}
