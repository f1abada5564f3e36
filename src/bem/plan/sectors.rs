//! Resultants on a rigid mat, solved by symmetry.
//!
//! If the cells are their own mirror image in x or y, tractions divide into sectors, even or odd in each axis,
//! that are not coupled. With the group G of reflections h and its characters χ (a shear along x changes its sign
//! with x), vectors e_p = Σ χ(h) e_hp of one cell p from each orbit satisfy
//!
//! e_pᵀ F e_q = |G| Σ χ(h) `F`_(p, hq)
//!
//! A rectangle needs only a quarter of the cells, in four systems. With unions, p and q are elements.

use realfft::num_complex::Complex64;

use super::cells::Plan;
use crate::error::{Error, Result, memory};
use crate::geometry::{SERIES_PER_OFFSET, offset};
use crate::linalg::{Complex, DenseFactor};

/// Rigid motions: along x, y, z (up) and about these axes.
pub(super) const MOTIONS: usize = 6;
/// Components of a cell: down, along x, along y.
const COMPONENTS: usize = 3;
/// Relative difference of mirrored cells that counts as rounding.
const MIRRORED: f64 = 1e-9;

/// A reflection of a plan in x, in y, or in both.
#[derive(Debug)]
struct Reflection {
    axes: [bool; 2],
    /// Mirror image of each element.
    images: Vec<usize>,
}

/// Symmetry of a plan.
#[derive(Debug)]
pub(super) struct Sectors<'a> {
    plan: &'a Plan,
    /// Reflections that keep the elements, the identity first.
    group: Vec<Reflection>,
    /// Representative element of each orbit.
    elements: Vec<usize>,
    /// Cells of these, each with the place of its element among them.
    cells: Vec<(usize, usize)>,
}

impl<'a> Sectors<'a> {
    pub(super) fn new(plan: &'a Plan) -> Self {
        Self::by(plan, &[[false, false], [true, false], [false, true], [true, true]])
    }

    /// Symmetry in these reflections at most.
    fn by(plan: &'a Plan, reflections: &[[bool; 2]]) -> Self {
        let owners: Vec<_> = (0..plan.cells.len()).map(|cell| plan.owner(cell)).collect();
        let count = owners.iter().max().map_or(0, |last| last + 1);
        let counts = plan.lattice.counts;
        let mut on = vec![None; counts[0] * counts[1]];
        for (cell, [i, j]) in plan.cells.iter().enumerate() {
            on[j * counts[0] + i] = Some(cell);
        }
        let near = |one: f64, other: f64, size: f64| (one - other).abs() <= MIRRORED * size;
        // Cells of an element must stay together, and cut cells must be mirrored.
        let reflection = |axes: &[bool; 2]| {
            let mut images = vec![None; count];
            for (cell, owner) in owners.iter().enumerate() {
                let [i, j] = mirrored(*axes, plan.cells[cell], counts);
                let other = on[j * counts[0] + i]?;
                let own = plan.arms(cell);
                let there = plan.arms(other);
                let is_mirrored = (0..2).all(|k| {
                    let sign = if axes[k] { -1.0 } else { 1.0 };
                    near(own[k], sign * there[k], plan.lattice.pitch[k])
                });
                let softness = plan.softness(cell);
                if !is_mirrored || !near(softness, plan.softness(other), 1.0 + softness) {
                    return None;
                }
                let image = owners[other];
                if *images[*owner].get_or_insert(image) != image {
                    return None;
                }
            }
            Some(Reflection { axes: *axes, images: images.into_iter().flatten().collect() })
        };
        let mut group: Vec<_> = reflections.iter().filter_map(reflection).collect();
        // A rotation by 180° alone is not a reflection.
        if group.len() == 2 && group[1].axes == [true, true] {
            group.pop();
        }
        let is_first = |element: &usize| group.iter().all(|h| h.images[*element] >= *element);
        let elements: Vec<_> = (0..count).filter(is_first).collect();
        let place = |owner| elements.binary_search(owner).ok();
        let each = owners.iter().enumerate();
        let cells = each.filter_map(|(cell, owner)| Some((cell, place(owner)?))).collect();
        Self { plan, group, elements, cells }
    }

    /// Forces and moments on the soil by unit rigid motions, AᵀF⁻¹A, for compliances of all classes.
    ///
    /// Only components in the same list of `parts` are coupled.
    ///
    /// # Errors
    /// [`Error::Memory`], [`Error::Singular`].
    pub(super) fn stiffness(
        &self,
        values: &[[Complex; SERIES_PER_OFFSET]],
        parts: &[&[usize]],
    ) -> Result<[[Complex; MOTIONS]; MOTIONS]> {
        let mut sum = [[Complex64::default(); MOTIONS]; MOTIONS];
        let has = |axis: usize| self.group.iter().any(|h| h.axes[axis]);
        let signs = |axis: usize| if has(axis) { &[1.0, -1.0][..] } else { &[1.0][..] };
        for x in signs(0) {
            for y in signs(1) {
                for components in parts {
                    self.add_sector([*x, *y], components, values, &mut sum)?;
                }
            }
        }
        // Rounding makes the sum unsymmetric.
        Ok(std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let mean = 0.5 * (sum[i][j] + sum[j][i]);
                Complex::new(mean.re, mean.im)
            })
        }))
    }

    /// Adds the resultants of tractions of one sector: even (1) or odd (−1) in x and in y.
    fn add_sector(
        &self,
        parity: [f64; 2],
        components: &[usize],
        values: &[[Complex; SERIES_PER_OFFSET]],
        sum: &mut [[Complex64; MOTIONS]; MOTIONS],
    ) -> Result<()> {
        let character = |axes: [bool; 2], component: usize| character(parity, axes, component);
        let (places, order) = self.places(components, character);
        let cells = self.plan.cells.len() as f64;
        memory::check("cells of a mat", cells, 32.0 * (order as f64).powi(2))?;
        let mut matrix = vec![Complex64::default(); order * order];
        let mut loads = vec![Complex64::default(); order * MOTIONS];
        let size = self.group.len() as f64;
        let counts = self.plan.lattice.counts;
        for (receiver, element) in &self.cells {
            let rows = places[*element];
            let at = self.plan.cells[*receiver];
            for Reflection { axes, .. } in &self.group {
                let resultants = self.resultants(*axes, *receiver);
                for (component, row) in rows.iter().enumerate() {
                    let Some(row) = row else { continue };
                    let loads = &mut loads[row * MOTIONS..(row + 1) * MOTIONS];
                    for (load, value) in loads.iter_mut().zip(resultants[component]) {
                        load.re += character(*axes, component) * value;
                    }
                }
            }
            for (source, element) in &self.cells {
                let columns = places[*element];
                for Reflection { axes, .. } in &self.group {
                    let image = mirrored(*axes, self.plan.cells[*source], counts);
                    let mut block = self.plan.lattice.block(values, offset(at, image));
                    if image == at {
                        let own = 1.0 + self.plan.softness(*receiver);
                        (0..COMPONENTS).for_each(|k| block[k][k] = block[k][k].scale(own));
                    }
                    for (row, block) in rows.iter().zip(block) {
                        let Some(row) = row else { continue };
                        for (component, column) in columns.iter().enumerate() {
                            let Some(column) = column else { continue };
                            let value = block[component].scale(size * character(*axes, component));
                            matrix[row * order + column] += value.inner();
                        }
                    }
                }
            }
        }
        add_resultants(&matrix, &loads, sum)
    }

    /// Place of each component of each element in a sector, and their number.
    ///
    /// An element on an axis has no odd components.
    fn places(
        &self,
        components: &[usize],
        character: impl Fn([bool; 2], usize) -> f64,
    ) -> (Vec<[Option<usize>; COMPONENTS]>, usize) {
        let mut order = 0;
        let places = self.elements.iter().map(|element| {
            let mut places = [None; COMPONENTS];
            for component in components {
                let fixed = |h: &&Reflection| h.images[*element] == *element;
                let even = |h: &Reflection| character(h.axes, *component) > 0.0;
                if self.group.iter().filter(fixed).all(even) {
                    places[*component] = Some(order);
                    order += 1;
                }
            }
            places
        });
        (places.collect(), order)
    }

    /// For each component of a reflected cell: the resultants of a unit traction in each rigid motion, N or N m.
    fn resultants(&self, h: [bool; 2], cell: usize) -> [[f64; MOTIONS]; COMPONENTS] {
        let ([a, b], arms) = (self.plan.lattice.pitch, self.plan.arms(cell));
        let area = a * b;
        let x = if h[0] { -arms[0] } else { arms[0] };
        let y = if h[1] { -arms[1] } else { arms[1] };
        // u = θ × r, and down is −z.
        let down = [0.0, 0.0, -1.0, -y, x, 0.0];
        let along = [1.0, 0.0, 0.0, 0.0, 0.0, -y];
        let across = [0.0, 1.0, 0.0, 0.0, 0.0, x];
        [down, along, across].map(|row| row.map(|value| area * value))
    }
}

/// χ of a reflection of a component, for parities of the sector in x and in y.
fn character(parity: [f64; 2], axes: [bool; 2], component: usize) -> f64 {
    let sign = |axis: usize| {
        let turned = if component == axis + 1 { -1.0 } else { 1.0 };
        if axes[axis] { parity[axis] * turned } else { 1.0 }
    };
    sign(0) * sign(1)
}

/// Adds LᵀF⁻¹L for the compliances F of a sector and the resultants L of its tractions.
fn add_resultants(
    matrix: &[Complex64],
    loads: &[Complex64],
    sum: &mut [[Complex64; MOTIONS]; MOTIONS],
) -> Result<()> {
    let order = loads.len() / MOTIONS;
    let mut tractions = loads.to_vec();
    let mut factor = DenseFactor::with_columns(order, MOTIONS);
    if !factor.factor(matrix, order) {
        return Err(Error::Singular { matrix: "compliance of a mat in plan", order });
    }
    factor.solve_columns(&mut tractions, MOTIONS);
    for (load, traction) in loads.chunks_exact(MOTIONS).zip(tractions.chunks_exact(MOTIONS)) {
        for (sum, load) in sum.iter_mut().zip(load) {
            for (sum, traction) in sum.iter_mut().zip(traction) {
                *sum += load * traction;
            }
        }
    }
    Ok(())
}

/// A cell's mirror image.
fn mirrored(h: [bool; 2], cell: [usize; 2], counts: [usize; 2]) -> [usize; 2] {
    std::array::from_fn(|axis| if h[axis] { counts[axis] - 1 - cell[axis] } else { cell[axis] })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bem::layered::Compliances;
    use crate::bem::plan::integrals::{Integrals, Workspace};
    use crate::error::Watch;
    use crate::soil::{Soil, SoilProfile};

    /// Symmetry changes no result: even and odd numbers of cells, one axis, a rotation by 180°, none.
    #[test]
    fn sectors_are_the_whole() {
        let masks = [
            ("####\n####", 4),
            ("###\n###\n###", 4),
            ("###\n.#.\n.#.", 2),
            ("#..\n##.\n###\n##.\n#..", 2),
            ("##.\n.##", 1),
            ("##\n#.", 1),
            ("###\n#.#\n###", 4),
        ];
        let masked = |(text, order): (&str, usize)| {
            let columns = text.lines().next().unwrap().len();
            let mask: Vec<bool> = text.lines().flat_map(str::chars).map(|c| c == '#').collect();
            (Plan::masked([0.0; 2], [1.0, 0.8], columns, &mask).unwrap(), order)
        };
        let mut plans: Vec<_> = masks.into_iter().map(masked).collect();
        for (along, order) in [(vec![1, 3, 1], 4), (vec![1, 2, 2, 1], 4), (vec![1, 2, 1, 1], 2)] {
            let cells = along.iter().sum();
            let plan = Plan::masked([0.0; 2], [1.0, 0.8], cells, &vec![true; 4 * cells]).unwrap();
            plans.push((plan.with_unions(&along, &[1, 2, 1]).unwrap(), order));
        }
        // Cut cells.
        let triangle = vec![[0.0, 0.0], [2.0, 0.5], [1.0, 1.5]];
        plans.push((Plan::disc([0.3, -0.1], 1.0, 6).unwrap(), 4));
        plans.push((Plan::on_faces(&[triangle], 5).unwrap(), 1));
        let profile = SoilProfile::on_half_plane(Soil::new(1.0, 0.3, 1.0).unwrap());
        for (plan, order) in plans {
            let s = Complex::new(0.1, 0.8);
            let mut watch = Watch::nobody();
            let integrals = Integrals::new(&plan.lattice, &profile, [s], 1e-9, &mut watch).unwrap();
            let mut work = Workspace::default();
            let mut values = vec![[Complex::default(); SERIES_PER_OFFSET]; integrals.table.classes];
            integrals.compliance(&profile, s, &mut work, &mut values).unwrap();
            let sectors = Sectors::new(&plan);
            assert_eq!(sectors.group.len(), order, "{plan:?}");
            let whole = Sectors::by(&plan, &[[false; 2]]);
            for parts in [&[&[0, 1, 2][..]][..], &[&[0], &[1, 2]]] {
                let found = sectors.stiffness(&values, parts).unwrap();
                let wanted = whole.stiffness(&values, parts).unwrap();
                for (found, wanted) in found.iter().flatten().zip(wanted.iter().flatten()) {
                    assert!((*found - *wanted).abs() < 1e-11, "{plan:?} {found:?} {wanted:?}");
                }
            }
        }
    }
}
