//! A block of bricks on supports.

use basemat::fem::{Hex8, Material};
use basemat_problems::supported::Supported;

/// Bricks whose nodes stand in a grid.
pub(super) struct Block {
    pub(super) scene: Supported,
    pub(super) counts: [usize; 3],
}

impl Block {
    /// Bricks between nodes that `at` places by their indices.
    pub(super) fn new(
        counts: [usize; 3],
        material: Material,
        at: impl Fn([usize; 3]) -> [f64; 3],
    ) -> Self {
        let mut block = Self { scene: Supported::new(), counts };
        let [nx, ny, nz] = counts;
        for i in 0..=nx {
            for j in 0..=ny {
                for k in 0..=nz {
                    block.scene.node(at([i, j, k]));
                }
            }
        }
        for i in 0..nx {
            for j in 0..ny {
                for k in 0..nz {
                    let nodes = block.corners([i, j, k]);
                    block.scene.add(Hex8::new(nodes, material));
                }
            }
        }
        block
    }

    /// Number of a node.
    pub(super) fn node(&self, [i, j, k]: [usize; 3]) -> usize {
        let [_, ny, nz] = self.counts;
        (i * (ny + 1) + j) * (nz + 1) + k
    }

    /// Nodes of a brick.
    pub(super) fn corners(&self, [i, j, k]: [usize; 3]) -> [usize; 8] {
        [
            [i, j, k],
            [i + 1, j, k],
            [i + 1, j + 1, k],
            [i, j + 1, k],
            [i, j, k + 1],
            [i + 1, j, k + 1],
            [i + 1, j + 1, k + 1],
            [i, j + 1, k + 1],
        ]
        .map(|index| self.node(index))
    }

    /// Nodes of the section at a column of the first index, with their parts of its area.
    pub(super) fn section(&self, i: usize) -> Vec<(usize, f64)> {
        let [_, ny, nz] = self.counts;
        let part = |k: usize, n: usize| if k == 0 || k == n { 0.5 } else { 1.0 } / n as f64;
        let nodes = (0..=ny).flat_map(|j| (0..=nz).map(move |k| (j, k)));
        nodes.map(|(j, k)| (self.node([i, j, k]), part(j, ny) * part(k, nz))).collect()
    }
}
