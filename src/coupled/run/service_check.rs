//! Serviceability of a run: each limit beside the largest response.

use crate::coupled::State;
use crate::coupled::run::peak::Peak;
use crate::coupled::serviceability::{Criterion, Serviceability};
use crate::text::readable_number::{PrintedUnit, number, printed_unit};
use std::fmt;

/// A criterion of [`Serviceability`] after a run.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct ServiceCheck {
    /// The limited response.
    pub criterion: Criterion,
    /// Limit, in the criterion's unit.
    pub limit: f64,
    /// The response of largest magnitude in the run, with its sign.
    pub largest: Peak,
    /// End of the first step beyond the limit, s; `None` if there was none.
    pub first_excess: Option<f64>,
}

impl ServiceCheck {
    /// Checks, one per limit, at the initial state of a run.
    pub(crate) fn all(limits: &Serviceability, state: &State) -> Vec<Self> {
        let limits_by_criterion = [
            (Criterion::Slip, limits.slip),
            (Criterion::Gap, limits.gap),
            (Criterion::UpliftedFraction, limits.uplifted_fraction),
            (Criterion::Rotation, limits.rotation),
            (Criterion::Settlement, limits.settlement),
        ];
        let mut checks = Vec::new();
        for (criterion, limit) in limits_by_criterion {
            if let Some(limit) = limit {
                checks.push(Self::start(criterion, limit, state));
            }
        }
        checks
    }

    fn start(criterion: Criterion, limit: f64, state: &State) -> Self {
        let largest = Peak { value: 0.0, time: state.time };
        let mut check = Self { criterion, limit, largest, first_excess: None };
        check.update(state);
        check
    }

    /// Records the response of a state.
    pub(crate) fn update(&mut self, state: &State) {
        self.update_value(self.criterion.largest_value(state), state.time);
    }

    fn update_value(&mut self, value: f64, time: f64) {
        self.largest.update(value, time);
        if self.first_excess.is_none() && value.abs() > self.limit {
            self.first_excess = Some(time);
        }
    }

    /// Whether the response stayed within its limit, or reached it exactly.
    pub fn is_met(&self) -> bool {
        self.first_excess.is_none()
    }

    /// 1 − |largest|/limit: the unused fraction of the limit; negative if it is exceeded.
    pub fn margin(&self) -> f64 {
        1.0 - self.largest.magnitude() / self.limit
    }
}

/// Writes one line: value, limit, verdict, margin and the time of the first excess.
impl fmt::Display for ServiceCheck {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let PrintedUnit { factor, symbol } = match self.criterion {
            Criterion::UpliftedFraction => PrintedUnit { factor: 100.0, symbol: "%" },
            criterion => printed_unit(criterion.unit()),
        };
        write!(
            f,
            "{}: {} {symbol} at {:.3} s, {} {symbol} allowed, ",
            self.criterion.name(),
            number(factor * self.largest.magnitude()),
            self.largest.time,
            number(factor * self.limit)
        )?;
        match self.first_excess {
            None => write!(f, "met, margin {:.1} %", 100.0 * self.margin()),
            Some(time) => {
                let margin = 100.0 * self.margin();
                write!(f, "exceeded from {time:.3} s, margin {margin:.1} %")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_excess_and_margin_by_hand() {
        let no_peak = Peak::default();
        let mut check = ServiceCheck {
            criterion: Criterion::Slip,
            limit: 2.0,
            largest: no_peak,
            first_excess: None,
        };
        for (k, value) in [0.5, -2.0, -3.0, 2.5, -5.0, 1.0].into_iter().enumerate() {
            assert_eq!(check.is_met(), k <= 2, "{k}");
            check.update_value(value, k as f64);
        }
        assert_eq!(check.first_excess, Some(2.0));
        assert_eq!(check.largest, Peak { value: -5.0, time: 4.0 });
        assert_eq!(check.margin(), -1.5);
    }
}
