//! Resultants on a rigid mat, solved by symmetry.
//!
//! If the cells are their own mirror image in x or y, tractions divide into sectors, even or odd in each axis,
//! that are not coupled. With the group G of reflections h and its characters χ (a shear along x changes its sign
//! with x), vectors e_p = Σ χ(h) e_hp of one cell p from each orbit satisfy
//!
//! e_pᵀ F e_q = |G| Σ χ(h) `F`_(p, hq)
//!
//! A rectangle needs only a quarter of the cells, in four systems. With unions, p and q are elements.

use basemat_fourier::num_complex::Complex64;

use super::cells::Plan;
use crate::error::{Error, Result, memory};
use crate::geometry::{SERIES_PER_OFFSET, offset};
use crate::linalg::{Complex, DenseFactor};

/// Number of rigid motions: along x, y, z (up) and about these axes.
pub(super) const RIGID_MOTION_COUNT: usize = 6;
/// Number of components of a cell's traction: down, along x, along y.
const CELL_COMPONENT_COUNT: usize = 3;
/// Relative difference of mirrored cells that counts as rounding.
const MIRROR_TOLERANCE: f64 = 1e-9;

/// A reflection of a plan in x, in y, or in both.
#[derive(Debug)]
struct Reflection {
    axes: [bool; 2],
    /// Mirror image of each element.
    images: Vec<usize>,
}

impl Reflection {
    /// The reflection along some axes, if it maps the plan to itself.
    ///
    /// Cells of an element must stay together, and cut cells must be mirrored.
    fn of(plan: &Plan, axes: [bool; 2]) -> Option<Self> {
        let counts = plan.lattice.counts;
        let mut numbers = vec![None; counts[0] * counts[1]];
        let mut element_count = 0;
        for (cell, [i, j]) in plan.cells.iter().enumerate() {
            numbers[j * counts[0] + i] = Some(cell);
            element_count = element_count.max(plan.owner(cell) + 1);
        }
        let mut images = vec![None; element_count];
        for cell in 0..plan.cells.len() {
            let image = mirrored(axes, plan.cells[cell], counts);
            let other = numbers[image[1] * counts[0] + image[0]]?;
            let arms = plan.arms(cell);
            let other_arms = plan.arms(other);
            for axis in 0..2 {
                let sign = if axes[axis] { -1.0 } else { 1.0 };
                if !are_equal(arms[axis], sign * other_arms[axis], plan.lattice.pitch[axis]) {
                    return None;
                }
            }
            let softness = plan.softness(cell);
            if !are_equal(softness, plan.softness(other), 1.0 + softness) {
                return None;
            }
            let image = plan.owner(other);
            if *images[plan.owner(cell)].get_or_insert(image) != image {
                return None;
            }
        }
        Some(Self { axes, images: images.into_iter().flatten().collect() })
    }
}

/// Whether two values differ by rounding only, relative to `size`.
fn are_equal(one: f64, other: f64, size: f64) -> bool {
    (one - other).abs() <= MIRROR_TOLERANCE * size
}

/// Symmetry of a plan: its reflections and one element of each orbit.
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
    /// Symmetry of a plan in x, in y and in both.
    pub(super) fn new(plan: &'a Plan) -> Self {
        Self::with_reflections(plan, &[[false, false], [true, false], [false, true], [true, true]])
    }

    /// Symmetry in these reflections at most.
    fn with_reflections(plan: &'a Plan, reflections: &[[bool; 2]]) -> Self {
        let owners: Vec<_> = (0..plan.cells.len()).map(|cell| plan.owner(cell)).collect();
        let count = owners.iter().max().map_or(0, |last| last + 1);
        let mut group: Vec<_> =
            reflections.iter().filter_map(|axes| Reflection::of(plan, *axes)).collect();
        // A rotation by 180° alone is not a reflection.
        if group.len() == 2 && group[1].axes == [true, true] {
            group.pop();
        }
        // The first element of each orbit represents it.
        let elements: Vec<_> = (0..count)
            .filter(|&element| group.iter().all(|h| h.images[element] >= element))
            .collect();
        let mut cells = vec![];
        for (cell, owner) in owners.iter().enumerate() {
            if let Ok(place) = elements.binary_search(owner) {
                cells.push((cell, place));
            }
        }
        Self { plan, group, elements, cells }
    }

    /// Forces and moments on the soil by unit rigid motions, AᵀF⁻¹A, for compliances of all classes.
    ///
    /// Only components in the same list of `coupled_components` are coupled.
    ///
    /// # Errors
    /// [`Error::Memory`], [`Error::Singular`].
    pub(super) fn stiffness(
        &self,
        values: &[[Complex; SERIES_PER_OFFSET]],
        coupled_components: &[&[usize]],
    ) -> Result<[[Complex; RIGID_MOTION_COUNT]; RIGID_MOTION_COUNT]> {
        let mut sum = [[Complex64::default(); RIGID_MOTION_COUNT]; RIGID_MOTION_COUNT];
        // Parities along x and along y: even, and odd if the plan is symmetric.
        let parities = [0, 1].map(|axis| {
            let is_symmetric = self.group.iter().any(|h| h.axes[axis]);
            if is_symmetric { &[1.0, -1.0][..] } else { &[1.0][..] }
        });
        for x_parity in parities[0] {
            for y_parity in parities[1] {
                for components in coupled_components {
                    self.add_sector([*x_parity, *y_parity], components, values, &mut sum)?;
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
        sum: &mut [[Complex64; RIGID_MOTION_COUNT]; RIGID_MOTION_COUNT],
    ) -> Result<()> {
        let (places, order) = self.places(components, parity);
        let cells = self.plan.cells.len() as f64;
        memory::check("cells of a mat", cells, 32.0 * (order as f64).powi(2))?;
        let mut matrix = vec![Complex64::default(); order * order];
        let mut loads = vec![Complex64::default(); order * RIGID_MOTION_COUNT];
        let size = self.group.len() as f64;
        let counts = self.plan.lattice.counts;
        for (receiver, element) in &self.cells {
            let rows = places[*element];
            let receiver_cell = self.plan.cells[*receiver];
            for Reflection { axes, .. } in &self.group {
                let resultants = self.resultants(*axes, *receiver);
                for (component, row) in rows.iter().enumerate() {
                    let Some(row) = row else { continue };
                    let loads =
                        &mut loads[row * RIGID_MOTION_COUNT..(row + 1) * RIGID_MOTION_COUNT];
                    for (load, value) in loads.iter_mut().zip(resultants[component]) {
                        load.re += character(parity, *axes, component) * value;
                    }
                }
            }
            for (source, element) in &self.cells {
                let columns = places[*element];
                for Reflection { axes, .. } in &self.group {
                    let image = mirrored(*axes, self.plan.cells[*source], counts);
                    let mut block = self.plan.lattice.block(values, offset(receiver_cell, image));
                    if image == receiver_cell {
                        let factor = 1.0 + self.plan.softness(*receiver);
                        for k in 0..CELL_COMPONENT_COUNT {
                            block[k][k] = block[k][k].scale(factor);
                        }
                    }
                    for (row, block) in rows.iter().zip(block) {
                        let Some(row) = row else { continue };
                        for (component, column) in columns.iter().enumerate() {
                            let Some(column) = column else { continue };
                            let factor = size * character(parity, *axes, component);
                            let value = block[component].scale(factor);
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
        parity: [f64; 2],
    ) -> (Vec<[Option<usize>; CELL_COMPONENT_COUNT]>, usize) {
        let mut order = 0;
        let mut places = vec![[None; CELL_COMPONENT_COUNT]; self.elements.len()];
        for (element, places) in self.elements.iter().zip(&mut places) {
            for component in components {
                let is_allowed = self.group.iter().all(|h| {
                    h.images[*element] != *element || character(parity, h.axes, *component) > 0.0
                });
                if is_allowed {
                    places[*component] = Some(order);
                    order += 1;
                }
            }
        }
        (places, order)
    }

    /// For each component of a reflected cell: the resultants of a unit traction in each rigid motion, N or N m.
    fn resultants(
        &self,
        axes: [bool; 2],
        cell: usize,
    ) -> [[f64; RIGID_MOTION_COUNT]; CELL_COMPONENT_COUNT] {
        let arms = self.plan.arms(cell);
        let area = self.plan.lattice.pitch[0] * self.plan.lattice.pitch[1];
        let x = if axes[0] { -arms[0] } else { arms[0] };
        let y = if axes[1] { -arms[1] } else { arms[1] };
        // u = θ × r, and down is −z.
        let down = [0.0, 0.0, -1.0, -y, x, 0.0];
        let along = [1.0, 0.0, 0.0, 0.0, 0.0, -y];
        let across = [0.0, 1.0, 0.0, 0.0, 0.0, x];
        [down, along, across].map(|row| row.map(|value| area * value))
    }
}

/// χ of a reflection of a component, for parities of the sector in x and in y.
fn character(parity: [f64; 2], axes: [bool; 2], component: usize) -> f64 {
    let mut product = 1.0;
    for axis in 0..2 {
        if axes[axis] {
            let is_shear_along_axis = component == axis + 1;
            product *= if is_shear_along_axis { -parity[axis] } else { parity[axis] };
        }
    }
    product
}

/// Adds LᵀF⁻¹L for the compliances F of a sector and the resultants L of its tractions.
fn add_resultants(
    matrix: &[Complex64],
    loads: &[Complex64],
    sum: &mut [[Complex64; RIGID_MOTION_COUNT]; RIGID_MOTION_COUNT],
) -> Result<()> {
    let order = loads.len() / RIGID_MOTION_COUNT;
    let mut tractions = loads.to_vec();
    let mut factor = DenseFactor::with_columns(order, RIGID_MOTION_COUNT);
    if !factor.factor(matrix, order) {
        return Err(Error::Singular { matrix: "compliance of a mat in plan", order });
    }
    factor.solve_columns(&mut tractions, RIGID_MOTION_COUNT);
    for (load, traction) in loads
        .chunks_exact(RIGID_MOTION_COUNT)
        .zip(tractions.chunks_exact(RIGID_MOTION_COUNT))
    {
        for (sum, load) in sum.iter_mut().zip(load) {
            for (sum, traction) in sum.iter_mut().zip(traction) {
                *sum += load * traction;
            }
        }
    }
    Ok(())
}

/// A cell's mirror image.
fn mirrored(axes: [bool; 2], cell: [usize; 2], counts: [usize; 2]) -> [usize; 2] {
    [0, 1].map(|axis| if axes[axis] { counts[axis] - 1 - cell[axis] } else { cell[axis] })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bem::layered::Compliances;
    use crate::bem::plan::integrals::{CellIntegrals, CellWorkspace};
    use crate::error::ProgressReporter;
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
        let mut plans = vec![];
        for (text, order) in masks {
            let columns = text.lines().next().unwrap().len();
            let mask: Vec<bool> = text.lines().flat_map(str::chars).map(|c| c == '#').collect();
            plans.push((Plan::masked([0.0; 2], [1.0, 0.8], columns, &mask).unwrap(), order));
        }
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
            let mut progress = ProgressReporter::unobserved();
            let integrals =
                CellIntegrals::new(&plan.lattice, &profile, [s], 1e-9, &mut progress).unwrap();
            let mut work = CellWorkspace::default();
            let mut values = vec![[Complex::default(); SERIES_PER_OFFSET]; integrals.table.classes];
            integrals.compliance(&profile, s, &mut work, &mut values).unwrap();
            let sectors = Sectors::new(&plan);
            assert_eq!(sectors.group.len(), order, "{plan:?}");
            let whole = Sectors::with_reflections(&plan, &[[false; 2]]);
            for coupled_components in [&[&[0, 1, 2][..]][..], &[&[0], &[1, 2]]] {
                let found = sectors.stiffness(&values, coupled_components).unwrap();
                let wanted = whole.stiffness(&values, coupled_components).unwrap();
                for (found, wanted) in found.iter().flatten().zip(wanted.iter().flatten()) {
                    assert!((*found - *wanted).abs() < 1e-11, "{plan:?} {found:?} {wanted:?}");
                }
            }
        }
    }
}
