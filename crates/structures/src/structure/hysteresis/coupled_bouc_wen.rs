//! Bouc–Wen spring with two deformations.

use super::{BiaxialResponse, corrupt_state};
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
    /// Factor b = β − γ.
    unloading: f64,
    /// Deformation at the end of the last committed step, m.
    deformation: [f64; 2],
    /// Hysteretic vector there.
    z: [f64; 2],
    /// Dissipated energy there, J.
    dissipated_energy: f64,
}

/// Largest |z| of a saved state: the radius of the yield circle, plus rounding.
const MAX_SAVED_NORM: f64 = 1.0 + 1e-12;
/// Path length ξ up to which [`Phase::lost_energy`] computes ln q from 1 − q.
///
/// No digits are lost, because q is at least 1/cosh² 1.
const MAX_SHORT_PATH: f64 = 1.0;

impl CoupledBoucWen {
    pub(super) fn new(stiffness: f64, yield_force: f64, hardening: f64, unloading: f64) -> Self {
        Self {
            stiffness,
            yield_force,
            hardening,
            unloading,
            deformation: [0.0; 2],
            z: [0.0; 2],
            dissipated_energy: 0.0,
        }
    }

    /// Straight path to a deformation.
    fn path_to(&self, deformation: [f64; 2]) -> PlanePath {
        let dx = deformation[0] - self.deformation[0];
        let dy = deformation[1] - self.deformation[1];
        let change_norm = dx.hypot(dy);
        let z_norm = self.z[0].hypot(self.z[1]);
        let direction = if change_norm > 0.0 {
            [dx / change_norm, dy / change_norm]
        } else if change_norm == 0.0 && z_norm > 0.0 {
            self.z.map(|z| -z / z_norm)
        } else {
            // [1, 0] for z = 0 and no change; NaN for a deformation that is NaN.
            [1.0 + change_norm, change_norm]
        };
        let path_length = change_norm * self.stiffness / self.yield_force;
        let start = [
            self.z[0] * direction[0] + self.z[1] * direction[1],
            self.z[1] * direction[0] - self.z[0] * direction[1],
        ];
        PlanePath { direction, end: PlanePathEnd::of_path(self.unloading, start, path_length) }
    }

    pub(super) fn response(&self, deformation: [f64; 2]) -> BiaxialResponse {
        let path = self.path_to(deformation);
        let z = path.end_z();
        let z_derivative = path.z_derivative();
        let k = self.stiffness;
        let hysteretic_fraction = 1.0 - self.hardening;
        let mut tangent = [[0.0; 2]; 2];
        for (i, row) in tangent.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                let elastic = if i == j { self.hardening } else { 0.0 };
                *entry = k
                    * (elastic
                        + hysteretic_fraction * 0.5 * (z_derivative[i][j] + z_derivative[j][i]));
            }
        }
        let force = [0, 1].map(|i| {
            self.hardening * k * deformation[i] + hysteretic_fraction * self.yield_force * z[i]
        });
        BiaxialResponse { force, tangent }
    }

    pub(super) fn energy(&self, deformation: [f64; 2]) -> InternalEnergy {
        let path = self.path_to(deformation);
        let energy_scale =
            (1.0 - self.hardening) * self.yield_force * self.yield_force / self.stiffness;
        let parallel_energy = self.hardening * self.stiffness * squared_norm(deformation);
        InternalEnergy {
            stored: 0.5 * (parallel_energy + energy_scale * squared_norm(path.end_z())),
            dissipated: self.dissipated_energy + energy_scale * path.end.lost_energy,
        }
    }

    pub(super) fn commit(&mut self, deformation: [f64; 2]) {
        self.dissipated_energy = self.energy(deformation).dissipated;
        self.z = self.path_to(deformation).end_z();
        self.deformation = deformation;
    }

    pub(super) fn save(&self) -> Vec<f64> {
        [&self.deformation[..], &self.z, &[self.dissipated_energy]].concat()
    }

    pub(super) fn restore(&mut self, values: &[f64]) -> Result<()> {
        match values {
            &[x, y, z_x, z_y, dissipated_energy]
                if values.iter().all(|value| value.is_finite())
                    && z_x.hypot(z_y) <= MAX_SAVED_NORM
                    && dissipated_energy >= 0.0 =>
            {
                (self.deformation, self.z, self.dissipated_energy) =
                    ([x, y], [z_x, z_y], dissipated_energy);
                Ok(())
            }
            _ => Err(corrupt_state()),
        }
    }
}

fn squared_norm([x, y]: [f64; 2]) -> f64 {
    x * x + y * y
}

/// A straight path in a direction (unit vector), and z at its end.
struct PlanePath {
    direction: [f64; 2],
    end: PlanePathEnd,
}

impl PlanePath {
    /// Vector in the axes of the spring, from its components along and normal to the path.
    fn in_spring_axes(&self, [tangential, normal]: [f64; 2]) -> [f64; 2] {
        let [x, y] = self.direction;
        [x * tangential - y * normal, y * tangential + x * normal]
    }

    /// z at the end of the path.
    fn end_z(&self) -> [f64; 2] {
        self.in_spring_axes(self.end.z)
    }

    /// Derivatives ∂z/∂(d/d_y) at the end of the path.
    fn z_derivative(&self) -> [[f64; 2]; 2] {
        let [x, y] = self.direction;
        let length_derivative = self.in_spring_axes(self.end.length_derivative);
        let rotation_derivative = self.in_spring_axes(self.end.rotation_derivative);
        [0, 1].map(|i| {
            [
                length_derivative[i] * x - rotation_derivative[i] * y,
                length_derivative[i] * y + rotation_derivative[i] * x,
            ]
        })
    }
}

/// z at the end of a straight path, in components (c, w) along and normal to it.
///
/// With κ = 1 while z loads (c > 0) and κ = −b while it unloads,
///
/// ```text
/// dc/dξ = 1 − κ c²,      dw/dξ = −κ c w,      1 − κ |z|² ∝ w²
/// ```
///
/// has elementary solutions by the addition theorems of tanh and tan, exact for any ξ.
#[derive(Clone, Copy)]
struct PlanePathEnd {
    z: [f64; 2],
    /// ∂z/∂ξ.
    length_derivative: [f64; 2],
    /// ∂z/∂φ/ξ, with the angle φ by which the path rotates about its start.
    rotation_derivative: [f64; 2],
    /// Energy ∫ (c − z·dz/dξ) dξ dissipated on the path.
    lost_energy: f64,
}

impl PlanePathEnd {
    /// End of a path of the length ξ = `path_length` from z = `start`; b = `unloading`.
    fn of_path(unloading: f64, start: [f64; 2], path_length: f64) -> Self {
        if start[0] >= 0.0 {
            return Phase::loading(path_length).end(start);
        }
        let root = unloading.sqrt();
        // Length of the unloading, until c = 0.
        let unloading_length =
            if root > 0.0 { (-root * start[0]).atan() / root } else { -start[0] };
        if path_length <= unloading_length {
            return Phase::unloading(unloading, path_length).end(start);
        }
        let unloaded_end = Phase::unloading(unloading, unloading_length).end(start);
        let loading_phase = Phase::loading(path_length - unloading_length);
        let loading_start = [0.0, unloaded_end.z[1]];
        let loaded_end = loading_phase.end(loading_start);
        let rotation_derivative =
            loading_phase.propagated_change(loading_start, unloaded_end.rotation_derivative);
        let unloading_fraction = unloading_length / path_length;
        Self {
            rotation_derivative: [0, 1].map(|i| {
                unloading_fraction * rotation_derivative[i]
                    + (1.0 - unloading_fraction) * loaded_end.rotation_derivative[i]
            }),
            lost_energy: unloaded_end.lost_energy + loaded_end.lost_energy,
            ..loaded_end
        }
    }
}

/// A path on which κ is constant.
struct Phase {
    kappa: f64,
    path_length: f64,
    /// tanh ξ for κ = 1; tan(x)/√−κ with x = ξ√−κ for κ < 0.
    tangent: f64,
    /// 1/cosh ξ for κ = 1; 1/cos x for κ < 0.
    secant: f64,
    /// tanh ½ξ for κ = 1; tan(½x)/√−κ for κ < 0.
    half_tangent: f64,
}

impl Phase {
    /// Path on which z loads.
    fn loading(path_length: f64) -> Self {
        Self {
            kappa: 1.0,
            path_length,
            tangent: path_length.tanh(),
            secant: 1.0 / path_length.cosh(),
            half_tangent: (0.5 * path_length).tanh(),
        }
    }

    /// Path on which z unloads, with the factor b.
    fn unloading(b: f64, path_length: f64) -> Self {
        let root = b.sqrt();
        let x = root * path_length;
        let is_curved = b > 0.0;
        let tangent = if is_curved { x.tan() / root } else { path_length };
        let half_tangent = if is_curved { (0.5 * x).tan() / root } else { 0.5 * path_length };
        Self { kappa: -b, path_length, tangent, secant: 1.0 / x.cos(), half_tangent }
    }

    /// End of the path from z = (c, w).
    fn end(&self, [c, w]: [f64; 2]) -> PlanePathEnd {
        let Self { kappa, tangent, secant, half_tangent, .. } = *self;
        let denominator = 1.0 + kappa * c * tangent;
        let z = [(c + tangent) / denominator, w * secant / denominator];
        // tangent/ξ
        let tangent_ratio = if self.path_length > 0.0 { tangent / self.path_length } else { 1.0 };
        let coupling = kappa * w * secant / (denominator * denominator);
        PlanePathEnd {
            z,
            length_derivative: [1.0 - kappa * z[0] * z[0], -kappa * z[0] * z[1]],
            rotation_derivative: [
                -tangent_ratio * coupling * (c + half_tangent),
                tangent_ratio * ((1.0 + kappa * c * half_tangent) / denominator - coupling * w),
            ],
            lost_energy: self.lost_energy([c, w], z),
        }
    }

    /// Change of z at the end of the path due to a small `change` of z at its start (c, w).
    fn propagated_change(&self, [c, w]: [f64; 2], change: [f64; 2]) -> [f64; 2] {
        let Self { kappa, tangent, secant, .. } = *self;
        let denominator = 1.0 + kappa * c * tangent;
        let tangential = secant / (denominator * denominator) * change[0];
        [secant * tangential, secant / denominator * change[1] - kappa * w * tangent * tangential]
    }

    /// Energy dissipated from `start` to `end`: ∫ κ c |z|² dξ.
    fn lost_energy(&self, start: [f64; 2], end: [f64; 2]) -> f64 {
        let start_square = squared_norm(start);
        let end_square = squared_norm(end);
        if self.kappa <= 0.0 {
            let b = -self.kappa;
            let released_square = (start_square - end_square).max(0.0);
            let log = (-b * released_square / (1.0 + b * start_square)).ln_1p();
            return if b > 0.0 { 0.5 * (released_square + log / b).max(0.0) } else { 0.0 };
        }
        // q = (1 − |z₁|²)/(1 − |z₀|²), h = 1 − q
        let c = start[0];
        let d = 1.0 + c * self.tangent;
        let h = self.tangent * (2.0 * c + (c * c + 1.0) * self.tangent) / (d * d);
        // −ln q; for long paths q is too small for 1 − h.
        let log = if self.path_length < MAX_SHORT_PATH {
            -(-h).ln_1p()
        } else {
            let length = self.path_length;
            2.0 * (d.ln() + length + (-2.0 * length).exp().ln_1p() - std::f64::consts::LN_2)
        };
        0.5 * ((log - h).max(0.0) + start_square * h)
    }
}
