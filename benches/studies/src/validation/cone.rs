//! Contact in plan by the measures of robotics: residuals of Signorini, Coulomb and maximum dissipation.

use basemat::bem::ElasticGround;
use basemat::bem::plan::Plan;
use basemat::interface::{ContactState, Coulomb, Mode};
use basemat::motion::{STANDARD_GRAVITY, Triaxial, el_centro_1940};
use basemat::structure::RigidBody;
use basemat::{Simulation, Soil};

use super::outcome::{Case, Check, Outcome, worse};
use crate::AnyError;
use crate::artificial_motion::artificial_motion;
use crate::figure::{BLUE, Figure, GREEN, Panel, RED};
use basemat_problems::series::whole;

pub(crate) const CASE: Case = Case {
    name: "cone",
    title: "Contact conditions of every element and step in plan",
    reference: "Signorini's conditions, Coulomb's cone and the principle of maximum dissipation, from pressures, shears, gaps and slips alone",
    settings: "bodies of 10 m × 8 m on 8 × 10 cells, c_S = 200 m/s, Δt = 5 ms, 10 s of El Centro and two artificial motions",
    run,
};

/// A body and its friction.
struct Scene {
    name: &'static str,
    height: f64,
    friction: f64,
    /// Largest acceleration along x, y and up, m/s².
    peaks: [f64; 3],
}

const SCENES: [Scene; 3] = [
    Scene { name: "low, slides", height: 4.0, friction: 0.3, peaks: [5.0, 4.0, 2.0] },
    Scene { name: "tall, lifts", height: 16.0, friction: 0.8, peaks: [4.0, 3.0, 2.0] },
    Scene { name: "low, thrown", height: 6.0, friction: 0.2, peaks: [8.0, 8.0, 11.0] },
];

/// Violations of one element in one step, over the mean pressure p₀ and the settlement s₀ of its unit: tension;
/// penetration; pressure × gap; shear above μp; shortfall of the friction work from that of μp against the slip.
fn violations(
    own: &ContactState,
    before: &ContactState,
    friction: f64,
    [pressure, settlement]: [f64; 2],
) -> [f64; 5] {
    let shear = own.shear.hypot(own.shear_across);
    let slip = [own.slip - before.slip, own.slip_across - before.slip_across];
    let bound = friction * own.pressure;
    let work = own.shear * slip[0] + own.shear_across * slip[1];
    [
        (-own.pressure).max(0.0) / pressure,
        (-own.gap).max(0.0) / settlement,
        (own.pressure * own.gap).abs() / (pressure * settlement),
        (shear - bound).max(0.0) / pressure,
        (bound * slip[0].hypot(slip[1]) - work).abs() / (pressure * settlement),
    ]
}

/// Worst of each violation in every tenth of a second, and the parts of elements and steps that were open or slid.
fn march(scene: &Scene, duration: f64) -> Result<(Vec<[f64; 5]>, [f64; 2]), AnyError> {
    let step = 0.005;
    let soil = Soil::from_shear_wave_speed(200.0, 1.0 / 3.0, 1900.0)?;
    let body = RigidBody::cuboid([10.0, 8.0, scene.height], 1500.0)?;
    let pressure = 1500.0 * scene.height * STANDARD_GRAVITY;
    // Of the order of an even load's settlement.
    let settlement = pressure * 8.0 * (1.0 - soil.poisson()) / (2.0 * soil.shear_modulus());
    let [x, y, up] = scene.peaks;
    let motion = Triaxial {
        x: Some(el_centro_1940().scaled_to_peak(x)?),
        y: Some(artificial_motion(2.5, 21)?.scaled_to_peak(y)?),
        up: Some(artificial_motion(5.0, 22)?.scaled_to_peak(up)?),
    };
    let mut simulation = Simulation::builder(step)
        .structure(body)
        .ground(ElasticGround::in_plan(soil, Plan::rectangle(-5.0..5.0, -4.0..4.0, 8)?)?)
        .interface(Coulomb::new(scene.friction)?)
        .motion(motion)
        .build()?;
    let mut before = simulation.state().contact.clone();
    let (mut worst, mut series) = ([0.0_f64; 5], Vec::new());
    let (mut open, mut slid, mut all) = (0.0, 0.0, 0.0);
    for n in 1..=whole(duration / step) {
        let state = simulation.step()?;
        for (own, last) in state.contact.iter().zip(&before) {
            let found = violations(own, last, scene.friction, [pressure, settlement]);
            worst = std::array::from_fn(|k| worse(worst[k], found[k]));
        }
        all += state.modes.len() as f64;
        open += state.modes.iter().filter(|mode| **mode == Mode::Open).count() as f64;
        slid += state.modes.iter().filter(|mode| mode.is_slip()).count() as f64;
        before.copy_from_slice(&state.contact);
        if n % 20 == 0 {
            series.push(worst);
            worst = [0.0; 5];
        }
    }
    Ok((series, [open / all, slid / all]))
}

fn run(short: bool) -> Result<Outcome, AnyError> {
    let names = [
        "tension over the mean pressure p₀",
        "penetration over the settlement s₀",
        "pressure × gap over p₀ s₀",
        "shear above μp over p₀",
        "friction work short of the largest, over p₀ s₀",
    ];
    let (mut checks, mut panels) = (Vec::new(), Vec::new());
    for scene in &SCENES {
        let (series, [open, slid]) = march(scene, if short { 4.0 } else { 10.0 })?;
        let worst = |k: usize| series.iter().fold(0.0, |most, own| worse(most, own[k]));
        for (k, name) in names.into_iter().enumerate() {
            checks.push(Check::below(format!("{}: {name}", scene.name), worst(k), 1e-11));
        }
        let name = |what: &str| format!("{}: part of elements and steps that {what}", scene.name);
        checks.push(Check::within(name("are open"), open, 0.0..=0.9));
        checks.push(Check::within(name("slide"), slid, 0.001..=0.9));
        let curve = |k: usize| {
            let each = series.iter().enumerate();
            each.map(|(n, own)| (0.1 * n as f64, own[k].max(1e-20))).collect::<Vec<_>>()
        };
        panels.push(
            Panel::new("time, s", &format!("worst residual ({})", scene.name))
                .logarithmic()
                .room(0.05, 0.4)
                .line("Signorini: pressure × gap", BLUE, curve(2))
                .line("Coulomb: shear above μp", GREEN, curve(3))
                .line("maximum dissipation", RED, curve(4)),
        );
    }
    let title =
        "Residuals of the contact conditions in plan, three bodies shaken in three directions";
    Ok(Outcome { checks, figure: Figure::new(title, 3, panels) })
}
