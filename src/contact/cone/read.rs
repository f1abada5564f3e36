//! Reads the data of a step into the contact problem.
//!
//! These are W with the layers of the laws, q, and the bounds of the forces.

use super::ForceSearch;
use super::compliance::ComplianceForm;
use super::lattice::LatticeCompliance;
use super::near_field::NearFieldBlocks;
use super::newton::Newton;
use super::problem::{Bounds, ConeProblem, MIN_ELEMENTS_FOR_ACCELERATION};
use crate::contact::OnBed;
use crate::contact::problem::ContactInput;
use crate::error::LawError;
use crate::interface::{Limits, Mode};
use crate::linalg::largest;

/// Rounding error of a length, relative to the largest: a few units in the last place.
pub(super) const ROUNDING_ERROR: f64 = 4.0 * f64::EPSILON;

impl ForceSearch {
    /// Reads W, q and the limits of the laws.
    pub(super) fn read_step(&mut self, input: &ContactInput<'_>) -> Result<(), LawError> {
        self.update_layers(input)?;
        if !self.has_valid_operator {
            self.has_valid_operator = true;
            self.update_operator(input);
        }
        let Self { problem, areas, layers, .. } = self;
        self.has_broken_bond.fill(false);
        self.hardens = false;
        for (e, &area) in areas.iter().enumerate() {
            let start = input.start.element(e);
            problem.bounds[e] = bounds(&input.limits(e, 0.0)?, area);
            self.hardens |= problem.bounds[e].hardening > 0.0;
            for (component, i) in problem.component_indices(e).into_iter().enumerate() {
                problem.static_force[i] = area * input.static_traction[i];
                problem.q[i] = input.free_jump[i];
                // A layer deforms in shear from its last shear, and the slip of the step begins at the last slip.
                let layer = layers[e][component.min(1)];
                let last_shear =
                    if component == 0 { 0.0 } else { start.state.traction()[component] };
                problem.q[i] += layer * (input.static_traction[i] - last_shear);
                if component > 0 {
                    problem.q[i] -= start.state.jump()[component];
                }
            }
        }
        problem.min_force_scale = largest(&problem.static_force);
        let max_rho = problem.rho.iter().flatten().fold(0.0_f64, |max, rho| max.max(*rho));
        // The relative rounding error of subnormal lengths is larger.
        let length = input.length_scale.max(f64::MIN_POSITIVE / f64::EPSILON);
        problem.rounding_residual = ROUNDING_ERROR * length * max_rho;
        if self.hardens {
            self.predict_settlements(input)?;
        }
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
            return self.read_low_rank(on_bed);
        }
        if self.problem.form.low_rank().is_some() {
            let count = self.areas.len();
            self.problem = ConeProblem::new(count);
            self.newton = Newton::new(count);
        }
        let is_constant = self.has_constant_operator(input);
        let Self { problem, areas, layers, .. } = self;
        let size = problem.component_count();
        let count = areas.len();
        let layer = |row: usize| layers[row % count][(row / count).min(1)] / areas[row % count];
        for (row, values) in problem.w.chunks_exact_mut(size).enumerate() {
            for (column, value) in values.iter_mut().enumerate() {
                *value = input.delassus[row * size + column] / areas[column % count];
            }
            values[row] += layer(row);
        }
        problem.update_scales();
        problem.form = ComplianceForm::Entries;
        // Other forms take longer to compute than they save if W changes.
        if let Some(soil) = input.delassus.soil().filter(|_| is_constant)
            && let Some(cells) = soil.cells()
        {
            let compliance =
                |row: usize, column: usize| soil[row * size + column] / areas[column % count];
            let ConeProblem { w, rho, form, .. } = problem;
            if let Some(blocks) = NearFieldBlocks::new(w, rho, cells, compliance, layer) {
                *form = ComplianceForm::NearField(Box::new(blocks));
            } else if cells.len() >= MIN_ELEMENTS_FOR_ACCELERATION
                && let Some(lattice) = LatticeCompliance::new(w, cells, compliance, layer)
            {
                *form = ComplianceForm::Lattice(Box::new(lattice));
            }
        }
        problem.prepare_acceleration();
        self.newton.invalidate(is_constant);
    }

    /// Reads W of low rank, and adds the layers of the laws.
    fn read_low_rank(&mut self, on_bed: &OnBed) {
        let Self { problem, newton, areas, layers, .. } = self;
        let count = areas.len();
        let layer = |row: usize| layers[row % count][(row / count).min(1)] / areas[row % count];
        let ComplianceForm::LowRank(low_rank) = &mut problem.form else {
            *problem = ConeProblem::on_bed(count);
            *newton = Newton::on_bed(count);
            return self.read_low_rank(on_bed);
        };
        low_rank.assemble(on_bed, areas, layer);
        newton.reserve(on_bed.mode_count());
        problem.update_scales();
    }

    /// Whether W is constant for the whole run.
    ///
    /// It is constant if the structure is linear, and laws with layers have no state variables.
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
pub(super) fn bounds(limits: &Limits, area: f64) -> Bounds {
    Bounds {
        friction: limits.friction,
        friction_limit: f64::INFINITY,
        attraction: limits.attraction * area,
        shear_strength: limits.shear_strength * area,
        interval: [-limits.tension * area, limits.pressure_cap * area],
        hardening: limits.hardening * area,
        closed_gap: limits.gap_offset,
        is_bonded: limits.bonded,
    }
}
