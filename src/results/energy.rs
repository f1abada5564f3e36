//! Where the energy went, as shares of what came in.

use crate::coupled::Ledger;

/// Terms of the [`Ledger`] over its input: they add up to one, to the ledger's residual.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct EnergyShares {
    /// The input itself, J/m.
    pub input: f64,
    /// Kinetic and strain energy still in the structure.
    pub structure: f64,
    /// Taken by the structure's hysteretic parts.
    pub hysteresis: f64,
    /// Taken by the structure's dampers.
    pub damping: f64,
    /// Given to the soil: radiated, and stored in it.
    pub soil: f64,
    /// Taken by friction and by impacts of the base.
    pub contact: f64,
    /// Stored in compliant interfaces.
    pub layer: f64,
    /// Stored against the static pressures: positive when the structure stands higher or farther.
    pub preload: f64,
    /// Taken by the time scheme.
    pub numerical: f64,
}

impl EnergyShares {
    /// Shares of the ledger's input; `None` unless that is above zero.
    pub fn of(ledger: &Ledger) -> Option<Self> {
        let input = ledger.input;
        (input > 0.0).then(|| Self {
            input,
            structure: (ledger.kinetic + ledger.strain) / input,
            hysteresis: ledger.hysteresis / input,
            damping: ledger.damping / input,
            soil: ledger.soil / input,
            contact: ledger.contact / input,
            layer: ledger.layer / input,
            preload: ledger.preload / input,
            numerical: ledger.numerical / input,
        })
    }

    /// Names and shares.
    pub fn named(&self) -> [(&'static str, f64); 8] {
        [
            ("soil (radiated, stored)", self.soil),
            ("friction and impact", self.contact),
            ("damping", self.damping),
            ("hysteresis", self.hysteresis),
            ("kinetic and strain", self.structure),
            ("interface layer", self.layer),
            ("static pressures", self.preload),
            ("time scheme", self.numerical),
        ]
    }

    /// Sum of the shares.
    pub fn sum(&self) -> f64 {
        self.named().iter().map(|(_, share)| share).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_add_up_as_the_ledger_does() {
        let ledger = Ledger {
            kinetic: 1.0,
            strain: 2.0,
            hysteresis: 256.0,
            damping: 4.0,
            numerical: 8.0,
            soil: 16.0,
            contact: 32.0,
            layer: 64.0,
            preload: -7.0,
            input: 376.0,
            relative_input: 300.0,
            soil_error_bound: 0.0,
        };
        assert_eq!(ledger.residual(), 0.0);
        let shares = EnergyShares::of(&ledger).unwrap();
        assert!((shares.sum() - 1.0).abs() < 1e-15);
        assert!((shares.structure - 3.0 / 376.0).abs() < 1e-16);
        for input in [0.0, -1.0, f64::NAN] {
            assert_eq!(EnergyShares::of(&Ledger { input, ..ledger }), None);
        }
    }
}
