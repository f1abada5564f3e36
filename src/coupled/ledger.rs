//! The energy ledger: where every joule of a run went.

use std::fmt;

use crate::results::unit::number;

/// Energies since the start, J per metre of thickness.
///
/// ```text
/// kinetic + strain + hysteresis + damping + numerical + soil + contact + layer + preload = input
/// ```
///
/// holds exactly for the discrete equations. Every term is computed from its own definition and
/// none as the remainder, so that [`Ledger::residual`] checks the whole step. One thing it does not
/// check: energies that a nonlinear structure says it stores and dissipates. The difference between
/// them and the work of its force is in `numerical`, and falls with the square of the step.
#[derive(Debug, Clone, Copy, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Ledger {
    /// ½ v·M v.
    #[cfg_attr(feature = "serde", serde(with = "crate::forms::number"))]
    pub kinetic: f64,
    /// ½ u·K u, plus what the nonlinear internal force stores: its work since t = 0, where the structure
    /// does not tell stored from dissipated energy.
    #[cfg_attr(feature = "serde", serde(with = "crate::forms::number"))]
    pub strain: f64,
    /// Heat of hysteretic parts of the structure
    /// ([`NonlinearForce::energy`](crate::structure::NonlinearForce::energy)); never less
    /// than before.
    #[cfg_attr(feature = "serde", serde(with = "crate::forms::number"))]
    pub hysteresis: f64,
    /// Work of the dashpots, on displacements relative to the free field's translation.
    #[cfg_attr(feature = "serde", serde(with = "crate::forms::number"))]
    pub damping: f64,
    /// Loss by the time scheme: in the structure (zero for the midpoint rule), and in compliant
    /// interfaces, whose traction is that of the end of the step all through it. With a nonlinear
    /// force of known energies, also its work in the discrete equation beyond them: the error of
    /// one point in a step, of either sign.
    #[cfg_attr(feature = "serde", serde(with = "crate::forms::number"))]
    pub numerical: f64,
    /// Work done on the soil by the changes of traction: radiated and stored.
    #[cfg_attr(feature = "serde", serde(with = "crate::forms::number"))]
    pub soil: f64,
    /// Loss by friction and impact, and with the springs of a compliant interface
    /// when its elements open and close: total tractions times minus the change of the jump, its
    /// elastic part left out. Never less from step to step, with any law of the crate.
    #[cfg_attr(feature = "serde", serde(with = "crate::forms::number"))]
    pub contact: f64,
    /// Elastic energy stored in compliant interfaces ([`crate::interface::InterfaceLaw::compliance`]),
    /// as a change against the static state; zero for hard contact.
    #[cfg_attr(feature = "serde", serde(with = "crate::forms::number"))]
    pub layer: f64,
    /// Potential of the static tractions against the change of the jump.
    #[cfg_attr(feature = "serde", serde(with = "crate::forms::number"))]
    pub preload: f64,
    /// Work of external loads and of the free field, and the energy of an initial motion.
    #[cfg_attr(feature = "serde", serde(with = "crate::forms::number"))]
    pub input: f64,
    /// Relative input energy (Uang & Bertero 1990): work of the loads, and of the inertia forces
    /// −M R ÿ of the free field's translation y, on displacements relative to it. It stands beside
    /// the balance, to be compared with that of a structure on a fixed base.
    #[cfg_attr(feature = "serde", serde(with = "crate::forms::number"))]
    pub relative_input: f64,
    /// Error bound of `soil`, Σ A |τ| |error of Δs|: zero unless the ground's history is
    /// approximate. The terms above balance with the history as it is, so nothing of the residual
    /// is due to it; but the soil of the equations may have taken this much more or less than it did here.
    #[cfg_attr(feature = "serde", serde(with = "crate::forms::number"))]
    pub soil_error_bound: f64,
}

impl Ledger {
    /// The ledger of a simulation that keeps none: every term is NaN.
    pub(crate) const LEFT_OUT: Self = Self {
        kinetic: f64::NAN,
        strain: f64::NAN,
        hysteresis: f64::NAN,
        damping: f64::NAN,
        numerical: f64::NAN,
        soil: f64::NAN,
        contact: f64::NAN,
        layer: f64::NAN,
        preload: f64::NAN,
        input: f64::NAN,
        relative_input: f64::NAN,
        soil_error_bound: f64::NAN,
    };

    fn terms(&self) -> [f64; 12] {
        let Self { kinetic, strain, hysteresis, damping, numerical, soil, .. } = *self;
        let Self { contact, layer, preload, input, relative_input, soil_error_bound, .. } = *self;
        [
            kinetic,
            strain,
            hysteresis,
            damping,
            numerical,
            soil,
            contact,
            layer,
            preload,
            input,
            relative_input,
            soil_error_bound,
        ]
    }

    /// Whether no ledger is kept: every term is then NaN.
    pub fn is_left_out(&self) -> bool {
        self.input.is_nan()
    }

    /// Left-hand side minus input, relative to the largest term (or to a thousandth of the relative input, if
    /// that is more); NaN if no ledger is kept.
    pub fn residual(&self) -> f64 {
        if self.is_left_out() {
            return f64::NAN;
        }
        let left = [
            self.kinetic,
            self.strain,
            self.hysteresis,
            self.damping,
            self.numerical,
            self.soil,
            self.contact,
            self.layer,
            self.preload,
        ];
        // A structure that the ground leaves behind has no energy but rounding.
        let least = self.input.abs().max(1e-3 * self.relative_input.abs());
        let scale = left.iter().fold(least, |m, x| m.max(x.abs()));
        if scale > 0.0 { (left.iter().sum::<f64>() - self.input).abs() / scale } else { 0.0 }
    }
}

/// Terms that are NaN in both are equal.
impl PartialEq for Ledger {
    fn eq(&self, other: &Self) -> bool {
        let same = |(a, b): (f64, f64)| a == b || (a.is_nan() && b.is_nan());
        self.terms().into_iter().zip(other.terms()).all(same)
    }
}

/// Energies in kJ/m.
impl fmt::Display for Ledger {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_left_out() {
            return write!(f, "energy ledger left out");
        }
        let shown = |energy: f64| number(1e-3 * energy);
        writeln!(f, "energy, kJ/m: input {}", shown(self.input))?;
        let pairs = [
            [("kinetic", self.kinetic), ("strain", self.strain)],
            [("soil", self.soil), ("contact", self.contact)],
            [("damping", self.damping), ("numerical", self.numerical)],
        ];
        for [(left, first), (right, second)] in pairs {
            let [first, second] = [first, second].map(shown);
            writeln!(f, "  {left:<12}{first:>12}    {right:<12}{second:>12}")?;
        }
        for (name, energy) in [("hysteresis", self.hysteresis), ("layer", self.layer)] {
            if energy != 0.0 {
                writeln!(f, "  {name:<12}{:>12}", shown(energy))?;
            }
        }
        let (preload, residual) = (shown(self.preload), self.residual());
        write!(f, "  {:<12}{preload:>12}    {:<12}{residual:>12.1e}", "preload", "residual")?;
        if self.soil_error_bound > 0.0 {
            let bound = shown(self.soil_error_bound);
            write!(f, "\n  {:<12}{bound:>12}    (approximate history)", "soil within")?;
        }
        Ok(())
    }
}
