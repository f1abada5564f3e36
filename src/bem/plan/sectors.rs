//! Resultants on a rigid mat, solved by symmetry.
//!
//! If the cells are symmetric in x or y, tractions divide into sectors, even or odd in each axis, which are not coupled.
//! G is the group of reflections h, and χ are its characters (a shear along x changes its sign with x). Vectors
//! e_p = Σ χ(h) e_hp of one cell p from each orbit satisfy
//!
//! e_pᵀ F e_q = |G| Σ χ(h) `F`_(p, hq)
//!
//! A rectangle needs only four systems, each with a quarter of the unknowns, or eight if the components are not all
//! coupled. With elements of several cells, p and q are elements.

use basemat_fourier::num_complex::Complex64;

use super::cells::Plan;
use crate::error::{Error, Result, memory};
use crate::geometry::{COMPLIANCES_PER_OFFSET, COMPONENTS_IN_SPACE, offset};
use crate::linalg::{Complex, DenseFactor};

/// Number of rigid motions: along x, y, z (up) and about these axes.
pub(super) const RIGID_MOTION_COUNT: usize = 6;
/// Largest difference between a cell and a mirror image that is attributed to rounding, relative to its side or compliance.
const MIRROR_TOLERANCE: f64 = 1e-9;
/// Memory per entry of the matrix of a sector, bytes: two matrices of complex numbers, one of them factored.
const BYTES_PER_SECTOR_ENTRY: f64 = 32.0;

/// Reflection in x, in y, in both, or in none, which maps the plan to itself.
#[derive(Debug)]
struct Reflection {
    /// Whether x and whether y change their sign.
    axes: [bool; 2],
    /// Mirror image of each element.
    image_elements: Vec<usize>,
}

impl Reflection {
    /// Reflection along these axes; `None` for a plan without this symmetry.
    ///
    /// All cells of an element need mirror images in one element, and cut cells need equal mirror images.
    fn of(plan: &Plan, axes: [bool; 2]) -> Option<Self> {
        let counts = plan.lattice.counts;
        let mut cell_indices = vec![None; counts[0] * counts[1]];
        let mut element_count = 0;
        for (cell, [i, j]) in plan.cells.iter().enumerate() {
            cell_indices[j * counts[0] + i] = Some(cell);
            element_count = element_count.max(plan.element_of(cell) + 1);
        }
        let mut image_elements = vec![None; element_count];
        for cell in 0..plan.cells.len() {
            let [column, row] = mirror_image(axes, plan.cells[cell], counts);
            let image_cell = cell_indices[row * counts[0] + column]?;
            let arms = plan.arms(cell);
            let image_arms = plan.arms(image_cell);
            for axis in 0..2 {
                let sign = if axes[axis] { -1.0 } else { 1.0 };
                if !are_equal(arms[axis], sign * image_arms[axis], plan.lattice.pitch[axis]) {
                    return None;
                }
            }
            let spring_ratio = plan.spring_ratio(cell);
            if !are_equal(spring_ratio, plan.spring_ratio(image_cell), 1.0 + spring_ratio) {
                return None;
            }
            let image = plan.element_of(image_cell);
            if *image_elements[plan.element_of(cell)].get_or_insert(image) != image {
                return None;
            }
        }
        Some(Self { axes, image_elements: image_elements.into_iter().flatten().collect() })
    }
}

/// Whether two values are equal but for rounding errors relative to `scale`.
fn are_equal(one: f64, other: f64, scale: f64) -> bool {
    (one - other).abs() <= MIRROR_TOLERANCE * scale
}

/// Symmetry of a plan, which reduces the unknown tractions to those on one element of each orbit.
#[derive(Debug)]
pub(super) struct Sectors<'a> {
    plan: &'a Plan,
    /// Reflections that map the plan to itself, the identity first.
    group: Vec<Reflection>,
    /// Representative element of each orbit.
    elements: Vec<usize>,
    /// Cells of the representative elements, each with the index of its element among these.
    cells: Vec<(usize, usize)>,
}

/// Row of each component of an element in the equations of a sector; `None` for a component without an equation.
type ComponentRows = [Option<usize>; COMPONENTS_IN_SPACE];

/// Receiver and source cell, with the rows and columns of their elements.
struct CellPair<'a> {
    cells: [usize; 2],
    rows: &'a ComponentRows,
    columns: &'a ComponentRows,
}

impl<'a> Sectors<'a> {
    /// Symmetry of a plan in x, in y and in both.
    pub(super) fn new(plan: &'a Plan) -> Self {
        Self::with_reflections(plan, &[[false, false], [true, false], [false, true], [true, true]])
    }

    /// Symmetry in at most these reflections.
    fn with_reflections(plan: &'a Plan, reflections: &[[bool; 2]]) -> Self {
        let cell_elements: Vec<_> =
            (0..plan.cells.len()).map(|cell| plan.element_of(cell)).collect();
        let element_count = cell_elements.iter().max().map_or(0, |last| last + 1);
        let mut group: Vec<_> =
            reflections.iter().filter_map(|axes| Reflection::of(plan, *axes)).collect();
        // A rotation by 180° without both reflections yields no sectors, even or odd in each axis.
        if group.len() == 2 && group[1].axes == [true, true] {
            group.pop();
        }
        // The first element of each orbit represents it.
        let elements: Vec<_> = (0..element_count)
            .filter(|&element| group.iter().all(|h| h.image_elements[element] >= element))
            .collect();
        let mut cells = vec![];
        for (cell, element) in cell_elements.iter().enumerate() {
            if let Ok(index) = elements.binary_search(element) {
                cells.push((cell, index));
            }
        }
        Self { plan, group, elements, cells }
    }

    /// Forces and moments on the soil due to unit rigid motions, AᵀF⁻¹A.
    ///
    /// `values`: compliances of all classes. Only components in the same list of `coupled_components` are coupled.
    ///
    /// # Errors
    /// [`Error::Memory`], [`Error::Singular`].
    pub(super) fn stiffness(
        &self,
        values: &[[Complex; COMPLIANCES_PER_OFFSET]],
        coupled_components: &[&[usize]],
    ) -> Result<[[Complex; RIGID_MOTION_COUNT]; RIGID_MOTION_COUNT]> {
        let mut stiffness = [[Complex64::default(); RIGID_MOTION_COUNT]; RIGID_MOTION_COUNT];
        // Parities along x and along y: even (1), and odd (−1) if the plan is symmetric.
        let parities = [0, 1].map(|axis| {
            let is_symmetric = self.group.iter().any(|h| h.axes[axis]);
            if is_symmetric { &[1.0, -1.0][..] } else { &[1.0][..] }
        });
        for x_parity in parities[0] {
            for y_parity in parities[1] {
                for components in coupled_components {
                    self.add_sector([*x_parity, *y_parity], components, values, &mut stiffness)?;
                }
            }
        }
        // The mean with the transpose removes the asymmetry due to rounding.
        Ok(std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let mean = 0.5 * (stiffness[i][j] + stiffness[j][i]);
                Complex::new(mean.re, mean.im)
            })
        }))
    }

    /// Adds the stiffness due to tractions of one sector, even (1) or odd (−1) in x and in y.
    fn add_sector(
        &self,
        parity: [f64; 2],
        components: &[usize],
        values: &[[Complex; COMPLIANCES_PER_OFFSET]],
        stiffness: &mut [[Complex64; RIGID_MOTION_COUNT]; RIGID_MOTION_COUNT],
    ) -> Result<()> {
        let (rows, order) = self.sector_rows(components, parity);
        let cell_count = self.plan.cells.len() as f64;
        let bytes = BYTES_PER_SECTOR_ENTRY * (order as f64).powi(2);
        memory::check("cells of a mat", cell_count, bytes)?;
        let mut matrix = vec![Complex64::default(); order * order];
        let mut loads = vec![Complex64::default(); order * RIGID_MOTION_COUNT];
        for (receiver, element) in &self.cells {
            for Reflection { axes, .. } in &self.group {
                let resultants = self.resultants(*axes, *receiver);
                for (component, row) in rows[*element].iter().enumerate() {
                    let Some(row) = row else { continue };
                    let row_loads =
                        &mut loads[row * RIGID_MOTION_COUNT..(row + 1) * RIGID_MOTION_COUNT];
                    for (load, resultant) in row_loads.iter_mut().zip(resultants[component]) {
                        load.re += character(parity, *axes, component) * resultant;
                    }
                }
            }
            for (source, source_element) in &self.cells {
                let pair = CellPair {
                    cells: [*receiver, *source],
                    rows: &rows[*element],
                    columns: &rows[*source_element],
                };
                self.add_pair(&pair, parity, values, &mut matrix, order);
            }
        }
        add_resultants(&matrix, &loads, stiffness)
    }

    /// Adds the compliances of a pair of cells, with all mirror images of the source, to the matrix of a sector.
    fn add_pair(
        &self,
        pair: &CellPair<'_>,
        parity: [f64; 2],
        values: &[[Complex; COMPLIANCES_PER_OFFSET]],
        matrix: &mut [Complex64],
        order: usize,
    ) {
        let [receiver, source] = pair.cells;
        let group_order = self.group.len() as f64;
        let receiver_cell = self.plan.cells[receiver];
        for Reflection { axes, .. } in &self.group {
            let image_cell = mirror_image(*axes, self.plan.cells[source], self.plan.lattice.counts);
            let mut block = self.plan.lattice.block(values, offset(receiver_cell, image_cell));
            if image_cell == receiver_cell {
                let factor = 1.0 + self.plan.spring_ratio(receiver);
                for k in 0..COMPONENTS_IN_SPACE {
                    block[k][k] = block[k][k].scale(factor);
                }
            }
            for (row, block_row) in pair.rows.iter().zip(block) {
                let Some(row) = row else { continue };
                for (component, column) in pair.columns.iter().enumerate() {
                    let Some(column) = column else { continue };
                    let factor = group_order * character(parity, *axes, component);
                    matrix[row * order + column] +=
                        block_row[component].scale(factor).to_complex64();
                }
            }
        }
    }

    /// Row of each component of each representative element in the equations of a sector, and the number of rows.
    ///
    /// An element on an axis has no odd components.
    fn sector_rows(&self, components: &[usize], parity: [f64; 2]) -> (Vec<ComponentRows>, usize) {
        let mut order = 0;
        let mut rows = vec![[None; COMPONENTS_IN_SPACE]; self.elements.len()];
        for (element, element_rows) in self.elements.iter().zip(&mut rows) {
            for component in components {
                let is_allowed = self.group.iter().all(|h| {
                    h.image_elements[*element] != *element
                        || character(parity, h.axes, *component) > 0.0
                });
                if is_allowed {
                    element_rows[*component] = Some(order);
                    order += 1;
                }
            }
        }
        (rows, order)
    }

    /// Forces (N) and moments (N m) of unit tractions on a reflected cell, for each component of the traction.
    fn resultants(
        &self,
        axes: [bool; 2],
        cell: usize,
    ) -> [[f64; RIGID_MOTION_COUNT]; COMPONENTS_IN_SPACE] {
        let arms = self.plan.arms(cell);
        let area = self.plan.lattice.pitch[0] * self.plan.lattice.pitch[1];
        let x = if axes[0] { -arms[0] } else { arms[0] };
        let y = if axes[1] { -arms[1] } else { arms[1] };
        // u = θ × r, and down is −z.
        let pressure_resultants = [0.0, 0.0, -1.0, -y, x, 0.0];
        let x_shear_resultants = [1.0, 0.0, 0.0, 0.0, 0.0, -y];
        let y_shear_resultants = [0.0, 1.0, 0.0, 0.0, 0.0, x];
        [pressure_resultants, x_shear_resultants, y_shear_resultants]
            .map(|row| row.map(|value| area * value))
    }
}

/// Character χ of a reflection for a component of the traction, with the parities of the sector in x and in y.
fn character(parity: [f64; 2], axes: [bool; 2], component: usize) -> f64 {
    let mut character = 1.0;
    for axis in 0..2 {
        if axes[axis] {
            let is_shear_along_axis = component == axis + 1;
            character *= if is_shear_along_axis { -parity[axis] } else { parity[axis] };
        }
    }
    character
}

/// Adds LᵀF⁻¹L to a stiffness, with the compliances F of a sector (`matrix`) and the resultants L (`loads`).
fn add_resultants(
    matrix: &[Complex64],
    loads: &[Complex64],
    stiffness: &mut [[Complex64; RIGID_MOTION_COUNT]; RIGID_MOTION_COUNT],
) -> Result<()> {
    let order = loads.len() / RIGID_MOTION_COUNT;
    let mut tractions = loads.to_vec();
    let mut factor = DenseFactor::with_columns(order, RIGID_MOTION_COUNT);
    if !factor.factor(matrix, order) {
        return Err(Error::Singular { matrix: "compliance of a mat in plan", order });
    }
    factor.solve_columns(&mut tractions, RIGID_MOTION_COUNT);
    let load_rows = loads.chunks_exact(RIGID_MOTION_COUNT);
    let traction_rows = tractions.chunks_exact(RIGID_MOTION_COUNT);
    for (row_loads, row_tractions) in load_rows.zip(traction_rows) {
        for (stiffness_row, load) in stiffness.iter_mut().zip(row_loads) {
            for (entry, traction) in stiffness_row.iter_mut().zip(row_tractions) {
                *entry += load * traction;
            }
        }
    }
    Ok(())
}

/// Mirror image of a cell about the middle of the lattice.
fn mirror_image(axes: [bool; 2], cell: [usize; 2], counts: [usize; 2]) -> [usize; 2] {
    [0, 1].map(|axis| if axes[axis] { counts[axis] - 1 - cell[axis] } else { cell[axis] })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bem::layered::Compliances;
    use crate::bem::plan::integrals::{CellIntegrals, CellWorkspace};
    use crate::error::ProgressReporter;
    use crate::soil::{Soil, SoilProfile};

    /// Results with and without symmetry are equal: even and odd numbers of cells, one axis, a rotation by 180°, none.
    #[test]
    fn sectors_yield_the_stiffness_of_all_cells() {
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
        for (text, group_order) in masks {
            let columns = text.lines().next().unwrap().len();
            let mask: Vec<bool> = text.lines().flat_map(str::chars).map(|c| c == '#').collect();
            plans.push((Plan::masked([0.0; 2], [1.0, 0.8], columns, &mask).unwrap(), group_order));
        }
        for (union_widths, group_order) in
            [(vec![1, 3, 1], 4), (vec![1, 2, 2, 1], 4), (vec![1, 2, 1, 1], 2)]
        {
            let column_count = union_widths.iter().sum();
            let plan =
                Plan::masked([0.0; 2], [1.0, 0.8], column_count, &vec![true; 4 * column_count])
                    .unwrap();
            plans.push((plan.with_unions(&union_widths, &[1, 2, 1]).unwrap(), group_order));
        }
        // Cut cells.
        let triangle = vec![[0.0, 0.0], [2.0, 0.5], [1.0, 1.5]];
        plans.push((Plan::disc([0.3, -0.1], 1.0, 6).unwrap(), 4));
        plans.push((Plan::on_faces(&[triangle], 5).unwrap(), 1));
        let profile = SoilProfile::on_half_plane(Soil::new(1.0, 0.3, 1.0).unwrap());
        for (plan, group_order) in plans {
            let s = Complex::new(0.1, 0.8);
            let mut progress = ProgressReporter::unobserved();
            let integrals =
                CellIntegrals::new(&plan.lattice, &profile, [s], 1e-9, &mut progress).unwrap();
            let mut workspace = CellWorkspace::default();
            let mut values =
                vec![[Complex::default(); COMPLIANCES_PER_OFFSET]; integrals.table.class_count];
            integrals.compliance(&profile, s, &mut workspace, &mut values).unwrap();
            let sectors = Sectors::new(&plan);
            assert_eq!(sectors.group.len(), group_order, "{plan:?}");
            let sectors_without_symmetry = Sectors::with_reflections(&plan, &[[false; 2]]);
            for coupled_components in [&[&[0, 1, 2][..]][..], &[&[0], &[1, 2]]] {
                let computed = sectors.stiffness(&values, coupled_components).unwrap();
                let expected =
                    sectors_without_symmetry.stiffness(&values, coupled_components).unwrap();
                for (a, b) in computed.iter().flatten().zip(expected.iter().flatten()) {
                    assert!((*a - *b).abs() < 1e-11, "{plan:?} {a:?} {b:?}");
                }
            }
        }
    }
}
