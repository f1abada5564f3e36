//! Sliding of a base in a run: the distance, and its slip events.

use crate::geometry::resultant;
use crate::interface::Mode;

/// A series of steps in which a whole base slid in one direction.
///
/// Some elements are closed, all closed elements slide, and the mean slip does not reverse.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct SlipEvent {
    /// Beginning of the event's first step, s.
    pub start: f64,
    /// End of the event's last step, s.
    pub end: f64,
    /// Change of the mean slip, m; positive to the right.
    pub slip: f64,
    /// In plan: slip along y, m; zero in the plane.
    #[cfg_attr(feature = "serde", serde(default))]
    pub slip_across: f64,
}

impl SlipEvent {
    /// Magnitude of the slip, m.
    pub(crate) fn distance(&self) -> f64 {
        resultant(self.slip, self.slip_across).abs()
    }
}

/// Sliding of one foundation, or of the whole base, by its mean slip.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Sliding {
    /// Sliding distance, m: the sum of the events' |slip|.
    pub path: f64,
    /// Time during which the whole base slid, s.
    pub duration: f64,
    /// Events, in order.
    pub events: Vec<SlipEvent>,
    in_event: bool,
}

impl Sliding {
    /// Sliding before the first step, with memory for `event_count` events.
    pub(crate) fn with_capacity(event_count: usize) -> Self {
        Self { events: Vec::with_capacity(event_count), ..Self::default() }
    }

    /// Records a step from the first to the second of `times`, s.
    ///
    /// `modes`: of the base's elements at the end of the step. `slip`: change of the mean slip along x and y, m.
    pub(crate) fn update(&mut self, modes: &[Mode], slip: [f64; 2], times: [f64; 2]) {
        let is_sliding = modes.iter().any(|mode| mode.is_slip())
            && modes.iter().all(|mode| mode.is_slip() || !mode.is_closed());
        self.advance(is_sliding, slip, times);
    }

    /// Records a step, in which the whole base slides or not.
    ///
    /// `slip` and `times` as for [`Sliding::update`].
    fn advance(&mut self, is_sliding: bool, [slip, slip_across]: [f64; 2], times: [f64; 2]) {
        if is_sliding {
            self.path += resultant(slip, slip_across).abs();
            self.duration += times[1] - times[0];
            match self.events.last_mut() {
                Some(event)
                    if self.in_event
                        && event.slip * slip + event.slip_across * slip_across >= 0.0 =>
                {
                    event.slip += slip;
                    event.slip_across += slip_across;
                    event.end = times[1];
                }
                _ => {
                    self.events.push(SlipEvent {
                        start: times[0],
                        end: times[1],
                        slip,
                        slip_across,
                    });
                }
            }
        }
        self.in_event = is_sliding;
    }

    /// Duration of the longest event, s.
    pub(crate) fn longest_duration(&self) -> f64 {
        self.events.iter().map(|event| event.end - event.start).fold(0.0, f64::max)
    }

    /// The event with the largest |slip|.
    pub(crate) fn largest_event(&self) -> Option<SlipEvent> {
        self.events.iter().copied().max_by(|a, b| a.distance().total_cmp(&b.distance()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn events_end_with_sticking_and_with_turning() {
        let mut sliding = Sliding::default();
        let steps = [
            (false, 0.5),
            (true, 1.0),
            (true, 2.0),
            (true, -4.0),
            (true, -1.0),
            (false, 0.0),
            (true, -3.0),
            (false, 0.1),
        ];
        for (k, (is_sliding, slip)) in steps.into_iter().enumerate() {
            sliding.advance(is_sliding, [slip, 0.0], [k as f64, (k + 1) as f64]);
        }
        let expected_events = [(1.0, 3.0, 3.0), (3.0, 5.0, -5.0), (6.0, 7.0, -3.0)]
            .map(|(start, end, slip)| SlipEvent { start, end, slip, slip_across: 0.0 });
        assert_eq!(sliding.events, expected_events);
        assert_eq!((sliding.path, sliding.duration), (11.0, 5.0));
        assert_eq!(sliding.largest_event(), Some(expected_events[1]));
        assert_eq!(Sliding::default().largest_event(), None);
        // In plan: 3 to the right and 4 away, then back at an angle of more than 90°.
        let mut sliding = Sliding::default();
        for (k, slip) in [[3.0, 4.0], [-4.0, 3.0], [-0.1, -6.0]].into_iter().enumerate() {
            sliding.advance(true, slip, [k as f64, (k + 1) as f64]);
        }
        assert_eq!(sliding.events.len(), 2);
        assert_eq!((sliding.events[0].slip, sliding.events[0].slip_across), (-1.0, 7.0));
        assert_eq!(sliding.path, 10.0 + 0.1_f64.hypot(6.0));
    }
}
