//! Isotropic linear elastic solid.

use crate::error::{Result, finite, not_negative, positive, require};

/// Elastic solid: Young's modulus, Poisson's ratio, density.
///
/// ```
/// let steel = basemat::fem::Material::new(200.0e9, 0.25, 7800.0)?;
/// assert_eq!(steel.elasticity()[2][2], 80.0e9); // shear modulus
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "MaterialForm"))]
pub struct Material {
    young_modulus: f64,
    poisson: f64,
    density: f64,
}

validated! {
    Material as MaterialForm { young_modulus: f64, poisson: f64, density: f64 }
    => Material::new(young_modulus, poisson, density)
}

impl Material {
    /// Material from Young's modulus E (Pa), Poisson's ratio ν and density ρ (kg/m³; 0 allowed).
    ///
    /// E and ν belong to the solid; the stiffness in plane strain, and of shells in plane stress, follows from them.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless E > 0, −1 < ν < 0.5, ρ ≥ 0, all finite.
    pub fn new(young_modulus: f64, poisson: f64, density: f64) -> Result<Self> {
        positive("Young's modulus", young_modulus)?;
        not_negative("density of the material", density)?;
        let quantity = "Poisson's ratio of the material";
        let needed = "above -1 and below 0.5";
        require(quantity, poisson, poisson > -1.0 && poisson < 0.5, needed)?;
        let material = Self { young_modulus, poisson, density };
        finite("plane-strain modulus of the material", material.elasticity()[0][0])?;
        Ok(material)
    }

    /// Density ρ, kg/m³.
    pub fn density(&self) -> f64 {
        self.density
    }

    /// Young's modulus E, Pa.
    pub(crate) fn young_modulus(&self) -> f64 {
        self.young_modulus
    }

    /// Lamé's first constant λ, Pa.
    pub(crate) fn lame(&self) -> f64 {
        2.0 * self.shear_modulus() * self.poisson / (1.0 - 2.0 * self.poisson)
    }

    /// Poisson's ratio ν.
    pub(crate) fn poisson(&self) -> f64 {
        self.poisson
    }

    /// Shear modulus E/(2(1+ν)), Pa.
    pub(crate) fn shear_modulus(&self) -> f64 {
        0.5 * self.young_modulus / (1.0 + self.poisson)
    }

    /// Plane-strain matrix D, Pa: `[σ_xx, σ_yy, τ_xy] = D · [ε_xx, ε_yy, γ_xy]`.
    pub fn elasticity(&self) -> [[f64; 3]; 3] {
        let shear = self.shear_modulus();
        let lame = self.lame();
        let direct_modulus = lame + 2.0 * shear;
        [[direct_modulus, lame, 0.0], [lame, direct_modulus, 0.0], [0.0, 0.0, shear]]
    }

    /// Plane-stress matrix D, Pa: `[σ_xx, σ_yy, τ_xy] = D · [ε_xx, ε_yy, γ_xy]`.
    pub(crate) fn plane_stress(&self) -> [[f64; 3]; 3] {
        let direct_modulus = self.young_modulus / (1.0 - self.poisson * self.poisson);
        let lateral_modulus = self.poisson * direct_modulus;
        [
            [direct_modulus, lateral_modulus, 0.0],
            [lateral_modulus, direct_modulus, 0.0],
            [0.0, 0.0, self.shear_modulus()],
        ]
    }
}
