//! Fundamental solution of the full elastic plane in the Laplace domain.
//!
//! A line load e^{st} in direction j at the origin (Cruse & Rizzo 1968; Eringen & Suhubi 1975,
//! § 5.10 transformed):
//!
//! * `U_ij` = (1/2πρ) {`δ_ij` K₀(z₂)/c₂² + s⁻² ∂ᵢ∂ⱼ [K₀(z₁) − K₀(z₂)]} = ψ `δ_ij` − χ `e_i` `e_j`
//! * 2πρ ψ = K₀(z₂)/c₂² + K₁(z₂)/(z₂c₂²) − K₁(z₁)/(z₁c₁²)
//! * 2πρ χ = K₂(z₂)/c₂² − K₂(z₁)/c₁²
//! * 2πρ rψ' = −z₂K₁(z₂)/c₂² − 2πρ χ
//! * 2πρ rχ' = −4πρ χ − z₂K₁(z₂)/c₂² + z₁K₁(z₁)/c₁²
//!
//! Near the load the poles 1/z² of K₁/z, and 2/z² of K₂ = K₀ + 2K₁/z, cancel between both waves. The functions
//! are computed without these poles there.
//!
//! | symbol | meaning |
//! |---|---|
//! | s | Laplace's variable, Re s > 0, 1/s |
//! | r, e | distance from the load and unit vector of the offset |
//! | c₁, c₂ | P and S wave speeds |
//! | z₁, z₂ | s r/c₁, s r/c₂ |

use std::f64::consts::PI;

use super::bessel::{Complex64, MAX_SERIES_ARGUMENT, modified_bessel};
use crate::soil::Soil;

/// Constants of the full plane of a soil at one s.
#[derive(Debug, Clone, Copy)]
pub(super) struct LaplacePlane {
    /// s/c₁, 1/m.
    pub(super) pressure: Complex64,
    /// s/c₂, 1/m.
    pub(super) shear: Complex64,
    /// 1/c₁² and 1/c₂² over 2πρ.
    pub(super) weights: [f64; 2],
    shear_modulus: f64,
    /// λ/μ.
    lame_ratio: f64,
}

/// Radial functions ψ, χ, rψ' and rχ' at one distance.
#[derive(Debug, Clone, Copy)]
pub(super) struct RadialFunctions {
    pub(super) psi: Complex64,
    pub(super) chi: Complex64,
    pub(super) psi_slope: Complex64,
    pub(super) chi_slope: Complex64,
}

/// Displacements and tractions at a point: `[i][j]`, component i due to a load j.
pub(super) struct PointKernels {
    pub(super) displacement: [[Complex64; 2]; 2],
    pub(super) traction: [[Complex64; 2]; 2],
}

impl LaplacePlane {
    /// The plane at the Laplace variable `s`.
    pub(super) fn new(soil: Soil, s: Complex64) -> Self {
        let pressure_speed = soil.pressure_wave_speed();
        let shear_speed = soil.shear_wave_speed();
        let unit = 1.0 / (2.0 * PI * soil.density());
        let nu = soil.poisson();
        Self {
            pressure: s / pressure_speed,
            shear: s / shear_speed,
            weights: [unit / (pressure_speed * pressure_speed), unit / (shear_speed * shear_speed)],
            shear_modulus: soil.shear_modulus(),
            lame_ratio: 2.0 * nu / (1.0 - 2.0 * nu),
        }
    }

    /// Radial functions at the distance `r` from the load.
    pub(super) fn radial(&self, r: f64) -> RadialFunctions {
        let z = self.shear * r;
        let omits_poles = z.norm() <= MAX_SERIES_ARGUMENT;
        let shear = modified_bessel(z, omits_poles);
        let pressure = modified_bessel(self.pressure * r, omits_poles);
        let pressure_weight = self.weights[0];
        let shear_weight = self.weights[1];
        let psi = shear_weight * (shear.k0 + shear.quotient) - pressure_weight * pressure.quotient;
        let chi = shear_weight * (shear.k0 + 2.0 * shear.quotient)
            - pressure_weight * (pressure.k0 + 2.0 * pressure.quotient);
        let shear_product = shear_weight * shear.product;
        RadialFunctions {
            psi,
            chi,
            psi_slope: -shear_product - chi,
            chi_slope: -2.0 * chi - shear_product + pressure_weight * pressure.product,
        }
    }

    /// Displacements at `offset` from the load, and tractions on the plane with the unit vector `normal`.
    pub(super) fn kernels(&self, offset: [f64; 2], normal: [f64; 2]) -> PointKernels {
        let r = offset[0].hypot(offset[1]);
        let e = [offset[0] / r, offset[1] / r];
        let f = self.radial(r);
        let normal_component = e[0] * normal[0] + e[1] * normal[1];
        let scale = self.shear_modulus / r;
        let shear = scale * (f.psi_slope - f.chi);
        let chi = 2.0 * scale * f.chi;
        let triple = 2.0 * (chi - scale * f.chi_slope) * normal_component;
        let pressure = self.lame_ratio * (shear - scale * f.chi_slope);
        let mut u = [[Complex64::default(); 2]; 2];
        let mut t = u;
        for i in 0..2 {
            for j in 0..2 {
                let psi_delta = if i == j { f.psi } else { Complex64::default() };
                let normal_delta = if i == j { normal_component } else { 0.0 };
                u[i][j] = psi_delta - f.chi * (e[i] * e[j]);
                t[i][j] = shear * (normal_delta + e[i] * normal[j]) + pressure * (e[j] * normal[i])
                    - chi * (normal[i] * e[j])
                    + triple * (e[i] * e[j]);
            }
        }
        PointKernels { displacement: u, traction: t }
    }
}
