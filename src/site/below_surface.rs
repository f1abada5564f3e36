//! Waves of one horizontal slowness below the free surface of layers.
//!
//! | symbol | meaning |
//! |---|---|
//! | s, p | Laplace variable, horizontal slowness: fields vary as e^(s(t − px)) |
//! | z | depth |
//! | u_x, u_z | displacement to the right and down |
//! | τ, σ, q | impulses of the stresses σ_xz, σ_zz, σ_xx: the stresses over s |
//! | ρ, μ, λ | density, shear modulus, Lamé's modulus |
//! | c, E | λ + 2μ, and 4μ(λ + μ)/c |
//!
//! Equilibrium and Hooke's law are, with ′ = d/dz (Aki & Richards, *Quantitative Seismology*, 2nd ed., § 7.2),
//!
//! * u_x′ = s(τ/μ + p u_z), u_z′ = s(σ + λp u_x)/c,
//! * τ′ = s(ρ u_x + p q), σ′ = s(ρ u_z + p τ), where q = λσ/c − E p u_x.
//!
//! The surface is free: τ = σ = 0. The motion of the surface and p determine the field at all depths.

use crate::linalg::Complex;
use crate::soil::Soil;

/// Displacements and impulses of stresses at one depth.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct WaveField {
    /// Displacement to the right, u_x.
    pub(super) right_displacement: Complex,
    /// Displacement down, u_z.
    pub(super) down_displacement: Complex,
    /// Impulse of the shear stress, τ.
    pub(super) shear: Complex,
    /// Impulse of the vertical stress, σ.
    pub(super) normal: Complex,
}

impl WaveField {
    /// This field times a factor.
    fn times(self, factor: Complex) -> Self {
        Self {
            right_displacement: self.right_displacement * factor,
            down_displacement: self.down_displacement * factor,
            shear: self.shear * factor,
            normal: self.normal * factor,
        }
    }

    /// Sum of two fields.
    fn plus(self, other: Self) -> Self {
        Self {
            right_displacement: self.right_displacement + other.right_displacement,
            down_displacement: self.down_displacement + other.down_displacement,
            shear: self.shear + other.shear,
            normal: self.normal + other.normal,
        }
    }
}

/// Bound of a term of the exponential's series, relative to the field, below which the series ends.
///
/// It is below the rounding of the sum.
const SERIES_TOLERANCE: f64 = 1e-17;

/// Soil for waves of one s and one horizontal slowness.
#[derive(Debug, Clone, Copy)]
pub(super) struct FieldMedium {
    /// Density ρ, kg/m³.
    density: f64,
    /// Horizontal slowness p, s/m.
    slowness: f64,
    /// 1/μ, 1/Pa.
    shear_compliance: Complex,
    /// 1/c, 1/Pa.
    pressure_compliance: Complex,
    /// λ/c.
    lateral_ratio: f64,
    /// Modulus E = 4μ(λ + μ)/c, Pa.
    plane_strain_modulus: Complex,
}

impl FieldMedium {
    /// Medium of a soil with this complex shear modulus.
    pub(super) fn new(soil: Soil, modulus: Complex, slowness: f64) -> Self {
        let speed_ratio_squared = soil.speed_ratio_squared();
        let shear_compliance = modulus.inverse();
        Self {
            density: soil.density(),
            slowness,
            shear_compliance,
            pressure_compliance: shear_compliance.scale(speed_ratio_squared),
            lateral_ratio: 1.0 - 2.0 * speed_ratio_squared,
            plane_strain_modulus: modulus.scale(4.0 * (1.0 - speed_ratio_squared)),
        }
    }

    /// Impulse of the horizontal stress, q.
    pub(super) fn horizontal_stress(&self, field: WaveField) -> Complex {
        field.normal.scale(self.lateral_ratio)
            - self.plane_strain_modulus * field.right_displacement.scale(self.slowness)
    }

    /// Derivative of a field with respect to depth, divided by s.
    fn rate(&self, field: WaveField) -> WaveField {
        let WaveField { right_displacement: right, down_displacement: down, shear, normal } = field;
        let p = self.slowness;
        WaveField {
            right_displacement: shear * self.shear_compliance + down.scale(p),
            down_displacement: normal * self.pressure_compliance
                + right.scale(p * self.lateral_ratio),
            shear: right.scale(self.density) + self.horizontal_stress(field).scale(p),
            normal: down.scale(self.density) + shear.scale(p),
        }
    }

    /// The field at a depth that is `depth_step` (m) below that of `field`.
    pub(super) fn field_below(
        &self,
        s: Complex,
        depth_step: f64,
        mut field: WaveField,
    ) -> WaveField {
        let max_slowness =
            (self.density * self.shear_compliance.abs()).sqrt() + self.slowness.abs();
        let total_phase = s.abs() * depth_step * max_slowness;
        let mut remaining_phase = total_phase;
        while remaining_phase > 0.0 {
            // For phases of at most one the series of the exponential converges fast.
            let phase_step = remaining_phase.min(1.0);
            let s_depth_step = s.scale(depth_step * (phase_step / total_phase));
            let mut term = field;
            let mut term_bound = 1.0;
            let mut order = 0.0;
            while term_bound > SERIES_TOLERANCE {
                order += 1.0;
                term_bound *= phase_step / order;
                let factor = s_depth_step.scale(1.0 / order);
                term = self.rate(term).times(factor);
                field = field.plus(term);
            }
            remaining_phase -= phase_step;
        }
        field
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::site::{InclinedControl, InclinedWave};
    use crate::soil::SoilProfile;

    /// P and S waves up and down along (p, ∓a) and (b, ±p), free of traction at the surface.
    #[test]
    fn fields_are_sums_of_plane_waves() {
        let soil = Soil::new(2.0, 0.3, 1.5).unwrap();
        let modulus = Complex::new(2.0, 0.13);
        let slowness = |ratio: f64, p: f64| {
            ((modulus.inverse().scale(1.5 * ratio)) - Complex::real(p * p)).sqrt()
        };
        for p in [0.0, 0.31, -0.55, 1.2] {
            let a = slowness(soil.speed_ratio_squared(), p);
            let b = slowness(1.0, p);
            let g = b * b - Complex::real(p * p);
            let s = Complex::new(0.4, 1.9);
            let x = Complex::new(0.7, -0.2);
            let z = Complex::new(-0.3, 0.5);
            let speed = modulus.scale(1.0 / 1.5);
            let even_part = x * speed / b;
            let odd_part = -(z * speed) / a;
            let p_even = b * even_part.scale(2.0 * p);
            let s_even = g * even_part;
            let p_odd = g * odd_part;
            let s_odd = -(a * odd_part.scale(2.0 * p));
            let medium = FieldMedium::new(soil, modulus, p);
            let surface =
                WaveField { right_displacement: x, down_displacement: z, ..WaveField::default() };
            let upper = medium.field_below(s, 1.1, surface);
            let computed = medium.field_below(s, 0.6, upper);
            // Σ over waves up (e = 1) and down (e = −1).
            let mut expected = [Complex::default(); 4];
            let mut horizontal_stress = Complex::default();
            let c = modulus.scale(1.0 / soil.speed_ratio_squared());
            let normal_stiffness = c.scale(p * p) + (c - modulus.scale(2.0)) * a * a;
            for e in [1.0, -1.0] {
                let p_travel = (s * a.scale(1.7 * e)).exp();
                let s_travel = (s * b.scale(1.7 * e)).exp();
                let pressure = (p_even + p_odd.scale(e)).scale(0.5) * p_travel;
                let shear = (s_even + s_odd.scale(e)).scale(0.5) * s_travel;
                expected[0] += pressure.scale(p) + shear * b;
                expected[1] += shear.scale(e * p) - pressure * a.scale(e);
                expected[2] += modulus * (pressure * a.scale(2.0 * p * e) + shear * g.scale(e));
                expected[3] += modulus * (shear * b.scale(2.0 * p) - pressure * g);
                horizontal_stress +=
                    -(pressure * normal_stiffness) - shear * modulus * b.scale(2.0 * p);
            }
            let values = [
                computed.right_displacement,
                computed.down_displacement,
                computed.shear,
                computed.normal,
            ];
            for (computed, expected) in values.into_iter().zip(expected) {
                assert!((computed - expected).abs() < 1e-12, "{p}: {computed:?} {expected:?}");
            }
            assert!((medium.horizontal_stress(computed) - horizontal_stress).abs() < 1e-12);
        }
    }

    /// Below layers, the only wave upwards is the incident one, of unit displacement.
    #[test]
    fn inclined_waves_of_layers_come_from_below() {
        let rock = Soil::new(40.0, 0.25, 2.0).unwrap();
        let profile = SoilProfile::on_half_plane(rock)
            .with_layer(Soil::new(2.0, 0.3, 1.5).unwrap(), 0.7)
            .unwrap()
            .with_layer(Soil::new(6.0, 0.4, 1.8).unwrap(), 1.3)
            .unwrap();
        let waves =
            [InclinedWave::sv(profile.clone(), 0.4), InclinedWave::p(profile.clone(), -0.6)];
        for (kind, wave) in waves.into_iter().enumerate() {
            let wave = wave.unwrap();
            let p = 1.0 / wave.apparent_velocity();
            let motion = wave.transfer(InclinedControl::Incident, 0.8).unwrap();
            let s = Complex::new(0.0, 0.8 * std::f64::consts::TAU);
            let mut field = WaveField {
                right_displacement: motion[0],
                down_displacement: -motion[1],
                ..WaveField::default()
            };
            for ((soil, _), layer) in profile.soils().zip(profile.layers()) {
                let medium = FieldMedium::new(soil, Complex::real(soil.shear_modulus()), p);
                field = medium.field_below(s, layer.thickness, field);
            }
            let WaveField { right_displacement: x, down_displacement: z, .. } = field;
            let a = (rock.pressure_wave_speed().powi(-2) - p * p).sqrt();
            let b = (rock.shear_wave_speed().powi(-2) - p * p).sqrt();
            let shear = field.shear.scale(1.0 / rock.shear_modulus());
            let normal = field.normal.scale(1.0 / rock.shear_modulus());
            // P along (p, −a), S along (b, p), upwards.
            let g = b * b - p * p;
            let c = 0.5 * rock.shear_wave_speed().powi(2);
            let p_amplitude =
                (x.scale(2.0 * p) - normal) + (shear.scale(p) - z.scale(g)).scale(1.0 / a);
            let s_amplitude =
                (x.scale(g) + normal.scale(p)).scale(1.0 / b) + (z.scale(2.0 * p) + shear);
            let computed = [
                s_amplitude.scale(c / rock.shear_wave_speed()),
                p_amplitude.scale(c / rock.pressure_wave_speed()),
            ];
            assert!((computed[kind].abs() - 1.0).abs() < 1e-11, "{computed:?}");
            assert!(computed[1 - kind].abs() < 1e-11, "{computed:?}");
        }
    }
}
