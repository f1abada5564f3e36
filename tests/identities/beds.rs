//! GOAL: grounds that a user writes behave as built-in ones, or give a warning.
//! SCENE: a bed as in the documents, also its dissipation; a bed without loss; a bed that follows the traction of the
//! step.
//! REFERENCE: `SpringGround`; the energy of free vibration.

use basemat::bem::{ContactElement, Ground, SpringGround, Strip};
use basemat::coupled::Load;
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::{Record, el_centro_1940};
use basemat::structure::RigidBlock;
use basemat::{Observer, Result, Simulation};
use basemat_problems::dense::largest;
use basemat_problems::random::Random;

use super::compare::largest_difference;
use super::tally::{IdentityTally, scenes};

/// Response of a spring and a dashpot to a traction that is constant over a step.
#[derive(Debug, Clone, Copy, PartialEq)]
enum BedForm {
    /// The example `your_own_ground`: the traction acts in the middle of the step.
    MidStep,
    /// The displacement at the end of the step is that of a spring in series with a body that creeps, exact under the
    /// traction. The spring dissipates energy of first order in the step.
    EndOfStep,
}

/// Springs (Pa/m) and dashpots (Pa s/m) down and to the right; for [`BedForm::EndOfStep`] springs alone.
struct UserBed {
    elements: Vec<ContactElement>,
    stiffness: [f64; 2],
    dashpot: [f64; 2],
    form: BedForm,
    time_step: f64,
    displacement: Vec<f64>,
}

impl UserBed {
    /// Factors of the displacement at the start of a step, and of its traction, in the displacement at its end.
    fn factors(&self, index: usize) -> [f64; 2] {
        let k = usize::from(index >= self.elements.len());
        let stiffness = self.stiffness[k];
        let dashpot = self.dashpot[k] / self.time_step;
        match self.form {
            BedForm::MidStep => {
                let half = 0.5 * stiffness;
                [(dashpot - half) / (dashpot + half), 1.0 / (dashpot + half)]
            }
            BedForm::EndOfStep => [0.0, 1.0 / stiffness],
        }
    }

    fn fill_diagonal(&self, matrix: &mut [f64], value: impl Fn(usize) -> f64) {
        let size = self.displacement.len();
        matrix.fill(0.0);
        for i in 0..size {
            matrix[i * (size + 1)] = value(i);
        }
    }
}

impl Ground for UserBed {
    fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    fn prepare(&mut self, step: f64, _: Option<usize>, _: &mut Observer<'_>) -> Result<()> {
        self.time_step = step;
        self.displacement.fill(0.0);
        Ok(())
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.fill_diagonal(matrix, |i| self.factors(i)[1]);
        Ok(())
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        for (i, out) in displacement.iter_mut().enumerate() {
            *out = self.factors(i)[0] * self.displacement[i];
        }
        Ok(())
    }

    fn commit(&mut self, traction: &[f64]) {
        for (i, traction) in traction.iter().enumerate() {
            let factors = self.factors(i);
            self.displacement[i] = factors[0] * self.displacement[i] + factors[1] * traction;
        }
    }

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.fill_diagonal(matrix, |i| 1.0 / self.stiffness[usize::from(i >= self.elements.len())]);
        Ok(())
    }
}

/// A block on a bed.
#[derive(Debug, Clone, Copy)]
struct BedScene {
    width: f64,
    height: f64,
    stiffness: [f64; 2],
    dashpot: [f64; 2],
    friction: Option<f64>,
    step: f64,
}

const BED_ELEMENTS: usize = 8;
const RUN_STEPS: usize = 300;
/// Steps in which a block swings several times; also a quarter of them contains several swings.
const FREE_VIBRATION_STEPS: usize = 2000;

impl BedScene {
    fn draw(random: &mut Random) -> Self {
        let stiffness = random.log_within(2e7, 2e8);
        let dashpot = if random.chance(0.5) { random.log_within(1e4, 1e6) } else { 0.0 };
        Self {
            width: random.within(3.0, 8.0),
            height: random.within(2.0, 12.0),
            stiffness: [stiffness, 0.6 * stiffness],
            dashpot: [dashpot, 0.7 * dashpot],
            friction: random.chance(0.7).then(|| random.within(0.2, 0.8)),
            step: random.pick(&[0.002, 0.005, 0.01]),
        }
    }

    fn strip(&self) -> Strip {
        Strip::uniform(-0.5 * self.width..0.5 * self.width, BED_ELEMENTS).unwrap()
    }

    fn built_in(&self) -> SpringGround {
        let bed =
            SpringGround::on_strips(&[self.strip()], self.stiffness[0], self.stiffness[1]).unwrap();
        bed.with_dashpots(self.dashpot[0], self.dashpot[1]).unwrap()
    }

    fn user_bed(&self, form: BedForm) -> UserBed {
        let Self { stiffness, dashpot, .. } = *self;
        let displacement = vec![0.0; 2 * BED_ELEMENTS];
        let elements = self.strip().elements();
        UserBed { elements, stiffness, dashpot, form, time_step: 0.0, displacement }
    }

    /// Rotations, and energies lost to the soil, of all steps.
    fn run(&self, ground: impl Ground) -> Result<[Vec<f64>; 2]> {
        let record: Record = el_centro_1940().scaled(0.6)?;
        let block = RigidBlock::new(self.width, self.height, 1200.0)?;
        let builder = Simulation::builder(self.step).ground(ground).structure(block).motion(record);
        let builder = match self.friction {
            Some(friction) => builder.interface(Coulomb::new(friction)?),
            None => builder.interface(Bonded),
        };
        let mut simulation = builder.build()?;
        let mut rotations = Vec::new();
        let mut energies = Vec::new();
        for _ in 0..RUN_STEPS {
            let state = simulation.step()?;
            rotations.push(state.base_rotation);
            energies.push(state.energy_balance.soil);
        }
        Ok([rotations, energies])
    }
}

/// GOAL: the bed of the documents is the built-in bed, in rotations and in dissipated energy.
#[test]
fn the_bed_of_the_documents_is_the_built_in_one() {
    let mut tally = IdentityTally::new("user's ground: bed of the documents");
    let mut random = Random(101);
    for number in 0..scenes(20, 300) {
        let scene = BedScene::draw(&mut random);
        tally.scene(&["springs", "block", "record", "ground of a user"]);
        let computed = scene.run(scene.user_bed(BedForm::MidStep)).unwrap();
        let expected = scene.run(scene.built_in()).unwrap();
        for (name, k) in [("rotation", 0), ("energy of the soil", 1)] {
            let place = format!("{number}: {name}, {scene:?}");
            let difference = largest_difference(&computed[k], &expected[k]);
            tally.within(&place, difference / largest(&expected[k]), 1e-7);
        }
    }
    tally.close(1.0);
}

/// GOAL: a bonded block released on springs without dashpots loses no energy, or there is a warning.
#[test]
fn a_lossless_bed_returns_its_energy_or_is_noticed() {
    let mut tally = IdentityTally::new("user's ground: lossless bed");
    let mut random = Random(102);
    for number in 0..scenes(20, 300) {
        let scene = BedScene { dashpot: [0.0; 2], friction: None, ..BedScene::draw(&mut random) };
        for form in [BedForm::MidStep, BedForm::EndOfStep] {
            tally.scene(&["springs", "block", "loads", "ground of a user"]);
            let block = RigidBlock::new(scene.width, scene.height, 1200.0).unwrap();
            let roof = block.horizontal_at(scene.height);
            let force = 0.1 * 1200.0 * 9.81 * scene.width * scene.height;
            let mut simulation = Simulation::builder(scene.step)
                .ground(scene.user_bed(form))
                .structure(block)
                .interface(Bonded)
                .load(Load::released(roof, force))
                .build()
                .unwrap();
            let mut rotations = vec![simulation.state().base_rotation];
            let run = simulation
                .run(FREE_VIBRATION_STEPS, |state| rotations.push(state.base_rotation))
                .unwrap();
            // The last swing is as large as the first one, up to the beat with the other mode.
            let quarter = rotations.len() / 4;
            let ratio = largest(&rotations[3 * quarter..]) / largest(&rotations[..quarter]);
            let place = format!("{number}: {form:?}, ratio of swings {ratio:.2}, {scene:?}");
            let has_warning = run
                .warnings
                .iter()
                .any(|warning| format!("{warning:?}").contains("FirstOrderGround"));
            if form == BedForm::MidStep {
                tally.within(&place, 1.0 - ratio, 0.25);
                if has_warning {
                    tally.fail(format!("{place}: a warning of a lossless bed"));
                }
            } else if ratio < 0.9 && !has_warning {
                tally.fail(format!("{place}: loses its energy without a warning"));
            }
        }
    }
    tally.close(1.0);
}
