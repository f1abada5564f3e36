//! Surface compliance of a layered ground in the wavenumber domain.
//!
//! Pressure p cos kx and shear τ sin kx on the surface cause displacements W cos kx (down) and U sin kx:
//! [U; W] = C(k, s) [τ; p] with a symmetric C. The impedance Z relates stresses to displacements on a horizontal plane.
//! It is computed upwards from the base, layer by layer, with decaying exponentials only (Kausel & Roësset 1981 for the
//! impedance; Luco & Apsel 1983 for the reflected waves).
//!
//! In layers thin relative to the wavelength, displacements and stresses follow from the power series of the layer's
//! differential equations. With waves, the reflected waves of a thin slab would nearly cancel the incident waves, and the
//! contribution of soft ground below would be lost in rounding.
//!
//! Waves with displacements normal to the wavenumber's direction have the scalar impedance Z = σ/u, μβ in a half-space.
//! A layer of thickness h has z₀ = μβ and the reflection R = e^(−2βh) (z₀ − Z)/(z₀ + Z) at its bottom, which yields
//! Z ← z₀ (1 − R)/(1 + R) at its top. With E = 1 − e^(−2βh) this is z₀ (z₀E + Z(2 − E))/(z₀(2 − E) + ZE), without
//! cancellation in thin layers. Rigid bedrock has Z = ∞.
//!
//! The waves of a layer are P and D = (S − P)/(β − α) instead of P and S, which become parallel for |s|/(c k) → 0. All
//! differences are computed as products.
//!
//! | symbol | meaning |
//! |---|---|
//! | μ, a² | shear modulus at s, (`c_S`/`c_P`)² |
//! | q₂, q₁ | ρs²/μ, a²q₂ |
//! | α, β | √(k² + q₁), √(k² + q₂), principal |
//! | U, T | columns: displacements (x, z) and stresses (xz, zz) of the waves P and D |
//! | Λ | transfer matrix of these waves over the layer |
//! | R | reflection matrix at the layer's bottom: up-going waves from down-going waves |

use crate::error::Result;
use crate::linalg::Complex;
use crate::soil::{Bedrock, SoilProfile};

mod square;

use square::Square;

/// Surface compliance C at one wavenumber, m/Pa.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct SurfaceCompliance {
    /// Displacement to the right due to shear.
    pub(crate) xx: Complex,
    /// Displacement downwards due to pressure.
    pub(crate) zz: Complex,
    /// Displacement to the right due to pressure, and downwards due to shear.
    pub(crate) xz: Complex,
}

/// Layer with its shear modulus μ(s), q₁, q₂ and a² at one Laplace variable.
#[derive(Debug, Clone, Copy)]
struct LaplaceLayer {
    modulus: Complex,
    q1: Complex,
    q2: Complex,
    a2: f64,
    /// Thickness, m; infinite for a half-plane.
    thickness: f64,
}

/// Soil with its modulus μ(s), q₂ and a² at one Laplace variable.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LaplaceSoil {
    pub(crate) modulus: Complex,
    pub(crate) q2: Complex,
    pub(crate) a2: f64,
}

/// Surface compliance C(k, s) of a profile at one Laplace variable.
#[derive(Debug, Clone, Default)]
pub(crate) struct LayeredCompliance {
    layers: Vec<LaplaceLayer>,
    has_rigid_bedrock: bool,
    moduli: Vec<Complex>,
    /// α and β of the layers, down to the last layer that affects the surface.
    roots: Vec<[Complex; 2]>,
}

/// Largest |β|h of a thin layer, whose power series converges in few terms.
const THIN_LAYER_PHASE: f64 = 0.2;
/// Magnitude of a term of the power series, relative to the first, below which the series ends: below rounding.
const SERIES_TOLERANCE: f64 = 1e-18;

impl LaplaceLayer {
    fn soil(&self) -> LaplaceSoil {
        LaplaceSoil { modulus: self.modulus, q2: self.q2, a2: self.a2 }
    }

    /// Whether the phase and decay of the layer's waves over its thickness are small at the wavenumber `k`.
    fn is_thin(&self, k: f64) -> bool {
        (k * k + self.q2.abs()).sqrt() * self.thickness < THIN_LAYER_PHASE
    }

    /// Displacements and stresses at the top of a thin layer, from the values at its bottom.
    ///
    /// f = [U; `σ_zz`/μ] and g = [W; `σ_xz`/μ] satisfy f′ = P g and g′ = Q f.
    fn top_state(&self, k: f64, bottom: PlaneState) -> PlaneState {
        let a2 = self.a2;
        let q2 = self.q2;
        let h = self.thickness;
        let wavenumber = Complex::real(k);
        let one = Complex::real(1.0);
        let poisson_factor = Complex::real((1.0 - 2.0 * a2) * k);
        let membrane_factor = Complex::real(4.0 * (1.0 - a2) * k * k) + q2;
        let p = Square([wavenumber, one, q2, -wavenumber]);
        let q = Square([-poisson_factor, Complex::real(a2), membrane_factor, poisson_factor]);
        // Rows: U, W; σ_xz, σ_zz.
        let u = bottom.displacement.0;
        let t = bottom.stress.scaled(self.modulus.inverse()).0;
        let mut f = Square([u[0], u[1], t[2], t[3]]);
        let mut g = Square([u[2], u[3], t[0], t[1]]);
        let mut f_term = f;
        let mut g_term = g;
        // The factor 2 is for entries without every other power of h k and h √q₂.
        let term_ratio = 2.0 * (k + q2.abs().sqrt()) * h;
        let mut n = 0.0;
        let mut magnitude = 1.0;
        while magnitude > SERIES_TOLERANCE {
            n += 1.0;
            magnitude *= term_ratio / n;
            let factor = Complex::real(-h / n);
            let next_f_term = p.times(g_term).scaled(factor);
            g_term = q.times(f_term).scaled(factor);
            f_term = next_f_term;
            f = f.plus(f_term);
            g = g.plus(g_term);
        }
        let stress = Square([g.0[2], g.0[3], f.0[2], f.0[3]]).scaled(self.modulus);
        let displacement = Square([f.0[0], f.0[1], g.0[0], g.0[1]]);
        PlaneState { displacement, stress }
    }
}

/// Displacements U and stresses T on a horizontal plane, with two independent solutions as columns.
#[derive(Clone, Copy)]
struct PlaneState {
    displacement: Square,
    stress: Square,
}

/// Depth, in decay lengths, below which reflections do not affect the surface, because e^(−2·21) is 6e-19.
const OPAQUE_DECAY_EXPONENT: f64 = 21.0;

impl LayeredCompliance {
    /// Sets the Laplace variable `s` and the moduli of the layers.
    ///
    /// # Errors
    /// As for [`SoilProfile::moduli`].
    pub(crate) fn set(&mut self, profile: &SoilProfile, s: Complex) -> Result<()> {
        profile.check()?;
        profile.moduli(s, &mut self.moduli)?;
        self.has_rigid_bedrock = matches!(profile.bedrock(), Bedrock::Rigid);
        self.layers.clear();
        for (layer, ((soil, _), modulus)) in profile.soils().zip(&self.moduli).enumerate() {
            let thickness =
                profile.layers().get(layer).map_or(f64::INFINITY, |layer| layer.thickness);
            let a2 = soil.speed_ratio_squared();
            // Two factors s, because s² may exceed the range of floating-point numbers although q₂ does not.
            let q2 = (s / *modulus) * s.scale(soil.density());
            self.layers.push(LaplaceLayer {
                modulus: *modulus,
                q1: q2.scale(a2),
                q2,
                a2,
                thickness,
            });
        }
        Ok(())
    }

    /// Soil of the top layer.
    pub(crate) fn top(&self) -> LaplaceSoil {
        self.layers[0].soil()
    }

    /// Soil of the half-plane below; `None` on rigid bedrock.
    pub(crate) fn half_plane(&self) -> Option<LaplaceSoil> {
        self.layers.last().filter(|_| !self.has_rigid_bedrock).map(LaplaceLayer::soil)
    }

    /// |√q₂| of the top layer, 1/m; infinite if the result is not a number.
    pub(crate) fn root(&self) -> f64 {
        let root = self.layers[0].q2.sqrt().abs();
        if root.is_nan() { f64::INFINITY } else { root }
    }

    /// Surface compliance at the wavenumber `k` > 0, 1/m.
    pub(crate) fn at(&mut self, k: f64) -> SurfaceCompliance {
        let decay_exponent = self.find_roots(k);
        let last_index = self.roots.len() - 1;
        let mut top = self.lowest_state(k, decay_exponent);
        for (layer, roots) in self.layers[..last_index].iter().zip(&self.roots).rev() {
            let z = top.stress.times_inverse(top.displacement);
            if layer.is_thin(k) {
                top = layer
                    .top_state(k, PlaneState { displacement: Square::IDENTITY_MATRIX, stress: z });
                continue;
            }
            let waves = LayerWaves::new(layer, k, *roots);
            let down = waves.down;
            let up = waves.up();
            let reflection = up
                .stress
                .minus(z.times(up.displacement))
                .solve(z.times(down.displacement).minus(down.stress));
            top = waves.top_state(layer, reflection);
        }
        let c = top.displacement.times_inverse(top.stress);
        SurfaceCompliance { xx: -c.0[0], zz: -c.0[3], xz: (c.0[1] + c.0[2]).scale(-0.5) }
    }

    /// Overwrites the roots α and β of all layers that affect the surface, and returns the decay exponent through them.
    fn find_roots(&mut self, k: f64) -> f64 {
        self.roots.clear();
        let mut decay_exponent = 0.0;
        for layer in &self.layers {
            let k_squared = Complex::real(k * k);
            let alpha = (k_squared + layer.q1).sqrt();
            let beta = (k_squared + layer.q2).sqrt();
            self.roots.push([alpha, beta]);
            decay_exponent += alpha.re.min(beta.re) * layer.thickness;
            if decay_exponent > OPAQUE_DECAY_EXPONENT {
                break;
            }
        }
        decay_exponent
    }

    /// Displacements and stresses at the top of the lowest layer that affects the surface.
    fn lowest_state(&self, k: f64, decay_exponent: f64) -> PlaneState {
        let last_index = self.roots.len() - 1;
        let lowest_layer = &self.layers[last_index];
        // A layer whose bottom does not affect the surface is a half-plane.
        let is_half_plane =
            lowest_layer.thickness.is_infinite() || decay_exponent > OPAQUE_DECAY_EXPONENT;
        if !is_half_plane && lowest_layer.is_thin(k) {
            let rigid_bottom =
                PlaneState { displacement: Square::default(), stress: Square::IDENTITY_MATRIX };
            return lowest_layer.top_state(k, rigid_bottom);
        }
        let waves = LayerWaves::new(lowest_layer, k, self.roots[last_index]);
        if is_half_plane {
            return waves.down;
        }
        let reflection = waves.up().displacement.solve(waves.down.displacement).negative();
        waves.top_state(lowest_layer, reflection)
    }

    /// Transverse compliance `C_tt` = 1/Z at the wavenumber of the last evaluation, m/Pa.
    ///
    /// It is the displacement due to shear, both normal to the direction of the wavenumber.
    pub(crate) fn transverse(&self) -> Complex {
        // The base below the last layer that affects the surface is arbitrary; the code uses a rigid base.
        let mut impedance = None;
        for (layer, [_, beta]) in self.layers.iter().zip(&self.roots).rev() {
            let z0 = layer.modulus * *beta;
            if layer.thickness.is_infinite() {
                impedance = Some(z0);
                continue;
            }
            let one_less_decay = one_less_exponential(beta.scale(2.0 * layer.thickness));
            let one_plus_decay = Complex::real(2.0) - one_less_decay;
            impedance = Some(match impedance {
                Some(z) => {
                    z0 * (z0 * one_less_decay + z * one_plus_decay)
                        / (z0 * one_plus_decay + z * one_less_decay)
                }
                None => z0 * one_plus_decay / one_less_decay,
            });
        }
        impedance.map_or_else(Complex::default, Complex::inverse)
    }
}

/// Largest |x| for which 1 − e^(−x) is computed by its series, of which thirteen terms are exact to rounding.
const EXPONENTIAL_SERIES_LIMIT: f64 = 0.3;
/// Largest power of x in this series.
const EXPONENTIAL_SERIES_DEGREE: u32 = 13;
/// Square of the largest |x| for which φ₁(x) = (eˣ − 1)/x is computed by its series, which is exact to rounding.
const PHI_SERIES_LIMIT_SQUARED: f64 = 0.01;
/// Number of terms of this series.
const PHI_SERIES_TERM_COUNT: u32 = 10;

/// Difference 1 − e^(−x) for Re x ≥ 0, without cancellation.
fn one_less_exponential(x: Complex) -> Complex {
    if x.squared_modulus() > EXPONENTIAL_SERIES_LIMIT * EXPONENTIAL_SERIES_LIMIT {
        return Complex::real(1.0) - (-x).exp();
    }
    let exponents = (2..=EXPONENTIAL_SERIES_DEGREE).rev().map(f64::from);
    let one = Complex::real(1.0);
    x * exponents.fold(one, |sum, n| one - (x * sum).scale(1.0 / n))
}

/// Down-going and up-going waves of a layer with the roots α and β.
struct LayerWaves {
    alpha: Complex,
    beta: Complex,
    /// Difference β − α, 1/m.
    root_difference: Complex,
    /// U and T of the down-going waves at the top of the layer.
    down: PlaneState,
}

impl LayerWaves {
    /// Waves of a layer at the wavenumber `k`, with its α and β.
    fn new(layer: &LaplaceLayer, k: f64, [alpha, beta]: [Complex; 2]) -> Self {
        let wavenumber = Complex::real(k);
        let root_sum = alpha + beta;
        let inverse_shear_ratio = 1.0 / (1.0 - layer.a2);
        // 1/(β + k) and 1/(k + α), with one division.
        let beta_sum = beta + wavenumber;
        let alpha_sum = alpha + wavenumber;
        let inverse_product = (beta_sum * alpha_sum).inverse();
        let inverse_beta_sum = inverse_product * alpha_sum;
        let inverse_alpha_sum = inverse_product * beta_sum;
        let u0 = (root_sum * inverse_beta_sum).scale(inverse_shear_ratio);
        let u1 = (root_sum * inverse_alpha_sum).scale(-layer.a2 * inverse_shear_ratio);
        let negative_modulus = -layer.modulus;
        let t0 = root_sum - layer.q1 * inverse_alpha_sum * u1;
        let t1 = -(layer.q2 * inverse_beta_sum * u0);
        let two_k_squared_plus_q2 = Complex::real(2.0 * k * k) + layer.q2;
        let displacement = Square([wavenumber, u0, alpha, u1]);
        let stress = Square([
            negative_modulus * alpha.scale(2.0 * k),
            negative_modulus * t0,
            negative_modulus * two_k_squared_plus_q2,
            negative_modulus * t1,
        ]);
        Self {
            alpha,
            beta,
            root_difference: layer.q2.scale(1.0 - layer.a2) / root_sum,
            down: PlaneState { displacement, stress },
        }
    }

    /// U and T of the up-going waves.
    fn up(&self) -> PlaneState {
        let displacement = self.down.displacement.mirrored();
        PlaneState { displacement, stress: self.down.stress.mirrored().negative() }
    }

    /// Displacements and stresses at the layer's top for the reflection matrix R at its bottom.
    fn top_state(&self, layer: &LaplaceLayer, reflection: Square) -> PlaneState {
        let returned_waves = self.transfer(layer.thickness).reflected(reflection);
        let up = self.up();
        PlaneState {
            displacement: self.down.displacement.plus(up.displacement.times(returned_waves)),
            stress: self.down.stress.plus(up.stress.times(returned_waves)),
        }
    }

    /// Transfer matrix Λ = [[e^(−αh), −g], [0, e^(−βh)]], g = (e^(−αh) − e^(−βh))/(β − α).
    fn transfer(&self, h: f64) -> Transfer {
        let pressure = self.alpha.scale(-h).exp();
        let x = self.root_difference.scale(-h);
        if x.squared_modulus() > PHI_SERIES_LIMIT_SQUARED {
            let shear = self.beta.scale(-h).exp();
            return Transfer { pressure, shear, g: (pressure - shear) / self.root_difference };
        }
        // e^(−βh) = e^(−αh) eˣ, with eˣ from the series of φ₁(x) = (eˣ − 1)/x.
        let mut phi = Complex::real(1.0);
        for n in (2..=PHI_SERIES_TERM_COUNT).rev() {
            phi = Complex::real(1.0) + (phi * x).scale(1.0 / f64::from(n));
        }
        let shear = pressure * (Complex::real(1.0) + x * phi);
        Transfer { pressure, shear, g: (pressure * phi).scale(h) }
    }
}

/// Transfer matrix Λ of a layer's waves.
struct Transfer {
    /// Decay e^(−αh).
    pressure: Complex,
    /// Decay e^(−βh).
    shear: Complex,
    /// Entry g, m.
    g: Complex,
}

impl Transfer {
    /// Λ R Λ: the up-going waves at the layer's top due to reflection at its bottom.
    fn reflected(&self, r: Square) -> Square {
        let Square([a, b, c, d]) = r;
        // Λ R.
        let product = [
            self.pressure * a - self.g * c,
            self.pressure * b - self.g * d,
            self.shear * c,
            self.shear * d,
        ];
        Square([
            product[0] * self.pressure,
            product[1] * self.shear - product[0] * self.g,
            product[2] * self.pressure,
            product[3] * self.shear - product[2] * self.g,
        ])
    }
}

#[cfg(test)]
mod tests;
