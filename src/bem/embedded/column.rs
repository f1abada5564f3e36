//! Finite elements of a column of one width, reduced to the sides of the column.

use basemat_fourier::num_complex::Complex64;

use super::polynomials::{IntervalFunctions, ProductIntegrals};
use super::stack::Stack;
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

    /// Adds the loads on the top edge to the matrices of a column.
    ///
    /// `node_count`: of a side. `first_load`: index of the horizontal load; the vertical load follows.
    fn load_top(
        &self,
        width: f64,
        node_count: usize,
        first_load: usize,
        sides: &mut ComplexBlock,
        coupling: &mut ComplexBlock,
    ) {
        for (component, means) in self.means.iter().enumerate() {
            let side_row = component * node_count;
            let load_row = 2 * node_count + first_load + component;
            sides[(side_row, load_row)] -= means[0] * width;
            sides[(load_row, side_row)] -= means[0] * width;
            let first_function = component * (self.function_counts[0] - 1);
            for (function, mean) in means[1..].iter().enumerate() {
                coupling[(first_function + function, load_row)] -= mean * width;
            }
        }
    }
}

/// Functions of one degree along z.
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

/// Functions of the elements of all columns.
pub(super) struct ElementBasis {
    /// Symmetric, and antisymmetric.
    parities: [Parity; 2],
    /// Of the near field, and of the stretched elements.
    depth_functions: [DepthFunctions; 2],
}

/// Matrices of a column whose sides move as mirror images of each other, or as their negatives.
///
/// Rows: horizontal and vertical displacement of the nodes of a side, then loads on the top edge. The energy
/// counts for one side.
pub(super) struct ElementColumn {
    pub(super) symmetric: ComplexBlock,
    pub(super) antisymmetric: ComplexBlock,
}

impl ElementColumn {
    /// Half the sum of both matrices, or for a `sign` of −1 of their difference.
    ///
    /// The sum is the stiffness of a side, and the difference the stiffness between a side and the mirrored other one.
    pub(super) fn mean(&self, sign: f64) -> ComplexBlock {
        let order = self.symmetric.rows();
        let mut mean = ComplexBlock::zeros(order, order);
        for j in 0..order {
            for i in 0..order {
                mean[(i, j)] = (self.symmetric[(i, j)] + self.antisymmetric[(i, j)] * sign) * 0.5;
            }
        }
        mean
    }
}

/// Loads on the top edge of a column.
#[derive(Debug, Clone, Copy)]
pub(super) struct EdgeLoads {
    /// Number of loads on all columns.
    pub(super) count: usize,
    /// Index of the horizontal load on this column, if it has loads; the vertical load follows.
    pub(super) first_load: Option<usize>,
}

impl EdgeLoads {
    /// No loads on any column.
    pub(super) const NO_LOADS: Self = Self { count: 0, first_load: None };
}

impl ElementBasis {
    /// Functions of near-field and stretched elements.
    ///
    /// `degree`: along x, and along z in the near field. `stretched_degree`: along z in stretched elements.
    pub(super) fn new(degree: usize, stretched_degree: usize) -> Self {
        let [even, odd] = IntervalFunctions::lagrange(degree).even_and_odd();
        // Mirror images about a vertical line: u_x is odd, u_z even.
        let parities = [Parity::new(&odd, &even), Parity::new(&even, &odd)];
        Self { parities, depth_functions: [degree, stretched_degree].map(DepthFunctions::new) }
    }

    /// Matrices of a column of `width`, m.
    pub(super) fn column(
        &self,
        width: f64,
        stack: &Stack,
        soils: &[Moduli],
        loads: EdgeLoads,
    ) -> Result<ElementColumn> {
        Ok(ElementColumn {
            symmetric: self.side_matrix(&self.parities[0], width, stack, soils, loads)?,
            antisymmetric: self.side_matrix(&self.parities[1], width, stack, soils, loads)?,
        })
    }

    /// Matrix of a side and the loads, for motions of one parity.
    fn side_matrix(
        &self,
        parity: &Parity,
        width: f64,
        stack: &Stack,
        soils: &[Moduli],
        loads: EdgeLoads,
    ) -> Result<ComplexBlock> {
        let node_count = stack.node_count();
        // Functions inside the column, of u_x and then of u_z.
        let inner_count = parity.function_counts.iter().sum::<usize>() - 2;
        let side_order = 2 * node_count + loads.count;
        let edge_order = stack.0.len() * inner_count;
        let mut matrices = ColumnMatrices {
            sides: ComplexBlock::zeros(side_order, side_order),
            edges: ComplexBlock::zeros(edge_order, edge_order),
            coupling: ComplexBlock::zeros(edge_order, side_order),
        };
        let near_field = &self.depth_functions[0];
        let stretched = &self.depth_functions[1];
        let mut top_node = 0;
        for (k, element) in stack.0.iter().enumerate() {
            let is_stretched = element.degree != near_field.degree;
            let depth_functions = if is_stretched { stretched } else { near_field };
            let moduli = soils[element.soil_index];
            let height = element.height;
            let column_element = ColumnElement { parity, depth_functions, width, height, moduli };
            let CondensedElement { matrix, functions } = column_element.condensed()?;
            let mut rows = Vec::with_capacity(functions.len());
            for function in functions {
                rows.push(match function {
                    RetainedFunction::Side { component, level } => {
                        side_row(component, top_node + level, node_count)
                    }
                    RetainedFunction::Edge { function, is_at_bottom } => {
                        let edge = k + usize::from(is_at_bottom);
                        let is_free = edge < stack.0.len();
                        is_free.then_some(MatrixRow::Edge(edge * inner_count + function))
                    }
                });
            }
            matrices.add(&matrix, &rows);
            top_node += element.degree;
        }
        if let Some(first_load) = loads.first_load {
            let ColumnMatrices { sides, coupling, .. } = &mut matrices;
            parity.load_top(width, node_count, first_load, sides, coupling);
        }
        let ColumnMatrices { mut sides, edges, coupling } = matrices;
        sides.eliminate(&edges, &coupling)?;
        Ok(sides)
    }
}

/// Row or column of an element's function in the matrices of a column.
enum MatrixRow {
    /// Among the nodes of a side.
    Side(usize),
    /// Among the functions of horizontal edges.
    Edge(usize),
}

/// Matrices of a column before the functions of edges are eliminated.
struct ColumnMatrices {
    sides: ComplexBlock,
    edges: ComplexBlock,
    /// Rows of edges, columns of sides.
    coupling: ComplexBlock,
}

impl ColumnMatrices {
    /// Adds the matrix of an element, whose functions have these `rows`.
    fn add(&mut self, matrix: &ComplexBlock, rows: &[Option<MatrixRow>]) {
        for (j, column) in rows.iter().enumerate() {
            for (i, row) in rows.iter().enumerate() {
                let value = matrix[(i, j)];
                match (row, column) {
                    (Some(MatrixRow::Side(row)), Some(MatrixRow::Side(column))) => {
                        self.sides[(*row, *column)] += value;
                    }
                    (Some(MatrixRow::Edge(row)), Some(MatrixRow::Edge(column))) => {
                        self.edges[(*row, *column)] += value;
                    }
                    (Some(MatrixRow::Edge(row)), Some(MatrixRow::Side(column))) => {
                        self.coupling[(*row, *column)] += value;
                    }
                    _ => {}
                }
            }
        }
    }
}

/// Row of a component at a node of a side; `None` at the fixed bottom.
fn side_row(component: usize, node: usize, node_count: usize) -> Option<MatrixRow> {
    (node < node_count).then_some(MatrixRow::Side(component * node_count + node))
}

/// Function of an element that remains when its inner functions are eliminated.
enum RetainedFunction {
    Side { component: usize, level: usize },
    Edge { function: usize, is_at_bottom: bool },
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

/// Matrix of an element's retained functions.
struct CondensedElement {
    matrix: ComplexBlock,
    functions: Vec<RetainedFunction>,
}

/// Element of a column.
struct ColumnElement<'a> {
    parity: &'a Parity,
    depth_functions: &'a DepthFunctions,
    width: f64,
    height: Complex64,
    moduli: Moduli,
}

impl ColumnElement<'_> {
    /// Half of the stiffness between two functions.
    fn stiffness(&self, row: ElementFunction, column: ElementFunction) -> Complex64 {
        let Self { parity, depth_functions: depth, width, height, moduli } = self;
        let Moduli { shear, lame, inertia } = *moduli;
        let ElementFunction { component, x_index: a, z_index: b } = row;
        let ElementFunction { component: other_component, x_index: e, z_index: f } = column;
        let pressure = lame + shear * 2.0;
        let value = if component == other_component {
            let x_stiffness = parity.stiffness[component].at(a, e);
            let x_mass = parity.mass[component].at(a, e);
            let x_modulus = if component == 0 { pressure } else { shear };
            let z_modulus = if component == 0 { shear } else { pressure };
            x_modulus * height * (x_stiffness * depth.mass.at(b, f) / width)
                + z_modulus / height * (x_mass * depth.stiffness.at(b, f) * width)
                + inertia * height * (x_mass * depth.mass.at(b, f) * width)
        } else if component == 0 {
            let lame_part =
                parity.derivative_products[0].at(a, e) * depth.derivative_products.at(f, b);
            let shear_part =
                parity.derivative_products[1].at(a, e) * depth.derivative_products.at(b, f);
            lame * lame_part + shear * shear_part
        } else {
            return self.stiffness(column, row);
        };
        value * 0.5
    }

    /// Eliminates the functions that vanish on all sides.
    fn condensed(&self) -> Result<CondensedElement> {
        let degree = self.depth_functions.degree;
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
            for x_index in 1..self.parity.function_counts[component] {
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
        let mut matrix = self.stiffness_block(&retained, &retained);
        let pivot = self.stiffness_block(&inner, &inner);
        matrix.eliminate(&pivot, &self.stiffness_block(&inner, &retained))?;
        Ok(CondensedElement { matrix, functions })
    }

    /// Stiffness between two lists of functions.
    fn stiffness_block(
        &self,
        rows: &[ElementFunction],
        columns: &[ElementFunction],
    ) -> ComplexBlock {
        let mut block = ComplexBlock::zeros(rows.len(), columns.len());
        for (j, column) in columns.iter().enumerate() {
            for (i, row) in rows.iter().enumerate() {
                block[(i, j)] = self.stiffness(*row, *column);
            }
        }
        block
    }
}
