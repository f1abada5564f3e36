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
/// At zero, the upward and the downward wave are the same. Results are even in a and b, so that the limit changes them by
/// about its value. The rounding errors, divided by the square root of the limit, are not larger.
const MIN_GRAZING_SLOWNESS_RATIO: f64 = 4e-11;
/// Relative magnitude of a real part below which its sign depends on rounding.
const SIGN_TOLERANCE: f64 = 1e-12;

/// Incident wave in the base, with the wave speed of the elastic constants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct IncidentWave {
    /// 1/c of the wave, s/m.
    pub(super) slowness: f64,
    /// Cosine of its angle from the vertical.
    pub(super) cosine: f64,
}

/// A layer or half-plane for waves of one slowness p, with one s in each lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct WaveMedium<C> {
    /// Complex shear modulus μ, Pa.
    modulus: C,
    /// Density ρ, kg/m³.
    density: f64,
    /// Horizontal slowness, s/m.
    p: f64,
    /// Vertical slowness of P waves, s/m.
    a: C,
    /// Vertical slowness of S waves, s/m.
    b: C,
    /// g = b² − p², s²/m².
    g: C,
    /// 1/c₂².
    pub(super) squared_s_slowness: C,
    /// 1/c₁².
    pub(super) squared_p_slowness: C,
}

/// A 2 × 2 matrix, row by row.
type Square<C> = [C; 4];

impl<C: ComplexArithmetic> WaveMedium<C> {
    /// Medium of a layer of finite thickness.
    #[inline(always)]
    pub(super) fn layer(soil: Soil, modulus: C, s: C, p: f64) -> Self {
        let squared_s_slowness = squared_shear_slowness(soil, modulus);
        let squared_p_slowness = squared_s_slowness.scale(soil.speed_ratio_squared());
        let squared_p = modulus.like_real(p * p);
        let squared_a = (squared_p_slowness - squared_p)
            .at_least(squared_p_slowness.scale(MIN_GRAZING_SLOWNESS_RATIO));
        let squared_b = (squared_s_slowness - squared_p)
            .at_least(squared_s_slowness.scale(MIN_GRAZING_SLOWNESS_RATIO));
        Self::new(soil, modulus, s, p, [squared_a, squared_b])
    }

    /// Impedance of an SH wave: its shear stress per velocity.
    #[inline(always)]
    fn impedance(&self) -> C {
        self.modulus * self.b
    }

    /// Vertical slownesses (a, b).
    #[inline(always)]
    pub(super) fn slownesses(&self) -> [C; 2] {
        [self.a, self.b]
    }

    /// Medium of the half-plane below the layers, from which the wave comes.
    ///
    /// `incident`: its cosine gives the vertical slowness of the wave without cancellation.
    #[inline(always)]
    pub(super) fn base(soil: Soil, modulus: C, s: C, p: f64, incident: IncidentWave) -> Self {
        let elastic_modulus = modulus.like_real(soil.shear_modulus());
        let modulus_change = (elastic_modulus - modulus) * modulus.inverse();
        let mut vertical_squares = [modulus_change; 2];
        let speeds = [soil.pressure_wave_speed(), soil.shear_wave_speed()];
        for (square, speed) in vertical_squares.iter_mut().zip(speeds) {
            let elastic_square = if incident.slowness == 1.0 / speed {
                (incident.slowness * incident.cosine).powi(2)
            } else {
                speed.powi(-2) - p * p
            };
            *square =
                modulus_change.scale(speed.powi(-2)) + modulus_change.like_real(elastic_square);
        }
        Self::new(soil, modulus, s, p, vertical_squares)
    }

    /// Medium with these squares of the vertical slownesses, a² and b².
    ///
    /// `s`: i at frequency zero, which is the limit from above.
    #[inline(always)]
    fn new(soil: Soil, modulus: C, s: C, p: f64, vertical_squares: [C; 2]) -> Self {
        let squared_s_slowness = squared_shear_slowness(soil, modulus);
        let squared_p_slowness = squared_s_slowness.scale(soil.speed_ratio_squared());
        let a_root = vertical_squares[0].sqrt();
        let b_root = vertical_squares[1].sqrt();
        let a = a_root.negated_where_negative(s * a_root, SIGN_TOLERANCE);
        let b = b_root.negated_where_negative(s * b_root, SIGN_TOLERANCE);
        let g = vertical_squares[1] - s.like_real(p * p);
        Self {
            modulus,
            density: soil.density(),
            p,
            a,
            b,
            g,
            squared_s_slowness,
            squared_p_slowness,
        }
    }

    /// Motion of a free surface, to the right and up, due to the incident waves A.
    #[inline(always)]
    pub(super) fn free_surface(&self) -> Square<C> {
        let Self { p, a, b, g, .. } = *self;
        let scale = self.squared_s_slowness.scale(2.0) * self.rayleigh().inverse();
        let mixed_product = (a * b).scale(2.0 * p);
        scaled([mixed_product, b * g, a * g, -mixed_product], scale)
    }

    /// Rayleigh's function r.
    #[inline(always)]
    fn rayleigh(&self) -> C {
        self.g * self.g + (self.a * self.b).scale(4.0 * self.p * self.p)
    }

    /// Reflection R at a free surface.
    #[inline(always)]
    fn surface_reflection(&self) -> Square<C> {
        let Self { p, a, b, g, .. } = *self;
        let scale = self.rayleigh().inverse();
        let p_due_to_p = (a * b).scale(4.0 * p * p) - g * g;
        let p_due_to_sv = (b * g).scale(4.0 * p);
        let sv_due_to_p = (a * g).scale(4.0 * p);
        scaled([p_due_to_p, p_due_to_sv, sv_due_to_p, -p_due_to_p], scale)
    }

    /// Displacements (x, z) and stresses due to upward and downward waves (P, SV).
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

    /// Amplitudes A and B, times (a, b), of the waves with these displacements and stresses.
    #[inline(always)]
    fn waves(&self, [x, z, shear, normal]: [C; 4]) -> [[C; 2]; 2] {
        let Self { modulus, p, a, b, g, .. } = *self;
        let half_inverse_density = 0.5 / self.density;
        let sums = [a * ((modulus * x).scale(2.0 * p) + normal), modulus * g * x - normal.scale(p)];
        let differences =
            [modulus * g * z + shear.scale(p), b * (shear - (modulus * z).scale(2.0 * p))];
        let up_p = (sums[0] - differences[0]).scale(half_inverse_density);
        let up_sv = (sums[1] - differences[1]).scale(half_inverse_density);
        let down_p = (sums[0] + differences[0]).scale(half_inverse_density);
        let down_sv = (sums[1] + differences[1]).scale(half_inverse_density);
        [[up_p, up_sv], [down_p, down_sv]]
    }
}

/// 1/c₂².
#[inline(always)]
fn squared_shear_slowness<C: ComplexArithmetic>(soil: Soil, modulus: C) -> C {
    modulus.inverse().scale(soil.density())
}

/// Product of two matrices.
#[inline(always)]
fn times<C: ComplexArithmetic>([a, b, c, d]: Square<C>, [e, f, g, h]: Square<C>) -> Square<C> {
    [a * e + b * g, a * f + b * h, c * e + d * g, c * f + d * h]
}

/// Matrix times a number.
#[inline(always)]
fn scaled<C: ComplexArithmetic>([a, b, c, d]: Square<C>, scale: C) -> Square<C> {
    [a * scale, b * scale, c * scale, d * scale]
}

/// Inverse of a matrix.
#[inline(always)]
fn inverse<C: ComplexArithmetic>([a, b, c, d]: Square<C>) -> Square<C> {
    let scale = (a * d - b * c).inverse();
    scaled([d, -b, -c, a], scale)
}

/// A layer, and the complex phases s h a and s h b of the waves through it.
#[derive(Clone, Copy)]
pub(super) struct InclinedLayerWaves<C> {
    pub(super) medium: WaveMedium<C>,
    pub(super) phases: [C; 2],
}

/// Surface motion due to waves A at one depth of a medium, and the reflection R there.
struct SurfaceTransfer<C> {
    medium: WaveMedium<C>,
    /// Motion of the surface due to unit P and unit SV upwards.
    surface: Square<C>,
    /// Reflection R.
    reflection: Square<C>,
}

impl<C: ComplexArithmetic> SurfaceTransfer<C> {
    /// Transfer at the top of `medium`.
    ///
    /// `upper_transfer`: transfer at the bottom of the medium above; `None` at the free surface.
    #[inline(always)]
    #[allow(clippy::needless_pass_by_value, reason = "a value that is not used again")]
    fn at_next_medium(upper_transfer: Option<Self>, medium: WaveMedium<C>) -> Self {
        let Some(Self { medium: upper_medium, surface, reflection }) = upper_transfer else {
            let surface = medium.free_surface();
            return Self { medium, surface, reflection: medium.surface_reflection() };
        };
        let one = medium.a.like_real(1.0);
        let zero = medium.a.like_real(0.0);
        // Waves (up, down) in this medium due to unit P and unit SV upwards in the medium above.
        let p_waves = medium.waves(upper_medium.state([one, zero], [reflection[0], reflection[2]]));
        let sv_waves =
            medium.waves(upper_medium.state([zero, one], [reflection[1], reflection[3]]));
        // A' = diag(1/a, 1/b) M A, and B' in the same way.
        let up_inverse = inverse([p_waves[0][0], sv_waves[0][0], p_waves[0][1], sv_waves[0][1]]);
        let down_waves = [p_waves[1][0], sv_waves[1][0], p_waves[1][1], sv_waves[1][1]];
        let [pp, ps, sp, ss] = times(down_waves, up_inverse);
        let slowness_ratio = medium.a * medium.b.inverse();
        let reflection = [pp, ps * slowness_ratio.inverse(), sp * slowness_ratio, ss];
        let [xp, xs, zp, zs] = times(surface, up_inverse);
        let surface = [xp * medium.a, xs * medium.b, zp * medium.a, zs * medium.b];
        Self { medium, surface, reflection }
    }

    /// Transfer at the bottom of the layer, if this is the transfer at its top.
    #[inline(always)]
    fn through_layer(self, phases: [C; 2]) -> Self {
        let p_decay = (-phases[0]).exp();
        let s_decay = (-phases[1]).exp();
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
/// `layers`: from the surface down.
#[inline(always)]
pub(super) fn surface_motion<C: ComplexArithmetic>(
    layers: &[InclinedLayerWaves<C>],
    base: &WaveMedium<C>,
) -> Square<C> {
    let mut upper_transfer = None;
    for layer in layers {
        let top_transfer = SurfaceTransfer::at_next_medium(upper_transfer, layer.medium);
        upper_transfer = Some(top_transfer.through_layer(layer.phases));
    }
    SurfaceTransfer::at_next_medium(upper_transfer, *base).surface
}

/// Motion of the surface due to an SH wave of unit displacement in `base`.
///
/// `layers`: from the surface down. Displacement u = (1 + R) A and stress μ b (1 − R) A
/// are continuous between layers.
#[inline(always)]
pub(super) fn sh_surface_motion<C: ComplexArithmetic>(
    layers: &[InclinedLayerWaves<C>],
    base: &WaveMedium<C>,
) -> C {
    let zero = base.a.like_real(0.0);
    let one = base.a.like_real(1.0);
    let mut surface = one + one;
    let mut reflection = one;
    let mut upper_medium: Option<WaveMedium<C>> = None;
    let at_base = InclinedLayerWaves { medium: *base, phases: [zero; 2] };
    for &InclinedLayerWaves { medium, phases: [_, phase] } in layers.iter().chain(&[at_base]) {
        if let Some(upper) = upper_medium.replace(medium) {
            let displacement = one + reflection;
            let stress = (one - reflection) * upper.impedance() * medium.impedance().inverse();
            let scale = (displacement + stress).inverse();
            surface = surface.scale(2.0) * scale;
            reflection = (displacement - stress) * scale;
        }
        let decay = (-phase).exp();
        surface = surface * decay;
        reflection = reflection * decay * decay;
    }
    surface
}
