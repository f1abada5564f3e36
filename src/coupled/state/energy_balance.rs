//! The energy balance: all energies of a run.

use std::fmt;

use crate::text::column::column;
use crate::text::readable_number::{number, of_body};

/// Place of a term in the energy balance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    /// Left-hand side: stored energy, and energy that the time scheme adds or removes.
    Stored,
    /// Left-hand side: energy that the structure has lost to heat or to the ground.
    Lost,
    /// Right-hand side.
    Input,
    /// Not part of the balance.
    Outside,
}

/// Row of the table of energies.
struct EnergyTermRow {
    /// Word in files and programs, `soil`.
    word: &'static str,
    side: Side,
    /// Name in tables and pictures.
    name: &'static str,
}

/// Declares the terms as an enum, and the energy balance with a field for each, from rows in the order of columns.
macro_rules! energies {
    ($($(#[$doc:meta])* $variant:ident $field:ident, $side:ident, $name:literal;)+) => {
        /// A term of the [`EnergyBalance`].
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum EnergyTerm {
            $($(#[$doc])* $variant,)+
        }

        const ENERGY_TERM_ROWS: &[EnergyTermRow] = &[$(EnergyTermRow {
            word: stringify!($field),
            side: Side::$side,
            name: $name,
        }),+];

        impl EnergyTerm {
            /// All terms, in the order of columns.
            pub const ALL_TERMS: [Self; ENERGY_TERM_ROWS.len()] = [$(Self::$variant),+];
        }

        /// Energies since the start, J, in the plane J per metre of thickness.
        ///
        /// ```text
        /// kinetic + strain + hysteresis + damping + algorithmic + soil + contact + interface + static_contact = input
        /// ```
        ///
        /// holds exactly for the discrete equations. Every term is computed from its own definition and none as
        /// the remainder, so [`EnergyBalance::residual`] checks the whole step. It does not check the energies
        /// that a nonlinear structure returns as stored and dissipated. The difference between them and the work
        /// of its force is in `algorithmic`, and falls with the square of the step.
        #[derive(Debug, Clone, Copy, Default)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
        #[non_exhaustive]
        pub struct EnergyBalance {
            $(
                $(#[$doc])*
                #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::number"))]
                pub $field: f64,
            )+
        }

        impl EnergyBalance {
            /// The energy balance of a simulation without one: every term is NaN.
            pub(crate) const LEFT_OUT: Self = Self { $($field: f64::NAN),+ };

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
    Kinetic kinetic, Stored, "kinetic and strain";
    /// Strain energy ½ u·K u, plus the stored energy of the nonlinear internal force.
    ///
    /// If the structure does not separate stored from dissipated energy, the work of that force since t = 0.
    Strain strain, Stored, "kinetic and strain";
    /// Heat of hysteretic parts of the structure; it never falls.
    ///
    /// See [`NonlinearForce::energy`](crate::structure::NonlinearForce::energy).
    Hysteresis hysteresis, Lost, "hysteresis";
    /// Work of the dashpots, on displacements relative to the free field's translation.
    Damping damping, Lost, "damping";
    /// Loss by the time scheme, in the structure and in compliant interfaces.
    ///
    /// In the structure it is zero for the midpoint rule. In compliant interfaces the traction at the end of the
    /// step acts throughout the step. With a nonlinear force of known energies, it includes the difference between
    /// its work in the discrete equation and these energies: the error of one point in a step, of either sign.
    Algorithmic algorithmic, Stored, "time scheme";
    /// Work of the changes of traction on the soil: radiated and stored.
    Soil soil, Lost, "soil (radiated, stored)";
    /// Loss by friction and impact, and by the springs of a compliant interface that opens and closes.
    ///
    /// Total tractions times minus the change of the jump, without its elastic part. It falls by the work of the
    /// weight of soil that follows a wall ([`EarthPressure`](crate::interface::EarthPressure)), and with no other
    /// law of the crate.
    Contact contact, Lost, "friction and impact";
    /// Elastic energy stored in compliant interfaces, minus that of the static state.
    ///
    /// See [`crate::interface::InterfaceLaw::compliance`]; zero for hard contact.
    Interface interface, Stored, "interface layer";
    /// Potential energy of the static tractions on the change of the jump.
    StaticContact static_contact, Stored, "static pressures";
    /// Work of external loads and of the free field, and the energy of an initial motion.
    Input input, Input, "input";
    /// Relative input energy (Uang & Bertero 1990); not part of the balance.
    ///
    /// Work of the loads, and of the inertia forces −M R ÿ of the free field's translation y, on displacements
    /// relative to it. Compare it with the value of a structure on a fixed base.
    RelativeInput relative_input, Outside, "relative input";
    /// Error bound of `soil`, Σ A |τ| |error of Δs|: zero unless the ground's history is approximate.
    ///
    /// The terms above balance with the approximate history, so the residual does not contain this error. With the
    /// exact history the soil may take this much more or less energy.
    SoilErrorBound soil_error_bound, Outside, "error bound of the soil";
    /// Largest energy since the start, to which residuals are relative.
    ///
    /// Magnitude of any term of the balance at the end of any step, ½ M v² of the whole structure moving with the
    /// ground, and the energy of the static state in compliant interfaces and nonlinear parts.
    Largest largest, Outside, "largest energy";
}

impl EnergyTerm {
    /// Name of the term in tables and pictures; terms with one name are shown as their sum.
    pub(crate) fn name(self) -> &'static str {
        ENERGY_TERM_ROWS[self as usize].name
    }

    /// Column of the term in files: `soil_energy_j_per_m`, in plan `soil_energy_j`.
    pub(crate) fn column(self, in_plan: bool) -> String {
        let word = ENERGY_TERM_ROWS[self as usize].word;
        let name = if word.contains("bound") { word.to_owned() } else { format!("{word} energy") };
        column(&name, of_body("J/m", in_plan))
    }

    /// Whether the structure has lost the term's energy to heat or to the ground.
    pub(crate) fn is_lost(self) -> bool {
        self.side() == Side::Lost
    }

    fn side(self) -> Side {
        ENERGY_TERM_ROWS[self as usize].side
    }
}

/// Prints the word of its field, `soil`.
impl fmt::Display for EnergyTerm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(ENERGY_TERM_ROWS[*self as usize].word)
    }
}

impl EnergyBalance {
    /// Value of a term, J, in the plane J/m.
    pub fn term(&self, term: EnergyTerm) -> f64 {
        self.terms()[term as usize]
    }

    /// Terms of the left-hand side, with their energies.
    fn left_hand_terms(&self) -> impl Iterator<Item = (EnergyTerm, f64)> {
        let energies = EnergyTerm::ALL_TERMS.into_iter().zip(self.terms());
        energies.filter(|(term, _)| matches!(term.side(), Side::Stored | Side::Lost))
    }

    /// Parts of the input energy, J, in the plane J/m; terms with one [name](EnergyTerm::name) are added.
    pub(crate) fn parts(&self) -> Vec<(&'static str, f64)> {
        let mut parts: Vec<(&'static str, f64)> = Vec::new();
        for (term, energy) in self.left_hand_terms() {
            match parts.iter_mut().find(|(name, _)| *name == term.name()) {
                Some((_, sum)) => *sum += energy,
                None => parts.push((term.name(), energy)),
            }
        }
        parts
    }

    /// The parts relative to the input; `None` if the input is not positive.
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
        let energies = self.left_hand_terms().map(|(_, energy)| energy).chain([self.input]);
        energies.fold(self.largest, |largest, energy| largest.max(energy.abs()))
    }

    /// Whether there is no energy balance: every term is then NaN.
    pub(crate) fn is_left_out(&self) -> bool {
        self.input.is_nan()
    }

    /// Left-hand side minus input, relative to the [largest energy](EnergyBalance::largest) so far.
    ///
    /// NaN without an energy balance.
    pub fn residual(&self) -> f64 {
        if self.is_left_out() {
            return f64::NAN;
        }
        let left_hand_side = self.left_hand_terms().map(|(_, energy)| energy).sum::<f64>();
        let imbalance = (left_hand_side - self.input).abs();
        // A term that is NaN makes the imbalance NaN; `scale` ignores it.
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
        if self.is_left_out() {
            return write!(f, "energy balance left out");
        }
        let kilojoules = |energy: f64| number(1e-3 * energy);
        writeln!(f, "energy, kJ (in the plane kJ/m): input {}", kilojoules(self.input))?;
        for pair in self.parts().chunks(2) {
            let cell =
                |(name, energy): &(&str, f64)| format!("{name:<24}{:>12}", kilojoules(*energy));
            writeln!(f, "  {}", pair.iter().map(cell).collect::<Vec<_>>().join("    "))?;
        }
        write!(f, "  {:<24}{:>12.1e}", "residual", self.residual())?;
        if self.soil_error_bound > 0.0 {
            let bound = kilojoules(self.soil_error_bound);
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
            soil: 16.0,
            contact: 32.0,
            interface: 64.0,
            static_contact: -7.0,
            input: 376.0,
            relative_input: 300.0,
            largest: 376.0,
            ..EnergyBalance::default()
        };
        assert_eq!(energy_balance.residual(), 0.0);
        let fractions = energy_balance.fractions().unwrap();
        assert!((fractions.iter().map(|(_, fraction)| fraction).sum::<f64>() - 1.0).abs() < 1e-15);
        assert_eq!(fractions.len(), 8);
        assert!(fractions.contains(&("kinetic and strain", 3.0 / 376.0)));
        assert_eq!(energy_balance.fraction(EnergyTerm::Soil), Some(16.0 / 376.0));
        for input in [0.0, -1.0, f64::NAN] {
            assert_eq!(EnergyBalance { input, ..energy_balance }.fractions(), None);
        }
    }

    #[test]
    fn columns_by_one_rule() {
        let columns = EnergyTerm::ALL_TERMS.map(|term| term.column(false));
        assert_eq!(columns[0], "kinetic_energy_j_per_m");
        assert!(columns.contains(&"relative_input_energy_j_per_m".to_owned()));
        assert!(columns.contains(&"soil_error_bound_j_per_m".to_owned()));
        assert_eq!(EnergyTerm::ALL_TERMS[0].column(true), "kinetic_energy_j");
    }
}
