//! Convolution histories: response to all past tractions at the end of the next step.
//!
//! A [`ConvolutionWeights`] gives the coefficients of a ground, lag by lag; the histories sum them over all
//! past tractions, exactly ([`DirectHistory`], [`RelaxedFftHistory`]) or within a tolerance
//! ([`ExponentialHistory`]). [`HistoryMethod::Auto`] chooses. Nothing here depends on what the ground is made of.

mod choice;
mod chosen;
mod convolution;
mod direct;
mod exponentials;
mod last_lag;
mod pair_classes;
mod relaxed_fft;

pub(crate) use choice::SavedChoice;
pub use choice::{ChoiceReason, HistoryChoice, HistoryMethod};
pub(crate) use chosen::ChosenHistory;
pub use chosen::HistoryOptions;
pub(crate) use convolution::OTHER_KINDS;
pub use convolution::{ConvolutionHistory, ConvolutionWeights, LateWeights};
pub use direct::DirectHistory;
pub(crate) use direct::RESERVED_STEPS;
pub use exponentials::{ExponentialFit, ExponentialHistory, ExponentialSum, TailProduct};
pub(crate) use pair_classes::KINDS;
pub use pair_classes::{Pair, PairClasses};
pub use relaxed_fft::{RelaxedFftHistory, SharedSpectra};
