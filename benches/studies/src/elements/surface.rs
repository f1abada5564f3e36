//! A surface of shells on supports.

use basemat::fem::{Direction, Element, Material, Shell, ShellResultants};
use basemat_problems::supported::{Load, Supported, values};

use crate::AnyError;

/// Elements of a cell of a grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Pattern {
    Quadrilaterals,
    /// The diagonal (i, j)–(i + 1, j + 1).
    Rising,
    /// The diagonal (i + 1, j)–(i, j + 1).
    Falling,
}

impl Pattern {
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
pub(super) struct Surface {
    pub(super) scene: Supported,
    pub(super) shells: Vec<Shell>,
    material: Material,
    thickness: f64,
}

impl Surface {
    pub(super) fn new(material: Material, thickness: f64) -> Self {
        Self { scene: Supported::new(), shells: Vec::new(), material, thickness }
    }

    pub(super) fn shell(&mut self, nodes: &[usize], thickness: f64) -> Result<(), AnyError> {
        let shell = Shell::new(nodes, self.material, thickness)?;
        self.scene.add(shell.clone());
        self.shells.push(shell);
        Ok(())
    }

    /// Cells between nodes in a grid.
    pub(super) fn fill(&mut self, nodes: &[Vec<usize>], pattern: Pattern) -> Result<(), AnyError> {
        for (one, other) in nodes.iter().zip(&nodes[1..]) {
            for j in 0..one.len() - 1 {
                let cell = [one[j], other[j], other[j + 1], one[j + 1]];
                for corners in pattern.split(cell) {
                    self.shell(&corners, self.thickness)?;
                }
            }
        }
        Ok(())
    }

    /// Nodes (nx + 1) × (ny + 1) at the points of `place`, whose arguments run from 0 to 1, and cells between them.
    pub(super) fn grid(
        &mut self,
        [nx, ny]: [usize; 2],
        pattern: Pattern,
        place: impl Fn(f64, f64) -> [f64; 3],
    ) -> Result<Vec<Vec<usize>>, AnyError> {
        let ratio = |k: usize, n: usize| k as f64 / n as f64;
        let mut row = |i| {
            let node = |j| self.scene.node(place(ratio(i, nx), ratio(j, ny)));
            (0..=ny).map(node).collect()
        };
        let nodes: Vec<Vec<usize>> = (0..=nx).map(&mut row).collect();
        self.fill(&nodes, pattern)?;
        Ok(nodes)
    }

    /// Mean, over the elements around a node, of a value at their corners there.
    pub(super) fn mean_at(
        &self,
        node: usize,
        all: &[[f64; 6]],
        value: impl Fn(&ShellResultants) -> f64,
    ) -> Result<f64, AnyError> {
        let (mut sum, mut count) = (0.0, 0.0);
        for shell in &self.shells {
            if let Some(corner) = shell.nodes().iter().position(|&own| own == node) {
                let points = self.scene.points(shell.nodes());
                let displacement = values(shell, all);
                let own = shell.resultants(&points, &displacement)?[corner];
                sum += value(&own.in_axes([1.0, 0.0, 0.0], [0.0, 0.0, 1.0])?);
                count += 1.0;
            }
        }
        Ok(sum / count)
    }
}

/// A force spread evenly over nodes in a row: half a share for each end.
pub(super) fn spread(nodes: &[usize], direction: Direction, force: f64) -> Vec<Load> {
    let spans = (nodes.len() - 1) as f64;
    let part = |k: usize| if k == 0 || k + 1 == nodes.len() { 0.5 } else { 1.0 };
    let load = |(k, &node): (usize, &usize)| (node, direction, force / spans * part(k));
    nodes.iter().enumerate().map(load).collect()
}
