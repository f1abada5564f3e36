//! GOAL: a convolution history of a user works as one of the crate.
//! SCENE: the plain sum in a half-plane ground under a block.
//! REFERENCE: the histories of the crate.

use std::sync::Arc;

use basemat::bem::{ElasticGround, PatchKernel, Strip};
use basemat::history::{ConvolutionHistory, ConvolutionWeights, DirectHistory};
use basemat::interface::Coulomb;
use basemat::{Observer, Result, Simulation};

use super::scene::{assert_same_motion, push, soil};
use basemat_problems::block_on_springs::block;

/// The convolution as a plain sum over pairs of elements and past steps.
struct PlainSum {
    kernel: Arc<dyn ConvolutionWeights>,
    /// Tractions of all past steps.
    past_tractions: Vec<Vec<f64>>,
}

impl PlainSum {
    fn new(kernel: Arc<dyn ConvolutionWeights>) -> Self {
        Self { kernel, past_tractions: Vec::new() }
    }

    /// Weights zz, xx and zx of each class for the lags from 2 on.
    fn late_weights(&self) -> Result<Vec<[Vec<f64>; 3]>> {
        let step_count = self.past_tractions.len();
        let mut weights = Vec::new();
        for class in 0..self.kernel.classes().count() {
            let mut lists = [vec![0.0; step_count], vec![0.0; step_count], vec![0.0; step_count]];
            if step_count > 0 {
                let mut values = lists.each_mut().map(Vec::as_mut_slice);
                self.kernel.coefficients(class, 2, &mut values)?;
            }
            weights.push(lists);
        }
        Ok(weights)
    }
}

impl ConvolutionHistory for PlainSum {
    fn steps(&self) -> usize {
        self.past_tractions.len()
    }

    fn prepare(&mut self, steps: usize, _: &mut Observer<'_>) -> Result<()> {
        self.past_tractions.reserve(steps.saturating_sub(self.past_tractions.len()));
        Ok(())
    }

    fn evaluate(&mut self, displacement: &mut [f64]) -> Result<()> {
        displacement.fill(0.0);
        let count = self.kernel.classes().elements().len();
        let weights = self.late_weights()?;
        for (step, traction) in self.past_tractions.iter().enumerate() {
            let lag = self.past_tractions.len() - 1 - step;
            for (p, pairs) in self.kernel.classes().pairs().chunks(count).enumerate() {
                for (q, pair) in pairs.iter().enumerate() {
                    let weight = [0, 1, 2].map(|k| pair.scale * weights[pair.class][k][lag]);
                    let coupling = pair.sign * weight[2];
                    displacement[p] += weight[0] * traction[q] + coupling * traction[count + q];
                    displacement[count + p] +=
                        weight[1] * traction[count + q] - coupling * traction[q];
                }
            }
        }
        Ok(())
    }

    fn push(&mut self, traction: &[f64]) {
        assert_eq!(traction.len(), 2 * self.kernel.classes().elements().len());
        self.past_tractions.push(traction.to_vec());
    }
}

fn half_plane() -> ElasticGround {
    ElasticGround::new(soil(), Strip::uniform(-2.0..2.0, 4).unwrap()).unwrap()
}

/// Motion of a block on this ground after 120 steps.
fn block_on(ground: ElasticGround) -> Simulation {
    let mut simulation = Simulation::builder(1e-2)
        .motion(push())
        .gravity(9.81)
        .ground(ground)
        .structure(block())
        .interface(Coulomb::new(0.4).unwrap())
        .build()
        .unwrap();
    simulation.run(120, |_| {}).unwrap();
    simulation
}

#[test]
fn a_history_of_a_user_moves_as_the_one_of_the_crate() {
    let by_plain_sum = half_plane()
        .with_own_history(|kernel| Box::new(PlainSum::new(kernel)) as Box<dyn ConvolutionHistory>);
    assert_same_motion(&block_on(by_plain_sum), &block_on(half_plane()), 1e-6);
}

#[test]
fn histories_agree_with_the_direct_sum() {
    let elements = Strip::uniform(0.0..3.0, 3).unwrap().elements();
    let kernel: Arc<dyn ConvolutionWeights> =
        Arc::new(PatchKernel::new(soil(), elements, 2e-3).unwrap());
    let mut plain_history = PlainSum::new(Arc::clone(&kernel));
    let mut direct_history = DirectHistory::new(kernel);
    let mut expected = [f64::NAN; 6];
    let mut computed = [f64::NAN; 6];
    for step in 0..40 {
        plain_history.evaluate(&mut expected).unwrap();
        direct_history.evaluate(&mut computed).unwrap();
        let max_magnitude = expected.iter().fold(0.0_f64, |max, value| max.max(value.abs()));
        for (a, b) in expected.iter().zip(&computed) {
            assert!((a - b).abs() <= 1e-12 * max_magnitude, "{expected:?} {computed:?}");
        }
        let traction: [f64; 6] = std::array::from_fn(|i| (1.7 * (i + 7 * step) as f64).sin());
        plain_history.push(&traction);
        direct_history.push(&traction);
        assert_eq!(plain_history.steps(), direct_history.steps());
    }
}
