//! Cross-sections of the benchmarks' beams.

use std::f64::consts::PI;

use basemat::Result;
use basemat::fem::BeamSection;

/// St Venant's torsion constant of a rectangle, m⁴: Timoshenko & Goodier, article 109.
fn torsion_constant(one: f64, other: f64) -> f64 {
    let (long, short) = (one.max(other), one.min(other));
    let sum: f64 = (0..20)
        .map(|k| f64::from(2 * k + 1))
        .map(|n| (0.5 * n * PI * long / short).tanh() / n.powi(5))
        .sum();
    long * short.powi(3) / 3.0 * (1.0 - 192.0 / PI.powi(5) * short / long * sum)
}

/// Rectangle with shear deformation, sides along the beam's y and z axes.
pub(super) fn rectangle(along_y: f64, along_z: f64) -> Result<BeamSection> {
    let area = along_y * along_z;
    let moments = [area * along_z * along_z / 12.0, area * along_y * along_y / 12.0];
    BeamSection::new(area, moments, torsion_constant(along_y, along_z))?
        .with_shear_areas([5.0 / 6.0 * area; 2])
}
