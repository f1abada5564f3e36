//! A column of elements of one width, reduced to its sides.

use std::ops::Range;

use realfft::num_complex::Complex64;

use super::polynomials::{Integrals, Polynomials, lagrange, nodes};
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

/// Element of a stack: its height, stretched below the near field, its soil, and its degree along z.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layer {
    pub(super) height: Complex64,
    pub(super) soil: usize,
    pub(super) degree: usize,
}

/// Elements one below the other; the bottom of the last one is fixed.
#[derive(Debug, Clone)]
pub(super) struct Stack(pub(super) Vec<Layer>);

impl Stack {
    /// Number of nodes on a side.
    pub(super) fn nodes(&self) -> usize {
        self.0.iter().map(|layer| layer.degree).sum()
    }

    /// Nodes above and at the top of each element.
    pub(super) fn first_nodes(&self) -> Vec<usize> {
        self.0
            .iter()
            .scan(0, |sum, layer| Some(std::mem::replace(sum, *sum + layer.degree)))
            .collect()
    }

    /// Values of a coarse stack's side at this one's nodes, which has elements `groups` of this one joined.
    pub(super) fn joined(&self, groups: &[Range<usize>]) -> (Self, Vec<(usize, usize, f64)>) {
        let mut coarse = Self(vec![]);
        let mut entries = vec![];
        let first = self.first_nodes();
        let mut begin = 0;
        let last = self.nodes();
        for group in groups {
            let top = self.0[group.start];
            let height: Complex64 = self.0[group.clone()].iter().map(|layer| layer.height).sum();
            let own = nodes(top.degree);
            let mut above = Complex64::ZERO;
            for k in group.clone() {
                let layer = self.0[k];
                // The last node of an element belongs to the next one, except for a group's: it is the next group's.
                for (j, place) in nodes(layer.degree).iter().enumerate().take(layer.degree) {
                    let at = ((above + layer.height * *place) / height).re;
                    for i in 0..=top.degree {
                        let value = if group.len() == 1 {
                            f64::from(u8::from(i == j))
                        } else {
                            lagrange(&own, i, at)
                        };
                        if value != 0.0 && first[k] + j < last {
                            entries.push((first[k] + j, begin + i, value));
                        }
                    }
                }
                above += layer.height;
            }
            begin += top.degree;
            coarse.0.push(Layer { height, ..top });
        }
        entries.retain(|(_, column, _)| *column < begin);
        (coarse, entries)
    }
}

/// Motions of a column that are symmetric or antisymmetric about its middle.
struct Parity {
    /// Number of functions of u_x and of u_z.
    counts: [usize; 2],
    stiffness: [Integrals; 2],
    mass: [Integrals; 2],
    /// ∫ φ′ψ and ∫ φψ′ for functions φ of u_x and ψ of u_z.
    slopes: [Integrals; 2],
    means: [Vec<f64>; 2],
}

impl Parity {
    fn new(along: &Polynomials, down: &Polynomials) -> Self {
        Self {
            stiffness: [along.stiffnesses(), down.stiffnesses()],
            mass: [along.masses(along), down.masses(down)],
            slopes: [along.slopes_by(down), down.slopes_by(along).transposed()],
            means: [along.means(), down.means()],
            counts: [along.count(), down.count()],
        }
    }

    /// Adds the loads `first` and `first` + 1 of the top edge to the matrices of a column with these `nodes` on a side.
    fn load_top(
        &self,
        width: f64,
        [nodes, first]: [usize; 2],
        sides: &mut ComplexBlock,
        coupling: &mut ComplexBlock,
    ) {
        for (component, means) in self.means.iter().enumerate() {
            let (side, load) = (component * nodes, 2 * nodes + first + component);
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
struct Down {
    degree: usize,
    stiffness: Integrals,
    mass: Integrals,
    slopes: Integrals,
}

impl Down {
    fn new(degree: usize) -> Self {
        let own = Polynomials::lagrange(degree);
        let (stiffness, mass, slopes) = (own.stiffnesses(), own.masses(&own), own.slopes_by(&own));
        Self { degree, stiffness, mass, slopes }
    }
}

/// Functions of the elements of all columns.
pub(super) struct Elements {
    parities: [Parity; 2],
    /// Of the near field, and of the stretched elements.
    down: [Down; 2],
}

/// Matrices of a column whose sides move as mirror images of each other, or as their negatives.
///
/// Rows: horizontal and vertical displacement of the nodes of a side, then loads on the top edge. The energy
/// counts for one side.
pub(super) struct Column {
    pub(super) symmetric: ComplexBlock,
    pub(super) antisymmetric: ComplexBlock,
}

impl Column {
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

/// Loads on the top edge of a column: number of all loads, and place of the horizontal one, before the vertical one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Loads {
    pub(super) count: usize,
    pub(super) first: Option<usize>,
}

impl Elements {
    /// Functions of `degree` along x, and of `degrees` along z: of the near field, and of the stretched elements.
    pub(super) fn new(degree: usize, degrees: [usize; 2]) -> Self {
        let [even, odd] = Polynomials::lagrange(degree).halves();
        // Mirror images about a vertical line: u_x is odd, u_z even.
        let parities = [Parity::new(&odd, &even), Parity::new(&even, &odd)];
        Self { parities, down: degrees.map(Down::new) }
    }

    /// The column of `width`, m.
    pub(super) fn column(
        &self,
        width: f64,
        stack: &Stack,
        soils: &[Moduli],
        loads: Loads,
    ) -> Result<Column> {
        let half = |parity: &Parity| self.half(parity, width, stack, soils, loads);
        Ok(Column { symmetric: half(&self.parities[0])?, antisymmetric: half(&self.parities[1])? })
    }

    fn half(
        &self,
        parity: &Parity,
        width: f64,
        stack: &Stack,
        soils: &[Moduli],
        loads: Loads,
    ) -> Result<ComplexBlock> {
        let count = stack.nodes();
        // Functions inside the column, of u_x and then of u_z.
        let inner = parity.counts.iter().sum::<usize>() - 2;
        let mut sides = ComplexBlock::zeros(2 * count + loads.count, 2 * count + loads.count);
        let edges = stack.0.len() * inner;
        let mut pivot = ComplexBlock::zeros(edges, edges);
        let mut coupling = ComplexBlock::zeros(edges, 2 * count + loads.count);
        let mut node = 0;
        for (k, layer) in stack.0.iter().enumerate() {
            let down = &self.down[usize::from(layer.degree != self.down[0].degree)];
            let element =
                Element { parity, down, width, height: layer.height, moduli: soils[layer.soil] };
            let (matrix, kept) = element.condensed()?;
            // Place of each kept function: a side's node, or one of an edge behind all of these.
            let place = |part: &Part| match *part {
                Part::Side { component, level } => {
                    (node + level < count).then_some(Place::Side(component * count + node + level))
                }
                Part::Edge { function, bottom } => {
                    let line = k + usize::from(bottom);
                    (line < stack.0.len()).then_some(Place::Edge(line * inner + function))
                }
            };
            let places: Vec<_> = kept.iter().map(place).collect();
            for (j, column) in places.iter().enumerate() {
                for (i, row) in places.iter().enumerate() {
                    let value = matrix[(i, j)];
                    match (row, column) {
                        (Some(Place::Side(row)), Some(Place::Side(column))) => {
                            sides[(*row, *column)] += value;
                        }
                        (Some(Place::Edge(row)), Some(Place::Edge(column))) => {
                            pivot[(*row, *column)] += value;
                        }
                        (Some(Place::Edge(row)), Some(Place::Side(column))) => {
                            coupling[(*row, *column)] += value;
                        }
                        _ => {}
                    }
                }
            }
            node += layer.degree;
        }
        if let Some(first) = loads.first {
            parity.load_top(width, [count, first], &mut sides, &mut coupling);
        }
        sides.eliminate(&pivot, &coupling)?;
        Ok(sides)
    }
}

enum Place {
    Side(usize),
    Edge(usize),
}

/// Function of an element that remains when its inner ones are eliminated.
enum Part {
    Side { component: usize, level: usize },
    Edge { function: usize, bottom: bool },
}

struct Element<'a> {
    parity: &'a Parity,
    down: &'a Down,
    width: f64,
    height: Complex64,
    moduli: Moduli,
}

impl Element<'_> {
    /// Half of the stiffness of functions (component, function along x, function along z).
    fn stiffness(&self, [c, a, b]: [usize; 3], [other, e, f]: [usize; 3]) -> Complex64 {
        let Self { parity, down, width, height, moduli } = self;
        let Moduli { shear, lame, inertia } = *moduli;
        let (own, z) = (lame + shear * 2.0, down);
        let value = if c == other {
            let (s, m) = (parity.stiffness[c].at(a, e), parity.mass[c].at(a, e));
            let (along, across) = if c == 0 { (own, shear) } else { (shear, own) };
            along * height * (s * z.mass.at(b, f) / width)
                + across / height * (m * z.stiffness.at(b, f) * width)
                + inertia * height * (m * z.mass.at(b, f) * width)
        } else if c == 0 {
            lame * (parity.slopes[0].at(a, e) * z.slopes.at(f, b))
                + shear * (parity.slopes[1].at(a, e) * z.slopes.at(b, f))
        } else {
            return self.stiffness([other, e, f], [c, a, b]);
        };
        value * 0.5
    }

    /// Matrix of the functions that do not vanish on all sides, and these functions.
    fn condensed(&self) -> Result<(ComplexBlock, Vec<Part>)> {
        let degree = self.down.degree;
        let (mut kept, mut parts, mut inside) = (vec![], vec![], vec![]);
        for component in 0..2 {
            for level in 0..=degree {
                kept.push([component, 0, level]);
                parts.push(Part::Side { component, level });
            }
        }
        let mut function = 0;
        for component in 0..2 {
            for along in 1..self.parity.counts[component] {
                for (level, bottom) in [(0, false), (degree, true)] {
                    kept.push([component, along, level]);
                    parts.push(Part::Edge { function, bottom });
                }
                inside.extend((1..degree).map(|level| [component, along, level]));
                function += 1;
            }
        }
        let matrix = |rows: &[[usize; 3]], columns: &[[usize; 3]]| {
            let mut block = ComplexBlock::zeros(rows.len(), columns.len());
            for (j, column) in columns.iter().enumerate() {
                for (i, row) in rows.iter().enumerate() {
                    block[(i, j)] = self.stiffness(*row, *column);
                }
            }
            block
        };
        let mut rest = matrix(&kept, &kept);
        rest.eliminate(&matrix(&inside, &inside), &matrix(&inside, &kept))?;
        Ok((rest, parts))
    }
}
