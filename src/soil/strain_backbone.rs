//! Backbones of yielding soil from strain curves.

use super::strain_curves::{ResolvedCurves, StrainCurves};
use crate::error::{Result, positive, require};
use crate::fem::Iwan;

/// Strains of the backbone's points for curves that are equations: four in each decade.
const BACKBONE_STRAINS: [f64; 17] = [
    1e-6, 1.778e-6, 3.162e-6, 5.623e-6, 1e-5, 1.778e-5, 3.162e-5, 5.623e-5, 1e-4, 1.778e-4,
    3.162e-4, 5.623e-4, 1e-3, 1.778e-3, 3.162e-3, 5.623e-3, 1e-2,
];

/// Largest deficit of a stress below a concave backbone, relative to the stress.
///
/// Published curves have deficits up to 0.0005, because their digits are rounded.
const CONCAVITY_TOLERANCE: f64 = 1e-3;

impl StrainCurves {
    /// Soil for finite elements that yields along these curves, up to a strength.
    ///
    /// `shear_modulus`: G_max, Pa. `strength`: largest shear stress, Pa. `poisson` and `density` (kg/m³) are those of
    /// [`Iwan::new`]. The backbone τ = G_max (G/G_max) γ passes through the points of the curves (Darendeli's: 17 strains
    /// from 10⁻⁶ to 1 %) and is straight between them. It ends where it reaches the strength. Curves that end below the
    /// strength are continued with their last slope. The damping curves are not used: damping follows from Masing's rules.
    ///
    /// ```
    /// use basemat::soil::StrainCurves;
    /// let curves = StrainCurves::VuceticDobry { plasticity_index: 30.0 };
    /// let clay = curves.iwan(45.6e6, 40.0e3, 0.49, 1900.0)?;
    /// assert_eq!((clay.shear_modulus().round(), clay.strength()), (45.6e6, 40.0e3));
    /// // G/G_max = 0.53 at 0.1 %; the strength is reached at 0.23 %.
    /// let [.., point, limit] = clay.points() else { panic!() };
    /// assert!((point[0] - 1.0e-3).abs() < 1e-15 && (point[1] - 24.168e3).abs() < 1e-9);
    /// assert!((limit[0] - 2.302e-3).abs() < 1e-6);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless G_max and the strength are positive and the curves rise up to the
    /// strength; errors of [`StrainCurves::at`]; and those of [`Iwan::new`], with the number of the point, for stresses
    /// that descend or are more than 0.1 % below a concave backbone.
    pub fn iwan(
        &self,
        shear_modulus: f64,
        strength: f64,
        poisson: f64,
        density: f64,
    ) -> Result<Iwan> {
        positive("shear modulus of the soil (Pa)", shear_modulus)?;
        positive("shear strength of the soil (Pa)", strength)?;
        let curves = self.resolved()?;
        let strains = match &curves {
            // Linear soil has a single row at an infinite strain.
            ResolvedCurves::Rows(rows) => rows.iter().map(|row| row[0]).collect(),
            ResolvedCurves::Darendeli { .. } => BACKBONE_STRAINS.to_vec(),
        };
        let mut points = Vec::with_capacity(strains.len() + 1);
        for strain in strains.into_iter().filter(|strain| strain.is_finite()) {
            let reduction = curves.at(strain)[0];
            add_concave(&mut points, [strain, shear_modulus * reduction * strain]);
        }
        end_at_strength(&mut points, shear_modulus, strength)?;
        Iwan::new(&points, poisson, density)
    }
}

/// Adds a point, and removes preceding points that are below a concave curve by no more than the tolerance.
fn add_concave(points: &mut Vec<[f64; 2]>, point: [f64; 2]) {
    while let Some(&last_point) = points.last() {
        let start = points.len().checked_sub(2).map_or([0.0; 2], |index| points[index]);
        let fraction = (last_point[0] - start[0]) / (point[0] - start[0]);
        let chord_stress = start[1] + fraction * (point[1] - start[1]);
        let excess = chord_stress / last_point[1] - 1.0;
        if !(excess > 0.0 && excess <= CONCAVITY_TOLERANCE) {
            break;
        }
        points.pop();
    }
    points.push(point);
}

/// Ends a backbone at a strength: cuts it, or continues its last slope.
fn end_at_strength(points: &mut Vec<[f64; 2]>, shear_modulus: f64, strength: f64) -> Result<()> {
    if let Some(index) = points.iter().position(|point| point[1] >= strength) {
        points.truncate(index + 1);
    } else if let [.., start, end] = points[..] {
        let slope = (end[1] - start[1]) / (end[0] - start[0]);
        // The constructor of the model returns an error for a descending curve, with the number of the point.
        if slope < 0.0 {
            return Ok(());
        }
        let needed = "at most the stress at which the curves end, because they end without a slope";
        require("shear strength of the soil (Pa)", strength, slope > 0.0, needed)?;
        points.push([end[0] + (strength - end[1]) / slope, strength]);
        return Ok(());
    } else {
        // One point or none: the soil is linear up to its strength.
        let slope = points.last().map_or(shear_modulus, |point| point[1] / point[0]);
        *points = vec![[strength / slope, strength]];
        return Ok(());
    }
    let last_index = points.len() - 1;
    let end = points[last_index];
    let start = last_index.checked_sub(1).map_or([0.0; 2], |index| points[index]);
    let fraction = (strength - start[1]) / (end[1] - start[1]);
    points[last_index] = [start[0] + fraction * (end[0] - start[0]), strength];
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Linear interpolation between the points of a backbone.
    fn stress_at(points: &[[f64; 2]], strain: f64) -> f64 {
        let index = points.iter().position(|point| strain <= point[0]).unwrap();
        let start = if index == 0 { [0.0; 2] } else { points[index - 1] };
        let fraction = (strain - start[0]) / (points[index][0] - start[0]);
        start[1] + fraction * (points[index][1] - start[1])
    }

    /// Backbones of all published curves pass within 0.1 % of G γ (G/G_max) below their strength.
    #[test]
    fn backbones_follow_published_curves() {
        let mut all_curves = vec![StrainCurves::SeedIdrissMean, StrainCurves::SeedIdrissUpper];
        for plasticity_index in [0.0, 15.0, 21.0, 30.0, 77.0, 200.0] {
            all_curves.push(StrainCurves::VuceticDobry { plasticity_index });
        }
        for depth in [3.0, 10.0, 30.0, 60.0, 100.0, 200.0] {
            all_curves.push(StrainCurves::Epri { depth });
        }
        all_curves.push(StrainCurves::Darendeli {
            plasticity_index: 20.0,
            overconsolidation: 2.0,
            mean_stress: 80.0e3,
            frequency: 1.0,
            cycles: 10.0,
        });
        for curves in all_curves {
            let clay = curves.iwan(50.0e6, 17.0e3, 0.45, 1800.0).unwrap();
            assert_eq!(clay.strength(), 17.0e3);
            for strain in [1e-6, 1e-5, 1e-4] {
                let expected = 50.0e6 * strain * curves.at(strain).unwrap()[0];
                let stress = stress_at(clay.points(), strain);
                assert!((stress / expected - 1.0).abs() < 1e-3, "{curves:?} at {strain}");
            }
        }
    }

    #[test]
    fn curves_end_at_the_strength() {
        let rows = vec![[1e-4, 1.0, 0.01], [1e-3, 0.5, 0.1], [1e-2, 0.1, 0.2]];
        let table = StrainCurves::Table(rows);
        let limit = |strength: f64| {
            table.iwan(1.0e8, strength, 0.3, 0.0).map(|clay| *clay.points().last().unwrap())
        };
        // τ is 10, 50 and 100 kPa at the rows.
        for (strength, strain) in
            [(5.0e3, 5e-5), (10.0e3, 1e-4), (30.0e3, 5.5e-4), (75.0e3, 5.5e-3)]
        {
            let [limit_strain, limit_stress] = limit(strength).unwrap();
            assert!((limit_strain / strain - 1.0).abs() < 1e-12 && limit_stress == strength);
        }
        let limit_strain = limit(120.0e3).unwrap()[0];
        assert!((limit_strain - (1e-2 + 20.0e3 * 9e-3 / 50.0e3)).abs() < 1e-12);
        let linear_soil =
            StrainCurves::Linear { damping: 0.02 }.iwan(1.0e8, 5.0e4, 0.3, 0.0).unwrap();
        assert_eq!(linear_soil.points(), [[5e-4, 5.0e4]]);
    }

    #[test]
    fn curves_without_a_backbone_are_errors() {
        let convex =
            vec![[1e-4, 0.5, 0.01], [1e-3, 0.5, 0.1], [2e-3, 0.48, 0.2], [3e-3, 0.475, 0.2]];
        let descending = vec![[1e-4, 1.0, 0.01], [1e-3, 0.5, 0.1], [1e-2, 0.01, 0.2]];
        let flat_rows = vec![[1e-4, 1.0, 0.01], [1e-3, 0.5, 0.1], [1e-2, 0.05, 0.2]];
        for (rows, part) in [
            (convex, "point 4 of the backbone: slope up to the point"),
            (descending, "point 3 of the backbone: shear stress (Pa) is 10000"),
            (
                flat_rows,
                "shear strength of the soil (Pa) is 2000000, but must be at most the stress",
            ),
        ] {
            let text =
                StrainCurves::Table(rows).iwan(1.0e8, 2.0e6, 0.3, 0.0).unwrap_err().to_string();
            assert!(text.contains(part), "{text}");
        }
        let curves = StrainCurves::SeedIdrissMean;
        for invalid_value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(curves.iwan(invalid_value, 1.0e4, 0.3, 0.0).is_err());
            assert!(curves.iwan(1.0e8, invalid_value, 0.3, 0.0).is_err());
        }
        assert!(curves.iwan(1.0e8, 1.0e4, 0.5, 0.0).is_err());
        assert!(StrainCurves::Table(vec![]).iwan(1.0e8, 1.0e4, 0.3, 0.0).is_err());
    }
}
