//! Stack of elements of a column, and the same stack with joined elements.

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

/// Place of an element in a stack of joined elements.
#[derive(Debug, Clone)]
pub(super) struct JoinedPlace {
    /// Index of the joined element.
    pub(super) element: usize,
    /// Functions of the joined element at the nodes of the element, node by node.
    ///
    /// `None` if both elements are the same.
    pub(super) interpolation: Option<Vec<f64>>,
}

/// Stack of joined elements, and the place of each of the original elements.
#[derive(Debug, Clone)]
pub(super) struct JoinedStack {
    pub(super) stack: Stack,
    pub(super) places: Vec<JoinedPlace>,
}

impl Stack {
    /// Number of nodes on a side.
    pub(super) fn node_count(&self) -> usize {
        self.0.iter().map(|element| element.degree).sum()
    }

    /// Index of the top node of an element.
    ///
    /// For the index after the last element it is the number of nodes.
    pub(super) fn top_node(&self, element: usize) -> usize {
        self.0[..element].iter().map(|element| element.degree).sum()
    }

    /// Joins each group of elements, which have real heights, to one element.
    pub(super) fn joined(&self, element_groups: &[Range<usize>]) -> JoinedStack {
        let mut stack = Self(vec![]);
        let mut places = vec![];
        for (index, group) in element_groups.iter().enumerate() {
            let top_element = self.0[group.start];
            let height: Complex64 =
                self.0[group.clone()].iter().map(|element| element.height).sum();
            let joined_nodes = lobatto_nodes(top_element.degree);
            let mut height_above = Complex64::ZERO;
            for element in &self.0[group.clone()] {
                let mut interpolation = None;
                if group.len() > 1 {
                    let mut values = vec![];
                    for position in lobatto_nodes(element.degree) {
                        let x = ((height_above + element.height * position) / height).re;
                        let functions = 0..joined_nodes.len();
                        values.extend(functions.map(|i| lagrange(&joined_nodes, i, x)));
                    }
                    interpolation = Some(values);
                }
                places.push(JoinedPlace { element: index, interpolation });
                height_above += element.height;
            }
            stack.0.push(StackElement { height, ..top_element });
        }
        JoinedStack { stack, places }
    }
}
