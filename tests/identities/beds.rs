//! Grounds that a user writes: a bed in the form of the documents is `SpringGround`, also in what it dissipates; a lossless
//! bed returns its energy; a bed that follows the traction of the step is noticed.

use basemat::bem::{ContactElement, Ground, SpringGround, Strip};
use basemat::coupled::Load;
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::{Record, el_centro_1940};
use basemat::structure::RigidBlock;
use basemat::{Observer, Result, Simulation};
use basemat_problems::random::Random;

use super::tally::{Tally, scenes};

/// How a spring and a dashpot answer to a traction that is constant over a step.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Form {
    /// The example `your_own_ground`: the traction acts in the middle of the step.
    MidStep,
    /// The displacement at the end of the step is that of a spring in series with a body that creeps, exact under the
    /// traction. The spring dissipates at first order.
    EndOfStep,
}

/// Springs (Pa/m) and dashpots (Pa s/m) down and to the right; for [`Form::EndOfStep`] springs alone.
struct Bed {
    elements: Vec<ContactElement>,
    stiffness: [f64; 2],
    dashpot: [f64; 2],
    form: Form,
    time_step: f64,
    displacement: Vec<f64>,
}

impl Bed {
    /// Displacement at the end of the step: `kept · old + gained · traction`.
    fn factors(&self, index: usize) -> [f64; 2] {
        let k = usize::from(index >= self.elements.len());
        let (stiffness, dashpot) = (self.stiffness[k], self.dashpot[k] / self.time_step);
        match self.form {
            Form::MidStep => {
                let half = 0.5 * stiffness;
                [(dashpot - half) / (dashpot + half), 1.0 / (dashpot + half)]
            }
            Form::EndOfStep => [0.0, 1.0 / stiffness],
        }
    }

    fn diagonal(&self, matrix: &mut [f64], value: impl Fn(usize) -> f64) {
        let size = self.displacement.len();
        matrix.fill(0.0);
        (0..size).for_each(|i| matrix[i * (size + 1)] = value(i));
    }
}

impl Ground for Bed {
    fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    fn prepare(&mut self, step: f64, _: Option<usize>, _: &mut Observer<'_>) -> Result<()> {
        self.time_step = step;
        self.displacement.fill(0.0);
        Ok(())
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.diagonal(matrix, |i| self.factors(i)[1]);
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
            let [kept, gained] = self.factors(i);
            self.displacement[i] = kept * self.displacement[i] + gained * traction;
        }
    }

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.diagonal(matrix, |i| 1.0 / self.stiffness[usize::from(i >= self.elements.len())]);
        Ok(())
    }
}

/// A block on a bed.
#[derive(Debug, Clone, Copy)]
struct Scene {
    width: f64,
    height: f64,
    stiffness: [f64; 2],
    dashpot: [f64; 2],
    friction: Option<f64>,
    step: f64,
}

const ELEMENTS: usize = 8;
const STEPS: usize = 300;
/// Steps in which a block swings several times, also in a quarter of them.
const LONG: usize = 2000;

impl Scene {
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
        Strip::uniform(-0.5 * self.width..0.5 * self.width, ELEMENTS).unwrap()
    }

    fn built_in(&self) -> SpringGround {
        let [normal, tangential] = self.stiffness;
        let bed = SpringGround::on_strips(&[self.strip()], normal, tangential).unwrap();
        bed.with_dashpots(self.dashpot[0], self.dashpot[1]).unwrap()
    }

    fn own(&self, form: Form) -> Bed {
        let Self { stiffness, dashpot, .. } = *self;
        let displacement = vec![0.0; 2 * ELEMENTS];
        let elements = self.strip().elements();
        Bed { elements, stiffness, dashpot, form, time_step: 0.0, displacement }
    }

    /// Rotations and energies lost to the soil of all steps, and warnings.
    fn run(&self, ground: impl Ground) -> Result<[Vec<f64>; 2]> {
        let record: Record = el_centro_1940().scaled(0.6)?;
        let block = RigidBlock::new(self.width, self.height, 1200.0)?;
        let builder = Simulation::builder(self.step).ground(ground).structure(block).motion(record);
        let builder = match self.friction {
            Some(friction) => builder.interface(Coulomb::new(friction)?),
            None => builder.interface(Bonded),
        };
        let mut simulation = builder.build()?;
        let [mut rotations, mut energies] = [Vec::new(), Vec::new()];
        for _ in 0..STEPS {
            let state = simulation.step()?;
            rotations.push(state.base_rotation);
            energies.push(state.energy_balance.soil);
        }
        Ok([rotations, energies])
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()))
}

#[test]
fn the_bed_of_the_documents_is_the_built_in_one() {
    let mut tally = Tally::new("own ground: bed of the documents");
    let mut random = Random(101);
    for number in 0..scenes(20, 300) {
        let scene = Scene::draw(&mut random);
        tally.scene(&["springs", "block", "record", "ground of a user"]);
        let own = scene.run(scene.own(Form::MidStep)).unwrap();
        let built_in = scene.run(scene.built_in()).unwrap();
        for (name, k) in [("rotation", 0), ("energy of the soil", 1)] {
            let pairs = own[k].iter().zip(&built_in[k]);
            let apart = pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
            let place = format!("{number}: {name}, {scene:?}");
            tally.within(&place, apart / largest(&built_in[k]), 1e-7);
        }
    }
    tally.close(1.0);
}

/// A block pulled aside and let go on springs without dashpots, bonded: nothing is lost.
#[test]
fn a_lossless_bed_returns_its_energy_or_is_noticed() {
    let mut tally = Tally::new("own ground: lossless bed");
    let mut random = Random(102);
    for number in 0..scenes(20, 300) {
        let scene = Scene { dashpot: [0.0; 2], friction: None, ..Scene::draw(&mut random) };
        for form in [Form::MidStep, Form::EndOfStep] {
            tally.scene(&["springs", "block", "loads", "ground of a user"]);
            let block = RigidBlock::new(scene.width, scene.height, 1200.0).unwrap();
            let roof = block.horizontal_at(scene.height);
            let force = 0.1 * 1200.0 * 9.81 * scene.width * scene.height;
            let mut simulation = Simulation::builder(scene.step)
                .ground(scene.own(form))
                .structure(block)
                .interface(Bonded)
                .load(Load::released(roof, force))
                .build()
                .unwrap();
            let mut rotations = vec![simulation.state().base_rotation];
            let run = simulation.run(LONG, |state| rotations.push(state.base_rotation)).unwrap();
            // The last swing is as large as the first one, up to what the other mode takes.
            let quarter = rotations.len() / 4;
            let kept = largest(&rotations[3 * quarter..]) / largest(&rotations[..quarter]);
            let place = format!("{number}: {form:?}, swings kept {kept:.2}, {scene:?}");
            let is_noticed = run
                .warnings
                .iter()
                .any(|warning| format!("{warning:?}").contains("FirstOrderGround"));
            if form == Form::MidStep {
                tally.within(&place, 1.0 - kept, 0.25);
                if is_noticed {
                    tally.fail(format!("{place}: a warning of a lossless bed"));
                }
            } else if kept < 0.9 && !is_noticed {
                tally.fail(format!("{place}: loses its energy without a warning"));
            }
        }
    }
    tally.close(1.0);
}
