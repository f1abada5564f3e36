//! The energy balance: all energies of a run.

use std::fmt;

use crate::text::column::column;
use crate::text::readable_number::{number, whole_body_unit};

/// Side of the balance on which a term stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    /// Left-hand side: energy that is stored, or changed by the time scheme.
    Balance,
    /// Left-hand side: energy lost by the structure, as heat or to the ground.
    Lost,
    /// Right-hand side of the balance.
    Input,
    /// Not part of the balance.
    Beside,
}

/// Declares the terms, and the energy balance with a field for each.
///
/// The rows are in the order of columns.
macro_rules! energies {
    ($($(#[$doc:meta])* $variant:ident $field:ident $(($default:ident))?, $side:ident, $name:literal;)+) => {
        /// A term of the [`EnergyBalance`].
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum EnergyTerm {
            $($(#[$doc])* $variant,)+
        }

        /// Field, side and name of each term.
        const ENERGY_TERM_ROWS: &[(&str, Side, &str)] = &[$((stringify!($field), Side::$side, $name)),+];

        impl EnergyTerm {
            /// All terms, in the order of columns.
            pub const ALL_TERMS: [Self; ENERGY_TERM_ROWS.len()] = [$(Self::$variant),+];
        }

        /// Energies since the start, J, in the plane J per metre of thickness.
        ///
        /// ```text
        /// kinetic + strain + hysteresis + damping + algorithmic + midstep_remainder + soil + contact + interface
        ///     + static_contact = input
        /// ```
        ///
        /// holds exactly for the discrete equations. Every term is computed from its own definition and none as the
        /// difference of the others, so that [`EnergyBalance::residual`] checks the whole step.
        ///
        /// For a nonlinear force with a [`remainder`](crate::structure::NonlinearForce::remainder), the residual also
        /// checks the stored and dissipated energies that the force returns: the balance closes only if force, energies
        /// and remainder agree. Without a remainder, the difference between the force's work and its energies counts as
        /// `algorithmic`, and the residual does not check these energies.
        #[derive(Debug, Clone, Copy, Default)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
        #[non_exhaustive]
        pub struct EnergyBalance {
            $(
                $(#[$doc])*
                #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::number"))]
                $(#[cfg_attr(feature = "serde", serde($default))])?
                pub $field: f64,
            )+
        }

        impl EnergyBalance {
            /// Energy balance of a simulation that omits it: every term is NaN.
            pub(crate) const ALL_NAN: Self = Self { $($field: f64::NAN),+ };

            /// All terms, in the order of [`EnergyTerm::ALL_TERMS`].
            pub(crate) fn terms(&self) -> [f64; ENERGY_TERM_ROWS.len()] {
                [$(self.$field),+]
            }

            /// Mutable access to all terms, in the order of [`EnergyTerm::ALL_TERMS`].
            pub(crate) fn terms_mut(&mut self) -> [&mut f64; ENERGY_TERM_ROWS.len()] {
                [$(&mut self.$field),+]
            }
        }
    };
}

energies! {
    /// Kinetic energy ½ v·M v.
    Kinetic kinetic, Balance, "kinetic and strain";
    /// Strain energy ½ u·K u, plus the stored energy of the nonlinear internal force.
    ///
    /// If the structure does not separate stored from dissipated energy, it contains the work of that force since t = 0.
    Strain strain, Balance, "kinetic and strain";
    /// Heat of hysteretic parts of the structure; it never decreases.
    ///
    /// See [`NonlinearForce::energy`](crate::structure::NonlinearForce::energy).
    Hysteresis hysteresis, Lost, "hysteresis";
    /// Work of the dashpots, on displacements relative to the free field's translation.
    Damping damping, Lost, "damping";
    /// Loss by the time scheme, in the structure and in compliant interfaces.
    ///
    /// In the structure it is zero for the midpoint rule. In compliant interfaces the traction at the end of the step acts
    /// throughout the step. With a nonlinear force that returns its energies without a
    /// [`remainder`](crate::structure::NonlinearForce::remainder), the term includes the difference between the force's
    /// work in the discrete equation and these energies. This is the error of one integration point in a step, of either
    /// sign.
    Algorithmic algorithmic, Balance, "time scheme";
    /// Work of yielding parts inside the steps that is neither stored nor dissipated.
    ///
    /// The force acts at mid-step, and plastic strains follow at the end of the step. The term is from the
    /// [`remainder`](crate::structure::NonlinearForce::remainder) of the nonlinear force; without one it is zero. In each
    /// step it is of second order in the time step, but it accumulates. For [`Iwan`](crate::fem::Iwan), and for
    /// [`DruckerPrager`](crate::fem::DruckerPrager) with equal angles of friction and dilation, it never decreases: the
    /// time scheme removes energy. With a smaller angle of dilation it has either sign.
    MidstepRemainder midstep_remainder (default), Balance, "mid-step remainder";
    /// Work of the changes of traction on the soil: radiated and stored.
    Soil soil, Lost, "soil (radiated, stored)";
    /// Loss by friction and impact.
    ///
    /// It includes the loss by the springs of a compliant interface that opens and closes.
    ///
    /// It is the work of the total tractions on minus the change of the jump, without the elastic part of this change.
    /// It decreases only by the work of the weight of soil that follows a wall
    /// ([`EarthPressure`](crate::interface::EarthPressure)), and for no other law of the crate.
    Contact contact, Lost, "friction and impact";
    /// Elastic energy stored in compliant interfaces, as a change against the static state.
    ///
    /// See [`crate::interface::InterfaceLaw::compliance`]; zero for hard contact.
    Interface interface, Balance, "interface layer";
    /// Potential of the static tractions against the change of the jump.
    StaticContact static_contact, Balance, "static pressures";
    /// Work of external loads and of the free field, and the energy of an initial motion.
    Input input, Input, "input";
    /// Relative input energy (Uang & Bertero 1990); not part of the balance.
    ///
    /// Work of the loads, and of the inertia forces −M R ÿ of the free field's translation y, on displacements
    /// relative to it. Compare it with the value of a structure on a fixed base.
    RelativeInput relative_input, Beside, "relative input";
    /// Error bound of `soil`; zero unless the ground's history is approximate.
    ///
    /// It is Σ A |τ| |error of Δs|. The terms above balance with the approximate history, so the residual does not
    /// contain this error. With the exact history the energy of the soil may be larger or smaller by up to this bound.
    SoilErrorBound soil_error_bound, Beside, "error bound of the soil";
    /// Largest energy since the start, to which residuals are relative.
    ///
    /// It is the largest of: the magnitude of any term of the balance at the end of any step, the kinetic energy of the
    /// whole structure moving with the ground, and the energy of the static state in compliant interfaces and nonlinear
    /// parts.
    Largest largest, Beside, "largest energy";
}

impl EnergyTerm {
    /// Name of the term in tables and pictures.
    ///
    /// These show terms of the same name as their sum.
    pub(crate) fn name(self) -> &'static str {
        ENERGY_TERM_ROWS[self as usize].2
    }

    /// Column of the term in files: `soil_energy_j_per_m`, in plan `soil_energy_j`.
    pub(crate) fn column(self, in_plan: bool) -> String {
        let field = ENERGY_TERM_ROWS[self as usize].0;
        let name =
            if field.contains("bound") { field.to_owned() } else { format!("{field} energy") };
        column(&name, whole_body_unit("J/m", in_plan))
    }

    /// Whether the structure has lost the term's energy as heat or to the ground.
    pub(crate) fn is_lost(self) -> bool {
        self.side() == Side::Lost
    }

    /// Side of the balance on which the term stands.
    fn side(self) -> Side {
        ENERGY_TERM_ROWS[self as usize].1
    }
}

/// Prints the name of the term's field, such as `soil`.
impl fmt::Display for EnergyTerm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(ENERGY_TERM_ROWS[*self as usize].0)
    }
}

impl EnergyBalance {
    /// Value of a term, J, in the plane J/m.
    pub fn term(&self, term: EnergyTerm) -> f64 {
        self.terms()[term as usize]
    }

    /// Terms of the left-hand side of the balance.
    fn left_hand_side(&self) -> impl Iterator<Item = (EnergyTerm, f64)> {
        let terms = EnergyTerm::ALL_TERMS.into_iter().zip(self.terms());
        terms.filter(|(term, _)| matches!(term.side(), Side::Balance | Side::Lost))
    }

    /// Left-hand side of the balance, J, in the plane J/m.
    ///
    /// Terms of the same [name](EnergyTerm::name) are added up.
    pub(crate) fn parts(&self) -> Vec<(&'static str, f64)> {
        let mut parts: Vec<(&'static str, f64)> = Vec::new();
        for (term, energy) in self.left_hand_side() {
            match parts.iter_mut().find(|(name, _)| *name == term.name()) {
                Some((_, sum)) => *sum += energy,
                None => parts.push((term.name(), energy)),
            }
        }
        parts
    }

    /// Terms of the left-hand side relative to the input, by name.
    ///
    /// `None` if the input is not positive.
    pub fn fractions(&self) -> Option<Vec<(&'static str, f64)>> {
        if self.input <= 0.0 || self.input.is_nan() {
            return None;
        }
        let parts = self.parts().into_iter();
        Some(parts.map(|(name, energy)| (name, energy / self.input)).collect())
    }

    /// A term relative to the input; `None` if the input is not positive.
    pub fn fraction(&self, term: EnergyTerm) -> Option<f64> {
        (self.input > 0.0).then(|| self.term(term) / self.input)
    }

    /// Largest energy so far, the present terms included.
    pub(crate) fn scale(&self) -> f64 {
        let terms = self.left_hand_side().map(|(_, energy)| energy).chain([self.input]);
        terms.fold(self.largest, |max, term| max.max(term.abs()))
    }

    /// Whether the energy balance is omitted, so that every term is NaN.
    pub(crate) fn is_omitted(&self) -> bool {
        self.input.is_nan()
    }

    /// Left-hand side minus input, relative to the [largest energy](EnergyBalance::largest) so far.
    ///
    /// The residual is NaN if the energy balance is omitted.
    pub fn residual(&self) -> f64 {
        if self.is_omitted() {
            return f64::NAN;
        }
        let imbalance =
            (self.left_hand_side().map(|(_, energy)| energy).sum::<f64>() - self.input).abs();
        // `max` ignores NaN, but the sum does not.
        if imbalance == 0.0 { 0.0 } else { imbalance / self.scale() }
    }
}

/// Terms that are NaN in both are equal.
impl PartialEq for EnergyBalance {
    fn eq(&self, other: &Self) -> bool {
        let mut pairs = self.terms().into_iter().zip(other.terms());
        pairs.all(|(a, b)| a == b || (a.is_nan() && b.is_nan()))
    }
}

/// Prints energies in kJ; in the plane per metre of thickness.
impl fmt::Display for EnergyBalance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_omitted() {
            return write!(f, "energy balance omitted");
        }
        let in_kilojoules = |energy: f64| number(1e-3 * energy);
        writeln!(f, "energy, kJ (in the plane kJ/m): input {}", in_kilojoules(self.input))?;
        let mut parts = self.parts();
        // Only yielding parts have a remainder.
        parts.retain(|(name, energy)| {
            *energy != 0.0 || *name != EnergyTerm::MidstepRemainder.name()
        });
        for pair in parts.chunks(2) {
            let cell =
                |(name, energy): &(&str, f64)| format!("{name:<24}{:>12}", in_kilojoules(*energy));
            writeln!(f, "  {}", pair.iter().map(cell).collect::<Vec<_>>().join("    "))?;
        }
        write!(f, "  {:<24}{:>12.1e}", "residual", self.residual())?;
        if self.soil_error_bound > 0.0 {
            let bound = in_kilojoules(self.soil_error_bound);
            write!(f, "\n  {:<24}{bound:>12}", EnergyTerm::SoilErrorBound.name())?;
        }
        Ok(())
    }
}

former_constants! {
    EnergyTerm { ALL: [Self; ENERGY_TERM_ROWS.len()] = ALL_TERMS, "use `ALL_TERMS`"; }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fractions_add_up_as_the_energy_balance_does() {
        let energy_balance = EnergyBalance {
            kinetic: 1.0,
            strain: 2.0,
            hysteresis: 256.0,
            damping: 4.0,
            algorithmic: 8.0,
            midstep_remainder: 512.0,
            soil: 16.0,
            contact: 32.0,
            interface: 64.0,
            static_contact: -7.0,
            input: 888.0,
            relative_input: 300.0,
            largest: 888.0,
            ..EnergyBalance::default()
        };
        assert_eq!(energy_balance.residual(), 0.0);
        let fractions = energy_balance.fractions().unwrap();
        assert!((fractions.iter().map(|(_, fraction)| fraction).sum::<f64>() - 1.0).abs() < 1e-15);
        assert_eq!(fractions.len(), 9);
        assert!(fractions.contains(&("kinetic and strain", 3.0 / 888.0)));
        assert_eq!(energy_balance.fraction(EnergyTerm::Soil), Some(16.0 / 888.0));
        for input in [0.0, -1.0, f64::NAN] {
            assert_eq!(EnergyBalance { input, ..energy_balance }.fractions(), None);
        }
    }

    #[test]
    fn columns_have_the_name_and_the_unit() {
        let columns = EnergyTerm::ALL_TERMS.map(|term| term.column(false));
        assert_eq!(columns[0], "kinetic_energy_j_per_m");
        assert!(columns.contains(&"relative_input_energy_j_per_m".to_owned()));
        assert!(columns.contains(&"soil_error_bound_j_per_m".to_owned()));
        assert_eq!(EnergyTerm::ALL_TERMS[0].column(true), "kinetic_energy_j");
    }
}
