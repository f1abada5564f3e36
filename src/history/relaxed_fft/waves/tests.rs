//! Compares three convolutions over cells in plan: by transforms, by the direct sum, and by a sum written here.

use std::sync::Arc;

use basemat_testkit::random::Random;

use super::*;
use crate::geometry::{COMPLIANCES_PER_OFFSET, Lattice as PlanLattice, offset};
use crate::history::{ConvolutionHistory, DirectHistory, PairClasses, RelaxedFftHistory};

/// Random coefficients that decay, with the zeros that symmetry requires.
struct RandomWeights {
    classes: PairClasses,
    lattice: PlanLattice,
}

impl RandomWeights {
    fn new(lattice: &PlanLattice, cells: Vec<[usize; 2]>) -> Arc<Self> {
        let classes = PairClasses::in_plan(lattice.clone(), cells, [0.0; 2]).unwrap();
        Arc::new(Self { classes, lattice: lattice.clone() })
    }

    fn lag(&self, class: usize, lag: usize) -> [f64; COMPLIANCES_PER_OFFSET] {
        let mut random = Random((class * 100_003 + lag) as u64);
        // Factors that are zero where symmetry requires it.
        let [x_factor, y_factor] =
            self.lattice.classes()[class].map(|n| if n == 0 { 0.0 } else { 1.0 });
        let factors = [1.0, 1.0, 1.0, x_factor * y_factor, x_factor, y_factor];
        factors.map(|factor| factor * random.within(-1.0, 1.0) / lag as f64)
    }
}

impl ConvolutionWeights for RandomWeights {
    fn classes(&self) -> &PairClasses {
        &self.classes
    }

    fn coefficients(
        &self,
        class: usize,
        first_lag: usize,
        values: &mut [&mut [f64]],
    ) -> Result<()> {
        for lag_index in 0..values[0].len() {
            let lag = self.lag(class, first_lag + lag_index);
            values.iter_mut().zip(lag).for_each(|(values, value)| values[lag_index] = value);
        }
        Ok(())
    }
}

/// Cells that are `#` in a picture of a lattice.
struct Mask {
    cells: Vec<[usize; 2]>,
    counts: [usize; 2],
}

impl Mask {
    fn new(picture: &str) -> Self {
        let rows: Vec<Vec<char>> = picture.lines().map(|line| line.chars().collect()).collect();
        let counts = [rows[0].len(), rows.len()];
        let places = (0..counts[0] * counts[1]).map(|n| [n % counts[0], n / counts[0]]);
        Self { cells: places.filter(|[i, j]| rows[*j][*i] == '#').collect(), counts }
    }
}

const CELL_MASKS: [&str; 6] = [
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
    for mask in CELL_MASKS {
        for pitch in [[0.5; 2], [0.5, 0.8]] {
            let Mask { cells, counts } = Mask::new(mask);
            let lattice = PlanLattice { pitch, counts };
            let size = 3 * cells.len();
            let kernel = RandomWeights::new(&lattice, cells.clone());
            let mut direct_history = DirectHistory::new(kernel.clone());
            let mut fft_history = RelaxedFftHistory::new(kernel.clone());
            let mut expected = vec![0.0; size];
            let mut computed = vec![0.0; size];
            let mut random = Random(3);
            let mut past_tractions: Vec<Vec<f64>> = vec![];
            let mut max_errors = [0.0_f64; 2];
            for step in 0..300 {
                direct_history.evaluate(&mut expected).unwrap();
                fft_history.evaluate(&mut computed).unwrap();
                let scale = expected.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
                for (computed, expected) in computed.iter().zip(&expected) {
                    max_errors[0] = max_errors[0].max((computed - expected).abs() / scale);
                }
                if step == 20 {
                    let reference = summed(&kernel, &cells, &past_tractions);
                    for (reference, expected) in reference.iter().zip(&expected) {
                        max_errors[1] = max_errors[1].max((reference - expected).abs() / scale);
                    }
                }
                let traction: Vec<f64> = (0..size).map(|_| random.within(-1.0, 1.0)).collect();
                direct_history.push(&traction);
                fft_history.push(&traction);
                past_tractions.push(traction);
            }
            println!("{counts:?} {pitch:?} {max_errors:?}");
            assert!(max_errors[0].max(max_errors[1]) < 1e-13, "{mask} {max_errors:?}");
        }
    }
}

/// Σ G τ, block by block.
fn summed(kernel: &RandomWeights, cells: &[[usize; 2]], past_tractions: &[Vec<f64>]) -> Vec<f64> {
    let count = cells.len();
    let mut sums = vec![0.0; 3 * count];
    let area = kernel.lattice.pitch.iter().product::<f64>();
    for (ago, traction) in past_tractions.iter().rev().enumerate() {
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

/// A history that is saved and restored at any step continues with the same bits.
#[test]
fn histories_resume_where_they_were_saved() {
    let Mask { cells, counts } = Mask::new(CELL_MASKS[2]);
    let size = 3 * cells.len();
    let kernel = RandomWeights::new(&PlanLattice { pitch: [0.5; 2], counts }, cells);
    let result_with_stop = |stop: Option<usize>| {
        let mut history = RelaxedFftHistory::new(kernel.clone());
        let mut random = Random(5);
        let mut values = vec![0.0; size];
        for step in 0..300 {
            if stop == Some(step) {
                let saved_state = history.save().unwrap();
                history = RelaxedFftHistory::new(kernel.clone());
                history.restore(step, &saved_state).unwrap();
            }
            history.evaluate(&mut values).unwrap();
            history.push(&(0..size).map(|_| random.within(-1.0, 1.0)).collect::<Vec<_>>());
        }
        values.into_iter().map(f64::to_bits).collect::<Vec<_>>()
    };
    let without_stop = result_with_stop(None);
    for stop in [1, 31, 32, 63, 128, 257] {
        assert_eq!(result_with_stop(Some(stop)), without_stop, "stop at {stop}");
    }
}
