//! Kinds of histories: the choice for a ground, its reason and its cost.

use std::fmt;

use super::convolution::{ConvolutionWeights, LateWeights};
use super::relaxed_fft::{LEAF, RelaxedFftHistory, waves_in_plan};
use crate::error::{CheckpointError, Result};
use crate::geometry::SERIES;

/// Convolution history of a ground: the method by which it sums the effect of all past tractions.
///
/// Q elements, N steps, C classes of pairs (Q on a uniform strip, about Q²/4 on a graded one), W
/// the lags before the exponentials (on the half-plane, the power of two at or above the steps in
/// which the Rayleigh wave crosses the patch three times), M the power of two at or above N; for a coupling that ends
/// after few lags, as on the half-plane:
///
/// | | result | multiply–adds per step | bytes |
/// |---|---|---|---|
/// | direct | exact to rounding | Q² N on average | 16 (C + Q) N |
/// | relaxed transforms, pairs of elements | exact to rounding | 64 Q² + log₂(N/64) (16 Q² + 5 Q log₂ N) | (32 C + 24 Q + 16) M |
/// | relaxed transforms, wavenumbers | exact to rounding | 128 Q + log₂(N/32) (8 Q + 5 Q log₂ 2N) | (64 Q + 32) M |
/// | exponentials | within a tolerance | as the transforms, with W for N, and about 3000 | as the transforms, with W for M, and 32 Q W |
///
/// Wavenumbers take the place of pairs from eight equal elements on. A processor makes 4 to 7 of
/// these multiply–adds in a nanosecond: the estimates distinguish factors of two, not less.
///
/// See [`RelaxedFftHistory`](super::RelaxedFftHistory) and
/// [`ExponentialHistory`](super::ExponentialHistory) for more.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum HistoryMethod {
    /// The sum as it is, [`DirectHistory`](super::DirectHistory): for checks.
    Direct,
    /// Transforms of blocks, [`RelaxedFftHistory`](super::RelaxedFftHistory).
    RelaxedFft,
    /// A window of exact lags and a sum of exponentials,
    /// [`ExponentialHistory`](super::ExponentialHistory): memory that does not grow, small
    /// checkpoints. The kernel has to know its [late lags](super::ConvolutionWeights::late_weights).
    Exponentials,
    /// Choice of one of the above, when the number of steps is known or the first step is made:
    ///
    /// 1. the exponentials, if they are estimated to take less time over the run than the
    ///    transforms, their making included: with the tolerance of [`HistoryOptions`](super::HistoryOptions),
    ///    or with 1e-12, which is rounding, if the number of steps is known; memory does not count
    ///    then;
    /// 2. the relaxed transforms, if they fit into the memory that a history may take
    ///    (that of [`HistoryOptions`](super::HistoryOptions)), or if the number of steps is not known, as
    ///    long as they do;
    /// 3. otherwise the exponentials, with their own tolerance; or the transforms all the same,
    ///    where exponentials are not possible.
    ///
    /// Runs that go on beyond the steps known keep an exact history only up to the memory allowed, and
    /// then the exponentials (3.), which take over all that was before.
    ///
    /// The choice is made once: from the steps that a simulation was asked to
    /// [expect](crate::coupled::SimulationBuilder::expected_steps), or else from those of the first
    /// run. Runs that follow keep it. Both give the same bits however a run is cut, but they differ
    /// from each other by their errors: say what to expect, and the choice is the same for every cut.
    #[default]
    Auto,
}

words! { pub(crate) HistoryMethod, "history", {
    Direct = "direct",
    RelaxedFft = "relaxed_fft",
    Exponentials = "exponentials",
    Auto = "auto",
} }

/// Why a history was chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum ChoiceReason {
    /// The options name it.
    Asked,
    /// The method is exact and fits into the memory allowed.
    Exact,
    /// The method is exact, and the number of steps is not known.
    UnknownLength,
    /// The tolerance allowed makes it the cheapest.
    ToleranceAllowed,
    /// The method takes least time, and its coefficients err by rounding: 1e-12 at most.
    Rounding,
    /// An exact history would take more memory than is allowed.
    MemoryLimit,
    /// An exact history takes more memory than is allowed, but exponentials are not possible, or would take more still.
    NoExponentials,
    /// In plan: an exact history of all lags takes more memory than is allowed, but fits without the lags beyond the last
    /// that counts.
    WithoutLateLags,
}

impl fmt::Display for ChoiceReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Asked => "as asked",
            Self::Exact => "exact, and within the memory allowed",
            Self::UnknownLength => "exact, and the number of steps is not known",
            Self::ToleranceAllowed => "cheapest within the tolerance allowed",
            Self::Rounding => "cheapest, with an error at rounding",
            Self::MemoryLimit => "an exact history would need more memory than allowed",
            Self::NoExponentials => {
                "more memory than allowed, but exponentials cannot be had or take more"
            }
            Self::WithoutLateLags => {
                "within the memory allowed without the lags beyond the last that counts"
            }
        })
    }
}

/// The history that a ground keeps.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct HistoryChoice {
    /// The method chosen; never [`HistoryMethod::Auto`].
    pub kind: HistoryMethod,
    /// Reason of the choice.
    pub reason: ChoiceReason,
    /// Steps that were expected; `None` if nothing was known.
    pub steps: Option<usize>,
    /// Bytes that it is estimated to take by then.
    pub estimated_memory: usize,
    /// Multiply–adds per step, averaged over the run.
    pub estimated_cost: f64,
    /// Relative error of its coefficients, measured; zero if it is exact.
    pub error_bound: f64,
    /// Runge–Kutta stages of the convolution quadrature that its coefficients come from; `None` for
    /// closed forms.
    pub stages: Option<usize>,
}

/// A choice as a checkpoint has it: with the same options, the same is chosen again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct SavedChoice {
    /// [`HistoryMethod::Auto`] where none was made, or the history is one of the user's own.
    pub(crate) kind: HistoryMethod,
    pub(crate) steps: Option<usize>,
}

impl SavedChoice {
    /// Kinds by their number in a checkpoint.
    const KINDS: [HistoryMethod; 4] = [
        HistoryMethod::Auto,
        HistoryMethod::Direct,
        HistoryMethod::RelaxedFft,
        HistoryMethod::Exponentials,
    ];

    pub(crate) fn new(choice: Option<HistoryChoice>) -> Self {
        let (kind, steps) = choice.map_or((HistoryMethod::Auto, None), |c| (c.kind, c.steps));
        Self { kind, steps }
    }

    /// Number of the kind, and steps that were expected or −1.
    pub(crate) fn numbers(self) -> [f64; 2] {
        let kind = Self::KINDS.iter().take_while(|kind| **kind != self.kind).count();
        [kind as f64, self.steps.map_or(-1.0, |steps| steps as f64)]
    }

    /// Choice from the first of `values`, and the values behind it.
    pub(crate) fn read(values: &[f64]) -> Result<(Self, &[f64])> {
        let corrupt = CheckpointError::Corrupt { quantity: "choice of the history" };
        let [kind, steps, rest @ ..] = values else { return Err(corrupt.into()) };
        let kind = (0_u8..).zip(Self::KINDS).find(|(number, _)| f64::from(*number) == *kind);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked")]
        let steps = match *steps {
            -1.0 => Some(None),
            n if n >= 0.0 && n <= usize::MAX as f64 && n.fract() == 0.0 => Some(Some(n as usize)),
            _ => None,
        };
        match (kind, steps) {
            (Some((_, kind)), Some(steps)) => Ok((Self { kind, steps }, rest)),
            _ => Err(corrupt.into()),
        }
    }
}

impl fmt::Display for HistoryChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = match self.kind {
            HistoryMethod::Direct => "direct sum",
            HistoryMethod::RelaxedFft => "relaxed transforms",
            HistoryMethod::Exponentials => "exponentials",
            HistoryMethod::Auto => "not chosen yet",
        };
        write!(f, "history: {name} ({}); ", self.reason)?;
        match self.steps {
            Some(steps) => write!(f, "{steps} steps, ")?,
            None => write!(f, "unknown number of steps, ")?,
        }
        write!(
            f,
            "about {:.1} MB and {:.1e} multiply–adds per step",
            self.estimated_memory as f64 / 1e6,
            self.estimated_cost
        )?;
        if let Some(stages) = self.stages {
            write!(f, ", coefficients by Radau IIA of {stages} stages")?;
        }
        if self.error_bound > 0.0 {
            write!(f, ", coefficients within {:.1e}", self.error_bound)?;
        }
        Ok(())
    }
}

// Cost model of the histories: the table of [`HistoryMethod`].

/// Longest window of exponentials: the step is so short that all of a run may lie in it.
pub(super) const LONGEST_WINDOW: usize = 1_000_000;

/// Memory in bytes, and multiply–adds.
#[derive(Clone, Copy)]
pub(super) struct Estimate {
    pub(super) memory: usize,
    /// Cost of a step.
    pub(super) cost: f64,
    /// Cost before the first step.
    pub(super) making: f64,
}

/// Multiply–adds that a coefficient of one class takes, its transforms included. Measured, as are
/// those for the exponentials: 10 elements, 54 000 lags, 60 ms; exponentials 12 ms with 10 elements
/// and 250 ms with 100.
const COEFFICIENT: f64 = 500.0;
/// Exponentials, and the search for passivity per cubed number of elements.
const EXPONENTIALS: f64 = 5.0e7;
const PASSIVITY: f64 = 1200.0;
/// Multiply–adds per step for the exponentials behind the window.
const TAIL: f64 = 3000.0;

impl Estimate {
    /// Memory and cost of a history over `steps` steps; infinite for exponentials that the kernel does not have.
    pub(super) fn new(
        kind: HistoryMethod,
        kernel: &dyn ConvolutionWeights,
        steps: usize,
    ) -> Result<Self> {
        let classes = kernel.classes();
        let (q, classes) = (classes.elements().len() as f64, classes.count() as f64);
        // A coupling that does not end is a third series of coefficients, and twice the products.
        let lasts = if couples_without_end(kernel)? { 1.0 } else { 0.0 };
        match kind {
            HistoryMethod::Direct => {
                let n = steps as f64;
                let memory = (16.0 * (classes + q) + 8.0 * lasts * classes) * n;
                let making = COEFFICIENT * classes * n;
                Ok(Self::of(q * q * n * (1.0 + lasts), memory, making))
            }
            HistoryMethod::RelaxedFft | HistoryMethod::Auto => {
                Ok(Self::transforms(kernel, steps, lasts))
            }
            HistoryMethod::Exponentials => {
                let late = kernel.late_weights().map(LateWeights::window);
                let Some(late) = late.filter(|late| *late <= LONGEST_WINDOW && lasts == 0.0) else {
                    return Ok(Self::of(f64::INFINITY, f64::INFINITY, f64::INFINITY));
                };
                let window = late.next_power_of_two().max(LEAF);
                let block = Self::transforms(kernel, window, lasts);
                let memory = block.memory as f64 + 32.0 * q * window as f64;
                let making = block.making + EXPONENTIALS + PASSIVITY * q.powi(3);
                Ok(Self::of(block.cost + TAIL, memory, making))
            }
        }
    }

    /// Bytes of a window of this number of lags with the inputs in it, and of the lags themselves while the
    /// exponentials behind it are made.
    pub(super) fn window(kernel: &dyn ConvolutionWeights, lags: usize) -> Result<f64> {
        let classes = kernel.classes();
        let (q, classes) = (classes.elements().len() as f64, classes.count() as f64);
        let lasts = if couples_without_end(kernel)? { 1.0 } else { 0.0 };
        let block = Self::transforms(kernel, lags, lasts).memory as f64;
        Ok(block + (32.0 * q + 16.0 * classes) * lags as f64)
    }

    /// Estimate for blocks up to this many steps.
    fn transforms(kernel: &dyn ConvolutionWeights, steps: usize, lasts: f64) -> Self {
        let length = (steps as f64).max(64.0).log2().ceil().exp2();
        if let Some((lattice, _)) = kernel.classes().plan() {
            let [all, own] = waves_in_plan(lattice).map(|count| count as f64);
            let levels = (length / LEAF as f64).log2();
            let series = (SERIES * kernel.classes().count()) as f64;
            // Nine products a wavenumber, of real and imaginary parts; transforms of six rows.
            return Self::of(
                all * (288.0 + levels * (72.0 + 30.0 * length.log2())),
                (96.0 * own + 48.0 * all) * length + 48.0 * LEAF as f64 * (own + 2.0 * all),
                COEFFICIENT * series * length,
            );
        }
        let classes = kernel.classes();
        let (q, classes) = (classes.elements().len() as f64, classes.count() as f64);
        let making = COEFFICIENT * classes * length;
        if RelaxedFftHistory::takes_wavenumbers(kernel) {
            let levels = (length / 32.0).log2();
            // Transforms of all lengths from 64 to M.
            let transforms = 5.0 * q * (2.0 * length).log2();
            Self::of(
                128.0 * q + levels * (8.0 * q * (1.0 + lasts) + transforms),
                (64.0 * q + 32.0 + 16.0 * lasts * q) * length,
                making,
            )
        } else {
            let levels = (length / 64.0).log2();
            let products = 16.0 * q * q * (1.0 + lasts);
            Self::of(
                64.0 * q * q + levels * (products + 5.0 * q * length.log2()),
                ((32.0 + 16.0 * lasts) * classes + 24.0 * q + 16.0) * length,
                making,
            )
        }
    }

    fn of(cost: f64, memory: f64, making: f64) -> Self {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let memory = memory as usize;
        Self { memory, cost, making }
    }

    /// Multiply–adds of a run of `steps`.
    pub(super) fn of_run(&self, steps: usize) -> f64 {
        self.making + self.cost * steps as f64
    }
}

/// Whether the coupling of the pair farthest apart never ends.
fn couples_without_end(kernel: &dyn ConvolutionWeights) -> Result<bool> {
    let classes = kernel.classes();
    let farthest = classes.pairs().get(classes.elements().len() - 1);
    // In plan the last class is that of the largest offset.
    let class = farthest.map_or(classes.count() - 1, |pair| pair.class);
    Ok(kernel.last_coupling_lag(class)?.is_none())
}
