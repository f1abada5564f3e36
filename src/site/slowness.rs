//! P–SV waves of one horizontal slowness, from the base to the surface.
//!
//! All quantities vary as e^(s(t − px)), z down. Waves that go up have the amplitudes A = (P, SV), waves that go
//! down B; displacements (x, z) and stresses (xz, zz)/(−s) are
//!
//! U↓ = [[p, b], [a, −p]],  T↓ = μ [[2pa, g], [g, −2pb]];  U↑ = diag(1, −1) U↓,  T↑ = diag(−1, 1) T↓
//!
//! The reflection R from A to B is carried down from the free surface, with decaying exponentials only. So is the
//! surface motion by A (Kennett 1983, ch. 6).
//!
//! | symbol | meaning |
//! |---|---|
//! | p | horizontal slowness, real |
//! | a, b | vertical slownesses √(1/c₁² − p²), √(1/c₂² − p²), with e^(−saz) going down or decaying |
//! | g = b² − p², r = g² + 4p²ab | r is Rayleigh's function |
//! | μ, ρ | complex shear modulus, density |

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use crate::linalg::ComplexArithmetic;
use crate::soil::Soil;

/// Squared vertical slowness of a layer, relative to the value at vertical incidence, that counts as zero.
///
/// Up-going and down-going waves are the same there. Results are even in a and b, so they change by this fraction;
/// rounding divided by its root is not larger.
const GRAZING: f64 = 4e-11;
/// Fraction of a number that counts as rounding.
const ROUNDING: f64 = 1e-12;

/// A layer or half-plane at one p, and at one s in each lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Medium<C> {
    modulus: C,
    density: f64,
    p: f64,
    a: C,
    b: C,
    g: C,
    /// 1/c₂², 1/c₁².
    pub(super) shear: C,
    pub(super) pressure: C,
}

/// A 2 × 2 matrix, row by row.
type Square<C> = [C; 4];

impl<C: ComplexArithmetic> Medium<C> {
    /// Slownesses of a finite layer.
    #[inline(always)]
    pub(super) fn layer(soil: Soil, modulus: C, s: C, p: f64) -> Self {
        let [shear, pressure] = squares(soil, modulus);
        let flat = modulus.like_real(p * p);
        let pressure = (pressure - flat).at_least(pressure.scale(GRAZING));
        let shear = (shear - flat).at_least(shear.scale(GRAZING));
        Self::new(soil, modulus, s, p, [pressure, shear])
    }

    /// Shear stress over velocity, both across, in an SH wave.
    #[inline(always)]
    fn impedance(&self) -> C {
        self.modulus * self.b
    }

    /// Vertical slownesses (a, b).
    #[inline(always)]
    pub(super) fn slownesses(&self) -> [C; 2] {
        [self.a, self.b]
    }

    /// Slownesses of the half-plane below, from which the wave comes.
    ///
    /// `own`: elastic slowness of this wave and the cosine of its angle, which give its vertical slowness without
    /// cancellation.
    #[inline(always)]
    pub(super) fn base(soil: Soil, modulus: C, s: C, p: f64, own: [f64; 2]) -> Self {
        let elastic = modulus.like_real(soil.shear_modulus());
        let change = (elastic - modulus) * modulus.inverse();
        let mut below = [change; 2];
        let speeds = [soil.pressure_wave_speed(), soil.shear_wave_speed()];
        for (below, speed) in below.iter_mut().zip(speeds) {
            let flat = if own[0] == 1.0 / speed {
                (own[0] * own[1]).powi(2)
            } else {
                speed.powi(-2) - p * p
            };
            *below = change.scale(speed.powi(-2)) + change.like_real(flat);
        }
        Self::new(soil, modulus, s, p, below)
    }

    /// Medium with these squares of vertical slownesses; frequency zero is the limit from above, s = i.
    #[inline(always)]
    fn new(soil: Soil, modulus: C, s: C, p: f64, below: [C; 2]) -> Self {
        let [shear, pressure] = squares(soil, modulus);
        let (a, b) = (below[0].sqrt(), below[1].sqrt());
        let a = a.negated_where_negative(s * a, ROUNDING);
        let b = b.negated_where_negative(s * b, ROUNDING);
        let g = below[1] - s.like_real(p * p);
        Self { modulus, density: soil.density(), p, a, b, g, shear, pressure }
    }

    /// Motion of a free surface, to the right and up, by the waves A below it.
    #[inline(always)]
    pub(super) fn free_surface(&self) -> Square<C> {
        let Self { p, a, b, g, .. } = *self;
        let scale = self.shear.scale(2.0) * self.rayleigh().inverse();
        let mixed = (a * b).scale(2.0 * p);
        scaled([mixed, b * g, a * g, -mixed], scale)
    }

    #[inline(always)]
    fn rayleigh(&self) -> C {
        self.g * self.g + (self.a * self.b).scale(4.0 * self.p * self.p)
    }

    /// R at a free surface.
    #[inline(always)]
    fn surface_reflection(&self) -> Square<C> {
        let Self { p, a, b, g, .. } = *self;
        let scale = self.rayleigh().inverse();
        let difference = (a * b).scale(4.0 * p * p) - g * g;
        let [right, left] = [(b * g).scale(4.0 * p), (a * g).scale(4.0 * p)];
        scaled([difference, right, left, -difference], scale)
    }

    /// Displacements (x, z) and stresses of these waves (P, SV) up and down.
    #[inline(always)]
    fn state(&self, up: [C; 2], down: [C; 2]) -> [C; 4] {
        let Self { modulus, p, a, b, g, .. } = *self;
        let sums = [down[0] + up[0], down[1] + up[1]];
        let differences = [down[0] - up[0], down[1] - up[1]];
        [
            sums[0].scale(p) + b * sums[1],
            a * differences[0] - differences[1].scale(p),
            modulus * ((a * differences[0]).scale(2.0 * p) + g * differences[1]),
            modulus * (g * sums[0] - (b * sums[1]).scale(2.0 * p)),
        ]
    }

    /// A and B of this state, each multiplied by (a, b).
    #[inline(always)]
    fn waves(&self, [x, z, shear, normal]: [C; 4]) -> [[C; 2]; 2] {
        let Self { modulus, p, a, b, g, .. } = *self;
        let half = 0.5 / self.density;
        let sums = [a * ((modulus * x).scale(2.0 * p) + normal), modulus * g * x - normal.scale(p)];
        let differences =
            [modulus * g * z + shear.scale(p), b * (shear - (modulus * z).scale(2.0 * p))];
        let [[s, t], [d, e]] = [sums, differences];
        [[(s - d).scale(half), (t - e).scale(half)], [(s + d).scale(half), (t + e).scale(half)]]
    }
}

/// 1/c₂² and 1/c₁².
#[inline(always)]
fn squares<C: ComplexArithmetic>(soil: Soil, modulus: C) -> [C; 2] {
    let shear = modulus.inverse().scale(soil.density());
    [shear, shear.scale(soil.speed_ratio_squared())]
}

#[inline(always)]
fn times<C: ComplexArithmetic>([a, b, c, d]: Square<C>, [e, f, g, h]: Square<C>) -> Square<C> {
    [a * e + b * g, a * f + b * h, c * e + d * g, c * f + d * h]
}

#[inline(always)]
fn scaled<C: ComplexArithmetic>([a, b, c, d]: Square<C>, scale: C) -> Square<C> {
    [a * scale, b * scale, c * scale, d * scale]
}

#[inline(always)]
fn inverse<C: ComplexArithmetic>([a, b, c, d]: Square<C>) -> Square<C> {
    let scale = (a * d - b * c).inverse();
    scaled([d, -b, -c, a], scale)
}

/// Surface motion by the waves A at a place, and R there, for a medium that ends at the place.
struct Above<C> {
    medium: Medium<C>,
    surface: Square<C>,
    reflection: Square<C>,
}

impl<C: ComplexArithmetic> Above<C> {
    /// The same at the top of the next medium down; without `above`, at the free surface.
    #[inline(always)]
    #[allow(clippy::needless_pass_by_value, reason = "a value that is not used again")]
    fn enter(above: Option<Self>, medium: &Medium<C>) -> [Square<C>; 2] {
        let Some(Self { medium: upper, surface, reflection }) = above else {
            return [medium.free_surface(), medium.surface_reflection()];
        };
        let (one, none) = (medium.a.like_real(1.0), medium.a.like_real(0.0));
        let [p, q, r, t] = reflection;
        let first = medium.waves(upper.state([one, none], [p, r]));
        let second = medium.waves(upper.state([none, one], [q, t]));
        // A' = diag(1/a, 1/b) M A, and B' in the same way.
        let [up, down] = [0, 1];
        let back = inverse([first[up][0], second[up][0], first[up][1], second[up][1]]);
        let below = [first[down][0], second[down][0], first[down][1], second[down][1]];
        let [p, q, r, t] = times(below, back);
        let ratio = medium.a * medium.b.inverse();
        let reflection = [p, q * ratio.inverse(), r * ratio, t];
        let [k, l, m, n] = times(surface, back);
        [[k * medium.a, l * medium.b, m * medium.a, n * medium.b], reflection]
    }
}

/// Motion of the surface, to the right and up, by the waves A in `base`.
///
/// `layers` from the surface down, each with s h a and s h b.
#[inline(always)]
pub(super) fn surface_motion<C: ComplexArithmetic>(
    layers: &[(Medium<C>, [C; 2])],
    base: &Medium<C>,
) -> Square<C> {
    let mut above = None;
    for &(medium, travels) in layers {
        let [[k, l, m, n], [p, q, r, t]] = Above::enter(above, &medium);
        let [e, f] = [(-travels[0]).exp(), (-travels[1]).exp()];
        let surface = [k * e, l * f, m * e, n * f];
        let reflection = [p * e * e, q * e * f, r * e * f, t * f * f];
        above = Some(Above { medium, surface, reflection });
    }
    Above::enter(above, base)[0]
}

/// Motion of the surface across p by an SH wave of unit displacement in `base`.
///
/// `layers` from the surface down, each with s h a and s h b. Displacement u = (1 + R) A and stress μ b (1 − R) A
/// are continuous between layers.
#[inline(always)]
pub(super) fn surface_motion_across<C: ComplexArithmetic>(
    layers: &[(Medium<C>, [C; 2])],
    base: &Medium<C>,
) -> C {
    let (none, one) = (base.a.like_real(0.0), base.a.like_real(1.0));
    let (mut surface, mut reflection) = (one + one, one);
    let mut above: Option<Medium<C>> = None;
    for &(medium, [_, travel]) in layers.iter().chain(&[(*base, [none; 2])]) {
        if let Some(upper) = above.replace(medium) {
            let sum = one + reflection;
            let rest = (one - reflection) * upper.impedance() * medium.impedance().inverse();
            let scale = (sum + rest).inverse();
            surface = surface.scale(2.0) * scale;
            reflection = (sum - rest) * scale;
        }
        let decay = (-travel).exp();
        surface = surface * decay;
        reflection = reflection * decay * decay;
    }
    surface
}
