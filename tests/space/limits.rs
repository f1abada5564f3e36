//! GOAL: a law of one's own in plan, by its limits, is placed on the ground under its own cap, tension and bond.
//! SCENE: square bodies, their weight in the middle or beside it, on independent springs under 8 × 8 cells.
//! REFERENCE: Navier's linear pressure; the package's laws of the same limits; a body in free fall.

use basemat::bem::SpringGround;
use basemat::bem::plan::Plan;
use basemat::coupled::StabilityError;
use basemat::coupled::{GravityStage, SimulationBuilder, Warning};
use basemat::interface::{
    Bonded, Cohesive, Condition, ContactState, Coulomb, InterfaceLaw, Limits, Mode,
    PreviousContact, Tolerance, Yielding,
};
use basemat::motion::STANDARD_GRAVITY;
use basemat::structure::RigidBody;
use basemat::{Error, Result, Simulation};

const SIDE: f64 = 4.0;
const MASS: f64 = 64.0e3;
/// Mean pressure under the weight, Pa: 39 kPa.
const PRESSURE: f64 = MASS * STANDARD_GRAVITY / (SIDE * SIDE);

/// A law by its limits, without modes of the plane. If it `remembers`, a base that lands meets the sunken surface.
#[derive(Clone, Copy)]
struct Own {
    limits: Limits,
    remembers: bool,
}

impl Own {
    fn by(limits: Limits) -> Self {
        Self { limits, remembers: false }
    }
}

impl InterfaceLaw for Own {
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
        usize::from(self.remembers)
    }

    fn commit(&self, _: &PreviousContact, end: &ContactState, mode: Mode, memory: &mut [f64]) {
        if matches!(mode, Mode::Yield | Mode::YieldSlip) {
            memory[0] = memory[0].max(-end.gap);
        }
    }

    fn limits(&self, start: &PreviousContact) -> Result<Limits> {
        let offset = start.state_variables.first().map_or(0.0, |indentation| -indentation);
        let lost = start.has_opened && !self.limits.bonded;
        let kept = |value: f64| if lost { 0.0 } else { value };
        Ok(Limits {
            gap_offset: offset,
            tension: kept(self.limits.tension),
            attraction: kept(self.limits.attraction),
            ..self.limits
        })
    }
}

/// A body whose centre of gravity is `beside` the middle of its base, m.
fn scene(law: impl InterfaceLaw + 'static, beside: f64) -> SimulationBuilder {
    let half = 0.5 * SIDE;
    let square = [[-half, -half], [half, -half], [half, half], [-half, half]].to_vec();
    let inertia = std::array::from_fn(|i| {
        std::array::from_fn(|j| if i == j { MASS * SIDE * SIDE / 6.0 } else { 0.0 })
    });
    let body = RigidBody::from_mass(square, MASS, inertia, [beside, 0.0, 1.0]).unwrap();
    let plan = Plan::rectangle(-half..half, -half..half, 8).unwrap();
    let springs = SpringGround::in_plan(plan, [3.0e7, 2.0e7, 2.0e7]).unwrap();
    Simulation::builder(4e-3).structure(body).ground(springs).interface(law)
}

fn pressures(simulation: &Simulation) -> Vec<f64> {
    simulation.state().contact.iter().map(|own| own.pressure).collect()
}

/// Navier's pressures, compressive or not: N/A (1 + e x A/I), with I of the cells' middles.
fn linear(simulation: &Simulation, beside: f64) -> Vec<f64> {
    let elements = simulation.ground().elements();
    let middles: Vec<f64> = elements.iter().map(|own| own.center()[0]).collect();
    let square = middles.iter().map(|x| x * x).sum::<f64>() / middles.len() as f64;
    middles.iter().map(|x| PRESSURE * (1.0 + beside * x / square)).collect()
}

fn close(found: &[f64], known: &[f64]) {
    for (found, known) in found.iter().zip(known) {
        assert!((found - known).abs() < 1e-7 * PRESSURE, "{found} {known}");
    }
}

#[test]
fn caps_below_the_weight_are_bearing_failure() {
    let of = |law: Box<dyn InterfaceLaw>| match scene(law, 0.0).build().unwrap_err() {
        Error::Stability(cause) => *cause,
        other => panic!("{other}"),
    };
    let limits = Limits { friction: 0.3, pressure_cap: 1e3, ..Limits::default() };
    let own = of(Box::new(Own::by(limits)));
    let StabilityError::BearingFailure { ratio, .. } = own else { panic!("{own}") };
    assert!((ratio / (PRESSURE / 1e3) - 1.0).abs() < 1e-9, "{ratio}");
    assert_eq!(own, of(Box::new(Yielding::new(1e3, 0.3).unwrap())));
}

/// The edge yields under a weight beside the middle: the static state, the indentation and the run equal the results of
/// the crate's own law.
#[test]
fn caps_are_kept_while_the_weight_comes_on() {
    let limits = Limits { friction: 0.3, pressure_cap: 1.5 * PRESSURE, ..Limits::default() };
    let push = |law: Box<dyn InterfaceLaw>| {
        let load = basemat::coupled::Load::new(0, |time| 2e4 * (9.0 * time).sin());
        let mut simulation = scene(law, 0.5).load(load).build().unwrap();
        let found = (pressures(&simulation), simulation.state().state_variables(7).to_vec());
        let run = simulation.run(100, |_| {}).unwrap();
        (found, format!("{:?}", simulation.state().contact), run.warnings)
    };
    let own = push(Box::new(Own { limits, remembers: true }));
    let (pressures, indentation) = &own.0;
    assert!(pressures.iter().all(|own| *own <= limits.pressure_cap * (1.0 + 1e-9)));
    assert!(indentation[0] > 1e-5, "{indentation:?}");
    assert_eq!(own, push(Box::new(Yielding::new(limits.pressure_cap, 0.3).unwrap())));
    // Without the memory, the pressures are the same.
    let simulation = scene(Own::by(limits), 0.5).build().unwrap();
    close(&self::pressures(&simulation), pressures);
}

#[test]
fn tension_and_bonds_hold_while_the_weight_comes_on() {
    let beside = 1.0;
    let strong = Limits { friction: 0.3, tension: PRESSURE, ..Limits::default() };
    let bonded = Limits { bonded: true, ..Limits::default() };
    let laws: [Box<dyn InterfaceLaw>; 5] = [
        Box::new(Own::by(strong)),
        Box::new(Own::by(bonded)),
        Box::new(Bonded),
        Box::new(Coulomb::new(0.3).unwrap().with_tensile_strength(PRESSURE).unwrap()),
        Box::new(Cohesive::new(PRESSURE, PRESSURE, 0.3).unwrap()),
    ];
    for law in laws {
        let simulation = scene(law, beside).build().unwrap();
        let known = linear(&simulation, beside);
        assert!(known.iter().any(|own| *own < -0.3 * PRESSURE));
        assert!(simulation.state().modes.iter().all(|mode| mode.is_closed()));
        close(&pressures(&simulation), &known);
    }
    // Less strength than that opens some of it, as without any.
    let weak = Limits { tension: 0.1 * PRESSURE, ..strong };
    for law in [weak, Limits { tension: 0.0, ..strong }] {
        let simulation = scene(Own::by(law), beside).build().unwrap();
        assert!(simulation.state().modes.contains(&Mode::Open));
        assert!(pressures(&simulation).iter().all(|own| *own >= -law.tension * (1.0 + 1e-9)));
    }
}

/// A layer of one's own is compressed by the weight before the run begins.
#[test]
fn layers_are_compressed_while_the_weight_comes_on() {
    struct Layer;
    impl InterfaceLaw for Layer {
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
            [1e-7, 1e-7]
        }
        fn limits(&self, _: &PreviousContact) -> Result<Limits> {
            Ok(Limits { friction: 0.5, ..Limits::default() })
        }
    }
    let mut simulation = scene(Layer, 0.5).build().unwrap();
    let known = linear(&simulation, 0.5);
    close(&pressures(&simulation), &known);
    for (own, pressure) in simulation.state().contact.iter().zip(&known) {
        assert!((own.gap + 1e-7 * pressure).abs() < 1e-12, "{} {pressure}", own.gap);
    }
    // Nothing moves.
    simulation.run(20, |_| {}).unwrap();
    close(&pressures(&simulation), &known);
}

/// Let go at t = 0 on soil that bears 1 kPa, a body sinks by ½ (g − cap/m) t², and the run says so: whatever the law.
#[test]
fn sinking_warns() {
    let cap = 1e3;
    let limits = Limits { friction: 0.3, pressure_cap: cap, ..Limits::default() };
    let laws: [Box<dyn InterfaceLaw>; 2] =
        [Box::new(Own::by(limits)), Box::new(Yielding::new(cap, 0.3).unwrap())];
    for law in laws {
        let mut simulation = scene(law, 0.0).gravity_stage(GravityStage::Unloaded).build().unwrap();
        let run = simulation.run(500, |_| {}).unwrap();
        let fallen = 0.5 * STANDARD_GRAVITY * (1.0 - cap / PRESSURE) * 2.0_f64.powi(2);
        let found = run.warnings.iter().find_map(|warning| match warning {
            Warning::LargeSettlement { foundation: 0, settlement, width } => {
                Some((*settlement, *width))
            }
            _ => None,
        });
        let (settlement, width) = found.expect("a warning");
        assert!((settlement - fallen).abs() < 0.01 && width == SIDE, "{settlement} {fallen}");
    }
    let mut simulation = scene(Coulomb::new(0.3).unwrap(), 0.0).build().unwrap();
    let run = simulation.run(50, |_| {}).unwrap();
    assert!(!run.warnings.iter().any(|own| matches!(own, Warning::LargeSettlement { .. })));
}
