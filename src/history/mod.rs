//! Convolution histories: response to all past tractions at the end of the next step.
//!
//! A [`ConvolutionWeights`] provides the coefficients of a ground, lag by lag. A history sums them over all past
//! tractions, exactly ([`DirectHistory`], [`RelaxedFftHistory`]) or within a tolerance ([`ExponentialHistory`]).
//! [`HistoryOptions`] contain the rule that chooses the method. Nothing in this module depends on the soil.

mod chosen;
mod convolution;
mod convolution_weights;
mod direct;
mod exponential_sum;
mod exponentials;
mod last_lag;
mod options;
mod pair_classes;
mod relaxed_fft;
mod shared_spectra;

pub(crate) use chosen::ChosenHistory;
pub use chosen::{HistoryChoice, HistoryMethod};
pub use convolution::ConvolutionHistory;
pub use convolution_weights::{ConvolutionWeights, LateWeights, by_kind};
pub use direct::DirectHistory;
pub use exponential_sum::{ExponentialSum, TailProduct};
pub use exponentials::{ExponentialFit, ExponentialHistory};
pub use options::HistoryOptions;
pub(crate) use pair_classes::STRIP_KINDS;
pub use pair_classes::{Pair, PairClasses};
pub use relaxed_fft::RelaxedFftHistory;
pub use shared_spectra::SharedSpectra;
