//! Pressure of walls on soil without a passive limit.

use crate::coupled::Warning;
use crate::coupled::run::envelope::ElementEnvelope;
use crate::coupled::scene::Scene;
use crate::coupled::statics::strength::InterfaceStrength;
use crate::geometry::ContactElement;
use crate::interface::LawForm;

/// Passive over vertical pressure of soil with a friction angle of 45°: tan²(67.5°).
const STRONG_SOIL_PRESSURE_RATIO: f64 = 5.828_427_124_746_19;
/// Fraction of a wall's thrust beyond the passive limit, above which a run warns.
const EXCESS_FRACTION_LIMIT: f64 = 0.1;

/// Pressure of the soil above the middle of each element, Pa.
///
/// Empty without walls or weight.
///
/// `masses`: mean mass of the soil above each element, kg/m². The pressure is infinite for elements of the base, and for
/// elements whose law has a largest pressure: these are not checked.
pub(crate) fn pressures_above(scene: &Scene, masses: &[f64], gravity: f64) -> Vec<f64> {
    let elements = scene.base.elements();
    if masses.len() != elements.len() || gravity == 0.0 || !elements.has_walls() {
        return Vec::new();
    }
    let mut pressures = Vec::with_capacity(masses.len());
    for (element, mass) in masses.iter().enumerate() {
        let law = scene.law(element);
        let is_unlimited_wall = !elements[element].faces_down()
            && !InterfaceStrength::at_pressure(law, gravity * mass, LawForm::Modes, false)
                .bearing_pressure
                .is_finite();
        pressures.push(if is_unlimited_wall { gravity * mass } else { f64::INFINITY });
    }
    pressures
}

/// Warning of a wall that presses beyond the passive pressure of strong soil.
///
/// It names the wall with the largest fraction of its thrust beyond that pressure.
///
/// `pressures_above`: as returned by [`pressures_above`].
pub(crate) fn wall_warning(
    envelope: &[ElementEnvelope],
    pressures_above: &[f64],
) -> Option<Warning> {
    if pressures_above.is_empty() {
        return None;
    }
    let elements: Vec<ContactElement> = envelope.iter().map(|envelope| envelope.element).collect();
    let faces = ContactElement::faces(&elements);
    let mut warning = None;
    let mut largest_fraction = EXCESS_FRACTION_LIMIT;
    for wall in [faces.left_wall, faces.right_wall] {
        let mut excess_force = 0.0;
        let mut thrust = 0.0;
        let mut largest_force = 0.0;
        let mut critical_element = wall.start;
        for e in wall {
            let pressure = envelope[e].pressure.highest.value;
            let area = elements[e].area();
            let force =
                area * (pressure - STRONG_SOIL_PRESSURE_RATIO * pressures_above[e]).max(0.0);
            excess_force += force;
            thrust += area * pressure;
            if force > largest_force {
                largest_force = force;
                critical_element = e;
            }
        }
        if excess_force > largest_fraction * thrust {
            largest_fraction = excess_force / thrust;
            let center = elements[critical_element].center();
            let peak = envelope[critical_element].pressure.highest;
            warning = Some(Warning::WallPressure {
                pressure: peak.value,
                above: pressures_above[critical_element],
                x: center[0],
                z: center[2],
                time: peak.time,
            });
        }
    }
    warning
}
