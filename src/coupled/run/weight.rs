//! Weight, buoyancy and effective weight of a run.

use std::fmt;

use crate::coupled::run::Run;
use crate::coupled::run::page::safety_text;
use crate::text::readable_number::whole_body_unit;

impl Run {
    /// Weight of the structure, N/m (in plan N): without water the normal force at the start.
    fn weight(&self) -> f64 {
        if self.buoyancy == 0.0 {
            self.whole.static_normal_force
        } else {
            self.weight_in_water
        }
    }

    /// Largest horizontal force on the base over the weight; `None` without weight.
    pub fn shear_coefficient(&self) -> Option<f64> {
        let weight = self.weight();
        (weight > 0.0).then(|| self.whole.horizontal_force.magnitude() / weight)
    }

    /// Writes the effective weight on the base, and under water the weight and the buoyancy.
    pub(super) fn write_weight(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = whole_body_unit("kN/m", self.in_plan);
        let weight = self.weight();
        if self.buoyancy == 0.0 && weight <= 0.0 {
            return Ok(());
        }
        if self.buoyancy == 0.0 {
            return writeln!(f, "Weight on the base: {:.1} {unit}", 1e-3 * weight);
        }
        let effective_kn = 1e-3 * (weight - self.buoyancy);
        writeln!(
            f,
            "Weight {:.1} {unit}, buoyancy {:.1} {unit}, factor of safety against flotation {}\n\
             Effective weight on the base: {effective_kn:.1} {unit}; pressures and factors of safety are effective",
            1e-3 * weight,
            1e-3 * self.buoyancy,
            safety_text(weight / self.buoyancy)
        )
    }
}
