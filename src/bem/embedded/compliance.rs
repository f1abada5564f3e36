//! Compliance of the faces of a trench at a Laplace variable.

use std::ops::Range;

use realfft::num_complex::Complex64;

use super::bottom::Bottom;
use super::grid::Grid;
use super::polynomials::Polynomials;
use super::stack::{Column, Elements, Layer, Loads, Moduli, Stack};
use crate::error::{Error, Result};
use crate::linalg::ComplexBlock;

/// Largest number of doublings of the regular columns.
const DOUBLINGS: usize = 45;

/// Compliances of the right half of a trench, for fields that are symmetric or antisymmetric about its axis.
///
/// Rows and columns: elements of the base from the axis, then of the wall from the surface down; horizontal and then
/// vertical for each. Displacements are integrals over the elements, tractions are constant on them.
#[derive(Debug, Clone)]
pub(super) struct Halves {
    pub(super) symmetric: ComplexBlock,
    pub(super) antisymmetric: ComplexBlock,
}

impl Halves {
    /// Largest difference to `other` compliances, relative to the largest compliance.
    pub(super) fn difference(&self, other: &Self) -> f64 {
        let pairs =
            [(&self.symmetric, &other.symmetric), (&self.antisymmetric, &other.antisymmetric)];
        let change = pairs.map(|(one, other)| {
            let entries = one.values().iter().zip(other.values());
            let most = entries.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
            most / one.largest()
        });
        change[0].max(change[1])
    }
}

/// Finite elements around a trench at one Laplace variable.
pub(super) struct Model<'a> {
    pub(super) grid: &'a Grid,
    pub(super) degree: usize,
    pub(super) bottom: &'a Bottom,
    /// From the surface down; then the backfill, if there is any.
    pub(super) soils: &'a [Moduli],
}

impl Model<'_> {
    /// The compliances; `None` if waves do not come to rest in any number of regular columns.
    ///
    /// # Errors
    /// [`Error::Singular`].
    pub(super) fn compliances(&self) -> Result<Option<Halves>> {
        let Self { grid, degree, .. } = self;
        let elements = Elements::new(*degree, [*degree, self.bottom.degree]);
        let stack = self.stack(false);
        let (coarse, entries) = stack.joined(&self.groups());
        let count = self.loads();
        let none = Loads { count: 0, first: None };
        let far = elements.column(grid.column, &coarse, self.soils, none)?;
        let Some(far) = far_columns(far, coarse.nodes())? else { return Ok(None) };
        let mut side = Side { matrix: far, nodes: coarse.nodes(), loads: 0 };
        let none = Loads { count, first: None };
        for (k, width) in grid.beside.iter().enumerate().rev() {
            let stack = self.stack(k < grid.backfilled);
            let column = elements.column(*width, &stack, self.soils, none)?;
            let joined = (k + 1 == grid.beside.len()).then_some(&entries[..]);
            side = side.beside(&column, stack.nodes(), count, joined)?;
        }
        self.load_wall(&mut side);
        let stack = Stack(stack.0[grid.wall.len()..].to_vec());
        for (k, width) in grid.base.iter().enumerate().rev() {
            let column =
                elements.column(*width, &stack, self.soils, Loads { count, first: Some(2 * k) })?;
            side = side.beside(&column, stack.nodes(), count, None)?;
        }
        let nodes = side.nodes;
        // On the axis the horizontal displacement is fixed, or the vertical one.
        Ok(Some(Halves {
            symmetric: side.compliance(nodes..2 * nodes)?,
            antisymmetric: side.compliance(0..nodes)?,
        }))
    }

    fn loads(&self) -> usize {
        2 * (self.grid.base.len() + self.grid.walls())
    }

    /// Elements of a column from the surface to the fixed bottom.
    fn stack(&self, backfilled: bool) -> Stack {
        let grid = self.grid;
        let real = |length: f64, soil| Layer {
            height: Complex64::from(length),
            soil,
            degree: self.degree,
        };
        let fill = self.soils.len() - 1;
        let walls = grid
            .wall
            .iter()
            .map(|(own, _)| real(own.length, if backfilled { fill } else { own.soil }));
        let below = grid.below.iter().map(|own| real(own.length, own.soil));
        let Bottom { heights, degree } = self.bottom;
        // The half-plane is the last soil of the profile.
        let soil = fill - usize::from(grid.backfilled > 0);
        let deep = heights.iter().map(|height| Layer { height: *height, soil, degree: *degree });
        Stack(walls.chain(below).chain(deep).collect())
    }

    /// Elements that the regular columns join.
    fn groups(&self) -> Vec<Range<usize>> {
        let grid = self.grid;
        let real: Vec<_> = grid.wall.iter().map(|(own, _)| own).chain(&grid.below).collect();
        let mut groups = vec![];
        let mut begin = 0;
        while begin < real.len() {
            let (mut end, mut length) = (begin + 1, real[begin].length);
            while end < real.len()
                && real[end].soil == real[begin].soil
                && length + real[end].length <= grid.joined
            {
                length += real[end].length;
                end += 1;
            }
            groups.push(begin..end);
            begin = end;
        }
        groups.extend((real.len()..real.len() + self.bottom.heights.len()).map(|k| k..k + 1));
        groups
    }

    fn load_wall(&self, side: &mut Side) {
        let weights = Polynomials::lagrange(self.degree).means();
        let (mut node, base) = (0, self.grid.base.len());
        for (interval, element) in &self.grid.wall {
            for (j, weight) in weights.iter().enumerate().filter(|(j, _)| node + j < side.nodes) {
                for component in 0..2 {
                    let row = component * side.nodes + node + j;
                    let load = 2 * side.nodes + 2 * (base + element) + component;
                    side.matrix[(row, load)] -= weight * interval.length;
                    side.matrix[(load, row)] -= weight * interval.length;
                }
            }
            node += self.degree;
        }
    }
}

/// Stiffness of the soil beyond a vertical line, bordered by the loads there.
struct Side {
    matrix: ComplexBlock,
    nodes: usize,
    loads: usize,
}

impl Side {
    /// The soil beyond the left side of a column that is joined to this line.
    ///
    /// `nodes`: of the left side, which are the lowest of this one. `joined`: values of this line at the column's nodes.
    fn beside(
        self,
        column: &Column,
        nodes: usize,
        loads: usize,
        joined: Option<&[(usize, usize, f64)]>,
    ) -> Result<Self> {
        let (own, order) = (self.nodes, 2 * nodes + loads);
        let mut rest = column.mean(1.0);
        let across = column.mean(-1.0);
        let mut pivot = self.matrix.submatrix(0..2 * own, 0..2 * own);
        let mut coupling = ComplexBlock::zeros(2 * own, order);
        // Places and values of each of the column's nodes on this line.
        let alone: Vec<_>;
        let entries = if let Some(entries) = joined {
            entries
        } else {
            alone = (0..nodes).map(|node| (node, own - nodes + node, 1.0)).collect();
            &alone
        };
        let both = |component: usize| {
            entries.iter().map(move |(fine, coarse, value)| {
                (component * nodes + fine, component * own + coarse, *value)
            })
        };
        let all: Vec<_> = both(0).chain(both(1)).collect();
        for (row, place, value) in &all {
            for column in 0..order {
                let stiffness = mirrored(*row, nodes, across[(*row, column)]);
                coupling[(*place, column)] += stiffness * *value;
            }
        }
        let mut half = ComplexBlock::zeros(2 * own, 2 * nodes);
        for (row, place, value) in &all {
            for column in 0..2 * nodes {
                let stiffness =
                    mirrored(*row, nodes, mirrored(column, nodes, rest[(*row, column)]));
                half[(*place, column)] += stiffness * *value;
            }
        }
        for (column, place, value) in &all {
            for row in 0..2 * own {
                pivot[(row, *place)] += half[(row, *column)] * *value;
            }
        }
        // Both triangles are the same to the last bit, whatever the order of the sums.
        for load in 0..self.loads {
            for row in 0..2 * own {
                coupling[(row, 2 * nodes + load)] += self.matrix[(row, 2 * own + load)];
            }
            for other in 0..self.loads {
                rest[(2 * nodes + load, 2 * nodes + other)] +=
                    self.matrix[(2 * own + load, 2 * own + other)];
            }
        }
        rest.eliminate(&pivot, &coupling)?;
        Ok(Self { matrix: rest, nodes, loads })
    }

    /// Compliance of the loads if only the `free` degrees of freedom of this line are not fixed.
    fn compliance(&self, free: Range<usize>) -> Result<ComplexBlock> {
        let loads = 2 * self.nodes..2 * self.nodes + self.loads;
        let mut rest = self.matrix.submatrix(loads.clone(), loads.clone());
        let pivot = self.matrix.submatrix(free.clone(), free.clone());
        rest.eliminate(&pivot, &self.matrix.submatrix(free, loads))?;
        Ok(rest.negated())
    }
}

/// A value of a degree of freedom on the other side of a mirror, which changes the sign of u_x.
fn mirrored(row: usize, nodes: usize, value: Complex64) -> Complex64 {
    if row < nodes { -value } else { value }
}

/// Stiffness of a side of endless equal columns; `None` if waves do not come to rest in 2^45 of them.
fn far_columns(mut column: Column, nodes: usize) -> Result<Option<ComplexBlock>> {
    for _ in 0..DOUBLINGS {
        let [sum, difference] = [1.0, -1.0].map(|sign| column.mean(sign));
        if difference.largest() < FADED * sum.largest() {
            return Ok(Some(sum));
        }
        column = doubled(&sum, &difference, nodes)?;
    }
    Ok(None)
}

/// Two equal columns as one, from the stiffness of a side of one, and between both sides.
fn doubled(own: &ComplexBlock, across: &ComplexBlock, nodes: usize) -> Result<Column> {
    let order = 2 * nodes;
    // In the middle one component is fixed, and the other one is free.
    let halved = |free: Range<usize>| {
        let mut half = own.clone();
        let pivot = own.submatrix(free.clone(), free.clone());
        half.eliminate(&pivot, &across.submatrix(free, 0..order))?;
        Ok::<_, Error>(half)
    };
    Ok(Column { symmetric: halved(nodes..order)?, antisymmetric: halved(0..nodes)? })
}

/// Stiffness between both ends of a row of columns, relative to a side's, that counts as zero.
const FADED: f64 = 1e-13;

#[cfg(test)]
mod tests;
