//! Stiffness of a shell's section per metre of width.

use super::resultants::ShellResultants;
use crate::fem::material::Material;
use crate::fem::vector::dot;

/// Shear correction factor κ: ratio of the shear area to the area of a rectangular section.
const SHEAR_CORRECTION: f64 = 5.0 / 6.0;

/// Section of an isotropic shell in plane stress.
pub(super) struct ShellSection {
    /// Plane-stress matrix D, Pa.
    pub(super) elasticity: [[f64; 3]; 3],
    /// Shear modulus G, Pa.
    pub(super) shear_modulus: f64,
    /// Poisson's ratio ν.
    pub(super) poisson: f64,
    /// Thickness t, m.
    pub(super) thickness: f64,
}

impl ShellSection {
    /// Section with a `material` and a `thickness` (m).
    pub(super) fn new(material: &Material, thickness: f64) -> Self {
        Self {
            elasticity: material.plane_stress(),
            shear_modulus: material.shear_modulus(),
            poisson: material.poisson(),
            thickness,
        }
    }

    /// Membrane stiffness D t (N/m), which gives `[n_xx, n_yy, n_xy]` from the strains `[ε_xx, ε_yy, γ_xy]`.
    pub(super) fn membrane_stiffness(&self) -> [[f64; 3]; 3] {
        self.elasticity.map(|row| row.map(|modulus| modulus * self.thickness))
    }

    /// Bending stiffness D t³/12, N m.
    pub(super) fn bending_stiffness(&self) -> [[f64; 3]; 3] {
        let factor = self.thickness.powi(3) / 12.0;
        self.elasticity.map(|row| row.map(|modulus| modulus * factor))
    }

    /// Shear stiffness κ G t, N/m.
    pub(super) fn shear_stiffness(&self) -> f64 {
        SHEAR_CORRECTION * self.shear_modulus * self.thickness
    }

    /// Bending and shear stiffness for the strains `[κ_xx, κ_yy, 2κ_xy, γ_x, γ_y]`.
    pub(super) fn plate_stiffness(&self) -> [[f64; 5]; 5] {
        let mut stiffness = [[0.0; 5]; 5];
        for (row, bending_row) in stiffness.iter_mut().zip(self.bending_stiffness()) {
            row[..3].copy_from_slice(&bending_row);
        }
        for axis in 3..5 {
            stiffness[axis][axis] = self.shear_stiffness();
        }
        stiffness
    }

    /// Resultants at N corners from the strains of membrane and plate.
    ///
    /// `membrane_strains`: `[ε_11, ε_22, γ_12]`; `plate_strains`: `[κ_11, κ_22, 2κ_12, γ_1, γ_2]`; `axes`: axes of the
    /// element.
    pub(super) fn resultants<const N: usize>(
        &self,
        axes: [[f64; 3]; 3],
        membrane_strains: &[[f64; 3]; N],
        plate_strains: &[[f64; 5]; N],
    ) -> Vec<ShellResultants> {
        let mut resultants = Vec::with_capacity(N);
        for (membrane_strain, &[kappa_11, kappa_22, twist, shear_strains @ ..]) in
            membrane_strains.iter().zip(plate_strains)
        {
            resultants.push(ShellResultants {
                axes,
                membrane: self.membrane_stiffness().map(|row| dot(row, *membrane_strain)),
                moments: self.bending_stiffness().map(|row| -dot(row, [kappa_11, kappa_22, twist])),
                shears: shear_strains.map(|strain| self.shear_stiffness() * strain),
            });
        }
        resultants
    }
}
