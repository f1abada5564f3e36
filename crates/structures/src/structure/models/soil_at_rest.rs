//! Sides of soil at rest in a finite-element model, and its mass, whose weight does not act in a run.

use std::collections::{HashMap, HashSet};

use super::feet::Foot;
use crate::error::{Error, Result, same_length};
use crate::fem::{Direction, Element, Mesh};
use crate::structure::{FemModel, Structure, StructureGroup};

/// Returns an error unless the pressure at rest acts on every side of soil at rest.
///
/// A side touches other soil at rest, the surface, or the ground. Elsewhere no pressure at rest acts on it.
pub(super) fn check(mesh: &Mesh, feet: &[Vec<Foot>]) -> Result<()> {
    let soil: Vec<&dyn Element> = mesh.elements().filter(|element| element.is_at_rest()).collect();
    if soil.is_empty() {
        return Ok(());
    }
    let soil_nodes: HashSet<usize> =
        soil.iter().flat_map(|element| element.nodes()).copied().collect();
    let feet_nodes: HashSet<usize> = feet.iter().flatten().map(|foot| foot.node).collect();
    if let Some(foot) = feet.iter().flatten().find(|foot| !soil_nodes.contains(&foot.node)) {
        let item = format!("contact node at {:?}", &mesh.nodes()[foot.node][..2]);
        return Err(Error::part(item, "it must belong to soil at rest, as other contact nodes do"));
    }
    let tolerance = mesh.height_tolerance();
    for side in outer_sides(&soil) {
        let start = mesh.nodes()[side[0]];
        let end = mesh.nodes()[side[1]];
        let width = (end[0] - start[0]).abs();
        let height = (end[1] - start[1]).abs();
        let is_surface = start[1].abs() <= tolerance && end[1].abs() <= tolerance;
        let is_in_contact =
            side.iter().all(|node| feet_nodes.contains(node)) && width.min(height) <= tolerance;
        if !(is_surface || is_in_contact) {
            let item =
                format!("soil at rest with a side from {:?} to {:?}", &start[..2], &end[..2]);
            let reason = "the side must touch other soil at rest, the surface y = 0 or the trench: \
                          no pressure at rest acts on it elsewhere";
            return Err(Error::part(item, reason));
        }
    }
    Ok(())
}

/// Nodes at the sides and the bottom of soil at rest.
///
/// They are the leftmost nodes downwards, the lowest ones to the right, and the rightmost ones upwards.
#[cfg(feature = "embedded")]
pub(super) fn outline(mesh: &Mesh) -> Vec<usize> {
    let soil = mesh.elements().filter(|element| element.is_at_rest());
    let mut nodes: Vec<usize> = soil.flat_map(|element| element.nodes().to_vec()).collect();
    nodes.sort_unstable();
    nodes.dedup();
    let place = |node: &usize| mesh.nodes()[*node];
    let tolerance = mesh.height_tolerance();
    let left = nodes.iter().map(|node| place(node)[0]).fold(f64::INFINITY, f64::min) + tolerance;
    let right =
        nodes.iter().map(|node| place(node)[0]).fold(f64::NEG_INFINITY, f64::max) - tolerance;
    let bottom = nodes.iter().map(|node| place(node)[1]).fold(f64::INFINITY, f64::min) + tolerance;
    nodes.sort_by(|a, b| place(a)[1].total_cmp(&place(b)[1]));
    let wall_nodes = nodes.iter().copied().filter(|node| place(node)[1] > bottom);
    let left_wall = wall_nodes.clone().rev().filter(|node| place(node)[0] <= left);
    let right_wall = wall_nodes.filter(|node| place(node)[0] >= right);
    let mut base: Vec<usize> =
        nodes.iter().copied().filter(|node| place(node)[1] <= bottom).collect();
    base.sort_by(|a, b| place(a)[0].total_cmp(&place(b)[0]));
    left_wall.chain(base).chain(right_wall).collect()
}

/// Corners of the sides that belong to one of these elements only.
///
/// They are in the order of the elements.
fn outer_sides(soil: &[&dyn Element]) -> Vec<[usize; 2]> {
    let mut sides = Vec::new();
    let mut element_counts: HashMap<[usize; 2], usize> = HashMap::new();
    for face in soil.iter().flat_map(|element| element.faces()) {
        let corners = face.corners();
        for (index, corner) in corners.iter().enumerate() {
            let next_corner = corners[(index + 1) % corners.len()];
            let side = [*corner.min(&next_corner), *corner.max(&next_corner)];
            sides.push(side);
            *element_counts.entry(side).or_default() += 1;
        }
    }
    sides.retain(|side| element_counts[side] == 1);
    sides
}

impl FemModel {
    /// Mass of soil at rest on each degree of freedom, kg.
    ///
    /// `None` without such soil.
    pub(super) fn mass_of_soil_at_rest(&self) -> Result<Option<Vec<f64>>> {
        check(&self.mesh, &self.feet)?;
        let up = self.mesh.up_direction();
        let mut masses = None;
        for element in self.mesh.elements().filter(|element| element.is_at_rest()) {
            let masses = masses.get_or_insert_with(|| vec![0.0; self.dofs()]);
            let coordinates = self.mesh.coordinates(element.nodes());
            let order = element.order();
            let mut element_mass = vec![0.0; order * order];
            element.mass(&coordinates, self.mass_kind, &mut element_mass);
            let dofs: Vec<(usize, Direction)> = element
                .nodes()
                .iter()
                .flat_map(|node| element.directions().iter().map(|direction| (*node, *direction)))
                .collect();
            for ((node, direction), row) in dofs.iter().zip(element_mass.chunks_exact(order)) {
                // Row of M r, where r is the upward translation by 1 m.
                let mut mass = 0.0;
                for ((_, column_direction), entry) in dofs.iter().zip(row) {
                    mass += if *column_direction == up { *entry } else { 0.0 };
                }
                for (dof, weight) in self.row(*node, *direction)? {
                    masses[dof] += weight * mass;
                }
            }
        }
        Ok(masses)
    }
}

impl StructureGroup {
    /// Mass of soil at rest of all members on the degrees of freedom of the group, kg.
    ///
    /// `None` without such soil.
    pub(super) fn mass_of_soil_at_rest(&self) -> Result<Option<Vec<f64>>> {
        let mut masses = None;
        for member in &self.members {
            if let Some(member_masses) = member.structure.mass_at_rest()? {
                let range = member.dof_range();
                same_length("mass at rest", member_masses.len(), range.len())?;
                let masses = masses.get_or_insert_with(|| vec![0.0; self.dofs()]);
                masses[range].copy_from_slice(&member_masses);
            }
        }
        Ok(masses)
    }
}
