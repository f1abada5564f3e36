//! P–SV waves of one horizontal slowness, from the base to the surface.
//!
//! All quantities vary as e^(s(t − px)), z down. Waves that go up have the amplitudes A = (P, SV), waves that go
//! down B; displacements (x, z) and stresses (xz, zz)/(−s) are
//!
//! U↓ = [[p, b], [a, −p]],  T↓ = μ [[2pa, g], [g, −2pb]];  U↑ = diag(1, −1) U↓,  T↑ = diag(−1, 1) T↓
//!
//! The reflection R (B = R A) is computed from the free surface downwards, with decaying exponentials only. So is the
//! surface motion due to A (Kennett 1983, ch. 6).
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

/// Smallest squared vertical slowness of a layer, relative to the value at vertical incidence.
///
/// At zero, up-going and down-going waves are the same. Results are even in a and b, so this limit changes them by its
/// value; rounding divided by its square root is not larger.
const GRAZING_SLOWNESS_RATIO: f64 = 4e-11;
/// Relative size up to which the sign of a real part is rounding.
const SIGN_ROUNDING: f64 = 1e-12;

/// Incident wave in the base, by its elastic constants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct IncidentWave {
    /// 1/c of the wave, s/m.
    pub(super) slowness: f64,
    /// Cosine of its angle from the vertical.
    pub(super) cosine: f64,
}

/// A layer or half-plane at one p, and at one s in each lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct WaveMedium<C> {
    modulus: C,
    density: f64,
    p: f64,
    a: C,
    b: C,
    g: C,
    /// 1/c₂².
    pub(super) shear: C,
    /// 1/c₁².
    pub(super) pressure: C,
}

/// A 2 × 2 matrix, row by row.
type Square<C> = [C; 4];

impl<C: ComplexArithmetic> WaveMedium<C> {
    /// Slownesses of a finite layer.
    #[inline(always)]
    pub(super) fn layer(soil: Soil, modulus: C, s: C, p: f64) -> Self {
        let shear = squared_shear_slowness(soil, modulus);
        let pressure = shear.scale(soil.speed_ratio_squared());
        let horizontal = modulus.like_real(p * p);
        let pressure = (pressure - horizontal).at_least(pressure.scale(GRAZING_SLOWNESS_RATIO));
        let shear = (shear - horizontal).at_least(shear.scale(GRAZING_SLOWNESS_RATIO));
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
    /// `incident` gives the vertical slowness of this wave without cancellation.
    #[inline(always)]
    pub(super) fn base(soil: Soil, modulus: C, s: C, p: f64, incident: IncidentWave) -> Self {
        let elastic = modulus.like_real(soil.shear_modulus());
        let change = (elastic - modulus) * modulus.inverse();
        let mut squares = [change; 2];
        let speeds = [soil.pressure_wave_speed(), soil.shear_wave_speed()];
        for (square, speed) in squares.iter_mut().zip(speeds) {
            let elastic_square = if incident.slowness == 1.0 / speed {
                (incident.slowness * incident.cosine).powi(2)
            } else {
                speed.powi(-2) - p * p
            };
            *square = change.scale(speed.powi(-2)) + change.like_real(elastic_square);
        }
        Self::new(soil, modulus, s, p, squares)
    }

    /// Medium with these squares of vertical slownesses (of P, of S).
    ///
    /// Frequency zero is the limit from above, s = i.
    #[inline(always)]
    fn new(soil: Soil, modulus: C, s: C, p: f64, vertical_squares: [C; 2]) -> Self {
        let shear = squared_shear_slowness(soil, modulus);
        let pressure = shear.scale(soil.speed_ratio_squared());
        let a = vertical_squares[0].sqrt();
        let b = vertical_squares[1].sqrt();
        let a = a.negated_where_negative(s * a, SIGN_ROUNDING);
        let b = b.negated_where_negative(s * b, SIGN_ROUNDING);
        let g = vertical_squares[1] - s.like_real(p * p);
        Self { modulus, density: soil.density(), p, a, b, g, shear, pressure }
    }

    /// Motion of a free surface, to the right and up, due to the waves A below it.
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
        let p_by_sv = (b * g).scale(4.0 * p);
        let sv_by_p = (a * g).scale(4.0 * p);
        scaled([difference, p_by_sv, sv_by_p, -difference], scale)
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
        let up_p = (sums[0] - differences[0]).scale(half);
        let up_sv = (sums[1] - differences[1]).scale(half);
        let down_p = (sums[0] + differences[0]).scale(half);
        let down_sv = (sums[1] + differences[1]).scale(half);
        [[up_p, up_sv], [down_p, down_sv]]
    }
}

/// 1/c₂².
#[inline(always)]
fn squared_shear_slowness<C: ComplexArithmetic>(soil: Soil, modulus: C) -> C {
    modulus.inverse().scale(soil.density())
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

/// A layer, and the exponents s h a and s h b of the waves through it.
#[derive(Clone, Copy)]
pub(super) struct LayerWaves<C> {
    pub(super) medium: WaveMedium<C>,
    pub(super) travels: [C; 2],
}

/// Surface motion due to the waves A at one depth of a medium, and R there.
struct SurfaceTransfer<C> {
    medium: WaveMedium<C>,
    surface: Square<C>,
    reflection: Square<C>,
}

impl<C: ComplexArithmetic> SurfaceTransfer<C> {
    /// At the top of `medium`, from the bottom of the one `above`; without one, at the free surface.
    #[inline(always)]
    #[allow(clippy::needless_pass_by_value, reason = "a value that is not used again")]
    fn at_next_medium(above: Option<Self>, medium: WaveMedium<C>) -> Self {
        let Some(Self { medium: upper, surface, reflection }) = above else {
            let surface = medium.free_surface();
            return Self { medium, surface, reflection: medium.surface_reflection() };
        };
        let one = medium.a.like_real(1.0);
        let zero = medium.a.like_real(0.0);
        // Waves (up, down) in the medium due to unit P and unit SV upwards above it.
        let by_p = medium.waves(upper.state([one, zero], [reflection[0], reflection[2]]));
        let by_sv = medium.waves(upper.state([zero, one], [reflection[1], reflection[3]]));
        // A' = diag(1/a, 1/b) M A, and B' in the same way.
        let up_inverse = inverse([by_p[0][0], by_sv[0][0], by_p[0][1], by_sv[0][1]]);
        let down = [by_p[1][0], by_sv[1][0], by_p[1][1], by_sv[1][1]];
        let [pp, ps, sp, ss] = times(down, up_inverse);
        let ratio = medium.a * medium.b.inverse();
        let reflection = [pp, ps * ratio.inverse(), sp * ratio, ss];
        let [xp, xs, zp, zs] = times(surface, up_inverse);
        let surface = [xp * medium.a, xs * medium.b, zp * medium.a, zs * medium.b];
        Self { medium, surface, reflection }
    }

    /// From the top to the bottom of a layer.
    #[inline(always)]
    fn through_layer(self, travels: [C; 2]) -> Self {
        let p_decay = (-travels[0]).exp();
        let s_decay = (-travels[1]).exp();
        let [xp, xs, zp, zs] = self.surface;
        let [pp, ps, sp, ss] = self.reflection;
        Self {
            medium: self.medium,
            surface: [xp * p_decay, xs * s_decay, zp * p_decay, zs * s_decay],
            reflection: [
                pp * p_decay * p_decay,
                ps * p_decay * s_decay,
                sp * p_decay * s_decay,
                ss * s_decay * s_decay,
            ],
        }
    }
}

/// Motion of the surface, to the right and up, due to the waves A in `base`.
///
/// `layers` from the surface down.
#[inline(always)]
pub(super) fn surface_motion<C: ComplexArithmetic>(
    layers: &[LayerWaves<C>],
    base: &WaveMedium<C>,
) -> Square<C> {
    let mut above = None;
    for layer in layers {
        let top = SurfaceTransfer::at_next_medium(above, layer.medium);
        above = Some(top.through_layer(layer.travels));
    }
    SurfaceTransfer::at_next_medium(above, *base).surface
}

/// Motion of the surface across p by an SH wave of unit displacement in `base`.
///
/// `layers` from the surface down. Displacement u = (1 + R) A and stress μ b (1 − R) A
/// are continuous between layers.
#[inline(always)]
pub(super) fn surface_motion_across<C: ComplexArithmetic>(
    layers: &[LayerWaves<C>],
    base: &WaveMedium<C>,
) -> C {
    let zero = base.a.like_real(0.0);
    let one = base.a.like_real(1.0);
    let mut surface = one + one;
    let mut reflection = one;
    let mut above: Option<WaveMedium<C>> = None;
    let at_base = LayerWaves { medium: *base, travels: [zero; 2] };
    for &LayerWaves { medium, travels: [_, travel] } in layers.iter().chain(&[at_base]) {
        if let Some(upper) = above.replace(medium) {
            let displacement = one + reflection;
            let stress = (one - reflection) * upper.impedance() * medium.impedance().inverse();
            let scale = (displacement + stress).inverse();
            surface = surface.scale(2.0) * scale;
            reflection = (displacement - stress) * scale;
        }
        let decay = (-travel).exp();
        surface = surface * decay;
        reflection = reflection * decay * decay;
    }
    surface
}
