//! Lines in place of the curves of laws, for yielding elements in the plane.
//!
//! The slope of a line is that of the curve, rounded relative to the element's stiffness ρ (see [`super::linearisation`]), so
//! that results do not depend on the units. The matrix of a trial is then the same in several trials and steps, with its
//! factors. The lines follow from the state at the start of the step alone, so that a resumed run has the same
//! ones. Each trial reduces the distance from the curves by the relative error of the slopes or more.

use crate::interface::{Condition, Limits};

/// Largest factor between the slopes of a line and of its curve.
const MAX_SLOPE_RATIO: f64 = 1.25;
/// Bits of a rounded ratio's mantissa after the first.
const RATIO_MANTISSA_BITS: u32 = 2;

/// Line on which a yielding element is solved in place of its law's curve.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct TrialLine {
    /// Settlement in the step at which the line meets the curve, m.
    pub(super) settlement: f64,
    /// Pressure there, Pa.
    pressure: f64,
    /// Gap of the closed element, m.
    pub(super) gap_offset: f64,
    /// Slope, Pa/m; zero for the tangent of the curve.
    pub(super) slope: f64,
}

impl TrialLine {
    /// Line of a rounded slope through the point of a curve, for an element of the stiffness ρ, Pa/m.
    pub(super) fn new(point: CurvePoint, gap_offset: f64, stiffness: f64) -> Self {
        let CurvePoint { settlement, pressure, hardening } = point;
        let slope = stiffness * rounded(hardening / stiffness);
        Self { settlement, pressure, gap_offset, slope }
    }

    /// This line through another point, with its slope if that is near the slope of the curve.
    pub(super) fn through(self, point: CurvePoint, stiffness: f64) -> Self {
        let Self { gap_offset, slope, .. } = self;
        let CurvePoint { settlement, pressure, hardening } = point;
        let is_near = slope <= MAX_SLOPE_RATIO * hardening && hardening <= MAX_SLOPE_RATIO * slope;
        if is_near {
            Self { settlement, pressure, ..self }
        } else {
            Self::new(point, gap_offset, stiffness)
        }
    }

    /// The tangent at the same point.
    pub(super) fn tangent(self) -> Self {
        Self { slope: 0.0, ..self }
    }

    /// Replaces the tangent in the condition of a yielding element by this line.
    pub(super) fn replace_tangent(&self, condition: &mut Condition) {
        if self.slope == 0.0 || condition.gap == 0.0 {
            return;
        }
        let layer = (condition.pressure - 1.0) / condition.gap;
        condition.gap = self.slope;
        condition.pressure = 1.0 + self.slope * layer;
        condition.value = self.value();
    }

    /// Right-hand side of the condition of a yielding element.
    pub(super) fn value(&self) -> f64 {
        self.pressure + self.slope * (self.gap_offset - self.settlement)
    }
}

/// Point of a law's curve.
#[derive(Debug, Clone, Copy)]
pub(super) struct CurvePoint {
    /// Settlement in the step, m.
    pub(super) settlement: f64,
    /// Pressure, Pa.
    pub(super) pressure: f64,
    /// Slope, Pa/m.
    pub(super) hardening: f64,
}

impl CurvePoint {
    /// Point at a settlement, from the limits of the law there.
    pub(super) fn new(settlement: f64, limits: &Limits) -> Self {
        let Limits { pressure_cap, hardening, .. } = *limits;
        Self { settlement, pressure: pressure_cap + hardening * settlement, hardening }
    }
}

/// How the lines in place of the curves have moved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum LineMotion {
    /// All pressures are on the curves.
    None,
    /// Lines of yielding elements have shifted: the matrix of the trial is the same.
    Shifted,
    /// Slopes have changed, or lines of elements that do not yield have moved.
    Turned,
}

/// Ratio of stiffnesses, rounded to a few bits.
fn rounded(ratio: f64) -> f64 {
    let dropped_bits = f64::MANTISSA_DIGITS - 1 - RATIO_MANTISSA_BITS;
    let half = 1_u64 << (dropped_bits - 1);
    let rounded = f64::from_bits((ratio.to_bits() + half) >> dropped_bits << dropped_bits);
    if rounded.is_normal() { rounded } else { ratio }
}
