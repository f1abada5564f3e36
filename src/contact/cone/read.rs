//! The data of a step: W with the layers of the laws, q, and the bounds of the forces.

use super::ForceSearch;
use super::blocks::NearFieldBlocks;
use super::newton::Newton;
use super::problem::{Bounds, ConeProblem};
use super::wide::DenseLattice;
use crate::contact::OnBed;
use crate::contact::linearisation::{TangentSolution, point_on_curve};
use crate::contact::problem::ContactInput;
use crate::error::LawError;
use crate::interface::{Limits, Mode};
use crate::linalg::largest;

impl ForceSearch {
    /// Reads W, q and the limits of the laws.
    pub(super) fn read_step(&mut self, input: &ContactInput<'_>) -> Result<(), LawError> {
        self.update_layers(input)?;
        if !self.has_valid_operator {
            self.has_valid_operator = true;
            self.update_operator(input);
        }
        let Self { problem, areas, layers, .. } = self;
        self.broken.fill(false);
        self.hardens = false;
        for (e, &area) in areas.iter().enumerate() {
            let start = input.start.element(e);
            problem.bounds[e] = bounds(&input.limits(e, 0.0)?, area);
            self.hardens |= problem.bounds[e].hardening > 0.0;
            for (component, i) in problem.places(e).into_iter().enumerate() {
                problem.anchor[i] = area * input.static_traction[i];
                problem.q[i] = input.free_jump[i];
                // A layer starts from its deformation, a slip from its last value.
                let layer = layers[e][component.min(1)];
                let begin = if component == 0 { 0.0 } else { start.state.traction()[component] };
                problem.q[i] += layer * (input.static_traction[i] - begin);
                if component > 0 {
                    problem.q[i] -= start.state.jump()[component];
                }
            }
        }
        problem.min_force_scale = largest(&problem.anchor);
        let stiffest = problem.rho.iter().flatten().fold(0.0_f64, |max, rho| max.max(*rho));
        // Rounding of lengths that are not normal numbers is larger.
        let length = input.length_scale.max(f64::MIN_POSITIVE / f64::EPSILON);
        problem.rounding_residual = 4.0 * f64::EPSILON * length * stiffest;
        if self.hardens {
            self.predict_settlements(input)?;
        }
        Ok(())
    }

    /// Linearises the laws at the settlements that each element alone would have under its present force.
    fn predict_settlements(&mut self, input: &ContactInput<'_>) -> Result<(), LawError> {
        self.trial_settlements.fill(0.0);
        self.set_initial_forces(input);
        self.problem.update_motions();
        for e in 0..self.areas.len() {
            if self.problem.bounds[e].hardening > 0.0 {
                let solution =
                    TangentSolution { yields: true, ..self.tangent_solution(input, e, 0.0) };
                let begin = solution.settlement.max(0.0);
                let limits = input.limits(e, begin)?;
                let point = point_on_curve(input, &solution, limits)?;
                self.trial_settlements[e] = point.settlement;
                self.linearise(input, e)?;
            }
        }
        Ok(())
    }

    /// Solution of an element in its present status, with a `residual` (N) that is a force, or a gap times ρ.
    pub(super) fn tangent_solution(
        &self,
        input: &ContactInput<'_>,
        e: usize,
        residual: f64,
    ) -> TangentSolution {
        let Self { problem, newton, areas, .. } = self;
        let area = areas[e];
        let [stiffness, _] = problem.rho[e];
        let rounding_of_length = 4.0 * f64::EPSILON * input.length_scale;
        TangentSolution {
            element: e,
            pressure: problem.force(e) / area,
            settlement: problem.bounds[e].offset - problem.y[e],
            yields: newton.statuses[e].is_yield(),
            stiffness: stiffness / area,
            pressure_rounding: residual / area,
            settlement_rounding: rounding_of_length + residual / stiffness,
        }
    }

    /// Replaces the pressure of yielding soil by the tangent at the element's trial settlement.
    pub(super) fn linearise(&mut self, input: &ContactInput<'_>, e: usize) -> Result<(), LawError> {
        let tangent = bounds(&input.limits(e, self.trial_settlements[e])?, self.areas[e]);
        let bounds = &mut self.problem.bounds[e];
        bounds.interval[1] = tangent.interval[1];
        bounds.hardening = tangent.hardening;
        Ok(())
    }

    /// Reads the compliances of the laws' layers, which are part of W.
    fn update_layers(&mut self, input: &ContactInput<'_>) -> Result<(), LawError> {
        for (e, stored) in self.layers.iter_mut().enumerate() {
            let layer = input.law(e).compliance(Mode::Stick, &input.start.element(e));
            if layer != *stored {
                for (value, quantity) in
                    layer.into_iter().zip(["normal compliance", "shear compliance"])
                {
                    if !(value >= 0.0 && value.is_finite()) {
                        let mode = Mode::Stick.word();
                        return Err(LawError::not_finite(e, mode, quantity, value));
                    }
                }
                *stored = layer;
                self.has_valid_operator = false;
            }
        }
        Ok(())
    }

    /// Copies W and adds the layers of the laws.
    fn update_operator(&mut self, input: &ContactInput<'_>) {
        if let Some(on_bed) = input.delassus.on_bed() {
            return self.read_modes(on_bed);
        }
        if self.problem.low_rank.is_some() {
            let count = self.areas.len();
            (self.problem, self.newton) = (ConeProblem::new(count), Newton::new(count));
        }
        let is_constant = self.has_constant_operator(input);
        let Self { problem, areas, layers, .. } = self;
        let size = problem.size();
        let count = areas.len();
        let layer = |row: usize| layers[row % count][(row / count).min(1)] / areas[row % count];
        for (row, values) in problem.w.chunks_exact_mut(size).enumerate() {
            for (column, value) in values.iter_mut().enumerate() {
                *value = input.delassus[row * size + column] / areas[column % count];
            }
            values[row] += layer(row);
        }
        problem.update_scales();
        problem.near_field = None;
        problem.dense_lattice = None;
        // Blocks take longer to compute than they save if W changes.
        if let Some(soil) = input.delassus.soil().filter(|_| is_constant)
            && let Some(cells) = soil.cells()
        {
            let compliance =
                |row: usize, column: usize| soil[row * size + column] / areas[column % count];
            let near_field =
                NearFieldBlocks::new(&problem.w, &problem.rho, cells, compliance, layer);
            if near_field.is_none() {
                problem.dense_lattice = DenseLattice::new(&problem.w, cells, compliance, layer);
            }
            problem.set_near_field(near_field);
        }
        problem.prepare_acceleration();
        self.newton.forget(is_constant);
    }

    /// Reads W of low rank, and adds the layers of the laws.
    fn read_modes(&mut self, on_bed: &OnBed) {
        let Self { problem, newton, areas, layers, .. } = self;
        let count = areas.len();
        let layer = |row: usize| layers[row % count][(row / count).min(1)] / areas[row % count];
        let Some(low_rank) = &mut problem.low_rank else {
            (*problem, *newton) = (ConeProblem::on_bed(count), Newton::on_bed(count));
            return self.read_modes(on_bed);
        };
        low_rank.set(on_bed, areas, layer);
        newton.reserve(on_bed.rank());
        problem.update_scales();
    }

    /// Whether W is constant for the whole run.
    ///
    /// True if the structure is linear, and laws with layers have no state variables.
    pub(super) fn has_constant_operator(&self, input: &ContactInput<'_>) -> bool {
        self.is_linear
            && self
                .layers
                .iter()
                .enumerate()
                .all(|(e, layer)| *layer == [0.0; 2] || input.law(e).state_variables() == 0)
    }
}

/// Bounds of the forces on an area, m².
fn bounds(limits: &Limits, area: f64) -> Bounds {
    Bounds {
        friction: limits.friction,
        friction_limit: f64::INFINITY,
        attraction: limits.attraction * area,
        strength: limits.shear_strength * area,
        interval: [-limits.tension * area, limits.pressure_cap * area],
        hardening: limits.hardening * area,
        offset: limits.gap_offset,
        bonded: limits.bonded,
    }
}
