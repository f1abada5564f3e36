//! Nonlinear forces of a group of structures.

use super::group::StructureGroup;
use crate::error::{CheckpointError, Result};
use crate::structure::nonlinear::{restore_variables, save_variables};
use crate::structure::{InternalEnergy, NonlinearForce, Triplets};

impl NonlinearForce for StructureGroup {
    fn force(&self, displacement: &[f64], force: &mut [f64]) -> Result<()> {
        for (member, nonlinear_force) in self.nonlinear_members() {
            let range = member.dof_range();
            if let (Some(u), Some(f)) = (displacement.get(range.clone()), force.get_mut(range)) {
                nonlinear_force.force(u, f)?;
            }
        }
        Ok(())
    }

    fn tangent(&self, displacement: &[f64], matrix: &mut Triplets) -> Result<()> {
        for (member, nonlinear_force) in self.nonlinear_members() {
            if let Some(u) = displacement.get(member.dof_range()) {
                matrix.block(member.first_dof, member.dof_count, |block| {
                    nonlinear_force.tangent(u, block)
                })?;
            }
        }
        Ok(())
    }

    fn has_symmetric_tangent(&self) -> bool {
        self.nonlinear_members().all(|(_, force)| force.has_symmetric_tangent())
    }

    /// Energies of all members; `None` unless all nonlinear members return theirs.
    fn energy(&self, displacement: &[f64]) -> Option<InternalEnergy> {
        self.nonlinear_members().try_fold(
            InternalEnergy::default(),
            |sum, (member, nonlinear_force)| {
                Some(sum + nonlinear_force.energy(displacement.get(member.dof_range())?)?)
            },
        )
    }

    /// Remainders of all members; `None` unless all nonlinear members return theirs.
    fn remainder(&self, midstep: &[f64], end: &[f64]) -> Option<f64> {
        self.nonlinear_members().try_fold(0.0, |sum, (member, nonlinear_force)| {
            let range = member.dof_range();
            let member_midstep = midstep.get(range.clone())?;
            Some(sum + nonlinear_force.remainder(member_midstep, end.get(range)?)?)
        })
    }

    /// Text of the first member that has one.
    ///
    /// The degrees of freedom are tried in their order.
    fn describe_state(&self, displacement: &[f64], dofs: &[usize]) -> Option<String> {
        dofs.iter().find_map(|dof| {
            let members = self.members.iter().enumerate();
            let (index, member) =
                members.into_iter().find(|(_, member)| member.dof_range().contains(dof))?;
            let member_displacement = displacement.get(member.dof_range())?;
            let member_dofs = [dof - member.first_dof];
            let force = member.structure.nonlinear()?;
            let text = force.describe_state(member_displacement, &member_dofs)?;
            Some(format!("structure {index}: {text}"))
        })
    }

    fn commit(&mut self, displacement: &[f64]) {
        for member in &mut self.members {
            let u = displacement.get(member.dof_range());
            if let (Some(u), Some(nonlinear_force)) = (u, member.structure.nonlinear_mut()) {
                nonlinear_force.commit(u);
            }
        }
    }

    fn save(&self) -> Result<Vec<f64>> {
        let mut values = Vec::new();
        for member in &self.members {
            let variables = save_variables(member.structure.as_ref())?;
            values.push(variables.len() as f64);
            values.extend(variables);
        }
        Ok(values)
    }

    fn restore(&mut self, values: &[f64]) -> Result<()> {
        let member_values = split_by_length(values, self.members.len())?;
        let saved_states: Vec<Vec<f64>> = self
            .members
            .iter()
            .map(|member| save_variables(member.structure.as_ref()))
            .collect::<Result<_>>()?;
        for (index, values) in member_values.into_iter().enumerate() {
            if let Err(error) = restore_variables(self.members[index].structure.as_mut(), values) {
                for (member, saved_state) in self.members[..index].iter_mut().zip(&saved_states) {
                    restore_variables(member.structure.as_mut(), saved_state)?;
                }
                return Err(error);
            }
        }
        Ok(())
    }
}

/// Splits saved values into `count` lists; the length of each list precedes its values.
fn split_by_length(values: &[f64], count: usize) -> Result<Vec<&[f64]>> {
    let corrupt_error = || CheckpointError::Corrupt { quantity: "state of the structures" };
    let mut remaining_values = values;
    let mut lists = Vec::with_capacity(count);
    for _ in 0..count {
        let (&saved_length, following) =
            remaining_values.split_first().ok_or_else(corrupt_error)?;
        let length =
            (0..=following.len()).find(|n| *n as f64 == saved_length).ok_or_else(corrupt_error)?;
        lists.push(&following[..length]);
        remaining_values = &following[length..];
    }
    if remaining_values.is_empty() { Ok(lists) } else { Err(corrupt_error().into()) }
}
