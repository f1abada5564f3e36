//! Forces of water at rest on a base.

use super::line::NodesOnElement;
use super::{PlacedBase, element_components};
use crate::error::Result;
use crate::geometry::ContactElement;
use crate::soil::WaterTable;

impl PlacedBase {
    /// Force of the water on each of `dofs` degrees of freedom, divided by gravity, kg.
    ///
    /// Empty if no element of the ground lies below the water table. Not for stepping coordinates.
    pub(crate) fn water_masses(&self, water: &WaterTable, dofs: usize) -> Result<Vec<f64>> {
        if self.elements.iter().all(|element| water.mass_above(-element.heights()[0]) == 0.0) {
            return Ok(Vec::new());
        }
        let mut masses = vec![0.0; dofs];
        for foundation in &self.foundations {
            let nodes = &self.nodes[foundation.nodes.clone()];
            for e in foundation.elements.clone() {
                let element = &self.elements[e];
                let [start_height, end_height] = element.heights();
                let row = if element.faces_down() && start_height == end_height {
                    let mass = element.area() * water.mass_above(-start_height);
                    self.mean_row(self.layout.index_of(0, e))
                        .into_iter()
                        .map(|(dof, weight)| (dof, mass * weight))
                        .collect()
                } else {
                    let weights = NodesOnElement::new(nodes, element)?
                        .integral_weights(|ends| resultant(water, element, ends));
                    element_components(nodes, &weights, element).swap_remove(0)
                };
                for (dof, mass) in row {
                    masses[dof] -= mass;
                }
            }
        }
        Ok(masses)
    }
}

/// Mass above the points between two `ends` of a wall element, summed over the length, and coordinate of its centroid.
///
/// Coordinates run along the element's tangent, m. The sum is in kg/m.
fn resultant(water: &WaterTable, element: &ContactElement, ends: [f64; 2]) -> (f64, f64) {
    let [_, middle, _] = element.components(element.center());
    let slope = element.directions()[1][2];
    let depths = ends.map(|end| -element.center()[2] - (end - middle) * slope);
    let heads = depths.map(|depth| depth - water.depth());
    // Coordinate at which the element crosses the water table.
    let crossing = ends[0] + (ends[1] - ends[0]) * heads[0] / (heads[0] - heads[1]);
    let [start, end] = [0, 1].map(|k| if heads[k] < 0.0 { crossing } else { ends[k] });
    let mass_at_start = water.mass_above(depths[0]);
    let mass_at_end = water.mass_above(depths[1]);
    let sum = mass_at_start + mass_at_end;
    if sum == 0.0 {
        return (0.0, middle);
    }
    let length = end - start;
    (0.5 * length * sum, start + length * (mass_at_start + 2.0 * mass_at_end) / (3.0 * sum))
}
