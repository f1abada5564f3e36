//! Yield surface of axial force and moment.

use std::f64::consts::TAU;

use super::convex_set::{ClosestPoint, ConvexSet};
use super::ellipse::Ellipse;
use super::parabola::DoubleParabola;
use super::polygon::{Polygon, difference};
use crate::error::{Result, at_least, first_not_finite, positive, require, require_part};
use crate::geometry::cross_in_plane;

/// Sine of the angle by which rounding may bend a straight corner of a polygon inwards.
const MAX_INWARD_SINE: f64 = 1e-12;
/// Largest error of the sum of all angles seen from zero.
const MAX_ANGLE_ERROR: f64 = 1e-6;

/// Axial forces N (tension is positive) and moments M that a section can carry together: a convex set about zero.
///
/// ```
/// use basemat::fem::AxialMomentSurface;
///
/// // A rectangle 0.3 m wide and 0.5 m deep of steel with 235 MPa.
/// let [width, depth, strength] = [0.3, 0.5, 235.0e6];
/// let axial_strength = width * depth * strength;
/// let plastic_moment = width * depth * depth / 4.0 * strength;
/// let surface = AxialMomentSurface::rectangle(axial_strength, plastic_moment)?;
/// // Under half of the axial strength the plastic moment is three quarters.
/// let moment = surface.moments_at(-0.5 * axial_strength).unwrap();
/// assert!((moment[1] / plastic_moment - 0.75).abs() < 1e-12);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct AxialMomentSurface(Outline);

/// Boundary of the set; also in coordinates that are scaled along the axes.
#[derive(Debug, Clone, PartialEq)]
enum Outline {
    Ellipse(Ellipse<2>),
    Parabolas(DoubleParabola),
    Polygon(Polygon),
}

/// Returns both strengths, or an error unless they are positive.
fn strengths(axial_strength: f64, plastic_moment: f64) -> Result<[f64; 2]> {
    Ok([
        positive("axial strength of the hinge", axial_strength)?,
        positive("plastic moment of the hinge", plastic_moment)?,
    ])
}

impl AxialMomentSurface {
    /// Rectangular section of a ductile material: |M|/M_p + (N/N_p)² ≤ 1.
    ///
    /// `axial_strength`: N_p, N. `plastic_moment`: M_p, N m. In the plane both are per metre of thickness.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless both are positive.
    pub fn rectangle(axial_strength: f64, plastic_moment: f64) -> Result<Self> {
        let semi_axes = strengths(axial_strength, plastic_moment)?;
        Ok(Self(Outline::Parabolas(DoubleParabola { semi_axes })))
    }

    /// Ellipse: (M/M_p)² + (N/N_p)² ≤ 1.
    ///
    /// `axial_strength`: N_p, N. `plastic_moment`: M_p, N m. In the plane both are per metre of thickness.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless both are positive.
    pub fn ellipse(axial_strength: f64, plastic_moment: f64) -> Result<Self> {
        let semi_axes = strengths(axial_strength, plastic_moment)?;
        Ok(Self(Outline::Ellipse(Ellipse { semi_axes })))
    }

    /// Convex polygon with these corners [N, M] (N, N m) around zero, in either sense.
    ///
    /// In the plane both are per metre of thickness. Reinforced concrete has most of its area at N < 0.
    ///
    /// ```
    /// use basemat::fem::AxialMomentSurface;
    ///
    /// // A column of concrete: 1 MN in tension, 6 MN in compression, 900 kN m at 2.5 MN of compression.
    /// let upper_half = [[1.0e6, 0.0], [0.0, 500.0e3], [-2.5e6, 900.0e3], [-6.0e6, 0.0]];
    /// let lower_half = [[-2.5e6, -900.0e3], [0.0, -500.0e3]];
    /// let surface = AxialMomentSurface::polygon(&[&upper_half[..], &lower_half].concat())?;
    /// assert_eq!(surface.moments_at(-1.25e6), Some([-700.0e3, 700.0e3]));
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for fewer than three corners, [`Error::Item`](crate::Error::Item) with the
    /// number of a corner that is not finite or bends inwards, [`Error::Scene`](crate::Error::Scene) unless the polygon
    /// goes around zero once, with zero inside.
    pub fn polygon(corners: &[[f64; 2]]) -> Result<Self> {
        at_least("corners of the yield surface", corners.len(), 3)?;
        let item = |index: usize| format!("corner {} of the yield surface", index + 1);
        if let Some((index, value)) = first_not_finite(corners.as_flattened()) {
            require("N or M", value, false, "finite")
                .map_err(|fault| fault.within(item(index / 2)))?;
        }
        // Signs of areas, and angles, relative to the largest N and M.
        let largest = [0, 1].map(|k| corners.iter().fold(0.0_f64, |max, c| max.max(c[k].abs())));
        for value in largest {
            positive("largest N or M of the yield surface", value)?;
        }
        let unit_corners: Vec<[f64; 2]> =
            corners.iter().map(|corner| [0, 1].map(|k| corner[k] / largest[k])).collect();
        let unit_polygon = Polygon { corners: unit_corners };
        let angles = unit_polygon.sides().map(|[start, end]| {
            cross_in_plane(start, end).atan2(start[0] * end[0] + start[1] * end[1])
        });
        let total_angle: f64 = angles.sum();
        let is_once_around = (total_angle.abs() - TAU).abs() < MAX_ANGLE_ERROR;
        let needed = "a polygon once around N = 0, M = 0";
        require_part("yield surface of the hinge", is_once_around, needed)?;
        let sense = total_angle.signum();
        let sides: Vec<[[f64; 2]; 2]> = unit_polygon.sides().collect();
        for (index, [start, end]) in sides.iter().enumerate() {
            let along = difference(*end, *start);
            let before = sides[(index + sides.len() - 1) % sides.len()];
            let along_before = difference(before[1], before[0]);
            let lengths = along[0].hypot(along[1]) * along_before[0].hypot(along_before[1]);
            let bend = sense * cross_in_plane(along_before, along) / lengths;
            require(
                "sine of the outward bend",
                bend,
                bend >= -MAX_INWARD_SINE,
                "not negative (a convex polygon)",
            )
            .map_err(|fault| fault.within(item(index)))?;
            let surrounds_zero = sense * cross_in_plane(*start, *end) > 0.0;
            require_part("yield surface of the hinge", surrounds_zero, needed)?;
        }
        let mut corners = corners.to_vec();
        if sense < 0.0 {
            corners.reverse();
        }
        Ok(Self(Outline::Polygon(Polygon { corners })))
    }

    /// Least and largest moment (N m) beside an axial force (N); `None` for a force beyond the strength.
    pub fn moments_at(&self, axial_force: f64) -> Option<[f64; 2]> {
        match &self.0 {
            Outline::Ellipse(Ellipse { semi_axes: [strength, plastic_moment] }) => {
                let ratio = axial_force / strength;
                let moment = plastic_moment * (1.0 - ratio * ratio).sqrt();
                (ratio.abs() <= 1.0).then_some([-moment, moment])
            }
            Outline::Parabolas(DoubleParabola { semi_axes: [strength, plastic_moment] }) => {
                let ratio = axial_force / strength;
                let moment = plastic_moment * (1.0 - ratio * ratio);
                (ratio.abs() <= 1.0).then_some([-moment, moment])
            }
            Outline::Polygon(polygon) => {
                let mut range: Option<[f64; 2]> = None;
                for [[n0, m0], [n1, m1]] in polygon.sides() {
                    if !(n0.min(n1)..=n0.max(n1)).contains(&axial_force) {
                        continue;
                    }
                    // A side of one axial force has all moments between its ends.
                    let moments = if n0 == n1 {
                        [m0, m1]
                    } else {
                        [m0 + (axial_force - n0) / (n1 - n0) * (m1 - m0); 2]
                    };
                    for moment in moments {
                        let bounds = range.get_or_insert([moment; 2]);
                        bounds[0] = bounds[0].min(moment);
                        bounds[1] = bounds[1].max(moment);
                    }
                }
                range
            }
        }
    }

    /// The set with both forces times their factors.
    pub(super) fn scaled(&self, factors: [f64; 2]) -> Self {
        let scale = |forces: [f64; 2]| [0, 1].map(|k| factors[k] * forces[k]);
        Self(match &self.0 {
            Outline::Ellipse(set) => Outline::Ellipse(Ellipse { semi_axes: scale(set.semi_axes) }),
            Outline::Parabolas(set) => {
                Outline::Parabolas(DoubleParabola { semi_axes: scale(set.semi_axes) })
            }
            Outline::Polygon(set) => {
                let corners = set.corners.iter().map(|corner| scale(*corner)).collect();
                Outline::Polygon(Polygon { corners })
            }
        })
    }
}

impl ConvexSet<2> for AxialMomentSurface {
    fn closest_point(&self, trial: &[f64; 2]) -> Option<ClosestPoint<2>> {
        match &self.0 {
            Outline::Ellipse(set) => set.closest_point(trial),
            Outline::Parabolas(set) => set.closest_point(trial),
            Outline::Polygon(set) => set.closest_point(trial),
        }
    }
}
