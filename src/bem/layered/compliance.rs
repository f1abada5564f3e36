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
struct Layer {
    modulus: Complex,
    q1: Complex,
    q2: Complex,
    a2: f64,
    thickness: f64,
}

/// C(k, s) of one profile at one s.
#[derive(Debug, Clone, Default)]
pub(crate) struct Compliance {
    layers: Vec<Layer>,
    rigid: bool,
    moduli: Vec<Complex>,
    /// α, β of the layers down to the last that affects the surface.
    roots: Vec<[Complex; 2]>,
}

/// |β|h below which a layer is thin.
const THIN: f64 = 0.2;
/// Size of the last term of the power series, relative to the first.
const SMALL: f64 = 1e-18;

impl Layer {
    /// Whether the phase and decay of the layer's waves over its thickness are small at the wavenumber `k`.
    fn is_thin(&self, k: f64) -> bool {
        let turn = (k * k + self.q2.abs()).sqrt() * self.thickness;
        turn < THIN
    }

    /// Displacements and stresses at the layer's top, from the values at its bottom.
    ///
    /// With `even` = [U; `σ_zz`/μ] and `odd` = [W; `σ_xz`/μ]: even′ = P odd and odd′ = Q even.
    fn carry(&self, k: f64, (u, t): (Square, Square)) -> (Square, Square) {
        let a2 = self.a2;
        let q2 = self.q2;
        let h = self.thickness;
        let wave = Complex::real(k);
        let one = Complex::real(1.0);
        let poisson = Complex::real((1.0 - 2.0 * a2) * k);
        let membrane = Complex::real(4.0 * (1.0 - a2) * k * k) + q2;
        let p = Square([wave, one, q2, -wave]);
        let q = Square([-poisson, Complex::real(a2), membrane, poisson]);
        let unit = self.modulus.inverse();
        let [xz_x, xz_z, zz_x, zz_z] = t.0.map(|stress| stress * unit);
        let [u_x, u_z, w_x, w_z] = u.0;
        let mut terms = [Square([u_x, u_z, zz_x, zz_z]), Square([w_x, w_z, xz_x, xz_z])];
        let [mut even, mut odd] = terms;
        // Every other power of h k and h √q₂ may be absent from an entry.
        let turn = 2.0 * (k + q2.abs().sqrt()) * h;
        let mut n = 0.0;
        let mut size = 1.0;
        while size > SMALL {
            n += 1.0;
            size *= turn / n;
            let factor = Complex::real(-h / n);
            let [one, other] = terms;
            terms = [p.times(other), q.times(one)].map(|m| Square(m.0.map(|x| x * factor)));
            (even, odd) = (even.plus(terms[0]), odd.plus(terms[1]));
        }
        let ([u_x, u_z, zz_x, zz_z], [w_x, w_z, xz_x, xz_z]) = (even.0, odd.0);
        let stress = Square([xz_x, xz_z, zz_x, zz_z].map(|x| x * self.modulus));
        (Square([u_x, u_z, w_x, w_z]), stress)
    }
}

/// Depth in decay lengths below which no wave returns to the surface: e^(−2·21) is 6e-19.
const OPAQUE: f64 = 21.0;

impl Compliance {
    /// Sets the Laplace variable `s` and the moduli of the layers.
    ///
    /// # Errors
    /// As for [`SoilProfile::moduli`].
    pub(crate) fn set(&mut self, profile: &SoilProfile, s: Complex) -> Result<()> {
        profile.check()?;
        profile.moduli(s, &mut self.moduli)?;
        self.rigid = matches!(profile.bedrock(), Bedrock::Rigid);
        self.layers.clear();
        let thicknesses = profile.layers().iter().map(|layer| layer.thickness);
        let thicknesses = thicknesses.chain(std::iter::once(f64::INFINITY));
        for (((soil, _), modulus), thickness) in profile.soils().zip(&self.moduli).zip(thicknesses)
        {
            let a2 = soil.speed_ratio_squared();
            // s is multiplied twice, because its square may leave the range of f64 when this product does
            // not.
            let q2 = (s / *modulus) * s.scale(soil.density());
            self.layers.push(Layer { modulus: *modulus, q1: q2.scale(a2), q2, a2, thickness });
        }
        Ok(())
    }

    /// μ(s), q₂ and a² of the top layer.
    pub(crate) fn top(&self) -> (Complex, Complex, f64) {
        let top = &self.layers[0];
        (top.modulus, top.q2, top.a2)
    }

    /// μ(s), q₂ and a² of the half-plane below; `None` on rigid bedrock.
    pub(crate) fn half_plane(&self) -> Option<(Complex, Complex, f64)> {
        let last = self.layers.last().filter(|_| !self.rigid)?;
        Some((last.modulus, last.q2, last.a2))
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
            if decay > OPAQUE {
                break;
            }
        }
        let last = self.roots.len() - 1;
        let lowest = &self.layers[last];
        let waves = || Waves::new(lowest, k, self.roots[last]);
        // A layer from whose bottom no wave returns is a half-plane.
        let (mut u, mut t) = if lowest.thickness.is_infinite() || decay > OPAQUE {
            let waves = waves();
            (waves.u, waves.t)
        } else if lowest.is_thin(k) {
            lowest.carry(k, (Square::default(), Square::UNIT))
        } else {
            let waves = waves();
            let up = waves.u.mirrored();
            waves.above(lowest, up.solve(waves.u).negative())
        };
        for (layer, roots) in self.layers[..last].iter().zip(&self.roots).rev() {
            let z = t.times_inverse(u);
            if layer.is_thin(k) {
                (u, t) = layer.carry(k, (Square::UNIT, z));
                continue;
            }
            let waves = Waves::new(layer, k, *roots);
            let u_up = waves.u.mirrored();
            let t_up = waves.t.mirrored().negative();
            let reflected = t_up.minus(z.times(u_up)).solve(z.times(waves.u).minus(waves.t));
            (u, t) = waves.above(layer, reflected);
        }
        let c = u.times_inverse(t);
        SurfaceCompliance { xx: -c.0[0], zz: -c.0[3], xz: (c.0[1] + c.0[2]).scale(-0.5) }
    }

    /// `C_tt` = 1/Z: displacement per shear across the wavenumber of the last evaluation, m/Pa.
    pub(crate) fn across(&self) -> Complex {
        // Below the last layer that affects the surface any base is valid, so it starts as rigid.
        let mut below = None;
        for (layer, [_, beta]) in self.layers.iter().zip(&self.roots).rev() {
            let own = layer.modulus * *beta;
            if layer.thickness.is_infinite() {
                below = Some(own);
                continue;
            }
            let missing = one_less_exponential(beta.scale(2.0 * layer.thickness));
            let rest = Complex::real(2.0) - missing;
            let (above, under) = match below {
                Some(z) => (own * missing + z * rest, own * rest + z * missing),
                None => (rest, missing),
            };
            below = Some(own * above / under);
        }
        below.map_or_else(Complex::default, Complex::inverse)
    }
}

/// |x| below which 1 − e^(−x) is summed as a series.
const SERIES_LIMIT: f64 = 0.3;

/// 1 − e^(−x) for Re x ≥ 0.
fn one_less_exponential(x: Complex) -> Complex {
    if x.square() > SERIES_LIMIT * SERIES_LIMIT {
        return Complex::real(1.0) - (-x).exp();
    }
    let terms = (2..=13).rev().map(f64::from);
    let one = Complex::real(1.0);
    x * terms.fold(one, |sum, n| one - (x * sum).scale(1.0 / n))
}

/// Down-going waves of a layer.
struct Waves {
    alpha: Complex,
    beta: Complex,
    /// β − α.
    gap: Complex,
    u: Square,
    t: Square,
}

impl Waves {
    fn new(layer: &Layer, k: f64, [alpha, beta]: [Complex; 2]) -> Self {
        let wave = Complex::real(k);
        let sum = alpha + beta;
        let rest = 1.0 / (1.0 - layer.a2);
        // 1/(β + k) and 1/(k + α), with one division.
        let right = beta + wave;
        let left = alpha + wave;
        let both = (right * left).inverse();
        let over_right = both * left;
        let over_left = both * right;
        let u0 = (sum * over_right).scale(rest);
        let u1 = (sum * over_left).scale(-layer.a2 * rest);
        let minus = -layer.modulus;
        let t0 = sum - layer.q1 * over_left * u1;
        let t1 = -(layer.q2 * over_right * u0);
        let square = Complex::real(2.0 * k * k) + layer.q2;
        Self {
            alpha,
            beta,
            gap: layer.q2.scale(1.0 - layer.a2) / sum,
            u: Square([wave, u0, alpha, u1]),
            t: Square([minus * alpha.scale(2.0 * k), minus * t0, minus * square, minus * t1]),
        }
    }

    /// Displacements and stresses at the layer's top for the reflection R at its bottom.
    fn above(&self, layer: &Layer, reflection: Square) -> (Square, Square) {
        let x = self.transfer(layer.thickness).around(reflection);
        let u_up = self.u.mirrored();
        let t_up = self.t.mirrored().negative();
        (self.u.plus(u_up.times(x)), self.t.plus(t_up.times(x)))
    }

    /// Λ = [[e^(−αh), −g], [0, e^(−βh)]], g = (e^(−αh) − e^(−βh))/(β − α).
    fn transfer(&self, h: f64) -> Transfer {
        let pressure = self.alpha.scale(-h).exp();
        let x = self.gap.scale(-h);
        if x.square() > 0.01 {
            let shear = self.beta.scale(-h).exp();
            return Transfer { pressure, shear, mixed: (pressure - shear) / self.gap };
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
        let first = self.pressure * a - self.mixed * c;
        let second = self.pressure * b - self.mixed * d;
        let third = self.shear * c;
        let fourth = self.shear * d;
        Square([
            first * self.pressure,
            second * self.shear - first * self.mixed,
            third * self.pressure,
            fourth * self.shear - third * self.mixed,
        ])
    }
}

/// A complex 2 × 2 matrix, row by row.
#[derive(Clone, Copy, Default)]
struct Square([Complex; 4]);

impl Square {
    const UNIT: Self = {
        let zero = Complex::new(0.0, 0.0);
        let one = Complex::new(1.0, 0.0);
        Self([one, zero, zero, one])
    };

    /// diag(1, −1) A: displacements of the mirrored waves.
    fn mirrored(self) -> Self {
        let Self([a, b, c, d]) = self;
        Self([a, b, -c, -d])
    }

    fn negative(self) -> Self {
        Self(self.0.map(|x| -x))
    }

    fn plus(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }

    fn minus(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] - other.0[i]))
    }

    fn times(self, other: Self) -> Self {
        let (Self([a, b, c, d]), Self([e, f, g, h])) = (self, other);
        Self([a * e + b * g, a * f + b * h, c * e + d * g, c * f + d * h])
    }

    /// A⁻¹ B.
    fn solve(self, other: Self) -> Self {
        let Self([a, b, c, d]) = self;
        let scale = (a * d - b * c).inverse();
        let Self([e, f, g, h]) = other;
        Self([d * e - b * g, d * f - b * h, a * g - c * e, a * h - c * f].map(|x| x * scale))
    }

    /// A B⁻¹.
    fn times_inverse(self, other: Self) -> Self {
        let Self([e, f, g, h]) = other;
        let scale = (e * h - f * g).inverse();
        let Self([a, b, c, d]) = self;
        Self([a * h - b * g, b * e - a * f, c * h - d * g, d * e - c * f].map(|x| x * scale))
    }
}

#[cfg(test)]
mod tests;
