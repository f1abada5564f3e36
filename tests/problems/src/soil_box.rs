//! Boxes of soil at rest that fill a trench.

use basemat::Result;
use basemat::fem::{Mesh, SharedMaterial, StressAtRest};
use basemat::structure::FemModel;

/// Mesh of soil at rest in a trench, to which structures can be added.
pub struct SoilBox {
    pub mesh: Mesh,
}

impl SoilBox {
    /// Eight-node quadrilaterals between lines.
    pub fn new(
        x: &[f64],
        y: &[f64],
        material: &SharedMaterial,
        stress: &StressAtRest,
    ) -> Result<Self> {
        let mesh = Mesh::quad8_block(x, y, |_, _| material.clone())?.with_stress_at_rest(stress)?;
        Ok(Self { mesh })
    }

    pub fn model(&self) -> FemModel {
        FemModel::on_soil_at_rest(self.mesh.clone()).unwrap()
    }

    /// Adds a block of quadrilaterals on the surface, welded to the soil.
    pub fn with_block(self, x: &[f64], y: &[f64], material: &SharedMaterial) -> Result<Self> {
        let block = Mesh::quad8_block(x, y, |_, _| material.clone())?;
        let mut mesh = self.mesh;
        let mut nodes = Vec::new();
        for [x, y, _] in block.nodes() {
            nodes.push(match mesh.node_at(*x, *y) {
                Ok(node) => node,
                Err(_) => mesh.add_node(*x, *y)?,
            });
        }
        for element in block.elements() {
            let element_nodes: Vec<usize> =
                element.nodes().iter().map(|node| nodes[*node]).collect();
            mesh.add(element.with_nodes(&element_nodes).unwrap())?;
        }
        Ok(Self { mesh })
    }
}
