//! State of a beam by forces.
//!
//! | symbol | meaning |
//! |---|---|
//! | v, q | basic deformations and forces |
//! | e, s, f | deformations, resultants and flexibility of a section |
//! | b, w | s = b q in equilibrium; part of the length of a section |
//!
//! The element (Spacone, Filippou and Taucer 1996, Earthq. Eng. Struct. Dyn. 25, 711) is in equilibrium at every section,
//! s(e) = b q, and compatible in the mean, v = Σ w bᵀ e. Newton's method solves both sets of equations together:
//! e ← e + f (b q − s), F = Σ w bᵀ f b, q ← q + F⁻¹ (v − Σ w bᵀ e), e ← e + f b F⁻¹ (v − Σ w bᵀ e). It starts at the state of
//! the last step. From the second iteration on all iterates are compatible, and their increments Δe descend the potential of
//! the sections: where its slope g = Σ w Δe·(s − b q) has changed its sign, the iterate goes back along Δe. With hardening
//! sections the potential is convex, and the iteration converges from everywhere. Where it still does not converge, v
//! approaches its value in parts (Neuenhofer and Filippou 1997, J. Struct. Eng. 123, 958, divide steps in the same way).
//! Sections that soften may leave no state on this path: the iteration then begins behind increments with the flexibility of
//! small strains. No law is stiffer than that, so that each of them reduces the potential.

use super::basic_beam::BasicBeam;
use super::basic_state::{BasicState, BeamLinearisation, MAX_SECTIONS};
use super::solution_memo::SolutionKey;
use crate::error::{Error, Result};
use crate::fem::element_nodes::inner_product;
use crate::fem::small_matrix::{add_congruent, add_transposed, inverse, product};
use crate::linalg::dot;

/// Largest number of Newton's iterations for one part of a change of the deformations.
const MAX_ELEMENT_ITERATIONS: usize = 40;
/// Energy of a correction at which the iterations end, relative to the largest correction and to q·v.
const ENERGY_TOLERANCE: f64 = 1e-24;
/// Factor of the number of parts of a change of the deformations after a failure.
const PART_FACTOR: usize = 4;
/// Largest number of parts of a change of the deformations.
const MAX_PARTS: usize = 64;
/// Number of increments with the flexibility of small strains before Newton's iterations.
const DESCENT_INCREMENTS: usize = 20;
/// Largest number of rounds of such increments.
const MAX_DESCENT_ROUNDS: usize = 20;
/// Slope of the potential behind an increment, relative to that before it, from which on the increment is too long.
const MAX_SLOPE_RATIO: f64 = 0.8;
/// Slope at which the search along an increment ends, relative to that before the increment.
const SEARCH_SLOPE_RATIO: f64 = 0.3;
/// Largest number of evaluations of a search along an increment.
const MAX_SEARCH_EVALUATIONS: usize = 8;
/// Smallest distance of a trial from the ends of the interval that contains the balance, relative to its length.
const MIN_INTERVAL_FRACTION: f64 = 0.05;
/// Stiffness of small strains that a singular tangent of a section receives, relative to all of it.
const ADDED_STIFFNESS_RATIO: f64 = 1e-6;

/// The last increment of the iteration, along which the next iterate may go back.
struct SectionIncrement<const N: usize, const B: usize> {
    /// Δe of each section.
    changes: [[f64; N]; MAX_SECTIONS],
    /// q behind the increment.
    forces: [f64; B],
    /// Slope of the potential before the increment, J; negative.
    slope: f64,
}

impl<const N: usize, const B: usize> BasicBeam<'_, N, B> {
    /// State of an element by forces at basic deformations v.
    ///
    /// # Errors
    /// Errors of fibres, and [`Error::Scene`] if the iterations do not converge.
    pub(super) fn force_based_state(
        &self,
        v: &[f64; B],
        variables: &[f64],
    ) -> Result<BasicState<N, B>> {
        let key = SolutionKey { length: self.length, v: *v };
        let mut memo = self.memo.at(variables);
        if let Some(state) = memo.find(&key) {
            return Ok(state);
        }
        let last = self.last_state(variables);
        let mut start = memo.start(self.length);
        if start.is_none() {
            start = self.linearise(&last.deformations, variables)?;
            memo.set_start(self.length, start);
        }
        let mut part_count = 1;
        while let Some(start) = &start
            && part_count <= MAX_PARTS
        {
            let mut state = BasicState { forces: last.forces, ..BasicState::zero() };
            state.deformations = last.deformations;
            let mut is_found = true;
            for part in 1..=part_count {
                let share = part as f64 / part_count as f64;
                let target: [f64; B] = std::array::from_fn(|i| {
                    last.basic_deformations[i] + share * (v[i] - last.basic_deformations[i])
                });
                let first = (part == 1).then_some(start);
                is_found = self.iterate(&target, variables, first, &mut state)?;
                if !is_found {
                    break;
                }
            }
            if is_found {
                memo.store(key, state);
                return Ok(state);
            }
            part_count *= PART_FACTOR;
        }
        if let Some(state) = self.descend(v, variables)? {
            memo.store(key, state);
            return Ok(state);
        }
        let quantity = "state of a force-based beam";
        let needed = "sections whose tangents are regular: less softening, or shorter steps";
        Err(Error::Scene { quantity, needed })
    }

    /// State that increments which reduce the potential find from the last step; `None` if they find none.
    fn descend(&self, v: &[f64; B], variables: &[f64]) -> Result<Option<BasicState<N, B>>> {
        let section_flexibility = inverse(self.section.elastic_stiffness::<N>());
        let stiffness = self.elastic_stiffness();
        let (Some(flexibility), Some(stiffness)) = (section_flexibility, stiffness) else {
            return Ok(None);
        };
        let mut linearisation = BeamLinearisation::zero();
        linearisation.flexibilities = [flexibility; MAX_SECTIONS];
        linearisation.stiffness = stiffness;
        let last = self.last_state(variables);
        let mut state = BasicState { forces: last.forces, ..BasicState::zero() };
        state.deformations = last.deformations;
        for _ in 0..MAX_DESCENT_ROUNDS {
            for _ in 0..DESCENT_INCREMENTS {
                let responses = self.responses(&state.deformations, variables, &mut [])?;
                linearisation.forces = responses.map(|response| response.forces);
                self.correct(v, &linearisation, &mut state, &mut [[0.0; N]; MAX_SECTIONS]);
            }
            let mut trial = state;
            if self.iterate(v, variables, None, &mut trial)? {
                return Ok(Some(trial));
            }
        }
        Ok(None)
    }

    /// Resultants and flexibilities of the sections, and stiffness of the element; `None` for a singular one.
    fn linearise(
        &self,
        deformations: &[[f64; N]; MAX_SECTIONS],
        variables: &[f64],
    ) -> Result<Option<BeamLinearisation<N, B>>> {
        let mut flexibility = [[0.0; B]; B];
        let mut linearisation = BeamLinearisation::zero();
        let responses = self.responses(deformations, variables, &mut [])?;
        for (index, (point, response)) in self.points.iter().zip(responses).enumerate() {
            let Some(section_flexibility) = self.flexibility(response.tangent) else {
                return Ok(None);
            };
            let b = (self.interpolation.forces)(point.position);
            add_congruent(point.weight * self.length, &b, &section_flexibility, &mut flexibility);
            linearisation.forces[index] = response.forces;
            linearisation.flexibilities[index] = section_flexibility;
        }
        let Some(stiffness) = inverse(flexibility) else { return Ok(None) };
        linearisation.stiffness = stiffness;
        Ok(Some(linearisation))
    }

    /// Inverse of a section's tangent, or of nearly this tangent if it is singular.
    fn flexibility(&self, tangent: [[f64; N]; N]) -> Option<[[f64; N]; N]> {
        inverse(tangent).or_else(|| {
            let elastic = self.section.elastic_stiffness::<N>();
            inverse(std::array::from_fn(|i| {
                std::array::from_fn(|j| tangent[i][j] + ADDED_STIFFNESS_RATIO * elastic[i][j])
            }))
        })
    }

    /// Newton's iterations for q and e at v; returns whether they have converged.
    ///
    /// `first`: the linearisation about the state with which they begin, if it is known.
    fn iterate(
        &self,
        v: &[f64; B],
        variables: &[f64],
        first: Option<&BeamLinearisation<N, B>>,
        state: &mut BasicState<N, B>,
    ) -> Result<bool> {
        let mut largest_energy = 0.0_f64;
        let mut last_increment = None;
        for iteration in 0..MAX_ELEMENT_ITERATIONS {
            let linearisation = match first {
                Some(first) if iteration == 0 => Some(*first),
                _ => self.linearise(&state.deformations, variables)?,
            };
            let Some(mut linearisation) = linearisation else { return Ok(false) };
            if let Some(increment) = &last_increment
                && !self.search(increment, variables, state, &mut linearisation)?
            {
                return Ok(false);
            }
            let mut changes = [[0.0; N]; MAX_SECTIONS];
            let energy = self.correct(v, &linearisation, state, &mut changes);
            if !energy.is_finite() {
                return Ok(false);
            }
            largest_energy = largest_energy.max(energy).max(dot(&state.forces, v).abs());
            if energy <= ENERGY_TOLERANCE * largest_energy {
                return Ok(true);
            }
            // The first iterate is not compatible yet.
            last_increment = None;
            if iteration > 0 {
                let slope = self.slope(&changes, &state.forces, &linearisation);
                let forces = state.forces;
                last_increment =
                    (slope < 0.0).then_some(SectionIncrement { changes, forces, slope });
            }
        }
        Ok(false)
    }

    /// Corrects q and e; returns the energy of the corrections, J.
    ///
    /// Overwrites `changes` with the corrections of e.
    fn correct(
        &self,
        v: &[f64; B],
        linearisation: &BeamLinearisation<N, B>,
        state: &mut BasicState<N, B>,
        changes: &mut [[f64; N]; MAX_SECTIONS],
    ) -> f64 {
        // v less the deformations of the sections after their own corrections.
        let mut residual = *v;
        let mut energy = 0.0;
        for (index, point) in self.points.iter().enumerate() {
            let b = (self.interpolation.forces)(point.position);
            let needed_forces = product(&b, &state.forces);
            let section_forces = &linearisation.forces[index];
            let imbalance: [f64; N] = std::array::from_fn(|i| needed_forces[i] - section_forces[i]);
            changes[index] = product(&linearisation.flexibilities[index], &imbalance);
            let deformations = &mut state.deformations[index];
            add_to(deformations, &changes[index]);
            let length = point.weight * self.length;
            add_transposed(-length, &b, deformations, &mut residual);
            energy += length * inner_product(&imbalance, &changes[index]).abs();
        }
        let force_increment = product(&linearisation.stiffness, &residual);
        add_to(&mut state.forces, &force_increment);
        state.stiffness = linearisation.stiffness;
        for (index, point) in self.points.iter().enumerate() {
            let b = (self.interpolation.forces)(point.position);
            let section_increment = product(&b, &force_increment);
            let change = product(&linearisation.flexibilities[index], &section_increment);
            add_to(&mut state.deformations[index], &change);
            add_to(&mut changes[index], &change);
        }
        energy + inner_product(&force_increment, &residual).abs()
    }

    /// Slope g of the potential along Δe, J.
    fn slope(
        &self,
        changes: &[[f64; N]; MAX_SECTIONS],
        forces: &[f64; B],
        linearisation: &BeamLinearisation<N, B>,
    ) -> f64 {
        let mut sum = 0.0;
        for (index, point) in self.points.iter().enumerate() {
            let b = (self.interpolation.forces)(point.position);
            let needed_forces = product(&b, forces);
            let section_forces = &linearisation.forces[index];
            let imbalance: [f64; N] = std::array::from_fn(|i| section_forces[i] - needed_forces[i]);
            sum += point.weight * self.length * inner_product(&changes[index], &imbalance);
        }
        sum
    }

    /// Goes back along the last increment if it was too long; false for a singular state on the way.
    fn search(
        &self,
        increment: &SectionIncrement<N, B>,
        variables: &[f64],
        state: &mut BasicState<N, B>,
        linearisation: &mut BeamLinearisation<N, B>,
    ) -> Result<bool> {
        let SectionIncrement { changes, forces, slope: first_slope } = increment;
        let mut slope = self.slope(changes, forces, linearisation);
        if slope <= -MAX_SLOPE_RATIO * first_slope {
            return Ok(true);
        }
        let end = state.deformations;
        // Fractions of Δe with a negative and a positive slope, and both slopes.
        let mut fractions = [0.0, 1.0];
        let mut slopes = [*first_slope, slope];
        for _ in 0..MAX_SEARCH_EVALUATIONS {
            let width = fractions[1] - fractions[0];
            let secant = slopes[0] / (slopes[0] - slopes[1]);
            let part = secant.clamp(MIN_INTERVAL_FRACTION, 1.0 - MIN_INTERVAL_FRACTION);
            let fraction = fractions[0] + part * width;
            for (index, deformations) in state.deformations.iter_mut().enumerate() {
                *deformations =
                    std::array::from_fn(|i| end[index][i] - (1.0 - fraction) * changes[index][i]);
            }
            let Some(trial) = self.linearise(&state.deformations, variables)? else {
                return Ok(false);
            };
            *linearisation = trial;
            slope = self.slope(changes, forces, linearisation);
            if slope.abs() <= -SEARCH_SLOPE_RATIO * first_slope {
                break;
            }
            // The slope at the other end is halved, so that both ends move (Illinois method).
            let side = usize::from(slope > 0.0);
            fractions[side] = fraction;
            slopes[side] = slope;
            slopes[1 - side] *= 0.5;
        }
        Ok(true)
    }
}

/// Adds an increment to values.
fn add_to<const N: usize>(values: &mut [f64; N], increment: &[f64; N]) {
    for (value, change) in values.iter_mut().zip(increment) {
        *value += change;
    }
}
