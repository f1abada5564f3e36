//! The first mode on a fixed base, and the structure's free vibration on its ground from that mode's shape.
//!
//! | symbol | meaning |
//! |---|---|
//! | φ, ω | mode on the fixed base, circular frequency |
//! | p = K φ | load that deflects the structure by φ, in balance with the reactions of its base |
//! | η = pᵀu/(φᵀK φ) | amplitude of the mode in the displacement; zero for rigid motions of the base, since K r = 0 |
//!
//! Under p the ground has no load. When the load is released, inertia replaces it and moves the base.

use std::f64::consts::TAU;

use crate::coupled::{GravityStage, Load, Midpoint, SimulationBuilder};
use crate::error::{Error, Result};
use crate::interface::Bonded;
use crate::linalg::{Complex, Eigenpairs, SparseMatrix, dot, lowest_modes};
use crate::motion::{AtRest, STANDARD_GRAVITY};
use crate::structure::Probe;
use crate::structure::{
    DofCombination, MassAndStiffness, SpringSupportedBase, Structure, Triplets, mass_and_stiffness,
    max_diagonal_stiffness,
};

/// Stiffness of the springs that fix the base, relative to the largest stiffness: their displacement is negligible.
const BASE_SPRING_FACTOR: f64 = 1e6;
/// Number of lowest modes among which the mode with the largest participating mass is chosen.
const MAX_SEARCHED_MODES: usize = 12;
/// Smallest fraction of a mode's stiffness that is in the structure; other modes deform the base's springs.
const MIN_STRUCTURAL_FRACTION: f64 = 0.5;
/// Smallest fraction of the mass that participates in the mode of a flexible structure.
const MIN_MASS_FRACTION: f64 = 1e-3;
/// Base shear in the deflected shape, relative to the weight: small, so that nothing yields.
const BASE_SHEAR_RATIO: f64 = 1e-3;
/// Smallest number of steps of the free vibration in a period T.
const STEPS_PER_PERIOD: f64 = 40.0;
/// Number of moving-average windows in a period T: the averages keep the mode and remove faster vibrations.
const WINDOWS_PER_PERIOD: f64 = 6.0;
/// Number of sign changes of the amplitude after which the evaluation ends.
const MAX_SIGN_CHANGES: usize = 10;
/// Longest evaluated vibration, in periods T.
const MAX_PERIODS: f64 = 60.0;
/// Amplitude, relative to the initial one, at which the evaluation ends.
const FINAL_AMPLITUDE_RATIO: f64 = 1e-3;
/// Largest accepted misfit of one decaying mode, relative to the amplitude.
const MISFIT_TOLERANCE: f64 = 0.1;

/// Vibration mode of a structure with fixed contact nodes.
pub(crate) struct FixedBaseMode {
    /// 2π/ω, s.
    pub(crate) period: f64,
    /// Damping ratio φᵀC φ/(2ω φᵀM φ).
    pub(crate) damping: f64,
    /// Amplitude η as a combination of displacements.
    amplitude: DofCombination,
    /// Forces p that deflect the structure by φ.
    forces: DofCombination,
}

impl FixedBaseMode {
    /// The mode with the largest participating mass along an axis.
    ///
    /// `axis` is 0 for x, 1 for y. The result is `None` for a rigid structure.
    pub(crate) fn dominant(structure: &dyn Structure, axis: usize) -> Result<Option<Self>> {
        let dofs = structure.dofs();
        let MassAndStiffness { mass, stiffness } = mass_and_stiffness(structure)?;
        let damping = SparseMatrix::assembled("damping matrix", &mut Triplets::new(dofs), &|m| {
            structure.damping(m)
        })?;
        let base = structure.base();
        base.check(dofs)?;
        let nodes = base.into_nodes();
        let springs = SpringSupportedBase::new(
            &nodes,
            &stiffness,
            BASE_SPRING_FACTOR * max_diagonal_stiffness(&stiffness),
        );
        let mut factor = springs.factor()?;
        // Forces of the springs for a unit translation: to the right, upwards, and in plan away.
        let Some(mut translation) = springs.translation_forces().into_iter().nth([0, 2][axis])
        else {
            return Ok(None);
        };
        factor.solve(&mut translation);
        let total_mass = mass.form(&translation, &translation);
        let eigenpairs = lowest_modes(&factor, &mass, MAX_SEARCHED_MODES, None);
        let Some(Eigenpairs { values: squared_frequencies, vectors: modes }) = eigenpairs else {
            return Ok(None);
        };
        let mut momentum = vec![0.0; dofs];
        mass.multiply_add(1.0, &translation, &mut momentum);
        let structural_modes = squared_frequencies.iter().zip(modes.chunks_exact(dofs)).filter(
            |(squared_frequency, mode)| {
                stiffness.form(mode, mode) > MIN_STRUCTURAL_FRACTION * **squared_frequency
            },
        );
        let candidates = structural_modes
            .map(|(squared_frequency, mode)| (dot(mode, &momentum), *squared_frequency, mode));
        let dominant = candidates.max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
        let Some((participation, squared_frequency, mode)) = dominant else {
            return Ok(None);
        };
        let has_participation = participation.powi(2) > MIN_MASS_FRACTION * total_mass;
        if !has_participation {
            return Ok(None);
        }
        let mut mode_forces = vec![0.0; dofs];
        stiffness.multiply_add(1.0, mode, &mut mode_forces);
        let modal_stiffness = dot(mode, &mode_forces);
        let circular_frequency = squared_frequency.sqrt();
        // A unit amplitude has the base shear ω² φᵀM r.
        let deflection_amplitude = BASE_SHEAR_RATIO * STANDARD_GRAVITY * total_mass
            / (squared_frequency * participation.abs());
        Ok(Some(Self {
            period: TAU / circular_frequency,
            damping: damping.form(mode, mode) / (2.0 * circular_frequency),
            amplitude: scaled(&mode_forces, 1.0 / (modal_stiffness * deflection_amplitude)),
            forces: scaled(&mode_forces, deflection_amplitude),
        }))
    }
}

/// The forces times `factor`, each on its degree of freedom.
fn scaled(forces: &[f64], factor: f64) -> DofCombination {
    forces.iter().map(|force| factor * force).enumerate().collect()
}

/// A decaying vibration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DecayingVibration {
    /// Period of the undamped vibration, 2π/|s| of its pole s, s.
    pub(crate) period: f64,
    /// Damping ratio.
    pub(crate) damping: f64,
}

/// Free vibration of a structure on its ground, after its release from the shape of `mode`.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small, not negative")]
pub(crate) fn free_vibration(
    mut builder: SimulationBuilder,
    mode: &FixedBaseMode,
) -> Result<DecayingVibration> {
    let time_step = builder.time_step.min(mode.period / STEPS_PER_PERIOD);
    builder.time_step = time_step;
    builder.loads = vec![Load::released(mode.forces.clone(), 1.0)];
    builder.probes = vec![Probe::displacement("mode", mode.amplitude.clone())];
    builder.expected_steps = 0;
    builder.initial_displacement.clear();
    builder.initial_velocity.clear();
    if builder.gravity == 0.0 {
        builder.gravity = STANDARD_GRAVITY;
    }
    let max_steps = (MAX_PERIODS * mode.period / time_step) as usize;
    let builder = builder
        .gravity_stage(GravityStage::Frictionless)
        .motion(AtRest)
        .interface(Bonded)
        .scheme(Midpoint)
        .without_energy_balance();
    let mut simulation = builder.build()?;
    // Two moving averages keep the pole and remove the vibration of a light base on its springs.
    let window_steps =
        2 * (mode.period / (2.0 * WINDOWS_PER_PERIOD * time_step)).round().max(1.0) as usize;
    // Probes are relative to the static state, in which the load acts.
    let mut amplitudes = vec![1.0];
    let mut averaged_once = Vec::new();
    let mut averaged_twice = Vec::new();
    let mut sign_changes = Vec::new();
    // Largest amplitude since the last change of sign.
    let mut max_amplitude = 0.0_f64;
    while amplitudes.len() <= max_steps && sign_changes.len() < MAX_SIGN_CHANGES {
        amplitudes.push(1.0 + simulation.step()?.probes[0]);
        averaged_once.extend(mean_of_last(&amplitudes, window_steps));
        averaged_twice.extend(mean_of_last(&averaged_once, window_steps));
        let [.., previous_amplitude, amplitude] = averaged_twice[..] else { continue };
        max_amplitude = max_amplitude.max(amplitude.abs());
        if previous_amplitude.signum() != amplitude.signum() {
            sign_changes.push(averaged_twice.len() - 1);
            if max_amplitude < FINAL_AMPLITUDE_RATIO {
                break;
            }
            max_amplitude = 0.0;
        }
    }
    fit_decay(&averaged_twice, &sign_changes, 2 * window_steps, time_step).ok_or(Error::Scene {
        quantity: "free vibration of the soil–structure system",
        needed: "must be one decaying mode: check that the structure defines no load and that the soil is not so soft \
                 that the vibration is overdamped",
    })
}

/// Mean of the last `count` values; `None` if there are fewer.
fn mean_of_last(values: &[f64], count: usize) -> Option<f64> {
    let start = values.len().checked_sub(count)?;
    Some(values[start..].iter().sum::<f64>() / count as f64)
}

/// Fits one decaying mode to values at every step; `None` if they do not follow one.
///
/// Values m steps apart follow η₊ = a η + b η₋, fitted by least squares. The fit begins `settling_steps` after the
/// first sign change, when the base and the soil have taken up the load. `sign_changes` are the steps of the sign
/// changes. The roots of z² = a z + b are exp(±σ m Δt), where the midpoint rule converts the pole s to σ:
/// s = (2/Δt) tanh(σΔt/2).
fn fit_decay(
    values: &[f64],
    sign_changes: &[usize],
    settling_steps: usize,
    time_step: f64,
) -> Option<DecayingVibration> {
    let first_change = sign_changes.first()?;
    let last_change = sign_changes.last()?;
    let half_periods = sign_changes.len() - 1;
    if half_periods == 0 {
        return None;
    }
    // A sixth of a period.
    let spacing = ((last_change - first_change) / (3 * half_periods)).max(1);
    let fitted_values = values.get(first_change + settling_steps..)?;
    let triples = || {
        fitted_values
            .iter()
            .zip(&fitted_values[spacing.min(fitted_values.len())..])
            .zip(fitted_values.get(2 * spacing..).unwrap_or_default())
    };
    // Sums of the products of η (n), η₋ (b) and η₊ (a).
    let mut sums = [0.0; 5];
    for ((earlier_value, value), later_value) in triples() {
        let products = [
            value * value,
            value * earlier_value,
            earlier_value * earlier_value,
            value * later_value,
            earlier_value * later_value,
        ];
        for (sum, product) in sums.iter_mut().zip(products) {
            *sum += product;
        }
    }
    let [nn, nb, bb, na, ba] = sums;
    let determinant = nn * bb - nb * nb;
    let a = (na * bb - ba * nb) / determinant;
    let b = (ba * nn - na * nb) / determinant;
    let misfit: f64 = triples()
        .map(|((earlier_value, value), later_value)| {
            (later_value - a * value - b * earlier_value).powi(2)
        })
        .sum();
    if misfit.sqrt() > MISFIT_TOLERANCE * (nn + bb).sqrt() || a * a + 4.0 * b >= 0.0 {
        return None;
    }
    // σ m Δt.
    let log_decay = 0.5 * (-b).ln();
    let phase_angle = (-a * a - 4.0 * b).sqrt().atan2(a);
    let half_step_factor = 0.5 / spacing as f64;
    // σΔt/2.
    let half_exponent = Complex::new(log_decay * half_step_factor, phase_angle * half_step_factor);
    let growth = (half_exponent * 2.0).exp();
    let one = Complex::new(1.0, 0.0);
    let pole = (growth - one) / (growth + one) * (2.0 / time_step);
    let circular_frequency = pole.abs();
    Some(DecayingVibration {
        period: TAU / circular_frequency,
        damping: -pole.re / circular_frequency,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The fit returns the pole of a midpoint solution, also beside a second mode that decays faster.
    #[test]
    fn a_decaying_vibration_is_read_back() {
        let time_step = 0.01;
        let step_count = 2000;
        for (period, damping_ratio) in [(0.7_f64, 0.0_f64), (0.7, 0.05), (1.3, 0.2)] {
            let slow_frequency = TAU / period;
            let march = |circular_frequency: f64, ratio: f64| {
                let mut u = 1.0;
                let mut v = 0.0;
                let mut values = vec![1.0];
                for _ in 0..step_count {
                    // Δu of the midpoint rule.
                    let stiffness = 2.0 / (time_step * time_step)
                        + ratio * 2.0 * circular_frequency / time_step
                        + 0.5 * circular_frequency.powi(2);
                    let du = (2.0 * v / time_step - circular_frequency.powi(2) * u) / stiffness;
                    v = 2.0 * du / time_step - v;
                    u += du;
                    values.push(u);
                }
                values
            };
            let slow_mode = march(slow_frequency, damping_ratio);
            let fast_mode = march(3.3 * slow_frequency, 0.6);
            for (fast_amplitude, tolerance) in [(0.0, 1e-9), (0.2, 3e-3)] {
                let values: Vec<f64> =
                    slow_mode.iter().zip(&fast_mode).map(|(x, y)| x + fast_amplitude * y).collect();
                let sign_changes: Vec<usize> = (1..values.len())
                    .filter(|k| values[*k].signum() != values[k - 1].signum())
                    .take(MAX_SIGN_CHANGES)
                    .collect();
                let end = sign_changes[sign_changes.len() - 1];
                let fit = fit_decay(&values[..=end], &sign_changes, 0, time_step).unwrap();
                assert!((fit.period / period - 1.0).abs() < tolerance, "{fit:?} for {period}");
                assert!(
                    (fit.damping - damping_ratio).abs() < tolerance,
                    "{fit:?} for {damping_ratio}"
                );
            }
        }
        assert_eq!(fit_decay(&[1.0; 50], &[], 0, time_step), None);
    }
}
