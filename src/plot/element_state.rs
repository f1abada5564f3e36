//! States of contact elements in pictures, with their names and colours.

use crate::interface::{ContactState, Mode};
use crate::results::ContactFrame;
use plotters::style::RGBColor;

/// Largest pressure that is due to rounding, relative to the largest pressure of the base.
const PRESSURE_ROUNDING: f64 = 1e-9;

/// State of an element in a picture.
///
/// If a column of a map has several states, the one that stands last in this list is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum ElementState {
    Stick,
    Open,
    /// Touching without pressure: with infinite friction, slip is the state between stick and open.
    WithoutPressure,
    SlipLeft,
    SlipRight,
    /// Slip in any direction, in plan.
    Slip,
}

impl ElementState {
    /// All states, in the order of the key.
    const KEY_ORDER: [Self; 6] = [
        Self::Stick,
        Self::SlipLeft,
        Self::SlipRight,
        Self::Slip,
        Self::Open,
        Self::WithoutPressure,
    ];

    /// State from mode and tractions of an element.
    ///
    /// `max_pressure`: largest pressure of the base, Pa.
    pub(super) fn new(mode: Mode, state: &ContactState, max_pressure: f64) -> Self {
        match mode.elastic() {
            Mode::Open => Self::Open,
            _ if state.pressure.abs() <= PRESSURE_ROUNDING * max_pressure => Self::WithoutPressure,
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
            Self::WithoutPressure => "touching without pressure",
        }
    }

    pub(super) fn color(self) -> RGBColor {
        match self {
            Self::Stick => RGBColor(214, 222, 228),
            Self::SlipLeft => RGBColor(255, 166, 43),
            Self::SlipRight | Self::Slip => RGBColor(214, 39, 40),
            Self::Open => RGBColor(22, 72, 120),
            Self::WithoutPressure => RGBColor(118, 172, 214),
        }
    }
}

/// States of the elements in all frames, and the states in the key.
pub(super) struct ElementStates {
    /// State of every element in every frame.
    pub(super) frame_states: Vec<Vec<ElementState>>,
    /// States in the key: all states of the plane or of plan, but touching without pressure only if it occurs.
    pub(super) key_states: Vec<ElementState>,
}

impl ElementStates {
    pub(super) fn new(frames: &[ContactFrame<'_>], in_plan: bool) -> Self {
        let states = frames.iter().flat_map(|frame| frame.states);
        let max_pressure = states.map(|state| state.pressure.abs()).fold(0.0, f64::max);
        let mut frame_states: Vec<Vec<ElementState>> = Vec::with_capacity(frames.len());
        for frame in frames {
            let modes_and_states = frame.modes.iter().zip(frame.states);
            frame_states.push(
                modes_and_states
                    .map(|(mode, state)| ElementState::new(*mode, state, max_pressure))
                    .collect(),
            );
        }
        let mut key_states = ElementState::KEY_ORDER.to_vec();
        key_states.retain(|state| match state {
            ElementState::WithoutPressure => {
                frame_states.iter().flatten().any(|other| other == state)
            }
            ElementState::Slip => in_plan,
            ElementState::SlipLeft | ElementState::SlipRight => !in_plan,
            ElementState::Stick | ElementState::Open => true,
        });
        Self { frame_states, key_states }
    }
}
