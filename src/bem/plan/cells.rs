//! Cells under one or several mats.

use std::ops::Range;

use super::boundary::MatBoundary;
use super::faces::{MatFace, check_apart, sort_by_mat};
use super::outline::{CutCell, MatCells, RIGID_MAT_OVERHANG, assign_cells};
use super::region::PlanGrid;
use super::unions::{Quarters, Unions};
use crate::error::{Error, PlanError, Result, at_least, finite, memory, positive, require};
use crate::geometry::{Lattice, circle, middle};
use crate::history::PairClasses;

mod areas;

/// Largest relative difference between the areas of mats and of their cells; a larger one means that a face is too narrow.
const MAX_AREA_ERROR: f64 = 0.01;
/// Upper estimate of the memory for a cell before matrices exist, bytes.
const BYTES_PER_CELL: f64 = 1000.0;
/// Relative difference of a cell's sides below which the difference is a rounding error.
const EQUAL_SIDES_TOLERANCE: f64 = 1e-12;
/// Fraction of a union's rectangle outside its cells below which the fraction is a rounding error.
const UNION_AREA_TOLERANCE: f64 = 1e-9;

/// Cells of one lattice under one or several mats.
///
/// x points to the right, y away from the reader. Tractions are constant over each cell. Outer cells of a rigid mat
/// with edges along x and y extend 0.105 of their side beyond its outline: without this overhang, piecewise constant
/// tractions under a rigid base act like a mat whose edge is this far inside. The overhang removes at least 0.9 of the
/// error, which is of first order in the side of a cell. Oblique edges cut cells. The contact element of a cut cell is a
/// rectangle about the centroid of its area inside the outline, with the same area. A spring in series with the soil
/// increases its compliance as the area decreases.
///
/// ```
/// use basemat::bem::plan::Plan;
/// let mat = Plan::rectangle(-10.0..10.0, -7.0..7.0, 8)?;
/// assert_eq!(mat.count(), 11 * 8);
/// assert!((mat.pitch()[1] - 14.0 / (8.0 - 0.21)).abs() < 1e-12);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    pub(super) lattice: Lattice,
    /// Column and row of each cell, mat by mat and row by row.
    pub(super) cells: Vec<[usize; 2]>,
    /// Smallest x and y of the lattice, m.
    corner: [f64; 2],
    /// Overhang of outer cells beyond the outline, as a fraction of their side.
    overhang: f64,
    /// Area inside the outline, m².
    area: f64,
    /// Faces of the mats; empty for masks.
    faces: Vec<MatFace>,
    /// Number of cells along the shorter side of the outline; 0 for masks.
    shorter_side_cells: usize,
    /// Contact element of each cell; `None` if each cell is one element.
    pub(super) cell_elements: Option<Vec<usize>>,
    /// Contact element of each cell; empty if no cell is cut.
    pub(super) cut_cells: Vec<CutCell>,
}

impl Plan {
    /// Plan of a rectangle (m), with `cells` along its shorter side.
    ///
    /// # Errors
    /// [`Error::Input`] for an empty range; as for [`Plan::on_faces`].
    pub fn rectangle(x: Range<f64>, y: Range<f64>, cells: usize) -> Result<Self> {
        positive("length of a mat along x", x.end - x.start)?;
        positive("length of a mat along y", y.end - y.start)?;
        let corners = [[x.start, y.start], [x.end, y.start], [x.end, y.end], [x.start, y.end]];
        Self::on_faces(&[corners.to_vec()], cells)
    }

    /// Plan under faces, with `cells` along the shorter side of all faces together.
    ///
    /// A face is a convex polygon, a list of its corners (m) in either order. Two faces form one mat if a corner of one
    /// face is on a corner or an edge of the other. Mats must be at least one empty cell apart. Cells depend only on the
    /// outline of the mats, and not on the division into faces.
    ///
    /// # Errors
    /// [`Error::Input`] for less than two cells; [`Error::Size`] for no faces; [`Error::Memory`];
    /// [`Error::Item`], [`PlanError::Overlap`], [`PlanError::NoCells`], [`PlanError::TooClose`],
    /// [`PlanError::Uncovered`].
    pub fn on_faces(faces: &[Vec<[f64; 2]>], cells: usize) -> Result<Self> {
        check_faces(faces.len())?;
        let mut mat_faces = Vec::with_capacity(faces.len());
        for (face, corners) in faces.iter().enumerate() {
            mat_faces.push(MatFace::new(face, corners)?);
        }
        Self::on_outlines(mat_faces, cells, RIGID_MAT_OVERHANG, f64::INFINITY)
    }

    /// Plan of a disc (m), as a polygon of the same area, with `cells` along its diameter.
    ///
    /// # Errors
    /// [`Error::Input`] for less than two cells, or a centre or radius not finite and positive; [`Error::Memory`].
    pub fn disc(center: [f64; 2], radius: f64, cells: usize) -> Result<Self> {
        finite("x of the centre of a disc", center[0])?;
        finite("y of the centre of a disc", center[1])?;
        positive("radius of a disc", radius)?;
        let corners = circle(radius).map(|[x, y]| [center[0] + x, center[1] + y]);
        Self::on_faces(&[corners.collect()], cells)
    }

    /// Plan of the cells with sides `pitch` (m) whose entry in `mask` is true.
    ///
    /// The mask has rows of `columns` entries along x, in the order of y; its first cell is at `corner` (m). The mat ends at
    /// the sides of the cells.
    ///
    /// # Errors
    /// [`Error::Input`] for a corner that is not finite or sides that are not positive; [`Error::Size`] for a mask
    /// that does not consist of whole rows; [`Error::Memory`]; [`PlanError::NoCells`].
    pub fn masked(
        corner: [f64; 2],
        pitch: [f64; 2],
        columns: usize,
        mask: &[bool],
    ) -> Result<Self> {
        for axis in 0..2 {
            finite("corner of a mask", corner[axis])?;
            positive("side of a cell", pitch[axis])?;
        }
        let rows = mask.len().div_ceil(columns.max(1)).max(1);
        if columns == 0 || rows * columns != mask.len() {
            let needed = rows * columns.max(1);
            return Err(Error::Size { quantity: "mask of a mat", found: mask.len(), needed });
        }
        check_memory([columns, rows])?;
        let mut cells = vec![];
        // Smallest and largest column and row of the cells.
        let mut min_cell = [usize::MAX; 2];
        let mut max_cell = [0; 2];
        for index in (0..mask.len()).filter(|index| mask[*index]) {
            let cell = [index % columns, index / columns];
            for axis in 0..2 {
                min_cell[axis] = min_cell[axis].min(cell[axis]);
                max_cell[axis] = max_cell[axis].max(cell[axis]);
            }
            cells.push(cell);
        }
        if cells.is_empty() {
            return Err(PlanError::NoCells { mat: 0, pitch }.into());
        }
        let area = pitch[0] * pitch[1] * cells.len() as f64;
        let sorted_cells = sort_by_mat(&cells);
        let counts = [0, 1].map(|axis| max_cell[axis] + 1 - min_cell[axis]);
        Ok(Self {
            corner: [0, 1].map(|axis| corner[axis] + pitch[axis] * min_cell[axis] as f64),
            cells: sorted_cells
                .into_iter()
                .map(|[i, j]| [i - min_cell[0], j - min_cell[1]])
                .collect(),
            lattice: Lattice { pitch, counts },
            overhang: 0.0,
            area,
            faces: vec![],
            shorter_side_cells: 0,
            cell_elements: None,
            cut_cells: vec![],
        })
    }

    /// Combines cells to contact elements that are rectangles of cells.
    ///
    /// `columns` and `rows` are the numbers of columns and rows of cells in each union, from the first column and row to the
    /// last. The ground still computes all cells. Under a rigid mat, unions of 1, 2, 2, 3, 3, 2, 2, 1 of sixteen cells are
    /// as accurate as single cells, with a quarter of the elements.
    ///
    /// ```
    /// use basemat::bem::plan::Plan;
    /// let graded = [1, 2, 2, 3, 3, 2, 2, 1];
    /// let mat = Plan::rectangle(-5.0..5.0, -5.0..5.0, 16)?.with_unions(&graded, &graded)?;
    /// assert_eq!(mat.count(), 256);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Size`] for numbers that do not sum up to the columns or rows; [`Error::Input`] for a rectangle that is
    /// partly outside the mat or that an oblique edge cuts, and for outermost elements wider than a cell, because the
    /// traction at the mat's edge would spread over them.
    pub fn with_unions(self, columns: &[usize], rows: &[usize]) -> Result<Self> {
        let cell_elements =
            Some(Unions::cell_elements(self.lattice.counts, &self.cells, [columns, rows])?);
        let plan = Self { cell_elements, ..self };
        for ([_, area], element) in plan.areas().into_iter().zip(plan.elements()) {
            let sides = element.sides();
            let filled_fraction = area / (sides[0] * sides[1]);
            require(
                "part of a union's rectangle in its cells",
                filled_fraction,
                filled_fraction > 1.0 - UNION_AREA_TOLERANCE,
                "1",
            )?;
        }
        Ok(plan)
    }

    /// Removes the overhang: the outermost cells end at the outline.
    ///
    /// The contact area is then exact, for prescribed pressures and on springs. Under a rigid mat on soil the error is of
    /// first order in the side of a cell. The method has no effect on masks.
    ///
    /// # Errors
    /// [`Error::Scene`] for a plan with unions, whose cells would change; as for [`Plan::on_faces`].
    pub fn without_overhang(self) -> Result<Self> {
        if self.overhang == 0.0 {
            return Ok(self);
        }
        if self.cell_elements.is_some() {
            return Err(Error::Scene {
                quantity: "plan with unions",
                needed: "`without_overhang` before `with_unions`",
            });
        }
        Self::on_outlines(self.faces, self.shorter_side_cells, 0.0, 0.0)
    }

    /// Plan under the faces of mats, for an overhang (as a fraction of a cell) and a rigidity.
    ///
    /// `shorter_side_cells`: number of cells along the shorter side of all faces together. `rigidity`: D/(G R³), infinite
    /// for rigid mats.
    pub(super) fn on_outlines(
        faces: Vec<MatFace>,
        shorter_side_cells: usize,
        overhang: f64,
        rigidity: f64,
    ) -> Result<Self> {
        MatFace::check_overlap(&faces)?;
        let bounds = MatFace::bounds(&faces);
        let grid = grid_over(bounds, shorter_side_cells, overhang)?;
        let PlanGrid { corner, pitch, counts } = grid;
        let boundaries = MatBoundary::of_mats(&faces);
        let MatCells { cell_mats, mut mats } = assign_cells(&boundaries, grid, overhang, rigidity);
        check_apart(&cell_mats, counts[0], pitch)?;
        if let Some(mat) = mats.iter().position(|mat| mat.cells.is_empty()) {
            return Err(PlanError::NoCells { mat, pitch }.into());
        }
        mats.sort_by_key(|mat| mat.cells.first().map(|[i, j]| [*j, *i]));
        let mut cells = vec![];
        let mut cut_cells = vec![];
        for mat in mats {
            cells.extend(mat.cells);
            cut_cells.extend(mat.cut_cells);
        }
        let area = boundaries.iter().map(MatBoundary::area).sum();
        let plan = Self {
            lattice: Lattice { pitch, counts },
            cells,
            corner,
            overhang,
            area,
            faces,
            shorter_side_cells,
            cell_elements: None,
            cut_cells,
        };
        let cell_area: f64 = plan.areas_inside_outline().iter().sum();
        if (cell_area - area).abs() > MAX_AREA_ERROR * area {
            return Err(PlanError::Uncovered { faces: area, cells: cell_area, pitch }.into());
        }
        Ok(plan)
    }

    /// Number of cells.
    pub fn count(&self) -> usize {
        self.cells.len()
    }

    /// Sides of a cell along x and y, m.
    pub fn pitch(&self) -> [f64; 2] {
        self.lattice.pitch
    }

    /// Middle of the bounding rectangle, m: the reference point of resultants and rotations.
    pub fn middle(&self) -> [f64; 2] {
        let sides = self.lattice.sides();
        [0, 1].map(|axis| self.corner[axis] + 0.5 * sides[axis])
    }

    /// Relative error of the area inside the outline, due to narrow faces.
    pub fn area_error(&self) -> f64 {
        self.areas_inside_outline().iter().sum::<f64>() / self.area - 1.0
    }

    /// Classes of pairs of cells.
    pub(super) fn classes(&self) -> Result<PairClasses> {
        PairClasses::in_plan(self.lattice.clone(), self.cells.clone(), self.corner)
    }

    /// Contact element of a cell.
    pub(super) fn element_of(&self, cell: usize) -> usize {
        self.cell_elements.as_ref().map_or(cell, |elements| elements[cell])
    }

    /// Plan of the quarters of all elements, to check whether a flexible base needs more elements.
    ///
    /// The quarters of an element are left front, right front, left back and right back.
    pub(in crate::bem) fn quartered(&self) -> Self {
        let Quarters { cells, elements } =
            Unions::quarters(&self.cells, |cell| self.element_of(cell));
        let Lattice { pitch, counts } = &self.lattice;
        Self {
            lattice: Lattice { pitch: pitch.map(|x| 0.5 * x), counts: counts.map(|n| 2 * n) },
            cells,
            overhang: 0.0,
            faces: vec![],
            shorter_side_cells: 0,
            cell_elements: Some(elements),
            cut_cells: self.cut_cells.iter().flat_map(|cell| vec![cell.clone(); 4]).collect(),
            ..self.clone()
        }
    }

    /// Numbers that identify the lattice and its cells.
    pub(in crate::bem) fn identity(&self) -> impl Iterator<Item = f64> {
        let Lattice { pitch, counts } = &self.lattice;
        let cells = self.cells.iter().flatten();
        let counts = counts.iter().chain(cells).map(|count| *count as f64);
        let elements = self.cell_elements.iter().flatten().map(|element| *element as f64);
        pitch.iter().copied().chain(self.corner).chain(counts).chain(elements)
    }
}

/// Lattice over `bounds` (m), the bounding rectangle of all faces.
///
/// # Errors
/// [`Error::Input`] for less than two cells along the shorter side; [`Error::Memory`].
fn grid_over(bounds: [[f64; 2]; 2], shorter_side_cells: usize, overhang: f64) -> Result<PlanGrid> {
    let sides = bounds.map(|[min, max]| max - min);
    let shorter_side = sides[0].min(sides[1]);
    let covered_cells = shorter_side_cells as f64 - 2.0 * overhang;
    let counts = sides.map(|side| {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let count = (covered_cells * side / shorter_side + 2.0 * overhang).round() as usize;
        count
    });
    require(
        "number of cells along the shorter side of a mat",
        shorter_side_cells as f64,
        shorter_side_cells > 1,
        "at least 2",
    )?;
    check_memory(counts)?;
    let mut pitch = [0, 1].map(|axis| sides[axis] / (counts[axis] as f64 - 2.0 * overhang));
    if (pitch[0] / pitch[1] - 1.0).abs() < EQUAL_SIDES_TOLERANCE {
        pitch[1] = pitch[0];
    }
    let corner = [0, 1].map(|k| middle(bounds[k]) - 0.5 * pitch[k] * counts[k] as f64);
    Ok(PlanGrid { corner, pitch, counts })
}

/// Error for a mat without faces.
pub(super) fn check_faces(face_count: usize) -> Result<()> {
    at_least("list of faces of a mat", face_count, 1)
}

/// Error for cells whose data would not fit into memory.
fn check_memory(counts: [usize; 2]) -> Result<()> {
    let cell_count = counts[0] as f64 * counts[1] as f64;
    Ok(memory::check("cells of a mat", cell_count, BYTES_PER_CELL * cell_count)?)
}
