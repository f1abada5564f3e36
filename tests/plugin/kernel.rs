//! GOAL: exact histories of a user's convolution weights are the direct sum.
//! SCENE: weights that fade with distance and lag, computed singly and in blocks; the crate's half-plane.
//! REFERENCE: the direct history; the same weights in one request.

use std::sync::{Arc, Mutex};

use basemat::bem::{ContactElement, Grading, PatchKernel, Strip};
use basemat::history::{
    ConvolutionHistory, ConvolutionWeights, DirectHistory, PairClasses, RelaxedFftHistory,
    SharedSpectra, by_kind,
};
use basemat::{Observer, Result, unobserved};

use super::scene::soil;

/// Weights that fade with distance and lag; reciprocal, not passive.
#[derive(Clone)]
struct FadingWeights {
    classes: PairClasses,
    last_coupling_lag: Option<usize>,
    spectra: Option<SharedSpectra>,
}

impl FadingWeights {
    fn new(elements: Vec<ContactElement>, last_coupling_lag: Option<usize>) -> Self {
        let classes = PairClasses::new(elements).unwrap();
        Self { classes, last_coupling_lag, spectra: None }
    }

    fn weights_at(&self, class: usize, lag: usize) -> [f64; 3] {
        let [source, receiver] = self.classes.representative(class).unwrap();
        let distance = receiver.center()[0] - source.center()[0];
        let weight = source.length() * receiver.length() / (1.0 + distance * distance);
        let decayed_weights =
            [0.004, 0.01, 0.003].map(|rate: f64| weight * (-rate * lag as f64).exp());
        let is_uncoupled = self.last_coupling_lag.is_some_and(|last| lag > last);
        let coupling = if is_uncoupled { 0.0 } else { distance * decayed_weights[2] };
        [decayed_weights[0], 0.7 * decayed_weights[1], coupling]
    }
}

impl ConvolutionWeights for FadingWeights {
    fn classes(&self) -> &PairClasses {
        &self.classes
    }

    fn coefficients(
        &self,
        class: usize,
        first_lag: usize,
        values: &mut [&mut [f64]],
    ) -> Result<()> {
        let [normal, tangential, coupling] = by_kind(values)?;
        for i in 0..normal.len() {
            [normal[i], tangential[i], coupling[i]] = self.weights_at(class, first_lag + i);
        }
        Ok(())
    }

    fn last_coupling_lag(&self, _class: usize) -> Result<Option<usize>> {
        Ok(self.last_coupling_lag)
    }

    fn spectra(&self) -> Option<&SharedSpectra> {
        self.spectra.as_ref()
    }
}

/// Fading weights that are computed in blocks of the lags 1, 2, 3 to 4, 5 to 8, … when they are prepared.
struct BlockwiseWeights {
    kernel: FadingWeights,
    /// Weights by class of all lags computed so far.
    computed: Mutex<Vec<Vec<[f64; 3]>>>,
}

impl BlockwiseWeights {
    fn new(kernel: FadingWeights) -> Self {
        let computed = Mutex::new(vec![Vec::new(); kernel.classes.count()]);
        Self { kernel, computed }
    }
}

impl ConvolutionWeights for BlockwiseWeights {
    fn classes(&self) -> &PairClasses {
        &self.kernel.classes
    }

    fn prepare(&self, lags: usize, _: &mut Observer<'_>) -> Result<()> {
        for (class, weights) in self.computed.lock().unwrap().iter_mut().enumerate() {
            for lag in weights.len() + 1..=lags.next_power_of_two() {
                weights.push(self.kernel.weights_at(class, lag));
            }
        }
        Ok(())
    }

    fn coefficients(
        &self,
        class: usize,
        first_lag: usize,
        values: &mut [&mut [f64]],
    ) -> Result<()> {
        let [normal, tangential, coupling] = by_kind(values)?;
        self.prepare(first_lag - 1 + normal.len(), &mut unobserved)?;
        let weights = &self.computed.lock().unwrap()[class];
        for (i, values) in weights[first_lag - 1..][..normal.len()].iter().enumerate() {
            [normal[i], tangential[i], coupling[i]] = *values;
        }
        Ok(())
    }
}

fn traction(step: usize, size: usize) -> Vec<f64> {
    (0..size)
        .map(|i| (1e4 * (1.7 + (3 * step + 7 * i) as f64).sin()).sin() + 0.3)
        .collect()
}

/// Displacements of all steps by a history.
///
/// `preparations`: pairs of a step and of the number of lags that are prepared before it.
fn displacements(
    mut history: impl ConvolutionHistory,
    steps: usize,
    preparations: &[(usize, usize)],
) -> Vec<f64> {
    let mut displacements = Vec::new();
    let mut displacement = vec![f64::NAN; 20];
    for step in 0..steps {
        for (_, lags) in
            preparations.iter().filter(|(preparation_step, _)| *preparation_step == step)
        {
            history.prepare(*lags, &mut unobserved).unwrap();
        }
        displacement.fill(f64::NAN);
        history.evaluate(&mut displacement).unwrap();
        displacements.extend_from_slice(&displacement);
        history.push(&traction(step, 20));
    }
    displacements
}

pub(super) fn ten_elements(grading: Grading) -> Vec<ContactElement> {
    Strip::new(-5.0..5.0, 10, grading).unwrap().elements()
}

const STEP_COUNT: usize = 1100;

fn by_transforms(
    weights: Arc<dyn ConvolutionWeights>,
    preparations: &[(usize, usize)],
) -> Vec<f64> {
    displacements(RelaxedFftHistory::new(weights), STEP_COUNT, preparations)
}

fn by_direct_sum(weights: Arc<dyn ConvolutionWeights>) -> Vec<f64> {
    displacements(DirectHistory::new(weights), STEP_COUNT, &[])
}

/// GOAL: every exact history of a user's weights is the same sum.
/// SCENE: equal elements (wavenumbers) and graded ones (pairs); a coupling that ends at once, soon, late, never; spectra
/// shared or not; weights that are computed in blocks.
#[test]
fn exact_histories_of_a_user_s_weights_agree() {
    for grading in [Grading::Uniform, Grading::Cosine] {
        for last_coupling_lag in [Some(0), Some(40), Some(300), None] {
            let label = format!("{grading:?} {last_coupling_lag:?}");
            let weights = FadingWeights::new(ten_elements(grading), last_coupling_lag);
            let direct_sum = by_direct_sum(Arc::new(weights.clone()));
            let max_magnitude = direct_sum.iter().fold(0.0_f64, |max, value| max.max(value.abs()));
            let transforms = by_transforms(Arc::new(weights.clone()), &[]);
            for (a, b) in transforms.iter().zip(&direct_sum) {
                assert!((a - b).abs() < 1e-13 * max_magnitude, "{label}: {a} {b}");
            }
            // Neither hints nor shared spectra nor the computation of the weights changes a bit.
            let spectra = Some(SharedSpectra::default());
            let with_spectra = Arc::new(FadingWeights { spectra, ..weights.clone() });
            for preparations in [&[(0, STEP_COUNT)][..], &[(0, 33), (50, 340)], &[(64, 1000)]] {
                let repeated_displacements = by_transforms(with_spectra.clone(), preparations);
                assert_eq!(repeated_displacements, transforms, "{label} {preparations:?}");
            }
            if last_coupling_lag.is_none() {
                let blockwise = Arc::new(BlockwiseWeights::new(weights));
                assert_eq!(by_direct_sum(blockwise.clone()), direct_sum, "{label}");
                assert_eq!(by_transforms(blockwise, &[]), transforms, "{label}");
            }
        }
    }
}

/// Spectra that were stored for other elements by mistake are not used.
#[test]
fn spectra_of_other_elements_are_not_used() {
    let spectra = Some(SharedSpectra::default());
    let other_elements = Strip::uniform(0.0..1.0, 3).unwrap().elements();
    let other_weights = FadingWeights::new(other_elements, None);
    let other_weights = FadingWeights { spectra: spectra.clone(), ..other_weights };
    RelaxedFftHistory::new(Arc::new(other_weights))
        .prepare(200, &mut unobserved)
        .unwrap();
    for grading in [Grading::Uniform, Grading::Cosine] {
        let weights = FadingWeights::new(ten_elements(grading), Some(90));
        let with_spectra = FadingWeights { spectra: spectra.clone(), ..weights.clone() };
        let expected = displacements(RelaxedFftHistory::new(Arc::new(weights)), 200, &[]);
        let history = RelaxedFftHistory::new(Arc::new(with_spectra));
        assert_eq!(displacements(history, 200, &[]), expected);
    }
}

/// Weights zz, xx and zx of consecutive lags.
fn consecutive_weights(
    kernel: &dyn ConvolutionWeights,
    class: usize,
    first_lag: usize,
    count: usize,
) -> [Vec<f64>; 3] {
    let mut lists = [vec![f64::NAN; count], vec![f64::NAN; count], vec![f64::NAN; count]];
    let mut values = lists.each_mut().map(Vec::as_mut_slice);
    kernel.coefficients(class, first_lag, &mut values).unwrap();
    lists
}

/// Weights do not depend on the order or size of requests.
#[test]
fn weights_do_not_depend_on_the_requests() {
    const LAG_COUNT: usize = 700;
    let patch = PatchKernel::new(soil(), ten_elements(Grading::Cosine), 2e-3).unwrap();
    let fading = FadingWeights::new(ten_elements(Grading::Cosine), None);
    let blockwise = BlockwiseWeights::new(fading);
    for kernel in [&patch as &dyn ConvolutionWeights, &blockwise] {
        for class in [0, 1, kernel.classes().count() - 1] {
            // The last lags are requested first, before anything is prepared.
            let requests = [(400, 301), (1, 1), (2, 62), (64, 1), (65, 335)];
            let in_parts = requests
                .map(|(first_lag, count)| consecutive_weights(kernel, class, first_lag, count));
            kernel.prepare(LAG_COUNT, &mut unobserved).unwrap();
            let all_lags = consecutive_weights(kernel, class, 1, LAG_COUNT);
            for ((first_lag, count), lists) in requests.into_iter().zip(&in_parts) {
                for (part, all) in lists.iter().zip(&all_lags) {
                    assert_eq!(part[..], all[first_lag - 1..][..count], "from {first_lag}");
                }
            }
        }
    }
}
