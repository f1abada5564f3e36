//! Cells under one or several mats.

use std::collections::HashSet;
use std::ops::Range;

use super::boundary::Boundary;
use super::faces::{Face, apart, mat_by_mat};
use super::outline::{Cut, OVERHANG, cut, error};
use super::region::Grid;
use super::unions::Unions;
use crate::error::{Error, PlanError, Result, at_least, finite, memory, positive, require};
use crate::geometry::{ContactElement, Lattice, circle, middle};
use crate::history::PairClasses;

/// Largest relative difference of the areas of mats and cells.
const MISSING: f64 = 0.01;
/// Memory for a cell, bytes.
const CELL: f64 = 1000.0;
/// Relative difference of sides that counts as rounding.
const ROUNDING: f64 = 1e-12;
/// Part of a union's rectangle beside its cells that counts as rounding.
const FILLED: f64 = 1e-9;

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
    /// Faces of the outline, and number of cells along its shorter side; empty for discs and masks.
    faces: (Vec<Face>, usize),
    /// Contact element of each cell; `None` if each cell is one.
    pub(super) owners: Option<Vec<usize>>,
    /// Each cell at the outline; empty if no cell is cut.
    pub(super) cuts: Vec<Cut>,
    /// Estimated relative error of a rigid mat's rocking stiffness by oblique edges.
    error: f64,
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
        let faces: Result<Vec<_>> =
            faces.iter().enumerate().map(|(number, corners)| Face::new(number, corners)).collect();
        Self::on(faces?, cells, OVERHANG, f64::INFINITY)
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
        let on = (0..mask.len()).filter(|place| mask[*place]);
        let cells: Vec<_> = on.map(|place| [place % columns, place / columns]).collect();
        let range = |axis: usize| {
            let places = || cells.iter().map(move |cell| cell[axis]);
            Some([places().min()?, places().max()?])
        };
        let [Some([left, right]), Some([front, back])] = [0, 1].map(range) else {
            return Err(PlanError::NoCells { mat: 0, pitch }.into());
        };
        let area = pitch[0] * pitch[1] * cells.len() as f64;
        Ok(Self {
            corner: [corner[0] + pitch[0] * left as f64, corner[1] + pitch[1] * front as f64],
            cells: mat_by_mat(&cells).into_iter().map(|[i, j]| [i - left, j - front]).collect(),
            lattice: Lattice { pitch, counts: [right + 1 - left, back + 1 - front] },
            overhang: 0.0,
            area,
            faces: (vec![], 0),
            owners: None,
            cuts: vec![],
            error: 0.0,
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
            let [length, depth] = element.sides();
            let ratio = area / (length * depth);
            require("part of a union's rectangle in its cells", ratio, ratio > 1.0 - FILLED, "1")?;
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
        let (faces, cells) = self.faces;
        Self::on(faces, cells, 0.0, 0.0)
    }

    /// Cells under faces of mats with this D/(G R³), infinite for rigid mats.
    pub(super) fn on(faces: Vec<Face>, cells: usize, overhang: f64, rigidity: f64) -> Result<Self> {
        Face::check_overlap(&faces)?;
        let bounds = Face::bounds(&faces);
        let sides = bounds.map(|[least, greatest]| greatest - least);
        let shorter = sides[0].min(sides[1]);
        let whole = cells as f64 - 2.0 * overhang;
        let counts = sides.map(|side| {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
            let count = (whole * side / shorter + 2.0 * overhang).round() as usize;
            count
        });
        check_count(cells, counts)?;
        let mut pitch = [0, 1].map(|axis| sides[axis] / (counts[axis] as f64 - 2.0 * overhang));
        if (pitch[0] / pitch[1] - 1.0).abs() < ROUNDING {
            pitch[1] = pitch[0];
        }
        let corner = [0, 1].map(|k| middle(bounds[k]) - 0.5 * pitch[k] * counts[k] as f64);
        let mats = Boundary::of_mats(&faces);
        let grid = Grid { corner, pitch, counts };
        let (owners, mut found) = cut(&mats, grid, overhang, rigidity);
        apart(&owners, counts[0], pitch)?;
        if let Some(mat) = found.iter().position(|(cells, _)| cells.is_empty()) {
            return Err(PlanError::NoCells { mat, pitch }.into());
        }
        let error = if rigidity.is_infinite() { error(&mats, pitch) } else { 0.0 };
        found.sort_by_key(|(cells, _)| cells.first().map(|[i, j]| [*j, *i]));
        let (own, cuts): (Vec<_>, Vec<_>) = found.into_iter().unzip();
        let area = mats.iter().map(Boundary::area).sum();
        let (cells, cuts, faces) = (own.concat(), cuts.concat(), (faces, cells));
        let lattice = Lattice { pitch, counts };
        let plan =
            Self { lattice, cells, corner, overhang, area, faces, owners: None, cuts, error };
        let found: f64 = plan.inside().iter().sum();
        if (found - area).abs() > MISSING * area {
            return Err(PlanError::Uncovered { faces: area, cells: found, pitch }.into());
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

    /// Estimated relative error of a rigid mat's rocking stiffness by an oblique outline.
    pub(in crate::bem) fn outline_error(&self) -> f64 {
        self.error
    }

    /// Pairs of the cells.
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
        Self { lattice, cells, overhang: 0.0, faces: (vec![], 0), owners, cuts, ..self.clone() }
    }

    /// Ends of a cell's contact element along x and y, m.
    pub(super) fn ends(&self, cell: usize) -> [[f64; 2]; 2] {
        if let Some(cut) = self.cuts.get(cell) {
            return cut.ends;
        }
        [0, 1].map(|axis| {
            [0, 1].map(|end| {
                self.corner[axis] + self.lattice.pitch[axis] * (self.cells[cell][axis] + end) as f64
            })
        })
    }

    /// Centre of a cell's contact element from the middle of the plan, m.
    pub(super) fn arms(&self, cell: usize) -> [f64; 2] {
        let (Lattice { pitch, counts }, place) = (&self.lattice, self.cells[cell]);
        [0, 1].map(|axis| {
            let whole = 2.0 * place[axis] as f64 + 1.0 - counts[axis] as f64;
            let cut = self.cuts.get(cell).map(|cut| middle(cut.ends[axis]) - self.middle()[axis]);
            cut.unwrap_or(0.5 * whole * pitch[axis])
        })
    }

    /// Compliance in series with a cell, relative to the cell's own.
    pub(super) fn softness(&self, cell: usize) -> f64 {
        self.cuts.get(cell).map_or(0.0, |cut| cut.softness)
    }

    /// The contact elements.
    pub fn elements(&self) -> Vec<ContactElement> {
        let mut all: Vec<[[f64; 2]; 2]> = vec![];
        for number in 0..self.count() {
            let own = self.ends(number);
            // Cells of a mat come row by row, and the first cell of an element before its others.
            match all.get_mut(self.owner(number)) {
                Some(sides) => (0..2).for_each(|k| sides[k][1] = sides[k][1].max(own[k][1])),
                None => all.push(own),
            }
        }
        let elements = all.into_iter().zip(self.areas());
        let element = |([along, across], [inside, all]): ([[f64; 2]; 2], [f64; 2])| {
            ContactElement::in_plan(along, across).with_fraction_inside((inside / all).min(1.0))
        };
        elements.map(element).collect()
    }

    /// Area of each contact element inside the outline, and of all its cells or parts of cells, m².
    fn areas(&self) -> Vec<[f64; 2]> {
        let [a, b] = self.lattice.pitch;
        let mut sums: Vec<[f64; 2]> = vec![];
        for (number, inside) in self.inside().into_iter().enumerate() {
            let owner = self.owner(number);
            sums.resize(sums.len().max(owner + 1), [0.0; 2]);
            sums[owner][0] += inside;
            sums[owner][1] += a * b * self.cuts.get(number).map_or(1.0, |cut| cut.size);
        }
        sums
    }

    /// Numbers that identify the lattice and its cells.
    pub(in crate::bem) fn identity(&self) -> impl Iterator<Item = f64> {
        let Lattice { pitch, counts } = &self.lattice;
        let cells = self.cells.iter().flatten();
        let counts = counts.iter().chain(cells).map(|count| *count as f64);
        let owners = self.owners.iter().flatten().map(|owner| *owner as f64);
        pitch.iter().copied().chain(self.corner).chain(counts).chain(owners)
    }

    /// Area of each cell that is inside the outline, m².
    fn inside(&self) -> Vec<f64> {
        let places: HashSet<_> = self.cells.iter().copied().collect();
        let [a, b] = self.lattice.pitch;
        let d = self.overhang;
        if !self.cuts.is_empty() {
            return self.cuts.iter().map(|cut| a * b * cut.size * cut.inside).collect();
        }
        let inside = |[i, j]: [usize; 2]| {
            let on = |right: usize, away: usize| {
                let column = (i + right).checked_sub(1);
                let row = (j + away).checked_sub(1);
                column.zip(row).is_some_and(|(i, j)| places.contains(&[i, j]))
            };
            let cut = |on: bool| if on { 0.0 } else { d };
            let width = 1.0 - cut(on(0, 1)) - cut(on(2, 1));
            let depth = 1.0 - cut(on(1, 0)) - cut(on(1, 2));
            let corners = [[0, 0], [0, 2], [2, 0], [2, 2]].into_iter();
            let notches = corners.filter(|[x, y]| on(*x, 1) && on(1, *y) && !on(*x, *y)).count();
            a * b * (width * depth - d * d * notches as f64)
        };
        self.cells.iter().map(|cell| inside(*cell)).collect()
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
    Ok(memory::check("cells of a mat", count, CELL * count)?)
}
