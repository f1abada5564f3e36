//! Fundamental solution of the full elastic plane (Eringen & Suhubi 1975, § 5.10).
//!
//! Line load j at the origin, distance r, direction e. For each wave (1 pressure, 2 shear) z = c t/r, s = √(z²−1):
//!
//! * `u_ij` = ψ `δ_ij` − χ `e_i` `e_j`
//! * ψ = (1/4πρ)[−(Z₁−Z₂) + (L₁+L₂)],  χ = −(1/2πρ)(Z₁−Z₂)
//! * r ψ' = (1/2πρ)[(Z₁−Z₂) − Q₂],  r χ' = (1/2πρ)[2(Z₁−Z₂) + Q₁ − Q₂]
//! * `t_ij` = (μ/r){(rψ'−χ)(`δ_ij` `r_n` + `e_i` `n_j`) − 2χ(`n_i` `e_j` − 2`e_i` `e_j` `r_n`)
//!   − 2rχ' `e_i` `e_j` `r_n` + (λ/μ)(rψ'−rχ'−χ) `e_j` `n_i`},  `r_n` = e·n
//!
//! For a load H(t), Z = z s/c², L = arccosh(z)/c², Q = z/(s c²), each zero for z ≤ 1. The functions of the
//! impulse and of the ramp are their time derivatives and integrals. After both waves have passed, the
//! differences are computed without the terms that grow with time, because these terms cancel.

use crate::error::{Result, finite, positive};
use crate::fundamental::{FundamentalSolution, LoadHistory, LoadResponse};
use crate::soil::Soil;

/// Fundamental solution of the elastic full plane, without a surface, in plane strain.
#[derive(Debug, Clone, Copy)]
pub struct FullPlane {
    soil: Soil,
    pressure_wave_speed: f64,
    shear_wave_speed: f64,
}

/// Time functions of a load history at one distance.
struct TimeFunctions {
    /// Difference Z₁−Z₂.
    z_difference: f64,
    /// Sum L₁+L₂.
    l_sum: f64,
    /// Function Q₂ of the shear wave.
    q_shear: f64,
    /// Sum 2(Z₁−Z₂)+Q₁−Q₂ in r χ'.
    chi_slope: f64,
}

impl FullPlane {
    /// Creates the solution for a soil.
    pub fn new(soil: Soil) -> Self {
        let pressure_wave_speed = soil.pressure_wave_speed();
        let shear_wave_speed = soil.shear_wave_speed();
        Self { soil, pressure_wave_speed, shear_wave_speed }
    }

    /// Time functions at the distance `r` and at `time` after the load began.
    fn time_functions(&self, r: f64, time: f64, load: LoadHistory) -> TimeFunctions {
        let mut functions =
            TimeFunctions { z_difference: 0.0, l_sum: 0.0, q_shear: 0.0, chi_slope: 0.0 };
        // After both waves have passed, terms of Z that do not depend on the wave speed cancel in Z₁ − Z₂.
        let is_past = self.shear_wave_speed * time / r > 1.0;
        for (c, sign) in [(self.pressure_wave_speed, 1.0), (self.shear_wave_speed, -1.0)] {
            let z = c * time / r;
            if z.is_nan() || z <= 1.0 {
                continue;
            }
            let s = ((z - 1.0) * (z + 1.0)).sqrt();
            let squared_slowness = 1.0 / (c * c);
            let sum = z + s;
            // Z, L, Q and 2Z + Q, divided by `unit`, without their common terms if `is_past`.
            let unit;
            let z_term;
            let l_term;
            let q_term;
            let slope_term;
            match load {
                LoadHistory::Impulse => {
                    unit = squared_slowness * c / r;
                    q_term = -1.0 / (s * s * s);
                    z_term = if is_past { 1.0 / (s * sum * sum) } else { z / s * z + s };
                    l_term = 1.0 / s;
                    slope_term = 2.0 * z_term + q_term;
                }
                LoadHistory::Step => {
                    unit = squared_slowness;
                    q_term = z / s;
                    z_term = if is_past { -z / sum } else { z * s };
                    l_term = s.asinh();
                    slope_term = if is_past { z / (s * sum * sum) } else { 2.0 * z_term + q_term };
                }
                LoadHistory::Ramp => {
                    unit = squared_slowness * r / c;
                    q_term = s;
                    // s³ − z³ = −(z² + zs + s²)/(z + s)
                    z_term = if is_past {
                        -(z * z + z * s + s * s) / (3.0 * sum)
                    } else {
                        s * s * s / 3.0
                    };
                    l_term = z * s.asinh() - s;
                    slope_term =
                        if is_past { -(s + 2.0 * z) / (3.0 * sum * sum) } else { 2.0 * z_term + s };
                }
            }
            functions.z_difference += sign * unit * z_term;
            functions.l_sum += unit * l_term;
            functions.chi_slope += sign * unit * slope_term;
            if sign < 0.0 {
                functions.q_shear = unit * q_term;
            }
        }
        functions
    }
}

/// Distance r and direction e of an offset.
struct PolarOffset {
    r: f64,
    e: [f64; 2],
}

/// Distance and direction of an offset; an error for a zero offset.
fn polar(offset: [f64; 2]) -> Result<PolarOffset> {
    finite("x component of the offset", offset[0])?;
    finite("z component of the offset", offset[1])?;
    let r = positive("distance", offset[0].hypot(offset[1]))?;
    Ok(PolarOffset { r, e: offset.map(|x| x / r) })
}

impl FundamentalSolution for FullPlane {
    fn soil(&self) -> Soil {
        self.soil
    }

    fn displacement(&self, offset: [f64; 2], time: f64, load: LoadHistory) -> Result<LoadResponse> {
        let PolarOffset { r, e } = polar(offset)?;
        finite("time", time)?;
        let functions = self.time_functions(r, time, load);
        let unit = 1.0 / (4.0 * std::f64::consts::PI * self.soil.density());
        let psi = unit * (functions.l_sum - functions.z_difference);
        let chi = -2.0 * unit * functions.z_difference;
        let coupling = -chi * e[0] * e[1];
        Ok([[psi - chi * e[0] * e[0], coupling], [coupling, psi - chi * e[1] * e[1]]])
    }

    /// For [`LoadHistory::Impulse`] the traction between the wave fronts. At a front it is singular, and its integral is
    /// a Hadamard finite part.
    fn traction(
        &self,
        offset: [f64; 2],
        normal: [f64; 2],
        time: f64,
        load: LoadHistory,
    ) -> Result<LoadResponse> {
        let PolarOffset { r, e } = polar(offset)?;
        finite("time", time)?;
        finite("x component of the normal", normal[0])?;
        finite("z component of the normal", normal[1])?;
        let functions = self.time_functions(r, time, load);
        let unit = 1.0 / (2.0 * std::f64::consts::PI * self.soil.density());
        let chi = -unit * functions.z_difference;
        let psi_slope = unit * (functions.z_difference - functions.q_shear);
        let chi_slope = unit * functions.chi_slope;
        let n = normal;
        let radial_normal = e[0] * n[0] + e[1] * n[1];
        let nu = self.soil.poisson();
        // λ/μ.
        let lame_ratio = 2.0 * nu / (1.0 - 2.0 * nu);
        let scale = self.soil.shear_modulus() / r;
        let mut t = [[0.0; 2]; 2];
        for i in 0..2 {
            for j in 0..2 {
                let delta = if i == j { radial_normal } else { 0.0 };
                t[i][j] = scale
                    * ((psi_slope - chi) * (delta + e[i] * n[j])
                        - 2.0 * chi * (n[i] * e[j] - 2.0 * e[i] * e[j] * radial_normal)
                        - 2.0 * chi_slope * e[i] * e[j] * radial_normal
                        + lame_ratio * (psi_slope - chi_slope - chi) * e[j] * n[i]);
            }
        }
        Ok(t)
    }
}
