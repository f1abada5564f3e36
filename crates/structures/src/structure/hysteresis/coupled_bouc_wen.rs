//! Bouc–Wen spring in a plane.

use super::{BiaxialResponse, corrupt};
use crate::error::Result;
use crate::structure::InternalEnergy;

/// Bouc–Wen hysteresis of Park, Wen & Ang (1986) with a vector z.
///
/// ```text
/// F = α k d + (1 − α) F_y z,      ż = (ḋ − (β |ḋ·z| + γ ḋ·z) z)/d_y,      β + γ = 1,  d_y = F_y/k
/// ```
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CoupledBoucWen {
    stiffness: f64,
    yield_force: f64,
    hardening: f64,
    /// b = β − γ.
    unloading: f64,
    deformation: [f64; 2],
    z: [f64; 2],
    dissipated: f64,
}

/// Largest |z| of a saved state: the circle of yield, and rounding.
const MAX_SAVED_Z: f64 = 1.0 + 1e-12;

impl CoupledBoucWen {
    pub(super) fn new(stiffness: f64, yield_force: f64, hardening: f64, unloading: f64) -> Self {
        Self {
            stiffness,
            yield_force,
            hardening,
            unloading,
            deformation: [0.0; 2],
            z: [0.0; 2],
            dissipated: 0.0,
        }
    }

    /// The straight path to a deformation.
    fn follow(&self, deformation: [f64; 2]) -> PlanePath {
        let x = deformation[0] - self.deformation[0];
        let y = deformation[1] - self.deformation[1];
        let length = x.hypot(y);
        let size = self.z[0].hypot(self.z[1]);
        let along = if length > 0.0 {
            [x / length, y / length]
        } else if length == 0.0 && size > 0.0 {
            self.z.map(|z| -z / size)
        } else {
            // A deformation that is not a number stays none.
            [1.0 + length, length]
        };
        let way = length * self.stiffness / self.yield_force;
        let start = [
            self.z[0] * along[0] + self.z[1] * along[1],
            self.z[1] * along[0] - self.z[0] * along[1],
        ];
        PlanePath { along, glide: Glide::along(self.unloading, start, way) }
    }

    pub(super) fn response(&self, deformation: [f64; 2]) -> BiaxialResponse {
        let path = self.follow(deformation);
        let z = path.end();
        let slope = path.slope();
        let k = self.stiffness;
        let hysteretic = 1.0 - self.hardening;
        let mut tangent = [[0.0; 2]; 2];
        for (i, row) in tangent.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                let elastic = if i == j { self.hardening } else { 0.0 };
                *entry = k * (elastic + hysteretic * 0.5 * (slope[i][j] + slope[j][i]));
            }
        }
        let force = [0, 1]
            .map(|i| self.hardening * k * deformation[i] + hysteretic * self.yield_force * z[i]);
        BiaxialResponse { force, tangent }
    }

    pub(super) fn energy(&self, deformation: [f64; 2]) -> InternalEnergy {
        let path = self.follow(deformation);
        let unit = (1.0 - self.hardening) * self.yield_force * self.yield_force / self.stiffness;
        let elastic = self.hardening * self.stiffness * squared_length(deformation);
        InternalEnergy {
            stored: 0.5 * (elastic + unit * squared_length(path.end())),
            dissipated: self.dissipated + unit * path.glide.lost,
        }
    }

    pub(super) fn commit(&mut self, deformation: [f64; 2]) {
        self.dissipated = self.energy(deformation).dissipated;
        self.z = self.follow(deformation).end();
        self.deformation = deformation;
    }

    pub(super) fn save(&self) -> Vec<f64> {
        [&self.deformation[..], &self.z, &[self.dissipated]].concat()
    }

    pub(super) fn restore(&mut self, values: &[f64]) -> Result<()> {
        match values {
            &[x, y, z_x, z_y, dissipated]
                if values.iter().all(|value| value.is_finite())
                    && z_x.hypot(z_y) <= MAX_SAVED_Z
                    && dissipated >= 0.0 =>
            {
                (self.deformation, self.z, self.dissipated) = ([x, y], [z_x, z_y], dissipated);
                Ok(())
            }
            _ => Err(corrupt()),
        }
    }
}

fn squared_length([x, y]: [f64; 2]) -> f64 {
    x * x + y * y
}

/// A straight path in the direction `along`.
struct PlanePath {
    along: [f64; 2],
    glide: Glide,
}

impl PlanePath {
    /// Vector of components along and across the path, in the axes of the spring.
    fn turned(&self, [along, across]: [f64; 2]) -> [f64; 2] {
        let direction = self.along;
        [direction[0] * along - direction[1] * across, direction[1] * along + direction[0] * across]
    }

    fn end(&self) -> [f64; 2] {
        self.turned(self.glide.end)
    }

    /// ∂z/∂(d/d_y).
    fn slope(&self) -> [[f64; 2]; 2] {
        let x = self.along[0];
        let y = self.along[1];
        let longer = self.turned(self.glide.longer);
        let turned = self.turned(self.glide.turned);
        [0, 1].map(|i| [longer[i] * x - turned[i] * y, longer[i] * y + turned[i] * x])
    }
}

/// z at the end of a straight path, in components (c, w) along and across it.
///
/// With κ = 1 while z loads (c > 0) and κ = −b while it unloads,
///
/// ```text
/// dc/dξ = 1 − κ c²,      dw/dξ = −κ c w,      1 − κ |z|² ∝ w²
/// ```
///
/// has elementary solutions by the addition theorems of tanh and tan, exact for any ξ.
#[derive(Clone, Copy)]
struct Glide {
    end: [f64; 2],
    /// ∂z/∂ξ at the end.
    longer: [f64; 2],
    /// ∂z/∂φ/ξ, with the angle φ by which the path turns about its start.
    turned: [f64; 2],
    /// Energy ∫ (c − z·dz/dξ) dξ dissipated on the path.
    lost: f64,
}

impl Glide {
    /// Path of the length `way` from z = `start`; b = `unloading`.
    fn along(unloading: f64, start: [f64; 2], way: f64) -> Self {
        if start[0] >= 0.0 {
            return Phase::loading(way).glide(start);
        }
        let root = unloading.sqrt();
        // Way until c = 0.
        let turn = if root > 0.0 { (-root * start[0]).atan() / root } else { -start[0] };
        if way <= turn {
            return Phase::unloading(unloading, way).glide(start);
        }
        let first = Phase::unloading(unloading, turn).glide(start);
        let rest = Phase::loading(way - turn);
        let begin = [0.0, first.end[1]];
        let second = rest.glide(begin);
        let carried = rest.carry(begin, first.turned);
        let part = turn / way;
        Self {
            turned: [0, 1].map(|i| part * carried[i] + (1.0 - part) * second.turned[i]),
            lost: first.lost + second.lost,
            ..second
        }
    }
}

/// A path on which κ is constant.
struct Phase {
    kappa: f64,
    way: f64,
    /// tanh ξ, 1/cosh ξ and tanh ½ξ of the curvature κ: for κ < 0 with x = ξ√−κ, tan x/√−κ, 1/cos x, tan ½x/√−κ.
    tangent: f64,
    secant: f64,
    half: f64,
}

impl Phase {
    fn loading(way: f64) -> Self {
        Self {
            kappa: 1.0,
            way,
            tangent: way.tanh(),
            secant: 1.0 / way.cosh(),
            half: (0.5 * way).tanh(),
        }
    }

    fn unloading(b: f64, way: f64) -> Self {
        let root = b.sqrt();
        let x = root * way;
        let has_curvature = b > 0.0;
        let tangent = if has_curvature { x.tan() / root } else { way };
        let half = if has_curvature { (0.5 * x).tan() / root } else { 0.5 * way };
        Self { kappa: -b, way, tangent, secant: 1.0 / x.cos(), half }
    }

    /// The path from z = (c, w).
    fn glide(&self, [c, w]: [f64; 2]) -> Glide {
        let Self { kappa, tangent, secant, half, .. } = *self;
        let d = 1.0 + kappa * c * tangent;
        let end = [(c + tangent) / d, w * secant / d];
        // tangent/ξ
        let ratio = if self.way > 0.0 { tangent / self.way } else { 1.0 };
        let across = kappa * w * secant / (d * d);
        Glide {
            end,
            longer: [1.0 - kappa * end[0] * end[0], -kappa * end[0] * end[1]],
            turned: [
                -ratio * across * (c + half),
                ratio * ((1.0 + kappa * c * half) / d - across * w),
            ],
            lost: self.lost([c, w], end),
        }
    }

    /// A small change of z at the start of the path, at its end.
    fn carry(&self, [c, w]: [f64; 2], change: [f64; 2]) -> [f64; 2] {
        let Self { kappa, tangent, secant, .. } = *self;
        let d = 1.0 + kappa * c * tangent;
        let along = secant / (d * d) * change[0];
        [secant * along, secant / d * change[1] - kappa * w * tangent * along]
    }

    /// Energy dissipated from `start` to `end`: ∫ κ c |z|² dξ.
    fn lost(&self, start: [f64; 2], end: [f64; 2]) -> f64 {
        let from = squared_length(start);
        let to = squared_length(end);
        if self.kappa <= 0.0 {
            let b = -self.kappa;
            let released = (from - to).max(0.0);
            let lost = (-b * released / (1.0 + b * from)).ln_1p();
            return if b > 0.0 { 0.5 * (released + lost / b).max(0.0) } else { 0.0 };
        }
        // q = (1 − |z₁|²)/(1 − |z₀|²), h = 1 − q
        let c = start[0];
        let d = 1.0 + c * self.tangent;
        let h = self.tangent * (2.0 * c + (c * c + 1.0) * self.tangent) / (d * d);
        let log = if self.way < 1.0 {
            -(-h).ln_1p()
        } else {
            2.0 * (d.ln() + self.way + (-2.0 * self.way).exp().ln_1p() - std::f64::consts::LN_2)
        };
        0.5 * ((log - h).max(0.0) + from * h)
    }
}
