//! Search for the force of a target displacement in a push-over.
//!
//! Above the target means beyond it in its direction; the target may be negative.

/// Width of the bracket of the limit force, relative to this force, at which the search ends.
pub(super) const LIMIT_FORCE_TOLERANCE: f64 = 1e-4;
/// Largest growth of the force in one extrapolation, so that a stiff start does not overshoot the limit.
const MAX_FORCE_GROWTH: f64 = 4.0;

/// Force and displacement of a static state.
#[derive(Clone, Copy)]
pub(super) struct ForceDisplacement {
    pub(super) force: f64,
    pub(super) displacement: f64,
}

/// Search for the force of a target displacement.
///
/// Between two states the search is the regula falsi with halved weights (Illinois method). Beyond all states the force
/// grows with the last secant stiffness. If a force has no equilibrium, the search bisects.
pub(super) struct DisplacementSearch {
    target: f64,
    /// Force of the first trial; it adds to the force of a state without displacement.
    first_force: f64,
    /// Last state below the target.
    pub(super) lower_state: ForceDisplacement,
    /// Last state above the target.
    pub(super) upper_state: Option<ForceDisplacement>,
    /// Last force without equilibrium.
    pub(super) failed_force: Option<f64>,
    /// Weights of the residuals of the lower and the upper state.
    lower_weight: f64,
    upper_weight: f64,
    /// Whether the previous state was above the target.
    was_above: Option<bool>,
}

impl DisplacementSearch {
    pub(super) fn new(target: f64, first_force: f64, lower_state: ForceDisplacement) -> Self {
        Self {
            target,
            first_force,
            lower_state,
            upper_state: None,
            failed_force: None,
            lower_weight: 1.0,
            upper_weight: 1.0,
            was_above: None,
        }
    }

    /// Force of the next trial.
    pub(super) fn next_force(&self) -> f64 {
        let lower_state = self.lower_state;
        match (self.upper_state, self.failed_force) {
            (Some(upper_state), _) => {
                let lower_residual = self.lower_weight * (self.target - lower_state.displacement);
                let upper_residual = self.upper_weight * (upper_state.displacement - self.target);
                (lower_state.force * upper_residual + upper_state.force * lower_residual)
                    / (upper_residual + lower_residual)
            }
            (None, Some(failed_force)) => 0.5 * (lower_state.force + failed_force),
            (None, None) if lower_state.displacement == 0.0 => lower_state.force + self.first_force,
            (None, None) => {
                lower_state.force * (self.target / lower_state.displacement).min(MAX_FORCE_GROWTH)
            }
        }
    }

    /// Replaces the lower or the upper state by `state`; returns whether `state` is above the target.
    pub(super) fn update(&mut self, state: ForceDisplacement) -> bool {
        let is_above = state.displacement / self.target > 1.0;
        let is_repeated = self.was_above.replace(is_above) == Some(is_above);
        let weight_factor = if is_repeated { 0.5 } else { 1.0 };
        if is_above {
            self.upper_state = Some(state);
            self.lower_weight *= weight_factor;
            self.upper_weight = 1.0;
        } else {
            self.lower_state = state;
            self.lower_weight = 1.0;
            self.upper_weight *= weight_factor;
        }
        is_above
    }

    /// Whether the forces with and without equilibrium agree to the tolerance, relative to `force`.
    pub(super) fn is_limit(&self, failed_force: f64, force: f64) -> bool {
        (failed_force - self.lower_state.force).abs() <= LIMIT_FORCE_TOLERANCE * force.abs()
    }
}
