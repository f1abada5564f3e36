//! Modulus reduction and damping curves computed from the backbone of a soil.

use std::f64::consts::{FRAC_2_PI, LN_10};

use super::strain_curves::StrainCurves;
use crate::error::{Result, at_least, positive, require};

/// Rows of the table in a decade of strain: interpolation between them errs by at most 0.2 %.
const ROWS_PER_DECADE: f64 = 20.0;
/// Upper limit, excluded, of the small-strain damping: with the largest Masing damping, 2/π, the ratio stays below one.
const MAX_SMALL_STRAIN_DAMPING: f64 = 0.3;
/// Largest strain of the table over the last strain of the backbone.
const MAX_STRAIN_RATIO: f64 = 10.0;

impl StrainCurves {
    /// Curves of a soil whose stress–strain loops follow Masing's rules on a backbone.
    ///
    /// `points`: shear strain (engineering) and shear stress (Pa) of the backbone, which is straight from the origin to the
    /// first point and between points, and constant beyond the last one. The
    /// [points of Iwan's model](crate::fem::Iwan::points) are such a backbone: a column of these curves is the
    /// equivalent-linear approximation of that material. With the area A under the backbone up to the strain γ and its
    /// stress τ, the damping ratio is `small_strain_damping` + (2/π)(2A/(γτ) − 1) (Kramer 1996, Geotechnical Earthquake
    /// Engineering, § 6.4.2). Soils have a small-strain damping of 0.005 to 0.02, which Masing's loops do not include.
    ///
    /// ```
    /// use basemat::soil::StrainCurves;
    ///
    /// // Elastic–perfectly plastic: at twice the yield strain the ratio is (2/π)(2·1.5/2 − 1) = 1/π.
    /// let curves = StrainCurves::masing(&[[0.001, 20.0e3]], 0.0)?;
    /// let [reduction, damping] = curves.at(0.002)?;
    /// assert!((reduction - 0.5).abs() < 2e-3);
    /// assert!((damping - std::f64::consts::FRAC_1_PI).abs() < 2e-3);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) without points; [`Error::Item`](crate::Error::Item) with the number of the point
    /// unless strains ascend from above zero and stresses are positive and finite;
    /// [`Error::Input`](crate::Error::Input) unless the small-strain damping is from 0 to below 0.3.
    pub fn masing(points: &[[f64; 2]], small_strain_damping: f64) -> Result<Self> {
        at_least("points of the backbone", points.len(), 1)?;
        let is_in_range = (0.0..MAX_SMALL_STRAIN_DAMPING).contains(&small_strain_damping);
        let quantity = "damping ratio of the soil at small strains";
        require(quantity, small_strain_damping, is_in_range, "from 0 to below 0.3")?;
        let mut previous_strain = 0.0;
        for (index, &[strain, stress]) in points.iter().enumerate() {
            positive("increase of the shear strain", strain - previous_strain)
                .and_then(|_| positive("shear stress", stress))
                .map_err(|error| error.within(format!("point {} of the backbone", index + 1)))?;
            previous_strain = strain;
        }
        let first_strain = points[0][0];
        let max_strain = MAX_STRAIN_RATIO * previous_strain;
        positive("range of the curves' strains", max_strain / first_strain)?;
        let decades = (max_strain / first_strain).ln() / LN_10;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let row_count = (decades * ROWS_PER_DECADE).ceil().max(1.0) as usize;
        let initial_modulus = points[0][1] / first_strain;
        let mut rows = vec![[first_strain, 1.0, small_strain_damping]];
        for row in 1..=row_count {
            let fraction = row as f64 / row_count as f64;
            let strain = first_strain * (max_strain / first_strain).powf(fraction);
            let (stress, area) = stress_and_area(points, strain);
            let damping = FRAC_2_PI * (2.0 * area / (strain * stress) - 1.0);
            let reduction = stress / (strain * initial_modulus);
            rows.push([strain, reduction, small_strain_damping + damping.max(0.0)]);
        }
        Ok(Self::Table(rows))
    }
}

/// Stress of a backbone at a strain (Pa), and the area below the backbone up to this strain (J/m³).
fn stress_and_area(points: &[[f64; 2]], strain: f64) -> (f64, f64) {
    let mut area = 0.0;
    let mut start_strain = 0.0;
    let mut start_stress = 0.0;
    for &[end_strain, end_stress] in points {
        if strain <= end_strain {
            let slope = (end_stress - start_stress) / (end_strain - start_strain);
            let stress = start_stress + slope * (strain - start_strain);
            area += 0.5 * (start_stress + stress) * (strain - start_strain);
            return (stress, area);
        }
        area += 0.5 * (start_stress + end_stress) * (end_strain - start_strain);
        start_strain = end_strain;
        start_stress = end_stress;
    }
    (start_stress, area + start_stress * (strain - start_strain))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Damping from areas: 4 τ (γ − γ_y) of the elastic–perfectly plastic loop, ½ τ γ of the secant's triangle.
    #[test]
    fn damping_is_the_area_of_the_loop() {
        let curves = StrainCurves::masing(&[[0.001, 20.0e3]], 0.01).unwrap();
        for strain in [0.0011_f64, 0.003, 0.009] {
            let values = curves.at(strain).unwrap();
            let exact_damping =
                0.01 + 4.0 * (strain - 0.001) / (4.0 * std::f64::consts::PI * 0.5 * strain);
            assert!(
                (values[1] - exact_damping).abs() < 3e-3,
                "{strain}: {values:?} {exact_damping}"
            );
            assert!((values[0] - 0.001 / strain).abs() < 3e-3);
        }
        assert_eq!(curves.at(0.0005).unwrap(), [1.0, 0.01]);
    }

    #[test]
    fn invalid_backbones_are_errors() {
        assert!(StrainCurves::masing(&[], 0.0).is_err());
        for points in [
            [[0.0, 1.0], [1.0, 2.0]],
            [[0.1, 1.0], [0.1, 2.0]],
            [[0.1, f64::NAN], [0.2, 2.0]],
            [[0.1, 1.0], [f64::INFINITY, 2.0]],
            [[0.1, 1.0], [f64::MAX, 2.0]],
        ] {
            assert!(StrainCurves::masing(&points, 0.0).is_err(), "{points:?}");
        }
    }
}
