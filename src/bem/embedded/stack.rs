//! Stack of elements of a column: its nodes, and the interpolation between a coarse and a fine stack.

use std::ops::Range;

use basemat_fourier::num_complex::Complex64;

use super::polynomials::{lagrange, lobatto_nodes};

/// Element of a stack.
#[derive(Debug, Clone, Copy)]
pub(super) struct StackElement {
    /// Height, m; complex where the element is stretched, below the near field.
    pub(super) height: Complex64,
    pub(super) soil_index: usize,
    /// Degree along z.
    pub(super) degree: usize,
}

/// Elements one below the other; the bottom of the last one is fixed.
#[derive(Debug, Clone)]
pub(super) struct Stack(pub(super) Vec<StackElement>);

/// Entry of the matrix that interpolates values of a coarse stack at the nodes of a fine stack.
#[derive(Debug, Clone, Copy)]
pub(super) struct InterpolationEntry {
    pub(super) fine_index: usize,
    pub(super) coarse_index: usize,
    /// Value of the function of the coarse node at the fine node.
    pub(super) value: f64,
}

/// Stack of joined elements, and its interpolation at the nodes of the original stack.
pub(super) struct CoarseStack {
    pub(super) stack: Stack,
    pub(super) interpolation: Vec<InterpolationEntry>,
}

impl Stack {
    /// Number of nodes on a side.
    pub(super) fn node_count(&self) -> usize {
        self.0.iter().map(|element| element.degree).sum()
    }

    /// Index of the top node of each element.
    fn top_nodes(&self) -> Vec<usize> {
        let mut top_nodes = Vec::with_capacity(self.0.len());
        let mut node = 0;
        for element in &self.0 {
            top_nodes.push(node);
            node += element.degree;
        }
        top_nodes
    }

    /// Joins each group of elements to one element.
    pub(super) fn coarsened(&self, element_groups: &[Range<usize>]) -> CoarseStack {
        let mut stack = Self(vec![]);
        let mut interpolation = vec![];
        let top_nodes = self.top_nodes();
        let node_count = self.node_count();
        let mut top_coarse_node = 0;
        for group in element_groups {
            let top_element = self.0[group.start];
            let height: Complex64 =
                self.0[group.clone()].iter().map(|element| element.height).sum();
            let coarse_nodes = lobatto_nodes(top_element.degree);
            let mut height_above = Complex64::ZERO;
            for k in group.clone() {
                let element = self.0[k];
                let nodes = lobatto_nodes(element.degree);
                // The last node of an element is the first one of the next element.
                for (j, position) in nodes.iter().enumerate().take(element.degree) {
                    let fine_index = top_nodes[k] + j;
                    let x = ((height_above + element.height * *position) / height).re;
                    for i in 0..=top_element.degree {
                        let value = if group.len() == 1 {
                            f64::from(u8::from(i == j))
                        } else {
                            lagrange(&coarse_nodes, i, x)
                        };
                        if value != 0.0 && fine_index < node_count {
                            let coarse_index = top_coarse_node + i;
                            let entry = InterpolationEntry { fine_index, coarse_index, value };
                            interpolation.push(entry);
                        }
                    }
                }
                height_above += element.height;
            }
            top_coarse_node += top_element.degree;
            stack.0.push(StackElement { height, ..top_element });
        }
        interpolation.retain(|entry| entry.coarse_index < top_coarse_node);
        CoarseStack { stack, interpolation }
    }
}
