//! Integrals over products of functions of an element, and its matrix without inner functions.

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

/// Functions along x of symmetric, or of antisymmetric motions.
///
/// The motions are symmetric or antisymmetric about the middle of a column. Lists of two: of u_x and of u_z.
#[derive(Debug)]
pub(super) struct Parity {
    function_counts: [usize; 2],
    stiffness: [ProductIntegrals; 2],
    mass: [ProductIntegrals; 2],
    /// ∫ φ′ψ and ∫ φψ′ for functions φ of u_x and ψ of u_z.
    derivative_products: [ProductIntegrals; 2],
    pub(super) means: [Vec<f64>; 2],
}

impl Parity {
    pub(super) fn new(horizontal: &IntervalFunctions, vertical: &IntervalFunctions) -> Self {
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
    pub(super) fn edge_function_count(&self) -> usize {
        self.function_counts.iter().sum::<usize>() - 2
    }

    /// Index of a component's first function among those of a horizontal edge.
    pub(super) fn first_edge_function(&self, component: usize) -> usize {
        component * (self.function_counts[0] - 1)
    }
}

/// Functions of one degree along z.
#[derive(Debug)]
pub(super) struct DepthFunctions {
    degree: usize,
    stiffness: ProductIntegrals,
    mass: ProductIntegrals,
    derivative_products: ProductIntegrals,
}

impl DepthFunctions {
    pub(super) fn new(degree: usize) -> Self {
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
    /// Index of the element's factors of these integrals.
    kind: usize,
    values: [f64; FACTOR_COUNT],
}

/// Number of factors of an element for each kind of [`FormIntegrals`].
const FACTOR_COUNT: usize = 3;
/// Both functions horizontal; both vertical; one of each.
const KIND_COUNT: usize = 3;

/// Factors of the integrals of an element, for each kind.
pub(super) type ElementFactors = [[Complex64; FACTOR_COUNT]; KIND_COUNT];

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
        let values = self.integrals.iter().map(|integrals| {
            let FormIntegrals { kind, values } = integrals;
            let factors = &factors[*kind];
            factors[0] * values[0] + factors[1] * values[1] + factors[2] * values[2]
        });
        ComplexBlock::from_columns(self.row_count, values.collect())
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

/// Factors of the integrals in half of the stiffness of an element.
///
/// `width` and `height` of the element are in m.
pub(super) fn element_factors(width: f64, height: Complex64, moduli: Moduli) -> ElementFactors {
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
pub(super) struct ElementForms {
    /// Functions of a side, then functions of horizontal edges.
    pub(super) functions: Vec<RetainedFunction>,
    retained: FormBlock,
    inner: FormBlock,
    /// Rows of inner functions, columns of retained ones.
    coupling: FormBlock,
}

impl ElementForms {
    pub(super) fn new(parity: &Parity, depth: &DepthFunctions) -> Self {
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
    pub(super) fn condensed(&self, factors: &ElementFactors) -> Result<ComplexBlock> {
        let mut matrix = self.retained.stiffness(factors);
        matrix.eliminate(&self.inner.stiffness(factors), &self.coupling.stiffness(factors))?;
        Ok(matrix)
    }
}
