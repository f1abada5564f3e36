//! Straight beam or column.

use super::element::{Element, MassKind};
use super::line::Line;
use crate::error::{Result, finite, not_negative, positive};
use crate::geometry::{Direction, FRAME};
use crate::linalg::gauss;

/// Straight prismatic beam between two nodes that rotate with it.
///
/// Euler–Bernoulli with axial deformation; [`with_shear_stiffness`](Beam::with_shear_stiffness) makes it a
/// Timoshenko beam. Exact for loads at the nodes (Przemieniecki, Theory of Matrix Structural Analysis, 1968,
/// ch. 5). Rotary inertia of the cross-section is included only with
/// [`with_rotary_inertia`](Beam::with_rotary_inertia). The P–Δ effect of an axial force is included only if
/// [`with_compression`](Beam::with_compression) gives the force or
/// [`FemModel::with_p_delta`](crate::structure::FemModel::with_p_delta) computes it. Quadrilaterals do not
/// restrain the rotation of their nodes: a beam that ends on a quadrilateral is hinged there, unless it
/// continues along the edge of a second one.
///
/// ```
/// use basemat::fem::{Beam, Element};
///
/// let beam = Beam::new([0, 1], 30.0e9, 0.5, 0.01, 2400.0)?;
/// let mut stiffness = vec![0.0; 36];
/// beam.stiffness(&[[0.0; 3], [0.0, 10.0, 0.0]], &mut stiffness);
/// assert!((stiffness[0] - 12.0 * 30.0e9 * 0.01 / 1000.0).abs() < 1e-6); // 12 EI/L³ sideways
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Beam {
    nodes: [usize; 2],
    axial_stiffness: f64,
    bending_stiffness: f64,
    shear_stiffness: Option<f64>,
    mass_per_length: f64,
    /// ρ I, kg m.
    section_inertia: f64,
    has_rotary_inertia: bool,
    /// Mean axial force for P–Δ, N; its excess at the first node over the second node, N; and whether the user gave it.
    ///
    /// A static state does not change a force that the user gave.
    compression: f64,
    taper: f64,
    is_given: bool,
}

impl Beam {
    /// Beam with Young's modulus (Pa), area (m²), second moment of area (m⁴) and density (kg/m³).
    ///
    /// Area and second moment are per metre of thickness.
    ///
    /// A plate strip in plane strain has E/(1−ν²) in place of E.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless all are positive; the density may be zero.
    pub fn new(
        nodes: [usize; 2],
        young_modulus: f64,
        area: f64,
        second_moment: f64,
        density: f64,
    ) -> Result<Self> {
        positive("Young's modulus of the beam", young_modulus)?;
        positive("area of the beam", area)?;
        positive("second moment of area of the beam", second_moment)?;
        not_negative("density of the beam", density)?;
        Ok(Self {
            nodes,
            axial_stiffness: positive("axial stiffness of the beam", young_modulus * area)?,
            bending_stiffness: positive("bending stiffness", young_modulus * second_moment)?,
            shear_stiffness: None,
            mass_per_length: not_negative("mass per length of the beam", density * area)?,
            section_inertia: not_negative("inertia of the section", density * second_moment)?,
            has_rotary_inertia: false,
            compression: 0.0,
            taper: 0.0,
            is_given: false,
        })
    }

    /// Adds shear deformation; `shear_stiffness` is G times the shear area, N.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless it is positive.
    pub fn with_shear_stiffness(self, shear_stiffness: f64) -> Result<Self> {
        let shear_stiffness = Some(positive("shear stiffness of the beam", shear_stiffness)?);
        Ok(Self { shear_stiffness, ..self })
    }

    /// Adds the rotary inertia ρ I of the cross-section: with shear stiffness,
    /// Timoshenko's beam in full.
    #[must_use]
    pub fn with_rotary_inertia(self) -> Self {
        Self { has_rotary_inertia: true, ..self }
    }

    /// Makes the beam a beam–column with the constant axial force `compression`, N (negative for tension).
    ///
    /// The force P adds −½ P ∫ w′² dx to the potential energy, where w is the lateral displacement (P–Δ and
    /// P–δ). It is the force of the static state, for example the weight above. A force given here stays when
    /// [`FemModel::with_p_delta`](crate::structure::FemModel::with_p_delta) computes the forces of the other
    /// elements. The beam then resists a rigid rotation with the moment of its offset end forces, as a real
    /// column does.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless it is finite.
    pub fn with_compression(self, compression: f64) -> Result<Self> {
        let compression = finite("axial force of the beam", compression)?;
        Ok(Self { compression, taper: 0.0, is_given: true, ..self })
    }

    /// `Φ = 12 EI/(G A_s L²)`, the ratio of shear to bending flexibility.
    fn shear_ratio(&self, length: f64) -> f64 {
        self.shear_stiffness.map_or(0.0, |k| 12.0 * self.bending_stiffness / (k * length * length))
    }

    /// Deflection across the beam at s = x/L due to unit end displacements and rotations.
    fn deflection(ratio: f64, length: f64, s: f64) -> [f64; 6] {
        let t = 1.0 - s;
        let scale = 1.0 / (1.0 + ratio);
        let near = |s: f64, t: f64| scale * t * (1.0 + s - 2.0 * s * s + ratio);
        let turn = |s: f64, t: f64| scale * length * s * t * (t + 0.5 * ratio);
        [0.0, near(s, t), turn(s, t), 0.0, near(t, s), -turn(t, s)]
    }

    /// Slope of the deflection along the beam, 1/m.
    fn slope(ratio: f64, length: f64, s: f64) -> [f64; 6] {
        let t = 1.0 - s;
        let scale = 1.0 / (length * (1.0 + ratio));
        let near = |s: f64, t: f64| scale * (t * (1.0 - 4.0 * s) - (1.0 + s - 2.0 * s * s + ratio));
        let turn = |s: f64, t: f64| scale * length * ((t - s) * (t + 0.5 * ratio) - s * t);
        [0.0, near(s, t), turn(s, t), 0.0, -near(t, s), turn(t, s)]
    }

    /// Rotation of the section, rad: the slope without the shear strain (Friedman & Kosmatka 1993).
    fn rotation(ratio: f64, length: f64, s: f64) -> [f64; 6] {
        let t = 1.0 - s;
        let scale = 1.0 / (1.0 + ratio);
        let side = 6.0 * scale * s * t / length;
        let turn = |s: f64, t: f64| scale * t * (t - 2.0 * s + ratio);
        [0.0, -side, turn(s, t), 0.0, side, turn(t, s)]
    }
}

impl Element for Beam {
    fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    fn directions(&self) -> &[Direction] {
        FRAME
    }

    fn stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        let Some(line) = Line::between(coordinates) else { return };
        let length = line.length;
        let ratio = self.shear_ratio(length);
        let a = self.axial_stiffness / length;
        let k = self.bending_stiffness / (length.powi(3) * (1.0 + ratio));
        let side = 12.0 * k;
        let turn = 6.0 * k * length;
        let own = (4.0 + ratio) * k * length * length;
        let far = (2.0 - ratio) * k * length * length;
        let local = [
            [a, 0.0, 0.0, -a, 0.0, 0.0],
            [0.0, side, turn, 0.0, -side, turn],
            [0.0, turn, own, 0.0, -turn, far],
            [-a, 0.0, 0.0, a, 0.0, 0.0],
            [0.0, -side, -turn, 0.0, side, -turn],
            [0.0, turn, far, 0.0, -turn, own],
        ];
        line.add_rotated(&local, matrix);
    }

    fn geometric_stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        let Some(line) = Line::between(coordinates) else { return };
        if self.compression != 0.0 || self.taper != 0.0 {
            let ratio = self.shear_ratio(line.length);
            let mut local = [[0.0; 6]; 6];
            for (place, weight) in gauss::rule(4).points_on_unit_interval() {
                let slope = Self::slope(ratio, line.length, place);
                let force = self.compression + self.taper * (0.5 - place);
                add_outer(-force * line.length * weight, &slope, &mut local);
            }
            line.add_rotated(&local, matrix);
        }
    }

    fn in_static_state(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        gravity: f64,
    ) -> Option<Box<dyn Element>> {
        let (Some(line), &[x0, y0, _, x1, y1, _]) = (Line::between(coordinates), displacement)
        else {
            return None;
        };
        if self.is_given {
            return None;
        }
        let lengthening = line.lengthening([x0, y0], [x1, y1]);
        // Displacements of the nodes are exact, so the compression is the mean over the length. The element's
        // own weight makes it vary between the nodes.
        let rise = coordinates[1][1] - coordinates[0][1];
        Some(Box::new(Self {
            compression: -self.axial_stiffness / line.length * lengthening,
            taper: self.mass_per_length * gravity * rise,
            ..self.clone()
        }))
    }

    fn compression(&self) -> Option<f64> {
        Some(self.compression)
    }

    /// Lumped: half the mass at each node, with the rotary inertia m L²/78, which keeps the ratio of the
    /// consistent diagonal (Hinton, Rock & Zienkiewicz, 1976), and half of the rotary inertia of the
    /// sections.
    fn mass(&self, coordinates: &[[f64; 3]], kind: MassKind, matrix: &mut [f64]) {
        let Some(line) = Line::between(coordinates) else { return };
        let length = line.length;
        let mass = self.mass_per_length * length;
        let mut local = [[0.0; 6]; 6];
        if kind == MassKind::Lumped {
            let own =
                if self.has_rotary_inertia { 0.5 * self.section_inertia * length } else { 0.0 };
            let turn = mass * length * length / 78.0 + own;
            for (i, value) in [0.5 * mass, 0.5 * mass, turn].into_iter().enumerate() {
                local[i][i] = value;
                local[i + 3][i + 3] = value;
            }
            return line.add_rotated(&local, matrix);
        }
        let ratio = self.shear_ratio(length);
        // Four points: exact for products of two cubics.
        for (place, weight) in gauss::rule(4).points_on_unit_interval() {
            let across = Self::deflection(ratio, length, place);
            let along = [1.0 - place, 0.0, 0.0, place, 0.0, 0.0];
            add_outer(mass * weight, &across, &mut local);
            add_outer(mass * weight, &along, &mut local);
            if self.has_rotary_inertia {
                let turned = Self::rotation(ratio, length, place);
                add_outer(self.section_inertia * length * weight, &turned, &mut local);
            }
        }
        line.add_rotated(&local, matrix);
    }

    /// [`Error::Input`](crate::Error::Input) when the two nodes coincide.
    fn check(&self, coordinates: &[[f64; 3]]) -> Result<()> {
        Line::check("length of the beam", coordinates)
    }
}

/// Adds factor · l lᵀ.
fn add_outer(factor: f64, row: &[f64; 6], matrix: &mut [[f64; 6]; 6]) {
    for (entries, a) in matrix.iter_mut().zip(row) {
        for (entry, b) in entries.iter_mut().zip(row) {
            *entry += factor * a * b;
        }
    }
}
