//! Finite elements of one column, reduced to their sides and horizontal edges.

use basemat_fourier::num_complex::Complex64;

use super::polynomials::{IntervalFunctions, ProductIntegrals};
use crate::error::Result;
use crate::linalg::ComplexBlock;

/// Elastic constants of a soil at a Laplace variable s.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moduli {
    /// μ(s), Pa.
    pub(super) shear: Complex64,
    /// λ(s), Pa.
    pub(super) lame: Complex64,
    /// ρ s², kg/(m³ s²).
    pub(super) inertia: Complex64,
}

/// Functions along x of motions that are symmetric or antisymmetric about the middle of a column.
///
/// Lists of two: of u_x and of u_z.
#[derive(Debug)]
struct Parity {
    function_counts: [usize; 2],
    stiffness: [ProductIntegrals; 2],
    mass: [ProductIntegrals; 2],
    /// ∫ φ′ψ and ∫ φψ′ for functions φ of u_x and ψ of u_z.
    derivative_products: [ProductIntegrals; 2],
    means: [Vec<f64>; 2],
}

impl Parity {
    fn new(horizontal: &IntervalFunctions, vertical: &IntervalFunctions) -> Self {
        Self {
            stiffness: [horizontal.stiffnesses(), vertical.stiffnesses()],
            mass: [horizontal.masses(horizontal), vertical.masses(vertical)],
            derivative_products: [
                horizontal.derivative_products(vertical),
                vertical.derivative_products(horizontal).transposed(),
            ],
            means: [horizontal.means(), vertical.means()],
            function_counts: [horizontal.count(), vertical.count()],
        }
    }

    /// Number of functions of a horizontal edge that vanish at its ends.
    fn edge_function_count(&self) -> usize {
        self.function_counts.iter().sum::<usize>() - 2
    }

    /// Index of a component's first function among those of a horizontal edge.
    fn first_edge_function(&self, component: usize) -> usize {
        component * (self.function_counts[0] - 1)
    }
}

/// Functions of one degree along z.
#[derive(Debug)]
struct DepthFunctions {
    degree: usize,
    stiffness: ProductIntegrals,
    mass: ProductIntegrals,
    derivative_products: ProductIntegrals,
}

impl DepthFunctions {
    fn new(degree: usize) -> Self {
        let functions = IntervalFunctions::lagrange(degree);
        let stiffness = functions.stiffnesses();
        let mass = functions.masses(&functions);
        let derivative_products = functions.derivative_products(&functions);
        Self { degree, stiffness, mass, derivative_products }
    }
}

/// Function of an element: a product of functions along x and z.
#[derive(Clone, Copy)]
struct ElementFunction {
    component: usize,
    /// Index along x.
    x_index: usize,
    /// Index along z.
    z_index: usize,
}

/// Integrals over products of two functions, for elements of any size and soil.
#[derive(Debug, Clone, Copy)]
struct FormIntegrals {
    /// Which of the element's factors belong to the integrals.
    kind: usize,
    values: [f64; FACTOR_COUNT],
}

/// Number of factors of an element for each kind of [`FormIntegrals`].
const FACTOR_COUNT: usize = 3;
/// Both functions horizontal; both vertical; one of each.
const KIND_COUNT: usize = 3;

/// Factors of the integrals of an element, for each kind.
type ElementFactors = [[Complex64; FACTOR_COUNT]; KIND_COUNT];

/// Integrals over products of two lists of functions, column by column.
#[derive(Debug)]
struct FormBlock {
    row_count: usize,
    integrals: Vec<FormIntegrals>,
}

impl FormBlock {
    fn new(
        rows: &[ElementFunction],
        columns: &[ElementFunction],
        parity: &Parity,
        depth: &DepthFunctions,
    ) -> Self {
        let mut integrals = Vec::with_capacity(rows.len() * columns.len());
        for column in columns {
            integrals.extend(rows.iter().map(|row| form_integrals(*row, *column, parity, depth)));
        }
        Self { row_count: rows.len(), integrals }
    }

    /// Stiffness of an element.
    fn stiffness(&self, factors: &ElementFactors) -> ComplexBlock {
        let mut values = Vec::with_capacity(self.integrals.len());
        for FormIntegrals { kind, values: [first, second, third] } in &self.integrals {
            let [first_factor, second_factor, third_factor] = factors[*kind];
            values.push(first_factor * first + second_factor * second + third_factor * third);
        }
        ComplexBlock::from_columns(self.row_count, values)
    }
}

/// Integrals over the product of two functions.
fn form_integrals(
    row: ElementFunction,
    column: ElementFunction,
    parity: &Parity,
    depth: &DepthFunctions,
) -> FormIntegrals {
    let ElementFunction { component, x_index: a, z_index: b } = row;
    let ElementFunction { component: other_component, x_index: e, z_index: f } = column;
    if component == other_component {
        let x_stiffness = parity.stiffness[component].at(a, e);
        let x_mass = parity.mass[component].at(a, e);
        let z_mass = depth.mass.at(b, f);
        let z_stiffness = depth.stiffness.at(b, f);
        let values = [x_stiffness * z_mass, x_mass * z_stiffness, x_mass * z_mass];
        FormIntegrals { kind: component, values }
    } else if component == 0 {
        let lame = parity.derivative_products[0].at(a, e) * depth.derivative_products.at(f, b);
        let shear = parity.derivative_products[1].at(a, e) * depth.derivative_products.at(b, f);
        FormIntegrals { kind: 2, values: [lame, shear, 0.0] }
    } else {
        form_integrals(column, row, parity, depth)
    }
}

/// Factors of an element of a `width` and a `height`, m, for half of its stiffness.
fn element_factors(width: f64, height: Complex64, moduli: Moduli) -> ElementFactors {
    let Moduli { shear, lame, inertia } = moduli;
    let pressure = lame + shear * 2.0;
    let x_factor = height * (0.5 / width);
    let z_factor = 0.5 * width / height;
    let mass = inertia * height * (0.5 * width);
    [
        [pressure * x_factor, shear * z_factor, mass],
        [shear * x_factor, pressure * z_factor, mass],
        [lame * 0.5, shear * 0.5, Complex64::ZERO],
    ]
}

/// Function of an element that remains when its inner functions are eliminated.
#[derive(Debug, Clone, Copy)]
pub(super) enum RetainedFunction {
    Side { component: usize, level: usize },
    Edge { function: usize, is_at_bottom: bool },
}

/// Matrices of elements of one parity and one degree along z.
#[derive(Debug)]
struct ElementForms {
    /// Functions of a side, then functions of horizontal edges.
    functions: Vec<RetainedFunction>,
    retained: FormBlock,
    inner: FormBlock,
    /// Rows of inner functions, columns of retained ones.
    coupling: FormBlock,
}

impl ElementForms {
    fn new(parity: &Parity, depth: &DepthFunctions) -> Self {
        let degree = depth.degree;
        let mut retained = vec![];
        let mut functions = vec![];
        let mut inner = vec![];
        for component in 0..2 {
            for level in 0..=degree {
                retained.push(ElementFunction { component, x_index: 0, z_index: level });
                functions.push(RetainedFunction::Side { component, level });
            }
        }
        let mut function = 0;
        for component in 0..2 {
            for x_index in 1..parity.function_counts[component] {
                for is_at_bottom in [false, true] {
                    let z_index = if is_at_bottom { degree } else { 0 };
                    retained.push(ElementFunction { component, x_index, z_index });
                    functions.push(RetainedFunction::Edge { function, is_at_bottom });
                }
                for z_index in 1..degree {
                    inner.push(ElementFunction { component, x_index, z_index });
                }
                function += 1;
            }
        }
        Self {
            functions,
            retained: FormBlock::new(&retained, &retained, parity, depth),
            inner: FormBlock::new(&inner, &inner, parity, depth),
            coupling: FormBlock::new(&inner, &retained, parity, depth),
        }
    }

    /// Eliminates the functions that vanish on all sides.
    fn condensed(&self, factors: &ElementFactors) -> Result<ComplexBlock> {
        let mut matrix = self.retained.stiffness(factors);
        matrix.eliminate(&self.inner.stiffness(factors), &self.coupling.stiffness(factors))?;
        Ok(matrix)
    }
}

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
    /// Of the near field and of the stretched elements; for each, symmetric and antisymmetric.
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

    /// Number of functions of a horizontal edge that vanish at its ends, symmetric and antisymmetric.
    pub(super) fn edge_function_counts(&self) -> [usize; 2] {
        self.parities.each_ref().map(Parity::edge_function_count)
    }

    fn forms(&self, degree: usize) -> &[ElementForms; 2] {
        &self.forms[usize::from(degree != self.near_degree)]
    }

    /// Functions of symmetric (0) or antisymmetric (1) motions: of a side, then of horizontal edges.
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
    /// Value of a function at the right side relative to the left side.
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
