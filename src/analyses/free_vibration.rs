//! The first mode on a fixed base, and the structure's free vibration on its ground from that mode's shape.
//!
//! | symbol | meaning |
//! |---|---|
//! | φ, ω | mode on the fixed base, circular frequency |
//! | p = K φ | load that deflects the structure by φ, in balance with the reactions of its base |
//! | η = pᵀu/(φᵀK φ) | part of the mode in the displacement; zero for rigid motions of the base, since K r = 0 |
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
    DofCombination, HeldBase, MassAndStiffness, Structure, Triplets, mass_and_stiffness, stiffest,
};

/// Stiffness of the springs that hold the base, relative to the largest stiffness.
const BASE_SPRING_FACTOR: f64 = 1e6;
/// Number of modes in which the mode with the most mass is sought.
const MAX_SEARCHED_MODES: usize = 12;
/// Largest part of the base's springs in the stiffness of a structural mode.
const MAX_BASE_SPRING_FRACTION: f64 = 0.5;
/// Smallest part of the mass that a mode must move.
const MIN_MASS_FRACTION: f64 = 1e-3;
/// Base shear in the deflected shape, relative to the weight: small, so that nothing yields.
const BASE_SHEAR_RATIO: f64 = 1e-3;
/// Smallest number of steps of the free vibration in a period T.
const STEPS_PER_PERIOD: f64 = 40.0;
/// Number of moving-average windows in a period T.
const WINDOWS_PER_PERIOD: f64 = 6.0;
/// Number of half periods that are evaluated.
const EVALUATED_HALF_PERIODS: usize = 10;
/// Largest number of periods T that the evaluated half periods may take.
const MAX_PERIODS: f64 = 60.0;
/// Amplitude, relative to the first, at which the evaluation ends.
const FINAL_AMPLITUDE_RATIO: f64 = 1e-3;
/// Misfit of one decaying mode, relative to the amplitude, that is accepted.
const MISFIT_TOLERANCE: f64 = 0.1;

/// Vibration mode of a structure with fixed contact nodes.
pub(crate) struct FixedBaseMode {
    /// 2π/ω, s.
    pub(crate) period: f64,
    /// φᵀC φ/(2ω φᵀM φ).
    pub(crate) damping: f64,
    /// η of displacements.
    row: DofCombination,
    /// Load p of the deflection.
    load: DofCombination,
}

impl FixedBaseMode {
    /// The mode of `structure` with the most mass along x (0) or y (1); `None` for a rigid structure.
    pub(crate) fn dominant(structure: &dyn Structure, axis: usize) -> Result<Option<Self>> {
        let n = structure.dofs();
        let MassAndStiffness { mass, stiffness } = mass_and_stiffness(structure)?;
        let damping = SparseMatrix::assembled("damping matrix", &mut Triplets::new(n), &|m| {
            structure.damping(m)
        })?;
        let base = structure.base();
        base.check(n)?;
        let nodes = base.into_nodes();
        let springs = HeldBase::new(&nodes, &stiffness, BASE_SPRING_FACTOR * stiffest(&stiffness));
        let mut factor = springs.factor()?;
        let Some(mut along) = springs.pulls().into_iter().nth([0, 2][axis]) else {
            return Ok(None);
        };
        factor.solve(&mut along);
        let total = mass.form(&along, &along);
        let found = lowest_modes(&factor, &mass, MAX_SEARCHED_MODES, None);
        let Some(Eigenpairs { values: squares, vectors: modes }) = found else {
            return Ok(None);
        };
        let mut momentum = vec![0.0; n];
        mass.multiply_add(1.0, &along, &mut momentum);
        let structural = squares.iter().zip(modes.chunks_exact(n)).filter(|(square, mode)| {
            stiffness.form(mode, mode) > MAX_BASE_SPRING_FRACTION * **square
        });
        let participations = structural.map(|(square, mode)| (dot(mode, &momentum), *square, mode));
        let largest = participations.max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
        let Some((participation, square, mode)) = largest else { return Ok(None) };
        let moves_mass = participation.powi(2) > MIN_MASS_FRACTION * total;
        if !moves_mass {
            return Ok(None);
        }
        let mut force = vec![0.0; n];
        stiffness.multiply_add(1.0, mode, &mut force);
        let energy = dot(mode, &force);
        let circular = square.sqrt();
        // Base shear ω² φᵀM r of a unit amplitude.
        let amplitude =
            BASE_SHEAR_RATIO * STANDARD_GRAVITY * total / (square * participation.abs());
        Ok(Some(Self {
            period: TAU / circular,
            damping: damping.form(mode, mode) / (2.0 * circular),
            row: scaled(&force, 1.0 / (energy * amplitude)),
            load: scaled(&force, amplitude),
        }))
    }
}

/// The forces times `factor`, each on its degree of freedom.
fn scaled(forces: &[f64], factor: f64) -> DofCombination {
    forces.iter().map(|force| factor * force).enumerate().collect()
}

/// Period (s) and damping ratio of the free vibration on the ground from the shape of `mode`.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small, not negative")]
pub(crate) fn free_vibration(
    mut builder: SimulationBuilder,
    mode: &FixedBaseMode,
) -> Result<[f64; 2]> {
    let step = builder.time_step.min(mode.period / STEPS_PER_PERIOD);
    builder.time_step = step;
    builder.loads = vec![Load::released(mode.load.clone(), 1.0)];
    builder.probes = vec![Probe::displacement("mode", mode.row.clone())];
    builder.steps = 0;
    builder.displacement.clear();
    builder.velocity.clear();
    if builder.gravity == 0.0 {
        builder.gravity = STANDARD_GRAVITY;
    }
    let max_steps = (MAX_PERIODS * mode.period / step) as usize;
    let builder = builder
        .gravity_stage(GravityStage::Frictionless)
        .motion(AtRest)
        .interface(Bonded)
        .scheme(Midpoint)
        .without_energy_balance();
    let mut simulation = builder.build()?;
    // Two moving averages keep the pole and remove the vibration of a light base on its springs.
    let window = 2 * (mode.period / (2.0 * WINDOWS_PER_PERIOD * step)).round().max(1.0) as usize;
    // Probes are relative to the static state, in which the load acts.
    let mut raw = vec![1.0];
    let mut averaged_once = Vec::new();
    let mut values = Vec::new();
    // Steps of the changes of sign, and the largest amplitude since the last one.
    let mut changes = Vec::new();
    let mut amplitude = 0.0_f64;
    while raw.len() <= max_steps && changes.len() < EVALUATED_HALF_PERIODS {
        raw.push(1.0 + simulation.step()?.probes[0]);
        averaged_once.extend(mean_of_last(&raw, window));
        values.extend(mean_of_last(&averaged_once, window));
        let [.., last, now] = values[..] else { continue };
        amplitude = amplitude.max(now.abs());
        if last.signum() != now.signum() {
            changes.push(values.len() - 1);
            if amplitude < FINAL_AMPLITUDE_RATIO {
                break;
            }
            amplitude = 0.0;
        }
    }
    decay(&values, &changes, 2 * window, step).ok_or(Error::Scene {
        quantity: "free vibration of the soil–structure system",
        needed: "must be that of one decaying mode (does a load of the structure's own act, or is the soil too soft to \
                 let it vibrate?)",
    })
}

/// Mean of the last `window` values; `None` if there are fewer.
fn mean_of_last(values: &[f64], window: usize) -> Option<f64> {
    let last = values.len().checked_sub(window)?;
    Some(values[last..].iter().sum::<f64>() / window as f64)
}

/// Period and damping ratio of a decaying vibration, from values at every step and the places of sign changes.
///
/// Values m steps apart follow η₊ = a η + b η₋, fitted by least squares from `settled` steps after the first
/// change of sign on: until then base and soil take up the load. The roots of z² = a z + b are exp(±σ m Δt), where
/// the midpoint rule converts the pole s to σ: s = (2/Δt) tanh(σΔt/2).
fn decay(values: &[f64], changes: &[usize], settled: usize, step: f64) -> Option<[f64; 2]> {
    let first = changes.first()?;
    let last = changes.last()?;
    let halves = changes.len() - 1;
    if halves == 0 {
        return None;
    }
    // A sixth of a period.
    let apart = ((last - first) / (3 * halves)).max(1);
    let used = values.get(first + settled..)?;
    let triples = || {
        used.iter()
            .zip(&used[apart.min(used.len())..])
            .zip(used.get(2 * apart..).unwrap_or_default())
    };
    let mut sums = [0.0; 5];
    for ((before, now), after) in triples() {
        let products = [now * now, now * before, before * before, now * after, before * after];
        for (sum, product) in sums.iter_mut().zip(products) {
            *sum += product;
        }
    }
    let [nn, nb, bb, na, ba] = sums;
    let determinant = nn * bb - nb * nb;
    let a = (na * bb - ba * nb) / determinant;
    let b = (ba * nn - na * nb) / determinant;
    let misfit: f64 =
        triples().map(|((before, now), after)| (after - a * now - b * before).powi(2)).sum();
    if misfit.sqrt() > MISFIT_TOLERANCE * (nn + bb).sqrt() || a * a + 4.0 * b >= 0.0 {
        return None;
    }
    let decay = 0.5 * (-b).ln();
    let angle = (-a * a - 4.0 * b).sqrt().atan2(a);
    // σΔt/2.
    let per_step = 0.5 / apart as f64;
    let half = Complex::new(decay * per_step, angle * per_step);
    let growth = (half * 2.0).exp();
    let one = Complex::new(1.0, 0.0);
    let pole = (growth - one) / (growth + one) * (2.0 / step);
    let circular = pole.abs();
    Some([TAU / circular, -pole.re / circular])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A vibration as the midpoint rule computes it from its pole, with and without a second one that decays.
    #[test]
    fn a_decaying_vibration_is_read_back() {
        let step = 0.01;
        let steps = 2000;
        for (period, ratio) in [(0.7_f64, 0.0_f64), (0.7, 0.05), (1.3, 0.2)] {
            let circular = TAU / period;
            let march = |circular: f64, ratio: f64| {
                let mut u = 1.0;
                let mut v = 0.0;
                let mut values = vec![1.0];
                for _ in 0..steps {
                    // Δu of the midpoint rule.
                    let stiffness = 2.0 / (step * step)
                        + ratio * 2.0 * circular / step
                        + 0.5 * circular.powi(2);
                    let du = (2.0 * v / step - circular.powi(2) * u) / stiffness;
                    v = 2.0 * du / step - v;
                    u += du;
                    values.push(u);
                }
                values
            };
            let lasting = march(circular, ratio);
            let dying = march(3.3 * circular, 0.6);
            for (part, tolerance) in [(0.0, 1e-9), (0.2, 3e-3)] {
                let values: Vec<f64> =
                    lasting.iter().zip(&dying).map(|(x, y)| x + part * y).collect();
                let changes: Vec<usize> = (1..values.len())
                    .filter(|k| values[*k].signum() != values[k - 1].signum())
                    .take(EVALUATED_HALF_PERIODS)
                    .collect();
                let end = changes[changes.len() - 1];
                let [found, damping] = decay(&values[..=end], &changes, 0, step).unwrap();
                assert!((found / period - 1.0).abs() < tolerance, "{found} for {period}");
                assert!((damping - ratio).abs() < tolerance, "{damping} for {ratio}");
            }
        }
        assert_eq!(decay(&[1.0; 50], &[], 0, step), None);
    }
}
