//! A column of elements of one width, reduced to its sides.

use std::ops::Range;

use basemat_fourier::num_complex::Complex64;

use super::polynomials::{IntervalFunctions, ProductIntegrals, lagrange, nodes};
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

/// Element of a stack.
#[derive(Debug, Clone, Copy)]
pub(super) struct StackElement {
    /// Height, m; complex where it is stretched, below the near field.
    pub(super) height: Complex64,
    /// Number of its soil.
    pub(super) soil: usize,
    /// Degree along z.
    pub(super) degree: usize,
}

/// Elements one below the other; the bottom of the last one is fixed.
#[derive(Debug, Clone)]
pub(super) struct Stack(pub(super) Vec<StackElement>);

impl Stack {
    /// Number of nodes on a side.
    pub(super) fn nodes(&self) -> usize {
        self.0.iter().map(|layer| layer.degree).sum()
    }

    /// Nodes above and at the top of each element.
    pub(super) fn first_nodes(&self) -> Vec<usize> {
        let mut first_nodes = Vec::with_capacity(self.0.len());
        let mut count = 0;
        for element in &self.0 {
            first_nodes.push(count);
            count += element.degree;
        }
        first_nodes
    }

    /// The stack with each group of elements joined to one, and values of its functions at this stack's nodes.
    ///
    /// Values: node of this stack, node of the coarse one, and value of the latter's function at the former.
    pub(super) fn coarsened(&self, groups: &[Range<usize>]) -> (Self, Vec<(usize, usize, f64)>) {
        let mut coarse = Self(vec![]);
        let mut values = vec![];
        let first_nodes = self.first_nodes();
        let node_count = self.nodes();
        let mut first_coarse_node = 0;
        for group in groups {
            let top = self.0[group.start];
            let height: Complex64 =
                self.0[group.clone()].iter().map(|element| element.height).sum();
            let coarse_nodes = nodes(top.degree);
            let mut height_above = Complex64::ZERO;
            for k in group.clone() {
                let element = self.0[k];
                // The last node of an element is the first one of the next element.
                for (j, place) in nodes(element.degree).iter().enumerate().take(element.degree) {
                    let x = ((height_above + element.height * *place) / height).re;
                    for i in 0..=top.degree {
                        let value = if group.len() == 1 {
                            f64::from(u8::from(i == j))
                        } else {
                            lagrange(&coarse_nodes, i, x)
                        };
                        if value != 0.0 && first_nodes[k] + j < node_count {
                            values.push((first_nodes[k] + j, first_coarse_node + i, value));
                        }
                    }
                }
                height_above += element.height;
            }
            first_coarse_node += top.degree;
            coarse.0.push(StackElement { height, ..top });
        }
        values.retain(|(_, coarse_node, _)| *coarse_node < first_coarse_node);
        (coarse, values)
    }
}

/// Functions along x of motions that are symmetric or antisymmetric about the middle of a column.
///
/// Lists of two: of u_x and of u_z.
struct Parity {
    /// Numbers of functions.
    counts: [usize; 2],
    stiffness: [ProductIntegrals; 2],
    mass: [ProductIntegrals; 2],
    /// ∫ φ′ψ and ∫ φψ′ for functions φ of u_x and ψ of u_z.
    slopes: [ProductIntegrals; 2],
    means: [Vec<f64>; 2],
}

impl Parity {
    fn new(horizontal: &IntervalFunctions, vertical: &IntervalFunctions) -> Self {
        Self {
            stiffness: [horizontal.stiffnesses(), vertical.stiffnesses()],
            mass: [horizontal.masses(horizontal), vertical.masses(vertical)],
            slopes: [horizontal.slopes_by(vertical), vertical.slopes_by(horizontal).transposed()],
            means: [horizontal.means(), vertical.means()],
            counts: [horizontal.count(), vertical.count()],
        }
    }

    /// Adds two loads of the top edge to the matrices of a column.
    ///
    /// `nodes`: on a side. `first`: number of the horizontal load.
    fn load_top(
        &self,
        width: f64,
        nodes: usize,
        first: usize,
        sides: &mut ComplexBlock,
        coupling: &mut ComplexBlock,
    ) {
        for (component, means) in self.means.iter().enumerate() {
            let side = component * nodes;
            let load = 2 * nodes + first + component;
            sides[(side, load)] -= means[0] * width;
            sides[(load, side)] -= means[0] * width;
            let begin = component * (self.counts[0] - 1);
            for (function, mean) in means[1..].iter().enumerate() {
                coupling[(begin + function, load)] -= mean * width;
            }
        }
    }
}

/// Functions of one degree along z.
struct DepthFunctions {
    degree: usize,
    stiffness: ProductIntegrals,
    mass: ProductIntegrals,
    slopes: ProductIntegrals,
}

impl DepthFunctions {
    fn new(degree: usize) -> Self {
        let functions = IntervalFunctions::lagrange(degree);
        let stiffness = functions.stiffnesses();
        let mass = functions.masses(&functions);
        let slopes = functions.slopes_by(&functions);
        Self { degree, stiffness, mass, slopes }
    }
}

/// Functions of the elements of all columns.
pub(super) struct Elements {
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
    /// Number of all loads, on this column and others.
    pub(super) count: usize,
    /// Number of the horizontal load on this column, which is before the vertical one; `None` without loads on it.
    pub(super) first: Option<usize>,
}

impl EdgeLoads {
    /// No loads on any column.
    pub(super) const NO_LOADS: Self = Self { count: 0, first: None };
}

impl Elements {
    /// Functions of `degree` along x, and of `degrees` along z: of the near field, and of the stretched elements.
    pub(super) fn new(degree: usize, degrees: [usize; 2]) -> Self {
        let [even, odd] = IntervalFunctions::lagrange(degree).halves();
        // Mirror images about a vertical line: u_x is odd, u_z even.
        let parities = [Parity::new(&odd, &even), Parity::new(&even, &odd)];
        Self { parities, depth_functions: degrees.map(DepthFunctions::new) }
    }

    /// The column of `width`, m.
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
        let count = stack.nodes();
        // Functions inside the column, of u_x and then of u_z.
        let inner = parity.counts.iter().sum::<usize>() - 2;
        let mut sides = ComplexBlock::zeros(2 * count + loads.count, 2 * count + loads.count);
        let edges = stack.0.len() * inner;
        let mut pivot = ComplexBlock::zeros(edges, edges);
        let mut coupling = ComplexBlock::zeros(edges, 2 * count + loads.count);
        let mut node = 0;
        for (k, element) in stack.0.iter().enumerate() {
            let is_stretched = element.degree != self.depth_functions[0].degree;
            let element_matrix = ColumnElement {
                parity,
                depth_functions: &self.depth_functions[usize::from(is_stretched)],
                width,
                height: element.height,
                moduli: soils[element.soil],
            };
            let (matrix, functions) = element_matrix.condensed()?;
            // Functions on the fixed bottom have no place.
            let mut places = Vec::with_capacity(functions.len());
            for function in functions {
                places.push(match function {
                    RetainedFunction::Side { component, level } => (node + level < count)
                        .then_some(MatrixPlace::Side(component * count + node + level)),
                    RetainedFunction::Edge { function, bottom } => {
                        let line = k + usize::from(bottom);
                        (line < stack.0.len()).then_some(MatrixPlace::Edge(line * inner + function))
                    }
                });
            }
            for (j, column) in places.iter().enumerate() {
                for (i, row) in places.iter().enumerate() {
                    let value = matrix[(i, j)];
                    match (row, column) {
                        (Some(MatrixPlace::Side(row)), Some(MatrixPlace::Side(column))) => {
                            sides[(*row, *column)] += value;
                        }
                        (Some(MatrixPlace::Edge(row)), Some(MatrixPlace::Edge(column))) => {
                            pivot[(*row, *column)] += value;
                        }
                        (Some(MatrixPlace::Edge(row)), Some(MatrixPlace::Side(column))) => {
                            coupling[(*row, *column)] += value;
                        }
                        _ => {}
                    }
                }
            }
            node += element.degree;
        }
        if let Some(first) = loads.first {
            parity.load_top(width, count, first, &mut sides, &mut coupling);
        }
        sides.eliminate(&pivot, &coupling)?;
        Ok(sides)
    }
}

/// Row or column of an element's function in the matrices of a column.
enum MatrixPlace {
    /// Among the nodes of a side.
    Side(usize),
    /// Among the functions of horizontal edges.
    Edge(usize),
}

/// Function of an element that remains when its inner ones are eliminated.
enum RetainedFunction {
    Side { component: usize, level: usize },
    Edge { function: usize, bottom: bool },
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
    /// Half of the stiffness of functions (component, function along x, function along z).
    fn stiffness(&self, [c, a, b]: [usize; 3], [other, e, f]: [usize; 3]) -> Complex64 {
        let Self { parity, depth_functions: depth, width, height, moduli } = self;
        let Moduli { shear, lame, inertia } = *moduli;
        let pressure = lame + shear * 2.0;
        let value = if c == other {
            let s = parity.stiffness[c].at(a, e);
            let m = parity.mass[c].at(a, e);
            let along = if c == 0 { pressure } else { shear };
            let across = if c == 0 { shear } else { pressure };
            along * height * (s * depth.mass.at(b, f) / width)
                + across / height * (m * depth.stiffness.at(b, f) * width)
                + inertia * height * (m * depth.mass.at(b, f) * width)
        } else if c == 0 {
            lame * (parity.slopes[0].at(a, e) * depth.slopes.at(f, b))
                + shear * (parity.slopes[1].at(a, e) * depth.slopes.at(b, f))
        } else {
            return self.stiffness([other, e, f], [c, a, b]);
        };
        value * 0.5
    }

    /// Matrix of the functions that do not vanish on all sides, and these functions.
    fn condensed(&self) -> Result<(ComplexBlock, Vec<RetainedFunction>)> {
        let degree = self.depth_functions.degree;
        let mut retained = vec![];
        let mut functions = vec![];
        let mut inside = vec![];
        for component in 0..2 {
            for level in 0..=degree {
                retained.push([component, 0, level]);
                functions.push(RetainedFunction::Side { component, level });
            }
        }
        let mut function = 0;
        for component in 0..2 {
            for along in 1..self.parity.counts[component] {
                for (level, bottom) in [(0, false), (degree, true)] {
                    retained.push([component, along, level]);
                    functions.push(RetainedFunction::Edge { function, bottom });
                }
                inside.extend((1..degree).map(|level| [component, along, level]));
                function += 1;
            }
        }
        let mut matrix = self.stiffness_block(&retained, &retained);
        let pivot = self.stiffness_block(&inside, &inside);
        matrix.eliminate(&pivot, &self.stiffness_block(&inside, &retained))?;
        Ok((matrix, functions))
    }

    /// Stiffness between two lists of functions.
    fn stiffness_block(&self, rows: &[[usize; 3]], columns: &[[usize; 3]]) -> ComplexBlock {
        let mut block = ComplexBlock::zeros(rows.len(), columns.len());
        for (j, column) in columns.iter().enumerate() {
            for (i, row) in rows.iter().enumerate() {
                block[(i, j)] = self.stiffness(*row, *column);
            }
        }
        block
    }
}
