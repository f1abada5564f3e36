//! P–SV waves of one horizontal slowness, from the base to the surface.
//!
//! All goes with e^(s(t − px)), z down. Waves that go up have amplitudes A = (P, SV), those that go
//! down B; displacements (x, z) and stresses (xz, zz)/(−s) are
//!
//! U↓ = [[p, b], [a, −p]],  T↓ = μ [[2pa, g], [g, −2pb]];  U↑ = diag(1, −1) U↓,  T↑ = diag(−1, 1) T↓
//!
//! The reflection R that takes A to B is carried down from the free surface, with decaying
//! exponentials only: so is the surface motion by A (Kennett 1983, ch. 6).
//!
//! | symbol | meaning |
//! |---|---|
//! | p | horizontal slowness, real |
//! | a, b | vertical slownesses √(1/c₁² − p²), √(1/c₂² − p²), with e^(−saz) going down or decaying |
//! | g = b² − p², r = g² + 4p²ab | the latter Rayleigh's function |
//! | μ, ρ | complex shear modulus, density |

use crate::linalg::Complex;
use crate::soil::Soil;

/// Squared vertical slowness of a layer, relative to that of the wave at vertical incidence, that
/// passes for zero. Up and down are the same wave there; results are even in a and b, so this
/// costs as much of them, and rounding over its root no more.
const GRAZING: f64 = 4e-11;
/// Share of a number that is rounding.
const ROUNDING: f64 = 1e-12;

/// A layer or half-plane at one s and p.
#[derive(Debug, Clone, Copy)]
pub(super) struct Medium {
    modulus: Complex,
    density: f64,
    p: f64,
    a: Complex,
    b: Complex,
    g: Complex,
    /// 1/c₂², 1/c₁².
    pub(super) shear: Complex,
    pub(super) pressure: Complex,
}

/// A 2 × 2 matrix, row by row.
type Square = [Complex; 4];

impl Medium {
    /// Slownesses of a finite layer.
    pub(super) fn layer(soil: Soil, modulus: Complex, s: Complex, p: f64) -> Self {
        let [shear, pressure] = squares(soil, modulus);
        let floor = |square: Complex| {
            let below = square - Complex::real(p * p);
            if below.abs() < GRAZING * square.abs() { square.scale(GRAZING) } else { below }
        };
        Self::new(soil, modulus, s, p, [floor(pressure), floor(shear)])
    }

    /// Shear stress across over velocity in an SH wave.
    fn impedance(&self) -> Complex {
        self.modulus * self.b
    }

    /// Vertical slownesses (a, b).
    pub(super) fn slownesses(&self) -> [Complex; 2] {
        [self.a, self.b]
    }

    /// Slownesses of the half-plane below, from which the wave comes; `own` is the elastic slowness of this wave and
    /// the cosine of its angle, which give its vertical slowness without cancellation.
    pub(super) fn base(soil: Soil, modulus: Complex, s: Complex, p: f64, own: [f64; 2]) -> Self {
        let elastic = Complex::real(soil.shear_modulus());
        let change = (elastic - modulus) / modulus;
        let [shear, pressure] =
            [soil.shear_wave_speed(), soil.pressure_wave_speed()].map(|speed| {
                let flat = if own[0] == 1.0 / speed {
                    (own[0] * own[1]).powi(2)
                } else {
                    speed.powi(-2) - p * p
                };
                change.scale(speed.powi(-2)) + Complex::real(flat)
            });
        Self::new(soil, modulus, s, p, [pressure, shear])
    }

    fn new(soil: Soil, modulus: Complex, s: Complex, p: f64, below: [Complex; 2]) -> Self {
        let [shear, pressure] = squares(soil, modulus);
        // Frequency zero is the limit from above.
        let direction = if s == Complex::default() { Complex::new(0.0, 1.0) } else { s };
        let [a, b] = below.map(|square| {
            let root = square.sqrt();
            let decay = direction * root;
            if decay.re < -ROUNDING * decay.abs() { -root } else { root }
        });
        let g = below[1] - Complex::real(p * p);
        Self { modulus, density: soil.density(), p, a, b, g, shear, pressure }
    }

    /// Motion of a free surface, to the right and up, by the waves A that come up to it.
    pub(super) fn free_surface(&self) -> Square {
        let Self { p, a, b, g, .. } = *self;
        let scale = self.shear.scale(2.0) / self.rayleigh();
        let mixed = (a * b).scale(2.0 * p);
        [mixed, b * g, a * g, -mixed].map(|x| x * scale)
    }

    fn rayleigh(&self) -> Complex {
        self.g * self.g + (self.a * self.b).scale(4.0 * self.p * self.p)
    }

    /// R at a free surface.
    fn surface_reflection(&self) -> Square {
        let Self { p, a, b, g, .. } = *self;
        let scale = self.rayleigh().inverse();
        let difference = (a * b).scale(4.0 * p * p) - g * g;
        [difference, (b * g).scale(4.0 * p), (a * g).scale(4.0 * p), -difference].map(|x| x * scale)
    }

    /// Displacements (x, z) and stresses where A is one wave of two, and B = R A.
    fn states(&self, reflection: Square) -> [[Complex; 4]; 2] {
        let Self { modulus, p, a, b, g, .. } = *self;
        [0, 1].map(|wave| {
            let up = [1 - wave, wave].map(|one| Complex::real(one as f64));
            let down = [reflection[wave], reflection[2 + wave]];
            let sums = [down[0] + up[0], down[1] + up[1]];
            let differences = [down[0] - up[0], down[1] - up[1]];
            [
                sums[0].scale(p) + b * sums[1],
                a * differences[0] - differences[1].scale(p),
                modulus * ((a * differences[0]).scale(2.0 * p) + g * differences[1]),
                modulus * (g * sums[0] - (b * sums[1]).scale(2.0 * p)),
            ]
        })
    }

    /// A and B of this state, each times (a, b).
    fn waves(&self, [x, z, shear, normal]: [Complex; 4]) -> [[Complex; 2]; 2] {
        let Self { modulus, p, a, b, g, .. } = *self;
        let half = 0.5 / self.density;
        let sums = [a * ((modulus * x).scale(2.0 * p) + normal), modulus * g * x - normal.scale(p)];
        let differences =
            [modulus * g * z + shear.scale(p), b * (shear - (modulus * z).scale(2.0 * p))];
        let up = [0, 1].map(|i| (sums[i] - differences[i]).scale(half));
        let down = [0, 1].map(|i| (sums[i] + differences[i]).scale(half));
        [up, down]
    }
}

/// 1/c₂² and 1/c₁².
fn squares(soil: Soil, modulus: Complex) -> [Complex; 2] {
    let shear = modulus.inverse().scale(soil.density());
    [shear, shear.scale(soil.speed_ratio_squared())]
}

fn times([a, b, c, d]: Square, [e, f, g, h]: Square) -> Square {
    [a * e + b * g, a * f + b * h, c * e + d * g, c * f + d * h]
}

fn inverse([a, b, c, d]: Square) -> Square {
    let scale = (a * d - b * c).inverse();
    [d, -b, -c, a].map(|x| x * scale)
}

/// Motion of the surface, to the right and up, by the waves A that come up in `base`: under `layers`
/// (from the surface down, each with s h a and s h b).
pub(super) fn surface_motion(
    layers: impl Iterator<Item = (Medium, [Complex; 2])>,
    base: &Medium,
) -> Square {
    // The surface by A at the bottom of a layer, and R there.
    let mut above: Option<(Medium, Square, Square)> = None;
    let enter = |medium: &Medium, above: Option<(Medium, Square, Square)>| match above {
        None => (medium.free_surface(), medium.surface_reflection()),
        Some((upper, surface, reflection)) => {
            let states = upper.states(reflection);
            let [first, second] = states.map(|state| medium.waves(state));
            let column = |k: usize| [first[k][0], second[k][0], first[k][1], second[k][1]];
            // A' = diag(1/a, 1/b) M A, and the same for B'.
            let back = inverse(column(0));
            let [p, q, r, t] = times(column(1), back);
            let ratio = medium.a / medium.b;
            let reflection = [p, q / ratio, r * ratio, t];
            let [k, l, m, n] = times(surface, back);
            ([k * medium.a, l * medium.b, m * medium.a, n * medium.b], reflection)
        }
    };
    for (medium, travels) in layers {
        let ([k, l, m, n], [p, q, r, t]) = enter(&medium, above);
        let [e, f] = travels.map(|travel| (-travel).exp());
        let surface = [k * e, l * f, m * e, n * f];
        above = Some((medium, surface, [p * e * e, q * e * f, r * e * f, t * f * f]));
    }
    enter(base, above).0
}

/// Motion of the surface across p by an SH wave of unit displacement that comes up in `base`: under `layers` (from the
/// surface down, each with s h b). Where it meets the next medium down, u = (1 + R) A and the stress, μ b (1 − R) A, go
/// on.
pub(super) fn surface_motion_across(
    layers: impl Iterator<Item = (Medium, Complex)>,
    base: &Medium,
) -> Complex {
    let one = Complex::real(1.0);
    let (mut surface, mut reflection) = (one + one, one);
    let mut above: Option<Medium> = None;
    let decays = layers.map(|(medium, travel)| (medium, (-travel).exp()));
    for (medium, decay) in decays.chain([(*base, one)]) {
        if let Some(upper) = above.replace(medium) {
            let sum = one + reflection;
            let rest = (one - reflection) * upper.impedance() / medium.impedance();
            surface = surface.scale(2.0) / (sum + rest);
            reflection = (sum - rest) / (sum + rest);
        }
        surface = surface * decay;
        reflection = reflection * decay * decay;
    }
    surface
}
