//! Accuracy of exponentials behind a window, and whether both together can create energy.
//!
//! Over any run the work of tractions is Σ τ·L Δs, s = Ĝ τ. By Parseval it is never negative if
//! H(ω) = Re[(1−ζ) L Ĝ(ζ)], ζ = e^(iω), has no negative eigenvalue at any ω; L Gⁿ is symmetric by
//! reciprocity, so H is the Hermitian part. Near ω = 0 all motions but a translation radiate like
//! ω², so eigenvalues are divided by (1−cos ω) times the diagonal of L G¹, the coefficient of an
//! immediate displacement. The window is a finite sum, and each pole a geometric series, so no sum
//! is truncated.

use super::tail::{Measured, Tail};
use crate::error::{Error, Observer, Result, unobserved};
use crate::history::convolution::ConvolutionWeights;
use crate::history::pair_classes::{KINDS, PairClasses};
use crate::history::shared_spectra::SharedSpectra;

/// Frequencies per decade below one radian per step.
const PER_DECADE: f64 = 8.0;
/// Equally spaced frequencies up to π.
const EVEN: usize = 48;
/// Lowest frequency, relative to the frequency of the horizon.
const LOWEST: f64 = 0.1;
/// Order of H above which only a third of the frequencies are tried.
const LARGE: usize = 100;

/// Smallest eigenvalue, and its frequency in radians per step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Margin {
    pub(super) least: f64,
    pub(super) frequency: f64,
}

/// Smallest eigenvalue of H/(1−cos ω), scaled by the diagonal of L G¹, over all frequencies tried.
pub(super) fn margin(
    kernel: &dyn ConvolutionWeights,
    lags: &Lags,
    tail: &Tail,
    horizon: f64,
) -> Margin {
    let order = kernel.classes().layout().len();
    let thin = if order > LARGE { 3.0 } else { 1.0 };
    let mut frequencies = Vec::new();
    let mut omega = LOWEST / horizon;
    while omega < 1.0 {
        frequencies.push(omega);
        omega *= 10.0_f64.powf(thin / PER_DECADE);
    }
    let mut even = 1.0;
    while even <= EVEN as f64 {
        frequencies.push(std::f64::consts::PI * even / EVEN as f64);
        even += thin;
    }
    let mut found = Margin { least: f64::INFINITY, frequency: 0.0 };
    for frequency in frequencies {
        let least = least_at(kernel, lags, tail, frequency);
        // NaN must not pass.
        if least.is_nan() || least < found.least {
            found = Margin { least, frequency };
        }
        if least.is_nan() {
            break;
        }
    }
    found
}

/// Smallest eigenvalue at one frequency.
fn least_at(kernel: &dyn ConvolutionWeights, lags: &Lags, tail: &Tail, omega: f64) -> f64 {
    let classes = kernel.classes();
    let window = lags.length();
    // Re (1−ζ) ζ^d = cos dω − cos (d+1)ω over 1 − cos ω = 2 sin² ω/2.
    let half = 0.5 * omega;
    let steps: Vec<f64> =
        (0..window).map(|d| ((d as f64 + 0.5) * omega).sin() / half.sin()).collect();
    let sum = |lags: &[f64]| lags.iter().zip(&steps).map(|(g, c)| g * c).sum::<f64>();
    let square = 2.0 * half.sin() * half.sin();
    let tails = tail.at_frequency(window as f64, omega);
    let sums: Vec<[f64; KINDS]> = (0..classes.count())
        .map(|class| lags.kinds.each_ref().map(|kind| sum(&kind[class])))
        .collect();
    let at_once = |class: usize, component: usize| lags.kinds[component][class][0];
    classes.least_eigenvalue(at_once, |[receiver, source], pair| {
        let mut values = sums[pair.class];
        for (value, tail_sums) in values.iter_mut().zip(&tails) {
            *value += tail.of_pair(tail_sums, receiver, source) / square;
        }
        values
    })
}

// Error of the exponentials against the exact coefficients, over the whole horizon.

/// Lags checked per octave: about two per period of the trapezoidal rule's error, which oscillates
/// with ln t, at phases that do not repeat.
const PER_OCTAVE: f64 = 7.3;
/// Number of pair classes checked; of more classes, an even sample. The error is a polynomial in
/// space.
const CLASSES: usize = 150;

/// Errors at one lag, their change to the next lag, and the largest coefficient.
struct Sample {
    error: f64,
    change: f64,
    relative: f64,
    largest: f64,
}

impl Measured {
    /// Measures the errors over the lags from `window` + 1 to `horizon`.
    pub(super) fn over(
        kernel: &dyn ConvolutionWeights,
        tail: &Tail,
        window: usize,
        horizon: usize,
    ) -> Result<Self> {
        let pairs = SampledPairs::new(kernel);
        let sample = |lag: usize| pairs.at(kernel, tail, lag, window);
        let mut lag = window + 1;
        let mut before = sample(lag)?;
        let mut found =
            Self { relative: before.relative, increments: before.error, last: before.largest };
        while lag < horizon {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a lag")]
            let next = (lag as f64 * (1.0 / PER_OCTAVE).exp2()).ceil() as usize;
            let next = next.clamp(lag + 1, horizon.max(lag + 1));
            let now = sample(next)?;
            found.increments += before.change.max(now.change) * (next - lag) as f64;
            found.relative = found.relative.max(now.relative);
            found.last = now.largest;
            (lag, before) = (next, now);
        }
        Ok(found)
    }
}

/// Pairs of elements on which errors are measured: places in the list of pairs, at most one for each class.
struct SampledPairs(Vec<usize>);

impl SampledPairs {
    fn new(kernel: &dyn ConvolutionWeights) -> Self {
        let mut first_pair = vec![None; kernel.classes().count()];
        for (place, pair) in kernel.classes().pairs().iter().enumerate() {
            first_pair[pair.class].get_or_insert(place);
        }
        let stride = kernel.classes().count().div_ceil(CLASSES);
        let places = first_pair.iter().flatten().copied().enumerate();
        let places =
            places.filter(|(k, _)| k % stride == 0 || k + 1 == first_pair.len()).map(|(_, at)| at);
        Self(places.collect())
    }

    /// Errors of the exponentials at a lag beyond the window.
    fn at(
        &self,
        kernel: &dyn ConvolutionWeights,
        tail: &Tail,
        lag: usize,
        window: usize,
    ) -> Result<Sample> {
        let count = kernel.classes().elements().len();
        let age = (lag - window - 1) as f64;
        let fits = [tail.at_age(age), tail.at_age(age + 1.0)];
        let mut sample = Sample { error: 0.0, change: 0.0, relative: 0.0, largest: 0.0 };
        let mut worst = [[0.0_f64; 2]; 2];
        for &place in &self.0 {
            let pair = kernel.classes().pairs()[place];
            let (p, q) = (place / count, place % count);
            let [mut zz, mut xx, mut zx] = [[0.0; 2]; KINDS];
            kernel.coefficients(pair.class, lag, [&mut zz, &mut xx, &mut zx])?;
            for (part, exact) in [zz, xx].iter().enumerate() {
                let error =
                    [0, 1].map(|k| pair.scale * (tail.of_pair(&fits[k][part], p, q) - exact[k]));
                let [worst_error, largest] = &mut worst[part];
                *worst_error = worst_error.max(error[0].abs());
                *largest = largest.max((pair.scale * exact[0]).abs());
                sample.change = sample.change.max((error[1] - error[0]).abs());
            }
        }
        for [error, largest] in worst {
            sample.error = sample.error.max(error);
            sample.largest = sample.largest.max(largest);
            sample.relative = sample.relative.max(error / largest);
        }
        Ok(sample)
    }
}

// The window: the exact lags.

const COUPLING_LASTS: Error =
    Error::NoExponentials { needed: "a coupling that ends before the exponentials begin" };

/// A kernel whose coefficients are zero after its window.
pub(super) struct Cut<'a> {
    pub(super) kernel: &'a dyn ConvolutionWeights,
    /// Last lag with coefficients.
    pub(super) lags: usize,
    pub(super) spectra: &'a SharedSpectra,
}

impl ConvolutionWeights for Cut<'_> {
    fn classes(&self) -> &PairClasses {
        self.kernel.classes()
    }

    fn prepare(&self, lags: usize, observer: &mut Observer<'_>) -> Result<()> {
        self.kernel.prepare(lags.min(self.lags), observer)
    }

    fn coefficients(
        &self,
        class: usize,
        first_lag: usize,
        values: [&mut [f64]; KINDS],
    ) -> Result<()> {
        let left = (self.lags + 1).saturating_sub(first_lag).min(values[0].len());
        let kept = values.map(|values| {
            let (kept, cut) = values.split_at_mut(left);
            cut.fill(0.0);
            kept
        });
        self.kernel.coefficients(class, first_lag, kept)
    }

    fn last_coupling_lag(&self, class: usize) -> Result<Option<usize>> {
        self.kernel.last_coupling_lag(class)
    }

    fn spectra(&self) -> Option<&SharedSpectra> {
        Some(self.spectra)
    }
}

/// Coefficients of lags 1 to W.
///
/// Lag 1 does not belong to the history; the check for passivity needs it.
#[derive(Debug, Clone)]
pub(super) struct Lags {
    /// Coefficients of each kind, class by class; the coupling only while it is not zero.
    pub(super) kinds: [Vec<Vec<f64>>; KINDS],
}

impl Lags {
    /// Reads lags 1 to `window` of `kernel`.
    pub(super) fn new(kernel: &dyn ConvolutionWeights, window: usize) -> Result<Self> {
        kernel.prepare(window, &mut unobserved)?;
        let mut kinds = [(); KINDS].map(|()| Vec::with_capacity(kernel.classes().count()));
        for class in 0..kernel.classes().count() {
            let mut lags = [(); KINDS].map(|()| vec![0.0; window]);
            kernel.coefficients(class, 1, lags.each_mut().map(Vec::as_mut_slice))?;
            let last = kernel.last_coupling_lag(class)?.filter(|last| *last <= window);
            let [_, _, zx] = &mut lags;
            zx.truncate(last.ok_or(COUPLING_LASTS)?);
            zx.shrink_to_fit();
            kinds.iter_mut().zip(lags).for_each(|(kind, lags)| kind.push(lags));
        }
        Ok(Self { kinds })
    }

    /// The last lag, W.
    pub(super) fn length(&self) -> usize {
        self.kinds[0].first().map_or(0, Vec::len)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tail::Tail;
    use super::*;
    use crate::bem::{PatchKernel, Strip};
    use crate::history::ExponentialSum;
    use crate::history::LateWeights;
    use crate::soil::Soil;

    fn patch() -> PatchKernel {
        let soil = Soil::new(1.0, 0.3, 1.0).unwrap();
        PatchKernel::new(soil, Strip::uniform(-1.0..1.0, 4).unwrap().elements(), 0.2).unwrap()
    }

    /// The correct tail times `factor`.
    fn tail(kernel: &PatchKernel, window: usize, factor: f64) -> Tail {
        let tail = kernel.exponentials(window, 1_000_000, 1e-9).unwrap();
        let mut products = tail.products.clone();
        for weight in products.iter_mut().flat_map(|p| p.normal.iter_mut().chain(&mut p.tangential))
        {
            *weight *= factor;
        }
        let (rates, functions) = (tail.rates, tail.functions);
        let tail = ExponentialSum::new(rates, functions, products).unwrap();
        Tail::new(tail, kernel.classes().elements()).unwrap()
    }

    #[test]
    fn a_tail_that_does_not_fit_the_window_is_found_out() {
        let kernel = patch();
        let window = 48;
        let lags = Lags::new(&kernel, window).unwrap();
        let least = |factor| margin(&kernel, &lags, &tail(&kernel, window, factor), 1e6).least;
        println!("{} {} {}", least(1.0), least(3.0), least(-1.0));
        assert!(least(1.0) > 1e-3);
        assert!(least(3.0) < 0.0);
        assert!(least(-1.0) < 0.0);
    }

    /// The closed form in ζ against the sum over the ages, by parts so that it converges.
    #[test]
    fn closed_form_is_the_sum() {
        let kernel = patch();
        let window = 48;
        let tail = tail(&kernel, window, 1.0);
        let ages: Vec<_> = (0..20_000).map(|age| tail.at_age(f64::from(age))).collect();
        for omega in [0.02, 0.3, 3.0] {
            let closed = tail.at_frequency(window as f64, omega);
            for (part, closed) in closed.iter().enumerate() {
                for (place, closed) in closed.iter().enumerate() {
                    let value = |age: usize| ages[age][part][place];
                    let mut sum = value(0) * (window as f64 * omega).cos();
                    for age in 1..ages.len() {
                        let angle = (window + age) as f64 * omega;
                        sum += (value(age) - value(age - 1)) * angle.cos();
                    }
                    let scale = ages[0][part][0].abs();
                    assert!((sum - closed).abs() < 1e-5 * scale, "{omega}: {sum} {closed}");
                }
            }
        }
    }
}
