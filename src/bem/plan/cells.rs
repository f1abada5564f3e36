//! Cells under one or several mats.

use std::ops::Range;

use super::boundary::MatBoundary;
use super::faces::{MatFace, check_apart, mat_by_mat};
use super::outline::{CutCell, RIGID_MAT_OVERHANG, cells_of_mats};
use super::region::PlanGrid;
use super::unions::Unions;
use crate::error::{Error, PlanError, Result, at_least, finite, memory, positive, require};
use crate::geometry::{Lattice, circle, middle};
use crate::history::PairClasses;

mod areas;

/// Largest relative difference of the areas of mats and cells.
const MAX_AREA_ERROR: f64 = 0.01;
/// Memory for a cell, bytes.
const BYTES_PER_CELL: f64 = 1000.0;
/// Relative difference of sides that counts as rounding.
const EQUAL_SIDES_TOLERANCE: f64 = 1e-12;
/// Part of a union's rectangle beside its cells that counts as rounding.
const UNION_AREA_TOLERANCE: f64 = 1e-9;

/// Cells of one lattice under one or several mats.
///
/// x points to the right, y away from the reader. Tractions are constant over each cell. Outer cells of a rigid mat
/// with edges along x and y extend 0.105 of their side beyond its outline: piecewise constant tractions under a rigid
/// base act like a mat whose edge lies this far inside. This removes at least 0.9 of the error, of first order in the
/// cells. Other edges cut cells. The contact element of a cut cell is a rectangle with the area inside the outline
/// about its centre of area, and a spring makes the soil under it softer as the area is smaller.
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
    overhang: f64,
    /// Area of the outline, m².
    area: f64,
    /// Faces of the outline; empty for masks.
    faces: Vec<MatFace>,
    /// Number of cells along the shorter side of the outline; 0 for masks.
    cells_along: usize,
    /// Contact element of each cell; `None` if each cell is one.
    pub(super) owners: Option<Vec<usize>>,
    /// Each cell at the outline; empty if no cell is cut.
    pub(super) cuts: Vec<CutCell>,
}

impl Plan {
    /// A rectangle, with `cells` along its shorter side.
    ///
    /// # Errors
    /// As for [`Plan::on_faces`].
    pub fn rectangle(x: Range<f64>, y: Range<f64>, cells: usize) -> Result<Self> {
        positive("length of a mat along x", x.end - x.start)?;
        positive("length of a mat along y", y.end - y.start)?;
        let corners = [[x.start, y.start], [x.end, y.start], [x.end, y.end], [x.start, y.end]];
        Self::on_faces(&[corners.to_vec()], cells)
    }

    /// Cells under some faces, with `cells` along the shorter side of all.
    ///
    /// Faces are convex polygons, each given by its corners (m) in either order. Faces that share a corner, or have
    /// one on the other's edge, form one mat; between mats there is at least one empty cell. Cells depend on the outline
    /// of the mats alone, and not on the faces that fill it.
    ///
    /// # Errors
    /// [`Error::Input`] for less than two cells; [`Error::Size`] for no faces; [`Error::Memory`];
    /// [`Error::Item`], [`PlanError::Overlap`], [`PlanError::NoCells`], [`PlanError::TooClose`],
    /// [`PlanError::Uncovered`].
    pub fn on_faces(faces: &[Vec<[f64; 2]>], cells: usize) -> Result<Self> {
        check_faces(faces.len())?;
        let mut checked = Vec::with_capacity(faces.len());
        for (number, corners) in faces.iter().enumerate() {
            checked.push(MatFace::new(number, corners)?);
        }
        Self::on_outlines(checked, cells, RIGID_MAT_OVERHANG, f64::INFINITY)
    }

    /// A disc, as a polygon of the same area, with `cells` along its diameter.
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

    /// Cells with sides `pitch` (m) where `mask` is true.
    ///
    /// Row by row of `columns`, from `corner` (m) to the right, then away. Nothing extends beyond the cells.
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
            let found = mask.len();
            let needed = rows * columns.max(1);
            return Err(Error::Size { quantity: "mask of a mat", found, needed });
        }
        check_memory([columns, rows])?;
        let mut cells = vec![];
        // Smallest and largest column and row of the cells.
        let mut first = [usize::MAX; 2];
        let mut last = [0; 2];
        for place in (0..mask.len()).filter(|place| mask[*place]) {
            let cell = [place % columns, place / columns];
            for axis in 0..2 {
                first[axis] = first[axis].min(cell[axis]);
                last[axis] = last[axis].max(cell[axis]);
            }
            cells.push(cell);
        }
        if cells.is_empty() {
            return Err(PlanError::NoCells { mat: 0, pitch }.into());
        }
        let area = pitch[0] * pitch[1] * cells.len() as f64;
        let sorted = mat_by_mat(&cells);
        Ok(Self {
            corner: [0, 1].map(|axis| corner[axis] + pitch[axis] * first[axis] as f64),
            cells: sorted.into_iter().map(|[i, j]| [i - first[0], j - first[1]]).collect(),
            lattice: Lattice { pitch, counts: [0, 1].map(|axis| last[axis] + 1 - first[axis]) },
            overhang: 0.0,
            area,
            faces: vec![],
            cells_along: 0,
            owners: None,
            cuts: vec![],
        })
    }

    /// Unites cells to contact elements that are rectangles of cells.
    ///
    /// `along`: numbers of columns, `across`: numbers of rows, of all. The ground still computes all cells. For a rigid
    /// mat, sixteen cells by 1, 2, 2, 3, 3, 2, 2, 1 are as accurate as all, with a quarter of the elements.
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
    /// not wholly on the mat or that an oblique edge cuts, and for outermost elements wider than a cell: the mat's edge
    /// would be theirs.
    pub fn with_unions(self, along: &[usize], across: &[usize]) -> Result<Self> {
        let owners = Some(Unions::owners(self.lattice.counts, &self.cells, [along, across])?);
        let plan = Self { owners, ..self };
        for ([_, area], element) in plan.areas().into_iter().zip(plan.elements()) {
            let sides = element.sides();
            let ratio = area / (sides[0] * sides[1]);
            require(
                "part of a union's rectangle in its cells",
                ratio,
                ratio > 1.0 - UNION_AREA_TOLERANCE,
                "1",
            )?;
        }
        Ok(plan)
    }

    /// Cuts the cells of the edge off at the outline.
    ///
    /// Exact for given pressures and on springs; for a rigid mat on soil an error of first order. No effect on masks.
    ///
    /// # Errors
    /// [`Error::Scene`] for a plan with unions, whose cells would change; as for [`Plan::on_faces`].
    pub fn without_overhang(self) -> Result<Self> {
        if self.overhang == 0.0 {
            return Ok(self);
        }
        if self.owners.is_some() {
            return Err(Error::Scene {
                quantity: "plan with unions",
                needed: "`without_overhang` before `with_unions`",
            });
        }
        Self::on_outlines(self.faces, self.cells_along, 0.0, 0.0)
    }

    /// Cells under faces of mats.
    ///
    /// `cells_along`: number of cells along the shorter side of all faces. `rigidity`: D/(G R³), infinite for rigid
    /// mats.
    pub(super) fn on_outlines(
        faces: Vec<MatFace>,
        cells_along: usize,
        overhang: f64,
        rigidity: f64,
    ) -> Result<Self> {
        MatFace::check_overlap(&faces)?;
        let bounds = MatFace::bounds(&faces);
        let sides = bounds.map(|[low, high]| high - low);
        let shorter = sides[0].min(sides[1]);
        let covered_cells = cells_along as f64 - 2.0 * overhang;
        let counts = sides.map(|side| {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
            let count = (covered_cells * side / shorter + 2.0 * overhang).round() as usize;
            count
        });
        check_count(cells_along, counts)?;
        let mut pitch = [0, 1].map(|axis| sides[axis] / (counts[axis] as f64 - 2.0 * overhang));
        if (pitch[0] / pitch[1] - 1.0).abs() < EQUAL_SIDES_TOLERANCE {
            pitch[1] = pitch[0];
        }
        let corner = [0, 1].map(|k| middle(bounds[k]) - 0.5 * pitch[k] * counts[k] as f64);
        let mats = MatBoundary::of_mats(&faces);
        let grid = PlanGrid { corner, pitch, counts };
        let (owners, mut by_mat) = cells_of_mats(&mats, grid, overhang, rigidity);
        check_apart(&owners, counts[0], pitch)?;
        if let Some(mat) = by_mat.iter().position(|of_mat| of_mat.cells.is_empty()) {
            return Err(PlanError::NoCells { mat, pitch }.into());
        }
        by_mat.sort_by_key(|of_mat| of_mat.cells.first().map(|[i, j]| [*j, *i]));
        let mut cells = vec![];
        let mut cuts = vec![];
        for of_mat in by_mat {
            cells.extend(of_mat.cells);
            cuts.extend(of_mat.cuts);
        }
        let area = mats.iter().map(MatBoundary::area).sum();
        let plan = Self {
            lattice: Lattice { pitch, counts },
            cells,
            corner,
            overhang,
            area,
            faces,
            cells_along,
            owners: None,
            cuts,
        };
        let cell_area: f64 = plan.inside().iter().sum();
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

    /// Middle of the bounding rectangle, m: reference point of resultants and rotations.
    pub fn middle(&self) -> [f64; 2] {
        let sides = self.lattice.sides();
        [0, 1].map(|axis| self.corner[axis] + 0.5 * sides[axis])
    }

    /// Relative error of the area inside the outline, due to narrow faces.
    pub fn area_error(&self) -> f64 {
        self.inside().iter().sum::<f64>() / self.area - 1.0
    }

    /// Classes of pairs of cells.
    pub(super) fn classes(&self) -> Result<PairClasses> {
        PairClasses::in_plan(self.lattice.clone(), self.cells.clone(), self.corner)
    }

    /// Contact element of a cell.
    pub(super) fn owner(&self, cell: usize) -> usize {
        self.owners.as_ref().map_or(cell, |owners| owners[cell])
    }

    /// The plan of the quarters of all elements: left front, right front, left back, right back of each.
    pub(in crate::bem) fn quartered(&self) -> Self {
        let (cells, owners) = Unions::quarters(&self.cells, |cell| self.owner(cell));
        let Lattice { pitch, counts } = &self.lattice;
        let lattice = Lattice { pitch: pitch.map(|x| 0.5 * x), counts: counts.map(|n| 2 * n) };
        let owners = Some(owners);
        let cuts = self.cuts.iter().flat_map(|cut| vec![cut.clone(); 4]).collect();
        let faces = vec![];
        let cells_along = 0;
        Self { lattice, cells, overhang: 0.0, faces, cells_along, owners, cuts, ..self.clone() }
    }

    /// Numbers that identify the lattice and its cells.
    pub(in crate::bem) fn identity(&self) -> impl Iterator<Item = f64> {
        let Lattice { pitch, counts } = &self.lattice;
        let cells = self.cells.iter().flatten();
        let counts = counts.iter().chain(cells).map(|count| *count as f64);
        let owners = self.owners.iter().flatten().map(|owner| *owner as f64);
        pitch.iter().copied().chain(self.corner).chain(counts).chain(owners)
    }
}

/// Error for a mat without faces.
pub(super) fn check_faces(count: usize) -> Result<()> {
    at_least("list of faces of a mat", count, 1)
}

/// Error for less than two cells along a side, or more than memory allows.
fn check_count(cells: usize, counts: [usize; 2]) -> Result<()> {
    require(
        "number of cells along the shorter side of a mat",
        cells as f64,
        cells > 1,
        "at least 2",
    )?;
    check_memory(counts)
}

/// Error for so many cells that their data would not fit into memory.
fn check_memory(counts: [usize; 2]) -> Result<()> {
    let count = counts[0] as f64 * counts[1] as f64;
    Ok(memory::check("cells of a mat", count, BYTES_PER_CELL * count)?)
}
