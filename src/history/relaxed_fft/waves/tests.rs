//! Compares the convolution over cells in plan by transforms, by the direct sum, and by a sum
//! written here.

use std::sync::Arc;

use basemat_testkit::random::Random;

use super::*;
use crate::error::Error;
use crate::geometry::{Lattice as Plan, SERIES, offset};
use crate::history::{ConvolutionHistory, DirectHistory, PairClasses, RelaxedFftHistory};

/// Random coefficients that decay, with the zeros that symmetry requires.
struct Made {
    classes: PairClasses,
    lattice: Plan,
}

impl Made {
    fn new(lattice: &Plan, cells: Vec<[usize; 2]>) -> Arc<Self> {
        let classes = PairClasses::in_plan(lattice.clone(), cells, [0.0; 2]).unwrap();
        Arc::new(Self { classes, lattice: lattice.clone() })
    }

    fn lag(&self, class: usize, lag: usize) -> [f64; SERIES] {
        let mut random = Random((class * 100_003 + lag) as u64);
        let [i, j] = self.lattice.classes()[class].map(|n| if n == 0 { 0.0 } else { 1.0 });
        let zeros = [1.0, 1.0, 1.0, i * j, i, j];
        zeros.map(|zero| zero * random.within(-1.0, 1.0) / lag as f64)
    }
}

impl ConvolutionWeights for Made {
    fn classes(&self) -> &PairClasses {
        &self.classes
    }

    fn coefficients(&self, _: usize, _: usize, _: [&mut [f64]; 3]) -> Result<()> {
        Err(Error::Scene { quantity: "kernel", needed: "one in plan" })
    }

    fn coefficients_in_plan(
        &self,
        class: usize,
        first_lag: usize,
        mut values: [&mut [f64]; SERIES],
    ) -> Result<()> {
        for place in 0..values[0].len() {
            let lag = self.lag(class, first_lag + place);
            values.iter_mut().zip(lag).for_each(|(values, value)| values[place] = value);
        }
        Ok(())
    }
}

fn cells(mask: &str) -> (Vec<[usize; 2]>, [usize; 2]) {
    let rows: Vec<Vec<char>> = mask.lines().map(|line| line.chars().collect()).collect();
    let counts = [rows[0].len(), rows.len()];
    let all = (0..counts[0] * counts[1]).map(|n| [n % counts[0], n / counts[0]]);
    (all.filter(|[i, j]| rows[*j][*i] == '#').collect(), counts)
}

const MASKS: [&str; 6] = [
    "####\n####\n####\n####",
    "#####\n#####",
    "##...\n##...\n#####",
    "#",
    "######",
    "#.#\n...\n#.#\n##.\n.##",
];

/// Transforms with and without cells missing, square and oblong, over blocks of four sizes.
#[test]
fn transforms_are_the_direct_sum() {
    for mask in MASKS {
        for pitch in [[0.5; 2], [0.5, 0.8]] {
            let (cells, counts) = cells(mask);
            let lattice = Plan { pitch, counts };
            let size = 3 * cells.len();
            let kernel = Made::new(&lattice, cells.clone());
            let mut direct = DirectHistory::new(kernel.clone());
            let mut fast = RelaxedFftHistory::new(kernel.clone());
            let [mut wanted, mut found] = [vec![0.0; size], vec![0.0; size]];
            let mut random = Random(3);
            let mut past: Vec<Vec<f64>> = vec![];
            let mut worst = [0.0_f64; 2];
            for step in 0..300 {
                direct.evaluate(&mut wanted).unwrap();
                fast.evaluate(&mut found).unwrap();
                let largest = wanted.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
                for (found, wanted) in found.iter().zip(&wanted) {
                    worst[0] = worst[0].max((found - wanted).abs() / largest);
                }
                if step == 20 {
                    let own = summed(&kernel, &cells, &past);
                    for (own, wanted) in own.iter().zip(&wanted) {
                        worst[1] = worst[1].max((own - wanted).abs() / largest);
                    }
                }
                let traction: Vec<f64> = (0..size).map(|_| random.within(-1.0, 1.0)).collect();
                direct.push(&traction);
                fast.push(&traction);
                past.push(traction);
            }
            println!("{counts:?} {pitch:?} {worst:?}");
            assert!(worst[0].max(worst[1]) < 1e-13, "{mask} {worst:?}");
        }
    }
}

/// Σ G τ, block by block.
fn summed(kernel: &Made, cells: &[[usize; 2]], past: &[Vec<f64>]) -> Vec<f64> {
    let count = cells.len();
    let mut sums = vec![0.0; 3 * count];
    let area = kernel.lattice.pitch.iter().product::<f64>();
    for (ago, traction) in past.iter().rev().enumerate() {
        let classes = 0..kernel.lattice.classes().len();
        let lag: Vec<_> = classes.map(|class| kernel.lag(class, ago + 2)).collect();
        for (p, receiver) in cells.iter().enumerate() {
            for (q, source) in cells.iter().enumerate() {
                let block = kernel.lattice.block(&lag, offset(*receiver, *source));
                for (to, row) in block.iter().enumerate() {
                    for (from, value) in row.iter().enumerate() {
                        sums[to * count + p] += value * traction[from * count + q] / area;
                    }
                }
            }
        }
    }
    sums
}

/// Saved and restored anywhere, with the same bits.
#[test]
fn histories_go_on_where_they_were() {
    let (cells, counts) = cells(MASKS[2]);
    let size = 3 * cells.len();
    let kernel = Made::new(&Plan { pitch: [0.5; 2], counts }, cells);
    let all = |stop: Option<usize>| {
        let mut history = RelaxedFftHistory::new(kernel.clone());
        let mut random = Random(5);
        let mut values = vec![0.0; size];
        for step in 0..300 {
            if stop == Some(step) {
                let saved = history.save().unwrap();
                history = RelaxedFftHistory::new(kernel.clone());
                history.restore(step, &saved).unwrap();
            }
            history.evaluate(&mut values).unwrap();
            history.push(&(0..size).map(|_| random.within(-1.0, 1.0)).collect::<Vec<_>>());
        }
        values.into_iter().map(f64::to_bits).collect::<Vec<_>>()
    };
    let whole = all(None);
    assert!([1, 31, 32, 63, 128, 257].into_iter().all(|stop| all(Some(stop)) == whole));
}
