//! The energy ledger: where every joule of a run went.

use std::fmt;

/// Energies since the start, J per metre of thickness.
///
/// ```text
/// kinetic + strain + damping + numerical + soil + contact + preload = input
/// ```
///
/// holds exactly for the discrete equations. Every term is computed from its own definition and
/// none as the remainder, so that [`Ledger::residual`] checks the whole step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Ledger {
    /// ½ v·M v.
    pub kinetic: f64,
    /// ½ u·K u, plus the work of the nonlinear internal force.
    pub strain: f64,
    /// Work of the dashpots, on displacements relative to the free field.
    pub damping: f64,
    /// What the time scheme takes (zero for the midpoint rule).
    pub numerical: f64,
    /// Work done on the soil by the changes of traction: radiated and stored.
    pub soil: f64,
    /// What friction and impact take: total tractions times minus the change of the jump.
    pub contact: f64,
    /// Potential of the static tractions against the change of the jump.
    pub preload: f64,
    /// Work of external loads and of the free field.
    pub input: f64,
}

impl Ledger {
    /// Left-hand side minus input, relative to the largest term.
    pub fn residual(&self) -> f64 {
        let left = [
            self.kinetic,
            self.strain,
            self.damping,
            self.numerical,
            self.soil,
            self.contact,
            self.preload,
        ];
        let scale = left.iter().fold(self.input.abs(), |m, x| m.max(x.abs()));
        if scale > 0.0 { (left.iter().sum::<f64>() - self.input).abs() / scale } else { 0.0 }
    }
}

impl fmt::Display for Ledger {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "energy, J/m:  input {:.4e}", self.input)?;
        writeln!(f, "  kinetic     {:>12.4e}    strain      {:>12.4e}", self.kinetic, self.strain)?;
        writeln!(f, "  soil        {:>12.4e}    contact     {:>12.4e}", self.soil, self.contact)?;
        writeln!(
            f,
            "  damping     {:>12.4e}    numerical   {:>12.4e}",
            self.damping, self.numerical
        )?;
        write!(f, "  preload     {:>12.4e}    residual    {:>12.1e}", self.preload, self.residual())
    }
}
