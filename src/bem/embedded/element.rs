//! Finite elements of one column, reduced to their sides and horizontal edges.

use basemat_fourier::num_complex::Complex64;

use super::forms::{
    DepthFunctions, ElementForms, Moduli, Parity, RetainedFunction, element_factors,
};
use super::polynomials::IntervalFunctions;
use crate::error::Result;
use crate::linalg::ComplexBlock;

/// Number of functions of a side.
pub(super) fn side_function_count(degree: usize) -> usize {
    2 * (degree + 1)
}

/// Functions of the elements of all columns.
#[derive(Debug)]
pub(super) struct ElementBasis {
    /// Symmetric, and antisymmetric.
    parities: [Parity; 2],
    /// Degree along z of the near field.
    near_degree: usize,
    /// Means of the functions of a side in the near field.
    side_means: Vec<f64>,
    /// Matrices of the near field and of stretched elements; for each, symmetric and antisymmetric.
    forms: [[ElementForms; 2]; 2],
}

/// Element of a column.
#[derive(Debug, Clone, Copy)]
pub(super) struct ColumnElement {
    pub(super) width: f64,
    pub(super) height: Complex64,
    /// Degree along z.
    pub(super) degree: usize,
    pub(super) moduli: Moduli,
}

impl ElementBasis {
    /// Functions of near-field and stretched elements.
    ///
    /// `degree`: along x, and along z in the near field. `stretched_degree`: along z in stretched elements.
    pub(super) fn new(degree: usize, stretched_degree: usize) -> Self {
        let [even, odd] = IntervalFunctions::lagrange(degree).even_and_odd();
        // Mirror images about a vertical line: u_x is odd, u_z even.
        let parities = [Parity::new(&odd, &even), Parity::new(&even, &odd)];
        let forms = [degree, stretched_degree].map(|z_degree| {
            let depth = DepthFunctions::new(z_degree);
            parities.each_ref().map(|parity| ElementForms::new(parity, &depth))
        });
        let side_means = IntervalFunctions::lagrange(degree).means();
        Self { parities, near_degree: degree, side_means, forms }
    }

    /// Number of symmetric and of antisymmetric functions of a horizontal edge.
    ///
    /// These functions vanish at the ends of the edge.
    pub(super) fn edge_function_counts(&self) -> [usize; 2] {
        self.parities.each_ref().map(Parity::edge_function_count)
    }

    /// Matrices of elements of this degree along z: symmetric and antisymmetric.
    fn forms(&self, degree: usize) -> &[ElementForms; 2] {
        &self.forms[usize::from(degree != self.near_degree)]
    }

    /// Functions of a side, then of horizontal edges.
    ///
    /// `parity`: 0 for symmetric, 1 for antisymmetric motions.
    pub(super) fn functions(&self, parity: usize, degree: usize) -> &[RetainedFunction] {
        &self.forms(degree)[parity].functions
    }

    /// Half of the stiffness of an element for symmetric (0) or antisymmetric (1) motions.
    pub(super) fn half_stiffness(
        &self,
        parity: usize,
        element: &ColumnElement,
    ) -> Result<ComplexBlock> {
        let factors = element_factors(element.width, element.height, element.moduli);
        self.forms(element.degree)[parity].condensed(&factors)
    }

    /// Stiffness of an element.
    ///
    /// Rows: functions of the left and of the right side, then of horizontal edges, symmetric and then antisymmetric. A
    /// horizontal and a vertical load on a `loaded_edge` follow.
    pub(super) fn stiffness(
        &self,
        element: &ColumnElement,
        loaded_edge: Option<LoadedEdge>,
    ) -> Result<ComplexBlock> {
        let edge_counts = self.edge_function_counts().map(|count| 2 * count);
        let first_edge_row = 2 * side_function_count(element.degree);
        let load_row = first_edge_row + edge_counts[0] + edge_counts[1];
        let order = load_row + if loaded_edge.is_some() { 2 } else { 0 };
        let mut stiffness = ComplexBlock::zeros(order, order);
        for (index, parity) in self.parities.iter().enumerate() {
            let rows = ParityRows {
                z_degree: element.degree,
                symmetry: if index == 0 { 1.0 } else { -1.0 },
                first_edge_row: if index == 0 {
                    first_edge_row
                } else {
                    first_edge_row + edge_counts[0]
                },
                edge_row_count: edge_counts[index],
            };
            rows.add_half(&self.half_stiffness(index, element)?, &mut stiffness);
            if loaded_edge == Some(LoadedEdge::Top) {
                rows.add_top_loads(parity, element.width, load_row, &mut stiffness);
            }
        }
        if loaded_edge == Some(LoadedEdge::Left) {
            self.add_left_loads(element, load_row, &mut stiffness);
        }
        Ok(stiffness)
    }

    /// Adds the loads on the left side of an element of the near field.
    fn add_left_loads(
        &self,
        element: &ColumnElement,
        load_row: usize,
        stiffness: &mut ComplexBlock,
    ) {
        for component in 0..2 {
            let load_column = load_row + component;
            for (level, mean) in self.side_means.iter().enumerate() {
                let row = component * self.side_means.len() + level;
                let value = element.height * *mean;
                stiffness[(row, load_column)] -= value;
                stiffness[(load_column, row)] -= value;
            }
        }
    }
}

/// Loaded edge of an element: a contact element, or a part of one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum LoadedEdge {
    Top,
    Left,
}

/// Rows of the functions of one parity in the matrix of an element.
struct ParityRows {
    z_degree: usize,
    /// 1 for symmetric motions, −1 for antisymmetric ones.
    symmetry: f64,
    first_edge_row: usize,
    edge_row_count: usize,
}

impl ParityRows {
    /// Sign of a side's function at the right side, relative to the left side.
    fn mirror(&self, function: usize) -> f64 {
        // In symmetric motions horizontal components change sign.
        if function <= self.z_degree { -self.symmetry } else { self.symmetry }
    }

    /// Adds the stiffness of motions of this parity, from `half` of the stiffness.
    fn add_half(&self, half: &ComplexBlock, stiffness: &mut ComplexBlock) {
        let side_count = side_function_count(self.z_degree);
        for j in 0..side_count {
            for i in 0..side_count {
                let value = half[(i, j)] * 0.5;
                let left_by_right = value * self.mirror(j);
                stiffness[(i, j)] += value;
                stiffness[(i, side_count + j)] += left_by_right;
                stiffness[(side_count + i, j)] += value * self.mirror(i);
                stiffness[(side_count + i, side_count + j)] += left_by_right * self.mirror(i);
            }
        }
        for j in 0..self.edge_row_count {
            let column = self.first_edge_row + j;
            for i in 0..side_count {
                let value = half[(i, side_count + j)];
                let right_value = value * self.mirror(i);
                stiffness[(i, column)] = value;
                stiffness[(column, i)] = value;
                stiffness[(side_count + i, column)] = right_value;
                stiffness[(column, side_count + i)] = right_value;
            }
            for i in 0..self.edge_row_count {
                let value = half[(side_count + i, side_count + j)];
                stiffness[(self.first_edge_row + i, column)] = value * 2.0;
            }
        }
    }

    /// Adds the loads on the top edge of an element of a `width`, m.
    fn add_top_loads(
        &self,
        parity: &Parity,
        width: f64,
        load_row: usize,
        stiffness: &mut ComplexBlock,
    ) {
        let side_count = side_function_count(self.z_degree);
        for (component, means) in parity.means.iter().enumerate() {
            let load_column = load_row + component;
            let function = component * (self.z_degree + 1);
            let side_value = 0.5 * means[0] * width;
            let mut values = vec![(function, side_value)];
            values.push((side_count + function, side_value * self.mirror(function)));
            let first_function = parity.first_edge_function(component);
            for (index, mean) in means[1..].iter().enumerate() {
                // Each function has a row at the top and one at the bottom.
                let row = self.first_edge_row + 2 * (first_function + index);
                values.push((row, mean * width));
            }
            for (row, value) in values {
                stiffness[(row, load_column)] -= value;
                stiffness[(load_column, row)] -= value;
            }
        }
    }
}
