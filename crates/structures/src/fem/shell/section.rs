//! Stiffness of a shell's section per unit of width.

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
    /// Section of a `material` and a `thickness`, m.
    pub(super) fn new(material: &Material, thickness: f64) -> Self {
        Self {
            elasticity: material.plane_stress(),
            shear_modulus: material.shear_modulus(),
            poisson: material.poisson(),
            thickness,
        }
    }

    /// Membrane forces `[n_xx, n_yy, n_xy]`, N/m, by the strains `[ε_xx, ε_yy, γ_xy]`.
    pub(super) fn membrane(&self) -> [[f64; 3]; 3] {
        self.elasticity.map(|row| row.map(|modulus| modulus * self.thickness))
    }

    /// Bending stiffness D t³/12, Nm.
    pub(super) fn bending(&self) -> [[f64; 3]; 3] {
        let factor = self.thickness.powi(3) / 12.0;
        self.elasticity.map(|row| row.map(|modulus| modulus * factor))
    }

    /// Shear stiffness κ G t, N/m.
    pub(super) fn shear(&self) -> f64 {
        SHEAR_CORRECTION * self.shear_modulus * self.thickness
    }

    /// Bending and shear stiffness for the strains `[κ_xx, κ_yy, 2κ_xy, γ_x, γ_y]`.
    pub(super) fn bending_and_shear(&self) -> [[f64; 5]; 5] {
        let mut moduli = [[0.0; 5]; 5];
        for (row, bending) in moduli.iter_mut().zip(self.bending()) {
            row[..3].copy_from_slice(&bending);
        }
        for axis in 3..5 {
            moduli[axis][axis] = self.shear();
        }
        moduli
    }

    /// Resultants at N corners due to the strains of membrane and plate.
    ///
    /// `membrane`: `[ε_11, ε_22, γ_12]`; `bending`: `[κ_11, κ_22, 2κ_12, γ_1, γ_2]`.
    pub(super) fn resultants<const N: usize>(
        &self,
        axes: [[f64; 3]; 3],
        membrane: &[[f64; 3]; N],
        bending: &[[f64; 5]; N],
    ) -> Vec<ShellResultants> {
        let mut resultants = Vec::with_capacity(N);
        for (strain, &[first, second, twist, shears @ ..]) in membrane.iter().zip(bending) {
            resultants.push(ShellResultants {
                axes,
                membrane: self.membrane().map(|row| dot(row, *strain)),
                moments: self.bending().map(|row| -dot(row, [first, second, twist])),
                shears: shears.map(|strain| self.shear() * strain),
            });
        }
        resultants
    }
}
