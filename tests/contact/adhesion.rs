//! GOAL: a bond that breaks leaves no step without a solution.
//! SCENE: blocks of ordinary size glued to a half-plane, shaken with 0.3 to 2 g in both directions.
//! REFERENCE: the law's own conditions, written down anew, on every state.

use basemat::bem::{ElasticGround, Strip};
use basemat::coupled::State;
use basemat::coupled::StepError;
use basemat::interface::Cohesive;
use basemat::motion::FreeFieldFn;
use basemat::structure::RigidBlock;
use basemat::{Error, Result, Simulation, Soil};

use basemat_problems::random::Random;

/// A glued block and its shaking.
#[derive(Debug, Clone, Copy)]
struct Glued {
    width: f64,
    height: f64,
    density: f64,
    shear_speed: f64,
    poisson: f64,
    elements: usize,
    graded: bool,
    time_step: f64,
    /// Tension, cohesion, friction.
    strengths: [f64; 3],
    /// Peak acceleration (m/s²) and period (s) of the shaking to the right, share of it upwards.
    shaking: [f64; 3],
}

impl Glued {
    fn random(random: &mut Random) -> Self {
        let width = random.within(2.0, 10.0);
        let shear_speed = random.log_within(100.0, 600.0);
        let poisson: f64 = random.pick(&[0.0, 0.2, 1.0 / 3.0, 0.45]);
        let elements = random.pick(&[4, 8, 12, 15, 18, 24]);
        let wave_speed = shear_speed * (2.0 * (1.0 - poisson) / (1.0 - 2.0 * poisson)).sqrt();
        let courant = random.log_within(0.5, 4.5);
        let period = random.log_within(0.1, 1.0);
        Self {
            width,
            height: width * random.within(0.5, 2.5),
            density: random.within(500.0, 2500.0),
            shear_speed,
            poisson,
            elements,
            graded: random.chance(0.7),
            time_step: (courant * width / elements as f64 / wave_speed).min(0.05 * period),
            strengths: [
                random.log_within(2e3, 2e5),
                random.log_within(2e3, 2e5),
                random.within(0.2, 1.2),
            ],
            shaking: [9.81 * random.log_within(0.3, 2.0), period, random.pick(&[0.0, 0.3, 0.7])],
        }
    }

    fn build(&self) -> Result<Simulation> {
        let soil = Soil::new(1900.0 * self.shear_speed.powi(2), self.poisson, 1900.0)?;
        let block = RigidBlock::new(self.width, self.height, self.density)?;
        let half = 0.5 * self.width;
        let ground = if self.graded {
            ElasticGround::new(soil, Strip::graded(-half..half, self.elements)?)?
        } else {
            ElasticGround::new(soil, Strip::uniform(-half..half, self.elements)?)?
        };
        let [acceleration, period, upwards] = self.shaking;
        let rate = std::f64::consts::TAU / period;
        let amplitude = acceleration / (rate * rate);
        let motion = FreeFieldFn::new(move |_, time| {
            // Two frequencies that never repeat, risen to in a period.
            let rise = (time / period).min(1.0).powi(3);
            let along = (rate * time).sin() + 0.3 * (2.37 * rate * time).sin();
            let up = (1.37 * rate * time).sin();
            [rise * amplitude * along, rise * amplitude * upwards * up]
        });
        let [tension, cohesion, friction] = self.strengths;
        Simulation::builder(self.time_step)
            .structure(block)
            .ground(ground)
            .interface(Cohesive::new(tension, cohesion, friction)?)
            .motion(motion)
            .build()
    }
}

/// Results of a number of scenes.
#[derive(Debug, Default)]
struct Tally {
    scenes: usize,
    /// Runs that ended in a contact error.
    unsolved: usize,
    steps: usize,
    /// Steps in which bonds break, and most in one.
    breaking: usize,
    most: usize,
    most_trials: usize,
    /// Worst violation of the law's conditions: of the largest traction so far, of the largest opening.
    violation: f64,
    /// Worst energy that contact gives back in a step, of the largest kinetic energy or input so far.
    given_back: f64,
}

fn glued(simulation: &Simulation, element: usize) -> bool {
    simulation.state().state_variables(element) == [1.0]
}

/// Violation of the conditions of the bond, or of friction where it has broken, at the end of a step.
fn violation(scene: &Glued, before: &State, now: &State, held: &[bool], scales: [f64; 2]) -> f64 {
    let [tension, cohesion, friction] = scene.strengths;
    let [force, length] = scales;
    let element = |e: usize| {
        let (start, end) = (&before.contact[e], &now.contact[e]);
        let (pressure, shear, gap) = (end.pressure / force, end.shear / force, end.gap / length);
        let advance = (end.slip - start.slip) / length;
        if held[e] {
            let limit = cohesion / force + friction * pressure.max(0.0);
            let strength = (-pressure - tension / force).max(shear.abs() - limit);
            return strength.max(gap.abs()).max(advance.abs());
        }
        let open = pressure.abs().max(shear.abs()).max(-gap);
        let stick = advance.abs().max(shear.abs() - friction * pressure);
        let slides = |sense: f64| (shear - sense * friction * pressure).abs().max(-sense * advance);
        let closed = gap.abs().max(-pressure);
        open.min(closed.max(stick.min(slides(1.0)).min(slides(-1.0))))
    };
    (0..held.len()).map(element).fold(0.0, f64::max)
}

fn shake(scene: &Glued, steps: usize, tally: &mut Tally) {
    tally.scenes += 1;
    let mut simulation = scene.build().unwrap();
    let count = scene.elements;
    let mut held = vec![true; count];
    let mut before = simulation.state().clone();
    let [mut force, mut length, mut energy] = [f64::MIN_POSITIVE; 3];
    for _ in 0..steps {
        match simulation.step() {
            Ok(_) => {}
            Err(Error::Step { step, source: StepError::Contact { .. }, .. }) => {
                println!("step {step}: {scene:?}");
                tally.unsolved += 1;
                return;
            }
            Err(other) => panic!("{scene:?}: {other}"),
        }
        let state = simulation.state().clone();
        tally.steps += 1;
        tally.most_trials = tally.most_trials.max(state.trials);
        let was = held.iter().filter(|held| **held).count();
        for (e, held) in held.iter_mut().enumerate() {
            // Glue does not heal.
            assert!(*held || !glued(&simulation, e), "{scene:?}");
            *held = glued(&simulation, e);
        }
        let breaks = was - held.iter().filter(|held| **held).count();
        tally.breaking += usize::from(breaks > 0);
        tally.most = tally.most.max(breaks);
        for contact in &state.contact {
            force = force.max(contact.pressure.abs()).max(contact.shear.abs());
            length = length.max(contact.gap.abs()).max(contact.slip.abs());
        }
        let distance = violation(scene, &before, &state, &held, [force, length.max(1e-4)]);
        tally.violation = tally.violation.max(distance);
        let lost = state.energy_balance.contact - before.energy_balance.contact;
        energy = energy.max(state.energy_balance.kinetic).max(state.energy_balance.input.abs());
        // Below a joule the tractions of the weight show their rounding.
        tally.given_back = tally.given_back.max(-lost / energy.max(1.0));
        before = state;
    }
}

/// `CONTACT_SCENES=10000 cargo test --release --test fast ordinary_scenes` shakes more of them.
#[test]
fn ordinary_scenes_are_solved() {
    let scenes = std::env::var("CONTACT_SCENES").ok().and_then(|text| text.parse().ok());
    let scenes = scenes.unwrap_or(120);
    let mut random = Random(20_240);
    let mut tally = Tally::default();
    for _ in 0..scenes {
        shake(&Glued::random(&mut random), 150, &mut tally);
    }
    println!("{tally:?}");
    assert_eq!(tally.unsolved, 0, "{tally:?}");
    assert!(tally.breaking > scenes && tally.most > 5, "{tally:?}");
    assert!(tally.violation < 1e-11 && tally.given_back < 1e-11, "{tally:?}");
}

/// Two scenes in which an active set that lets bonds heal within a step comes back to bonds that it
/// has broken, and neither Gauss–Seidel nor a path ends.
#[test]
fn bonds_that_break_do_not_heal_within_a_step() {
    let mut tally = Tally::default();
    for scene in [
        Glued {
            width: 4.495_040_340_458_662_5,
            height: 7.984_017_714_847_206,
            density: 855.025_909_796_820_5,
            shear_speed: 226.784_291_411_407_17,
            poisson: 0.0,
            elements: 24,
            graded: true,
            time_step: 0.002_254_091_337_715_054_4,
            strengths: [2_548.255_850_864_481, 160_639.858_509_519_9, 0.612_250_507_927_719],
            shaking: [4.736_501_475_317_782, 0.191_312_087_461_415_8, 0.7],
        },
        Glued {
            width: 2.870,
            height: 5.124,
            density: 1149.5,
            shear_speed: 248.55,
            poisson: 0.0,
            elements: 15,
            graded: true,
            time_step: 9.711e-4,
            strengths: [23_471.0, 183_620.0, 1.0],
            shaking: [9.81, 0.2, 0.7],
        },
    ] {
        shake(&scene, 200, &mut tally);
    }
    println!("{tally:?}");
    assert!(tally.unsolved == 0 && tally.violation < 1e-11, "{tally:?}");
}
