//! States of elements in pictures.

use crate::interface::{ContactState, Mode};
use crate::results::ContactFrame;
use plotters::style::RGBColor;

/// State of an element in a picture; where several share a column, the larger is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Shown {
    Stick,
    Open,
    /// Touching without pressure: with infinite friction this is the meaning of slip, the state between stick
    /// and open.
    Weightless,
    SlipLeft,
    SlipRight,
    /// Slip in any direction, in plan.
    Slip,
}

impl Shown {
    pub(super) const ALL: [Self; 6] =
        [Self::Stick, Self::SlipLeft, Self::SlipRight, Self::Slip, Self::Open, Self::Weightless];

    /// State from mode and tractions of an element; `scale` is the largest pressure of the base.
    pub(super) fn new(mode: Mode, state: &ContactState, scale: f64) -> Self {
        match mode.elastic() {
            Mode::Open => Self::Open,
            _ if state.pressure.abs() <= 1e-9 * scale => Self::Weightless,
            Mode::SlipLeft => Self::SlipLeft,
            Mode::SlipRight => Self::SlipRight,
            Mode::Slip => Self::Slip,
            _ => Self::Stick,
        }
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Stick => "stick",
            Self::SlipLeft => "slip to the left",
            Self::SlipRight => "slip to the right",
            Self::Slip => "slip",
            Self::Open => "open",
            Self::Weightless => "touching without pressure",
        }
    }

    pub(super) fn color(self) -> RGBColor {
        match self {
            Self::Stick => RGBColor(214, 222, 228),
            Self::SlipLeft => RGBColor(255, 166, 43),
            Self::SlipRight | Self::Slip => RGBColor(214, 39, 40),
            Self::Open => RGBColor(22, 72, 120),
            Self::Weightless => RGBColor(118, 172, 214),
        }
    }
}

/// State of every element in every frame, and the states in the key.
///
/// The key always has the modes of the plane or of plan, and touching without pressure only where it occurs.
pub(super) fn shown(frames: &[ContactFrame<'_>], in_plan: bool) -> (Vec<Vec<Shown>>, Vec<Shown>) {
    let pressures = frames.iter().flat_map(|frame| frame.states).map(|state| state.pressure.abs());
    let scale = pressures.fold(0.0, f64::max);
    let of_frame = |frame: &ContactFrame<'_>| -> Vec<Shown> {
        let both = frame.modes.iter().zip(frame.states);
        both.map(|(mode, state)| Shown::new(*mode, state, scale)).collect()
    };
    let all: Vec<Vec<Shown>> = frames.iter().map(of_frame).collect();
    let occurs = |what: Shown| all.iter().flatten().any(|shown| *shown == what);
    let has = |what: &Shown| match what {
        Shown::Weightless => occurs(*what),
        Shown::Slip => in_plan,
        Shown::SlipLeft | Shown::SlipRight => !in_plan,
        Shown::Stick | Shown::Open => true,
    };
    let key = Shown::ALL.into_iter().filter(has).collect();
    (all, key)
}
