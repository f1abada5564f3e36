//! Surface compliance of a layered ground in the wavenumber domain.
//!
//! Pressure p cos kx and shear τ sin kx on the surface give W cos kx (down) and U sin kx:
//! [U; W] = C(k, s) [τ; p], C symmetric. The impedance Z (stresses by displacements on a horizontal
//! plane) is carried upwards from the base, layer by layer, with decaying exponentials only (Kausel
//! & Roësset 1981 for the impedance; Luco & Apsel 1983 for the reflected waves).
//!
//! Through layers thin relative to the wavelength, displacements and stresses are carried by the power series
//! of their differential equations. There the reflected waves of a slab would nearly cancel the others, and
//! the contribution of soft ground below would be lost in rounding.
//!
//! Waves polarised across the wavenumber have the impedance Z = σ/u alone. It is μβ in a half-space. Through
//! a layer of thickness h with z₀ = μβ and the reflection R = e^(−2βh) (z₀ − Z)/(z₀ + Z) at its bottom, Z ←
//! z₀ (1 − R)/(1 + R). With E = 1 − e^(−2βh) the result is z₀ (z₀E + Z(2 − E))/(z₀(2 − E) + ZE), which keeps
//! its digits in thin layers; rigid bedrock is Z = ∞.
//!
//! Each layer has the waves P and D = (S − P)/(β − α) instead of P and S, which become parallel for
//! |s|/(c k) → 0; all differences are formed as products.
//!
//! | symbol | meaning |
//! |---|---|
//! | μ, a² | shear modulus at s, (`c_S`/`c_P`)² |
//! | q₂, q₁ | ρs²/μ, a²q₂ |
//! | α, β | √(k² + q₁), √(k² + q₂), principal |
//! | U, T | columns: displacements (x, z) and stresses (xz, zz) of the waves P and D |
//! | Λ | change of these waves over the layer |
//! | R | up-going waves per down-going waves, at the layer's bottom |

use crate::error::Result;
use crate::linalg::Complex;
use crate::soil::{Bedrock, SoilProfile};

mod square;

use square::Square;

/// C at one wavenumber, m/Pa.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct SurfaceCompliance {
    /// Displacement to the right due to shear.
    pub(crate) xx: Complex,
    /// Displacement downwards due to pressure.
    pub(crate) zz: Complex,
    /// Displacement to the right due to pressure, and downwards due to shear.
    pub(crate) xz: Complex,
}

/// A layer at one Laplace variable.
#[derive(Debug, Clone, Copy)]
struct LaplaceLayer {
    modulus: Complex,
    q1: Complex,
    q2: Complex,
    a2: f64,
    thickness: f64,
}

/// μ(s), q₂ and a² of a soil at one Laplace variable.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LaplaceSoil {
    pub(crate) modulus: Complex,
    pub(crate) q2: Complex,
    pub(crate) a2: f64,
}

/// C(k, s) of one profile at one s.
#[derive(Debug, Clone, Default)]
pub(crate) struct LayeredCompliance {
    layers: Vec<LaplaceLayer>,
    has_rigid_bedrock: bool,
    moduli: Vec<Complex>,
    /// α, β of the layers down to the last that affects the surface.
    roots: Vec<[Complex; 2]>,
}

/// Largest |β|h of a layer that counts as thin.
const THIN_LAYER_PHASE: f64 = 0.2;
/// Size of the last term of the power series, relative to the first.
const SERIES_CUTOFF: f64 = 1e-18;

impl LaplaceLayer {
    fn soil(&self) -> LaplaceSoil {
        LaplaceSoil { modulus: self.modulus, q2: self.q2, a2: self.a2 }
    }

    /// Whether the phase and decay of the layer's waves over its thickness are small at the wavenumber `k`.
    fn is_thin(&self, k: f64) -> bool {
        (k * k + self.q2.abs()).sqrt() * self.thickness < THIN_LAYER_PHASE
    }

    /// Displacements and stresses at the layer's top, from the values at its bottom.
    ///
    /// With `even` = [U; `σ_zz`/μ] and `odd` = [W; `σ_xz`/μ]: even′ = P odd and odd′ = Q even.
    fn top_state(&self, k: f64, bottom: PlaneState) -> PlaneState {
        let a2 = self.a2;
        let q2 = self.q2;
        let h = self.thickness;
        let wave = Complex::real(k);
        let one = Complex::real(1.0);
        let poisson = Complex::real((1.0 - 2.0 * a2) * k);
        let membrane = Complex::real(4.0 * (1.0 - a2) * k * k) + q2;
        let p = Square([wave, one, q2, -wave]);
        let q = Square([-poisson, Complex::real(a2), membrane, poisson]);
        // Rows: U, W; σ_xz, σ_zz.
        let u = bottom.displacement.0;
        let t = bottom.stress.scaled(self.modulus.inverse()).0;
        let mut even = Square([u[0], u[1], t[2], t[3]]);
        let mut odd = Square([u[2], u[3], t[0], t[1]]);
        let mut even_term = even;
        let mut odd_term = odd;
        // Every other power of h k and h √q₂ may be absent from an entry.
        let term_ratio = 2.0 * (k + q2.abs().sqrt()) * h;
        let mut n = 0.0;
        let mut size = 1.0;
        while size > SERIES_CUTOFF {
            n += 1.0;
            size *= term_ratio / n;
            let factor = Complex::real(-h / n);
            let next_even = p.times(odd_term).scaled(factor);
            odd_term = q.times(even_term).scaled(factor);
            even_term = next_even;
            even = even.plus(even_term);
            odd = odd.plus(odd_term);
        }
        let stress = Square([odd.0[2], odd.0[3], even.0[2], even.0[3]]).scaled(self.modulus);
        let displacement = Square([even.0[0], even.0[1], odd.0[0], odd.0[1]]);
        PlaneState { displacement, stress }
    }
}

/// Displacements and stresses on a horizontal plane, U and T: two independent solutions in columns.
#[derive(Clone, Copy)]
struct PlaneState {
    displacement: Square,
    stress: Square,
}

/// Depth, in decay lengths, below which no wave returns to the surface: e^(−2·21) is 6e-19.
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
        for (number, ((soil, _), modulus)) in profile.soils().zip(&self.moduli).enumerate() {
            let thickness =
                profile.layers().get(number).map_or(f64::INFINITY, |layer| layer.thickness);
            let a2 = soil.speed_ratio_squared();
            // s is multiplied twice, because its square may exceed the range of f64 where the product does not.
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

    /// C at the wavenumber `k` > 0, 1/m.
    pub(crate) fn at(&mut self, k: f64) -> SurfaceCompliance {
        self.roots.clear();
        let mut decay = 0.0;
        for layer in &self.layers {
            let square = Complex::real(k * k);
            let alpha = (square + layer.q1).sqrt();
            let beta = (square + layer.q2).sqrt();
            self.roots.push([alpha, beta]);
            decay += alpha.re.min(beta.re) * layer.thickness;
            if decay > OPAQUE_DECAY_EXPONENT {
                break;
            }
        }
        let last = self.roots.len() - 1;
        let lowest = &self.layers[last];
        // A layer from whose bottom no wave returns is a half-plane.
        let is_half_plane = lowest.thickness.is_infinite() || decay > OPAQUE_DECAY_EXPONENT;
        let mut top = if !is_half_plane && lowest.is_thin(k) {
            let rigid =
                PlaneState { displacement: Square::default(), stress: Square::IDENTITY_MATRIX };
            lowest.top_state(k, rigid)
        } else {
            let waves = DownGoingWaves::new(lowest, k, self.roots[last]);
            if is_half_plane {
                waves.down
            } else {
                let reflection = waves.up().displacement.solve(waves.down.displacement).negative();
                waves.above(lowest, reflection)
            }
        };
        for (layer, roots) in self.layers[..last].iter().zip(&self.roots).rev() {
            let z = top.stress.times_inverse(top.displacement);
            if layer.is_thin(k) {
                top = layer
                    .top_state(k, PlaneState { displacement: Square::IDENTITY_MATRIX, stress: z });
                continue;
            }
            let waves = DownGoingWaves::new(layer, k, *roots);
            let down = waves.down;
            let up = waves.up();
            let reflection = up
                .stress
                .minus(z.times(up.displacement))
                .solve(z.times(down.displacement).minus(down.stress));
            top = waves.above(layer, reflection);
        }
        let c = top.displacement.times_inverse(top.stress);
        SurfaceCompliance { xx: -c.0[0], zz: -c.0[3], xz: (c.0[1] + c.0[2]).scale(-0.5) }
    }

    /// Transverse compliance `C_tt` = 1/Z at the wavenumber of the last evaluation, m/Pa.
    ///
    /// It is the displacement due to shear, both normal to the direction of the wavenumber.
    pub(crate) fn transverse(&self) -> Complex {
        // Below the last layer that affects the surface any base is valid, so it starts as rigid.
        let mut impedance = None;
        for (layer, [_, beta]) in self.layers.iter().zip(&self.roots).rev() {
            let z0 = layer.modulus * *beta;
            if layer.thickness.is_infinite() {
                impedance = Some(z0);
                continue;
            }
            let e = one_less_exponential(beta.scale(2.0 * layer.thickness));
            let two_less_e = Complex::real(2.0) - e;
            impedance = Some(match impedance {
                Some(z) => z0 * (z0 * e + z * two_less_e) / (z0 * two_less_e + z * e),
                None => z0 * two_less_e / e,
            });
        }
        impedance.map_or_else(Complex::default, Complex::inverse)
    }
}

/// Largest |x| for which 1 − e^(−x) is summed as a series.
const EXPONENTIAL_SERIES_LIMIT: f64 = 0.3;

/// 1 − e^(−x) for Re x ≥ 0.
fn one_less_exponential(x: Complex) -> Complex {
    if x.square() > EXPONENTIAL_SERIES_LIMIT * EXPONENTIAL_SERIES_LIMIT {
        return Complex::real(1.0) - (-x).exp();
    }
    let terms = (2..=13).rev().map(f64::from);
    let one = Complex::real(1.0);
    x * terms.fold(one, |sum, n| one - (x * sum).scale(1.0 / n))
}

/// Down-going waves of a layer.
struct DownGoingWaves {
    alpha: Complex,
    beta: Complex,
    /// β − α.
    root_difference: Complex,
    /// U and T of these waves at the top of the layer.
    down: PlaneState,
}

impl DownGoingWaves {
    /// Waves of a layer at the wavenumber `k`, with its α and β.
    fn new(layer: &LaplaceLayer, k: f64, [alpha, beta]: [Complex; 2]) -> Self {
        let wave = Complex::real(k);
        let sum = alpha + beta;
        let inverse_ratio = 1.0 / (1.0 - layer.a2);
        // 1/(β + k) and 1/(k + α), with one division.
        let beta_sum = beta + wave;
        let alpha_sum = alpha + wave;
        let inverse_product = (beta_sum * alpha_sum).inverse();
        let inverse_beta_sum = inverse_product * alpha_sum;
        let inverse_alpha_sum = inverse_product * beta_sum;
        let u0 = (sum * inverse_beta_sum).scale(inverse_ratio);
        let u1 = (sum * inverse_alpha_sum).scale(-layer.a2 * inverse_ratio);
        let minus = -layer.modulus;
        let t0 = sum - layer.q1 * inverse_alpha_sum * u1;
        let t1 = -(layer.q2 * inverse_beta_sum * u0);
        let square = Complex::real(2.0 * k * k) + layer.q2;
        let displacement = Square([wave, u0, alpha, u1]);
        let stress = Square([minus * alpha.scale(2.0 * k), minus * t0, minus * square, minus * t1]);
        Self {
            alpha,
            beta,
            root_difference: layer.q2.scale(1.0 - layer.a2) / sum,
            down: PlaneState { displacement, stress },
        }
    }

    /// U and T of the up-going waves.
    fn up(&self) -> PlaneState {
        let displacement = self.down.displacement.mirrored();
        PlaneState { displacement, stress: self.down.stress.mirrored().negative() }
    }

    /// Displacements and stresses at the layer's top for the reflection R at its bottom.
    fn above(&self, layer: &LaplaceLayer, reflection: Square) -> PlaneState {
        let x = self.transfer(layer.thickness).around(reflection);
        let up = self.up();
        PlaneState {
            displacement: self.down.displacement.plus(up.displacement.times(x)),
            stress: self.down.stress.plus(up.stress.times(x)),
        }
    }

    /// Λ = [[e^(−αh), −g], [0, e^(−βh)]], g = (e^(−αh) − e^(−βh))/(β − α).
    fn transfer(&self, h: f64) -> Transfer {
        let pressure = self.alpha.scale(-h).exp();
        let x = self.root_difference.scale(-h);
        if x.square() > 0.01 {
            let shear = self.beta.scale(-h).exp();
            return Transfer { pressure, shear, mixed: (pressure - shear) / self.root_difference };
        }
        // e^(−βh) is the product of e^(−αh) and e^x; φ₁(x) = (e^x − 1)/x by its series.
        let mut phi = Complex::real(1.0);
        for n in (2..=10).rev() {
            phi = Complex::real(1.0) + (phi * x).scale(1.0 / f64::from(n));
        }
        let shear = pressure * (Complex::real(1.0) + x * phi);
        Transfer { pressure, shear, mixed: (pressure * phi).scale(h) }
    }
}

/// Λ of a layer.
struct Transfer {
    pressure: Complex,
    shear: Complex,
    /// g.
    mixed: Complex,
}

impl Transfer {
    /// Λ R Λ.
    fn around(&self, r: Square) -> Square {
        let Square([a, b, c, d]) = r;
        // Λ R.
        let left = [
            self.pressure * a - self.mixed * c,
            self.pressure * b - self.mixed * d,
            self.shear * c,
            self.shear * d,
        ];
        Square([
            left[0] * self.pressure,
            left[1] * self.shear - left[0] * self.mixed,
            left[2] * self.pressure,
            left[3] * self.shear - left[2] * self.mixed,
        ])
    }
}

#[cfg(test)]
mod tests;
