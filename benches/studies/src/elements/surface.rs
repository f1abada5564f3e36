//! A surface of shells on supports.

use basemat::fem::{Direction, Element, Material, Shell, ShellResultants};
use basemat_problems::supported::{NodalLoad, SupportedMesh, values};

use crate::AnyError;

/// Elements of a cell of a grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum ShellPattern {
    Quadrilaterals,
    /// The diagonal (i, j)–(i + 1, j + 1).
    Rising,
    /// The diagonal (i + 1, j)–(i, j + 1).
    Falling,
}

impl ShellPattern {
    /// Name of the elements in the tables.
    pub(super) fn element(self) -> &'static str {
        if self == Self::Quadrilaterals { "Shell4" } else { "Shell3" }
    }

    pub(super) fn split(self, [a, b, c, d]: [usize; 4]) -> Vec<Vec<usize>> {
        match self {
            Self::Quadrilaterals => vec![vec![a, b, c, d]],
            Self::Rising => vec![vec![a, b, c], vec![a, c, d]],
            Self::Falling => vec![vec![a, b, d], vec![b, c, d]],
        }
    }
}

/// Shells of one material and thickness.
pub(super) struct ShellSurface {
    pub(super) scene: SupportedMesh,
    pub(super) shells: Vec<Shell>,
    material: Material,
    thickness: f64,
}

impl ShellSurface {
    pub(super) fn new(material: Material, thickness: f64) -> Self {
        Self { scene: SupportedMesh::new(), shells: Vec::new(), material, thickness }
    }

    pub(super) fn shell(&mut self, nodes: &[usize], thickness: f64) -> Result<(), AnyError> {
        let shell = Shell::new(nodes, self.material, thickness)?;
        self.scene.add(shell.clone());
        self.shells.push(shell);
        Ok(())
    }

    /// Cells between nodes in a grid.
    pub(super) fn fill(
        &mut self,
        nodes: &[Vec<usize>],
        pattern: ShellPattern,
    ) -> Result<(), AnyError> {
        for (row, next) in nodes.iter().zip(&nodes[1..]) {
            for j in 0..row.len() - 1 {
                let cell = [row[j], next[j], next[j + 1], row[j + 1]];
                for corners in pattern.split(cell) {
                    self.shell(&corners, self.thickness)?;
                }
            }
        }
        Ok(())
    }

    /// Nodes (nx + 1) × (ny + 1) at the points of `point`, whose arguments run from 0 to 1, and cells between them.
    pub(super) fn grid(
        &mut self,
        [nx, ny]: [usize; 2],
        pattern: ShellPattern,
        point: impl Fn(f64, f64) -> [f64; 3],
    ) -> Result<Vec<Vec<usize>>, AnyError> {
        let mut nodes: Vec<Vec<usize>> = Vec::new();
        for i in 0..=nx {
            let mut row = Vec::new();
            for j in 0..=ny {
                row.push(self.scene.node(point(i as f64 / nx as f64, j as f64 / ny as f64)));
            }
            nodes.push(row);
        }
        self.fill(&nodes, pattern)?;
        Ok(nodes)
    }

    /// Mean, over the elements around a node, of a value at their corners there.
    pub(super) fn mean_at(
        &self,
        node: usize,
        displacements: &[[f64; 6]],
        value: impl Fn(&ShellResultants) -> f64,
    ) -> Result<f64, AnyError> {
        let mut sum = 0.0;
        let mut count = 0.0;
        for shell in &self.shells {
            if let Some(corner) = shell.nodes().iter().position(|&corner| corner == node) {
                let points = self.scene.points(shell.nodes());
                let displacement = values(shell, displacements);
                let resultants = shell.resultants(&points, &displacement)?[corner];
                sum += value(&resultants.in_axes([1.0, 0.0, 0.0], [0.0, 0.0, 1.0])?);
                count += 1.0;
            }
        }
        Ok(sum / count)
    }
}

/// A force spread evenly over the spans between nodes in a row.
pub(super) fn spread(nodes: &[usize], direction: Direction, force: f64) -> Vec<NodalLoad> {
    let spans = (nodes.len() - 1) as f64;
    let mut loads = Vec::new();
    for (k, &node) in nodes.iter().enumerate() {
        let part = if k == 0 || k + 1 == nodes.len() { 0.5 } else { 1.0 };
        loads.push((node, direction, force / spans * part));
    }
    loads
}
