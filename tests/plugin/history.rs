//! GOAL: a convolution history of one's own.
//! SCENE: the plain sum in a half-plane ground under a block.
//! REFERENCE: the histories of the crate.

use std::sync::Arc;

use basemat::bem::{ElasticGround, PatchKernel, Strip};
use basemat::coupled::SimulationBuilder;
use basemat::history::{ConvolutionHistory, ConvolutionWeights, DirectHistory};
use basemat::interface::Coulomb;
use basemat::{Observer, Result, Simulation};

use super::scene::{assert_same_motion, push, soil};
use basemat_problems::block_on_springs::block;

/// The convolution as a triple loop over the kernel's classes, with its own store.
struct Plain {
    kernel: Arc<dyn ConvolutionWeights>,
    past: Vec<Vec<f64>>,
}

impl ConvolutionHistory for Plain {
    fn steps(&self) -> usize {
        self.past.len()
    }

    fn prepare(&mut self, steps: usize, _: &mut Observer<'_>) -> Result<()> {
        self.past.reserve(steps.saturating_sub(self.past.len()));
        Ok(())
    }

    fn evaluate(&mut self, displacement: &mut [f64]) -> Result<()> {
        displacement.fill(0.0);
        let (count, past) = (self.kernel.classes().elements().len(), self.past.len());
        let mut lags = Vec::new();
        for class in 0..self.kernel.classes().count() {
            let [mut zz, mut xx, mut zx] = [(); 3].map(|()| vec![0.0; past]);
            if past > 0 {
                self.kernel.coefficients(class, 2, &mut [&mut zz, &mut xx, &mut zx])?;
            }
            lags.push([zz, xx, zx]);
        }
        for (m, traction) in self.past.iter().enumerate() {
            let lag = past - 1 - m;
            for (p, pairs) in self.kernel.classes().pairs().chunks(count).enumerate() {
                for (q, pair) in pairs.iter().enumerate() {
                    let [zz, xx, zx] = [0, 1, 2].map(|k| pair.scale * lags[pair.class][k][lag]);
                    displacement[p] += zz * traction[q] + pair.sign * zx * traction[count + q];
                    displacement[count + p] +=
                        xx * traction[count + q] - pair.sign * zx * traction[q];
                }
            }
        }
        Ok(())
    }

    fn push(&mut self, traction: &[f64]) {
        assert_eq!(traction.len(), 2 * self.kernel.classes().elements().len());
        self.past.push(traction.to_vec());
    }
}

#[test]
fn own_history() {
    let inner = || ElasticGround::new(soil(), Strip::uniform(-2.0..2.0, 4).unwrap()).unwrap();
    let march = |scene: SimulationBuilder| {
        let law = Coulomb::new(0.4).unwrap();
        let mut simulation = scene.structure(block()).interface(law).build().unwrap();
        simulation.run(120, |_| {}).unwrap();
        simulation
    };
    let scene = || Simulation::builder(1e-2).motion(push()).gravity(9.81);
    let plain =
        |kernel| Box::new(Plain { kernel, past: Vec::new() }) as Box<dyn ConvolutionHistory>;
    let own = march(scene().ground(inner().with_own_history(plain)));
    let crate_history = march(scene().ground(inner()));
    assert_same_motion(&own, &crate_history, 1e-6);
}

#[test]
fn histories_agree_with_the_direct_sum() {
    let elements = Strip::uniform(0.0..3.0, 3).unwrap().elements();
    let kernel: Arc<dyn ConvolutionWeights> =
        Arc::new(PatchKernel::new(soil(), elements, 2e-3).unwrap());
    let mut plain = Plain { kernel: Arc::clone(&kernel), past: Vec::new() };
    let mut direct = DirectHistory::new(kernel);
    let (mut a, mut b) = ([f64::NAN; 6], [f64::NAN; 6]);
    for step in 0..40 {
        plain.evaluate(&mut a).unwrap();
        direct.evaluate(&mut b).unwrap();
        let largest = a.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        assert!(a.iter().zip(&b).all(|(x, y)| (x - y).abs() <= 1e-12 * largest), "{a:?} {b:?}");
        let traction: [f64; 6] = std::array::from_fn(|i| (1.7 * (i + 7 * step) as f64).sin());
        plain.push(&traction);
        direct.push(&traction);
        assert_eq!(plain.steps(), direct.steps());
    }
}
