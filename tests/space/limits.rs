//! GOAL: the static state of a user's law in space keeps the law's limits: cap of the pressure, tension and bond.
//! SCENE: square bodies, their weight in the middle or beside it, on independent springs under 8 × 8 cells.
//! REFERENCE: Navier's linear pressure; the crate's laws of the same limits; a body in free fall.

use basemat::bem::SpringGround;
use basemat::bem::plan::Plan;
use basemat::coupled::{GravityStage, Load, SimulationBuilder, StabilityError, Warning};
use basemat::interface::{
    Bonded, Cohesive, Condition, ContactState, Coulomb, InterfaceLaw, Limits, Mode,
    PreviousContact, Tolerance, Yielding,
};
use basemat::motion::STANDARD_GRAVITY;
use basemat::structure::RigidBody;
use basemat::{Error, Result, Simulation};

const BASE_SIDE: f64 = 4.0;
const BODY_MASS: f64 = 64.0e3;
/// Mean pressure under the weight, Pa: 39 kPa.
const MEAN_PRESSURE: f64 = BODY_MASS * STANDARD_GRAVITY / (BASE_SIDE * BASE_SIDE);
/// Compliance of the compressible layer, m/Pa.
const LAYER_COMPLIANCE: f64 = 1e-7;

/// A law by its limits, without modes of the plane.
///
/// If it `has_memory`, a base that lands touches the soil at its indented surface.
#[derive(Clone, Copy)]
struct LimitsLaw {
    limits: Limits,
    has_memory: bool,
}

impl LimitsLaw {
    fn new(limits: Limits) -> Self {
        Self { limits, has_memory: false }
    }
}

impl InterfaceLaw for LimitsLaw {
    fn modes(&self) -> &[Mode] {
        &[Mode::Stick, Mode::Open]
    }

    fn conditions(&self, _: Mode, _: &PreviousContact) -> [Condition; 2] {
        unreachable!("of the plane")
    }

    fn next_mode(&self, _: Mode, _: &PreviousContact, _: &ContactState, _: Tolerance) -> Mode {
        unreachable!("of the plane")
    }

    fn state_variables(&self) -> usize {
        usize::from(self.has_memory)
    }

    fn commit(&self, _: &PreviousContact, end: &ContactState, mode: Mode, variables: &mut [f64]) {
        if matches!(mode, Mode::Yield | Mode::YieldSlip) {
            variables[0] = variables[0].max(-end.gap);
        }
    }

    fn limits(&self, start: &PreviousContact) -> Result<Limits> {
        let gap_offset = start.state_variables.first().map_or(0.0, |indentation| -indentation);
        let mut limits = Limits { gap_offset, ..self.limits };
        if start.has_opened && !self.limits.bonded {
            limits.tension = 0.0;
            limits.attraction = 0.0;
        }
        Ok(limits)
    }
}

/// A body whose centre of gravity is at a distance from the middle of its base, m.
fn scene(law: impl InterfaceLaw + 'static, eccentricity: f64) -> SimulationBuilder {
    let half = 0.5 * BASE_SIDE;
    let square = [[-half, -half], [half, -half], [half, half], [-half, half]].to_vec();
    let inertia = std::array::from_fn(|i| {
        std::array::from_fn(|j| if i == j { BODY_MASS * BASE_SIDE * BASE_SIDE / 6.0 } else { 0.0 })
    });
    let center = [eccentricity, 0.0, 1.0];
    let body = RigidBody::from_mass(square, BODY_MASS, inertia, center).unwrap();
    let plan = Plan::rectangle(-half..half, -half..half, 8).unwrap();
    let springs = SpringGround::in_plan(plan, [3.0e7, 2.0e7, 2.0e7]).unwrap();
    Simulation::builder(4e-3).structure(body).ground(springs).interface(law)
}

fn pressures(simulation: &Simulation) -> Vec<f64> {
    simulation.state().contact.iter().map(|contact| contact.pressure).collect()
}

/// Navier's pressures, compressive or not: N/A (1 + e x A/I), with I of the cells' middles.
fn linear_pressures(simulation: &Simulation, eccentricity: f64) -> Vec<f64> {
    let elements = simulation.ground().elements();
    let middles: Vec<f64> = elements.iter().map(|element| element.center()[0]).collect();
    let mean_square = middles.iter().map(|x| x * x).sum::<f64>() / middles.len() as f64;
    middles
        .iter()
        .map(|x| MEAN_PRESSURE * (1.0 + eccentricity * x / mean_square))
        .collect()
}

fn assert_close(computed: &[f64], expected: &[f64]) {
    for (computed, expected) in computed.iter().zip(expected) {
        assert!((computed - expected).abs() < 1e-7 * MEAN_PRESSURE, "{computed} {expected}");
    }
}

/// Why a body cannot stand under its weight with a law.
fn stability_error(law: impl InterfaceLaw + 'static) -> StabilityError {
    match scene(law, 0.0).build().unwrap_err() {
        Error::Stability(cause) => *cause,
        other => panic!("{other}"),
    }
}

#[test]
fn caps_below_the_mean_pressure_are_a_bearing_failure() {
    let limits = Limits { friction: 0.3, pressure_cap: 1e3, ..Limits::default() };
    let error = stability_error(LimitsLaw::new(limits));
    let StabilityError::BearingFailure { ratio, .. } = error else {
        panic!("{error}")
    };
    assert!((ratio / (MEAN_PRESSURE / 1e3) - 1.0).abs() < 1e-9, "{ratio}");
    assert_eq!(error, stability_error(Yielding::new(1e3, 0.3).unwrap()));
}

/// The static state of a pushed body, and the end of its run.
#[derive(Debug, PartialEq)]
struct PushedBody {
    static_pressures: Vec<f64>,
    /// Indentation of one element under the edge, m.
    indentation: Vec<f64>,
    final_contact: String,
    warnings: Vec<Warning>,
}

fn push(law: impl InterfaceLaw + 'static) -> PushedBody {
    let load = Load::new(0, |time| 2e4 * (9.0 * time).sin());
    let mut simulation = scene(law, 0.5).load(load).build().unwrap();
    let static_pressures = pressures(&simulation);
    let indentation = simulation.state().state_variables(7).to_vec();
    let run = simulation.run(100, |_| {}).unwrap();
    let final_contact = format!("{:?}", simulation.state().contact);
    PushedBody { static_pressures, indentation, final_contact, warnings: run.warnings }
}

/// The edge yields under a weight beside the middle: the static state, the indentation and the run equal the results of
/// the crate's law.
#[test]
fn caps_of_the_pressure_hold_while_the_weight_is_applied() {
    let limits = Limits { friction: 0.3, pressure_cap: 1.5 * MEAN_PRESSURE, ..Limits::default() };
    let pushed = push(LimitsLaw { limits, has_memory: true });
    let cap = limits.pressure_cap * (1.0 + 1e-9);
    assert!(pushed.static_pressures.iter().all(|pressure| *pressure <= cap));
    assert!(pushed.indentation[0] > 1e-5, "{:?}", pushed.indentation);
    assert_eq!(pushed, push(Yielding::new(limits.pressure_cap, 0.3).unwrap()));
    // Without the memory, the pressures are the same.
    let simulation = scene(LimitsLaw::new(limits), 0.5).build().unwrap();
    assert_close(&pressures(&simulation), &pushed.static_pressures);
}

#[test]
fn tension_and_bonds_hold_while_the_weight_is_applied() {
    let eccentricity = 1.0;
    let strong = Limits { friction: 0.3, tension: MEAN_PRESSURE, ..Limits::default() };
    let bonded = Limits { bonded: true, ..Limits::default() };
    let laws: [Box<dyn InterfaceLaw>; 5] = [
        Box::new(LimitsLaw::new(strong)),
        Box::new(LimitsLaw::new(bonded)),
        Box::new(Bonded),
        Box::new(Coulomb::new(0.3).unwrap().with_tensile_strength(MEAN_PRESSURE).unwrap()),
        Box::new(Cohesive::new(MEAN_PRESSURE, MEAN_PRESSURE, 0.3).unwrap()),
    ];
    for law in laws {
        let simulation = scene(law, eccentricity).build().unwrap();
        let expected = linear_pressures(&simulation, eccentricity);
        assert!(expected.iter().any(|pressure| *pressure < -0.3 * MEAN_PRESSURE));
        assert!(simulation.state().modes.iter().all(|mode| mode.is_closed()));
        assert_close(&pressures(&simulation), &expected);
    }
    // With less or no tensile strength, a part of the base opens.
    for tension in [0.1 * MEAN_PRESSURE, 0.0] {
        let limits = Limits { tension, ..strong };
        let simulation = scene(LimitsLaw::new(limits), eccentricity).build().unwrap();
        assert!(simulation.state().modes.contains(&Mode::Open));
        let min_pressure = -tension * (1.0 + 1e-9);
        assert!(pressures(&simulation).iter().all(|pressure| *pressure >= min_pressure));
    }
}

/// Friction on a layer that the pressure compresses.
struct CompressibleLayer;

impl InterfaceLaw for CompressibleLayer {
    fn modes(&self) -> &[Mode] {
        &[Mode::Stick, Mode::Open]
    }
    fn conditions(&self, _: Mode, _: &PreviousContact) -> [Condition; 2] {
        unreachable!("of the plane")
    }
    fn next_mode(&self, _: Mode, _: &PreviousContact, _: &ContactState, _: Tolerance) -> Mode {
        unreachable!("of the plane")
    }
    fn compliance(&self, _: Mode, _: &PreviousContact) -> [f64; 2] {
        [LAYER_COMPLIANCE, LAYER_COMPLIANCE]
    }
    fn limits(&self, _: &PreviousContact) -> Result<Limits> {
        Ok(Limits { friction: 0.5, ..Limits::default() })
    }
}

/// A layer of a user's law is compressed by the weight before the run begins.
#[test]
fn layers_are_compressed_while_the_weight_is_applied() {
    let mut simulation = scene(CompressibleLayer, 0.5).build().unwrap();
    let expected = linear_pressures(&simulation, 0.5);
    assert_close(&pressures(&simulation), &expected);
    for (contact, pressure) in simulation.state().contact.iter().zip(&expected) {
        assert!(
            (contact.gap + LAYER_COMPLIANCE * pressure).abs() < 1e-12,
            "{} {pressure}",
            contact.gap
        );
    }
    // Nothing moves.
    simulation.run(20, |_| {}).unwrap();
    assert_close(&pressures(&simulation), &expected);
}

/// The warning of a large settlement.
fn large_settlement(warnings: &[Warning]) -> Option<Warning> {
    warnings
        .iter()
        .find(|warning| matches!(warning, Warning::LargeSettlement { .. }))
        .copied()
}

/// A body released at t = 0 on soil with a bearing pressure of 1 kPa sinks by ½ g (1 − cap/p) t², p its mean pressure.
///
/// With each law the run has a warning of this settlement.
#[test]
fn large_settlements_cause_a_warning() {
    let cap = 1e3;
    let limits = Limits { friction: 0.3, pressure_cap: cap, ..Limits::default() };
    let laws: [Box<dyn InterfaceLaw>; 2] =
        [Box::new(LimitsLaw::new(limits)), Box::new(Yielding::new(cap, 0.3).unwrap())];
    for law in laws {
        let mut simulation = scene(law, 0.0).gravity_stage(GravityStage::Unloaded).build().unwrap();
        let run = simulation.run(500, |_| {}).unwrap();
        let expected = 0.5 * STANDARD_GRAVITY * (1.0 - cap / MEAN_PRESSURE) * 2.0_f64.powi(2);
        let warning = large_settlement(&run.warnings).expect("a warning");
        let Warning::LargeSettlement { foundation: 0, settlement, width } = warning else {
            panic!("{warning:?}")
        };
        assert!(
            (settlement - expected).abs() < 0.01 && width == BASE_SIDE,
            "{settlement} {expected}"
        );
    }
    let mut simulation = scene(Coulomb::new(0.3).unwrap(), 0.0).build().unwrap();
    let run = simulation.run(50, |_| {}).unwrap();
    assert_eq!(large_settlement(&run.warnings), None);
}
