//! Cases of a sweep.

use std::any::Any;

/// Why a case of a [`Sweep`](crate::Sweep) has no result.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CaseError<E> {
    /// It failed with an error of its own.
    #[error("{0}")]
    Failed(E),
    /// It panicked.
    #[error("the case panicked: {message}")]
    Panicked {
        /// Message of the panic; empty if that is no text.
        message: String,
    },
}

impl<E> CaseError<E> {
    /// A panic, by what it was raised with.
    pub(crate) fn panicked(payload: &(dyn Any + Send)) -> Self {
        let text = payload.downcast_ref::<&str>().map(|text| (*text).to_owned());
        let message = text.or_else(|| payload.downcast_ref().cloned()).unwrap_or_default();
        Self::Panicked { message }
    }
}
