//! Random scenes that lift off and slide: the energy balance closes, nothing gives back what it has taken,
//! and saved runs go on to the same bits.
//! `SPACE_SCENES=1000` draws so many, `SPACE_FIRST=40` from that one on.

use basemat::bem::plan::Plan;
use basemat::bem::{ContactElement, ElasticGround};
use basemat::coupled::StepError;
use basemat::coupled::{GravityStage, Load, Mistake, Warning};
use basemat::interface::{Cohesive, Coulomb, InterfaceLaw, Mode, ThinLayer, Yielding};
use basemat::structure::RigidBody;
use basemat::{Error, Simulation, Soil};
use basemat_problems::flexible_scenes::{Outcome, Sines, profile};
use basemat_problems::random::Random;

const SCENES: usize = 40;
const STEPS: usize = 60;

fn law(random: &mut Random, friction: f64, pressure: f64) -> Box<dyn InterfaceLaw> {
    match random.pick(&[0, 0, 0, 1, 2, 3]) {
        0 => Box::new(Coulomb::new(friction).unwrap()),
        1 => Box::new(Yielding::new(random.within(2.0, 4.0) * pressure, friction).unwrap()),
        2 => {
            let [tension, cohesion] = [0.5, 0.5].map(|most| random.within(0.0, most) * pressure);
            Box::new(Cohesive::new(tension, cohesion, friction).unwrap())
        }
        _ => {
            let stiffness = random.log_within(3.0, 100.0);
            let layer = ThinLayer::from_stiffness(2.0 * stiffness, stiffness, friction).unwrap();
            Box::new(layer.with_debonded_ratio(0.0).unwrap())
        }
    }
}

fn scene(random: &mut Random) -> Result<Simulation, Error> {
    let soil = Soil::new(1.0, random.within(0.0, 0.45), 1.0)?;
    let profile = profile(random, soil, 0.25)?;
    let sides = [2.0, random.within(1.2, 2.0)];
    let height = random.within(0.5, 5.0);
    let density = random.log_within(0.05, 3.0);
    let body = RigidBody::cuboid([sides[0], sides[1], height], density)?;
    let cells = random.pick(&[2, 3, 4, 5]);
    let plan = if random.chance(0.4) {
        // A rectangle without a corner, or two mats of one body.
        let pitch = sides.map(|side| side / cells as f64);
        let cut = random.pick(&[0, 1]);
        let on = |place: usize| match cut {
            0 => place != 0,
            _ => place % cells != cells / 2 || cells < 3,
        };
        let mask: Vec<bool> = (0..cells * cells).map(on).collect();
        Plan::masked(sides.map(|side| -0.5 * side), pitch, cells, &mask)?
    } else {
        let [x, y] = sides.map(|side| -0.5 * side..0.5 * side);
        let plan = Plan::rectangle(x, y, cells)?;
        let [columns, rows] = [plan.count() / cells, cells];
        if columns > 3 && rows > 3 && random.chance(0.3) {
            // All but the outermost of each column and row as one.
            let ends = |count: usize| [1, count - 2, 1];
            plan.with_unions(&ends(columns), &ends(rows))?
        } else {
            plan
        }
    };
    let pitch = plan.pitch()[1];
    let step = pitch * random.log_within(0.05, 10.0);
    let gravity = random.log_within(1e-4, 1e-2);
    let friction = random.log_within(0.02, 10.0);
    // None at all, some, or endless.
    let friction = if friction < 0.03 { 0.0 } else { friction };
    let friction = if random.chance(0.1) { f64::INFINITY } else { friction };
    let pressure = gravity * density * height;
    let motion = Sines::random(random, step, gravity);
    let weight = pressure * sides[0] * sides[1];
    let push = random.within(0.0, 0.05) * friction.min(1.0) * weight;
    let stage =
        if random.chance(0.2) { GravityStage::Unloaded } else { GravityStage::Frictionless };
    Simulation::builder(step)
        .structure(body)
        .ground(ElasticGround::in_plan(profile, plan)?)
        .interface(law(random, friction, pressure))
        .motion(motion)
        .gravity(gravity)
        .gravity_stage(stage)
        .load(Load::new(1, move |time: f64| push * (1.0 + (0.3 * time).sin())))
        .expected_steps(STEPS)
        .build()
}

#[test]
fn energies_of_random_scenes_close() {
    let number = |name, usual| std::env::var(name).map_or(usual, |text| text.parse().unwrap());
    let (first, scenes) = (number("SPACE_FIRST", 0), number("SPACE_SCENES", SCENES));
    let (mut opened, mut slid, mut unsolved) = (0, 0, 0);
    let (mut residual, mut least, mut steps, mut trials, mut most) = (0.0_f64, 0.0_f64, 0, 0, 0);
    let mut lessened = 0;
    for number in first..first + scenes {
        if number % 50 == 0 {
            println!(
                "{number}: {steps} steps, {unsolved} unsolved, energy error {residual:.1e}, friction work {least:.1e}"
            );
        }
        let mut simulation = match scene(&mut Random(29 + number as u64)) {
            Ok(simulation) => simulation,
            // A structure that cannot stand under its load at t = 0.
            Err(error @ (Error::Preload { .. } | Error::Stability(_))) => {
                println!("{number}: {error}");
                unsolved += 1;
                continue;
            }
            Err(error) => panic!("{number}: {error}"),
        };
        let areas: Vec<f64> = {
            let ground = simulation.ground();
            ground.elements().iter().map(ContactElement::area).collect()
        };
        let mut before = simulation.state().contact.clone();
        let begun = simulation.begin_run();
        for _ in 0..STEPS {
            let state = match simulation.step() {
                Ok(state) => state,
                Err(Error::Step { source: source @ StepError::Cone { .. }, step, .. }) => {
                    println!("{number}, step {step}: {source}");
                    unsolved += 1;
                    break;
                }
                Err(error) => panic!("{number}: {error}"),
            };
            let energy = &state.energy_balance;
            assert!(energy.residual() < 1e-9, "{number}: {energy}");
            assert!(energy.soil >= -1e-9 * energy.largest, "{number}: {energy}");
            for ((own, last), area) in state.contact.iter().zip(&before).zip(&areas) {
                let along = own.shear * (own.slip - last.slip);
                let across = own.shear_across * (own.slip_across - last.slip_across);
                // A layer gives back what it has stored.
                if energy.interface == 0.0 {
                    let work = area * (along + across);
                    assert!(work >= -1e-10 * energy.largest, "{number}: {work:e}");
                    least = least.min(work / energy.largest);
                }
            }
            residual = residual.max(energy.residual());
            (steps, trials, most) = (steps + 1, trials + state.trials, most.max(state.trials));
            before.copy_from_slice(&state.contact);
            opened += usize::from(state.modes.contains(&Mode::Open));
            slid += usize::from(state.modes.iter().any(|mode| mode.is_slip()));
        }
        for warning in simulation.end_run(begun).warnings {
            let of_units = matches!(
                warning,
                Warning::Mistake(
                    Mistake::UnusualInterval { .. }
                        | Mistake::LightStructure { .. }
                        | Mistake::UnusualFriction { .. }
                        | Mistake::UnusualGravity { .. }
                )
            );
            assert!(!of_units, "{number}: {warning}");
            if let Warning::LessFriction { steps, .. } = warning {
                println!("{number}: {warning}");
                lessened += steps;
            }
        }
    }
    println!(
        "{scenes} scenes, {steps} steps: {opened} open, {slid} slide, {unsolved} unsolved, \
         {lessened} with less friction; energy error {residual:.1e}, friction work {least:.1e}, \
         {:.1} iterations, at most {most}",
        trials as f64 / f64::from(steps)
    );
    assert!(opened > scenes * STEPS / 5 && slid > scenes * STEPS / 5, "{opened} {slid}");
    assert!(unsolved <= scenes / 20, "{unsolved}");
}

/// Rafts of shells with walls or frames, and bricks: energy balances close (`cargo study elements` runs 200).
#[test]
fn energies_of_random_flexible_scenes_close() {
    let mut outcome = Outcome::default();
    for number in [10, 17, 18, 32, 43, 69] {
        outcome.run(number);
    }
    println!("{outcome:?}");
    assert!(outcome.refused.is_empty() && outcome.reduced == 4, "{outcome:?}");
    assert!(outcome.opened > 150 && outcome.slid > 200, "{outcome:?}");
}

/// Scenes whose Ritz vectors do not converge are stepped in all modes.
#[test]
fn small_flexible_scenes_are_reduced_without_refusal() {
    let mut outcome = Outcome::default();
    for number in [33, 37] {
        outcome.run(number);
    }
    println!("{outcome:?}");
    assert!(outcome.refused.is_empty() && outcome.reduced == 2, "{outcome:?}");
}

/// Saved anywhere and resumed in another simulation, steps have the same bits: half as many scenes.
#[test]
fn random_scenes_resume_to_the_last_bit() {
    let number = |name, usual| std::env::var(name).map_or(usual, |text| text.parse().unwrap());
    let (first, scenes) = (number("SPACE_FIRST", 0), number("SPACE_SCENES", 24) / 2);
    let (mut compared, mut slid) = (0, 0);
    for number in first..first + scenes {
        let build = || scene(&mut Random(29 + number as u64));
        let Ok(mut whole) = build() else { continue };
        let mut random = Random(number as u64);
        let cuts: [f64; 2] = [0, 30].map(|from| random.within(from.into(), (from + 25).into()));
        let (mut saved, mut states) = (Vec::new(), Vec::new());
        for step in 0..STEPS {
            if cuts.iter().any(|cut| cut.round() == step as f64) {
                saved.push((step, whole.checkpoint().unwrap()));
            }
            let Ok(state) = whole.step() else { break };
            states.push(state.clone());
        }
        for (step, checkpoint) in saved {
            let mut other = build().unwrap();
            other.resume(&checkpoint).unwrap();
            for wanted in &states[step..] {
                assert!(other.step().unwrap() == wanted, "{number}, saved after {step}");
                compared += 1;
                slid += usize::from(wanted.modes.iter().any(|mode| mode.is_slip()));
            }
        }
    }
    println!("{scenes} scenes, {compared} steps compared, {slid} slide");
    assert!(compared > 30 * scenes && slid > 10 * scenes, "{compared} {slid}");
}

/// Endless friction beside a bond, on a base whose third cell carries next to nothing: a pull of the fictitious springs
/// of 5e-7 of the load turns its shear from one bound to another and back.
#[test]
fn what_hardly_presses_comes_to_rest() {
    scene(&mut Random(29 + 931)).unwrap();
}
