//! Cells under one or several mats.

use std::collections::HashSet;
use std::ops::Range;

use super::faces::{Face, apart, mat_by_mat, owners};
use super::unions::Unions;
use crate::error::{Error, PlanError, Result, at_least, finite, memory, positive, require};
use crate::geometry::{ContactElement, Lattice};
use crate::history::PairClasses;
use crate::structure::{Base, BaseNode, Structure};

/// Overhang of outer cells beyond the outline, as a fraction of their side: see [`Plan`].
const OVERHANG: f64 = 0.105;
/// Largest fraction of the area that the cells may lack.
const MISSING: f64 = 0.1;
/// Largest number of cells to which the number under flexible faces is raised.
const MOST_RAISED: f64 = 1000.0;
/// Memory for a cell, bytes.
const CELL: f64 = 1000.0;
/// Relative difference of sides that counts as rounding.
const ROUNDING: f64 = 1e-12;

/// Cells of one lattice under one or several rigid mats.
///
/// x points to the right, y away from the reader. Tractions are constant over each cell. Outer cells of a mat with
/// straight edges extend 0.105 of their side beyond its outline: piecewise constant tractions under a rigid base act
/// like a mat whose edge lies this far inside. This removes at least 0.9 of the error, of first order in the cells.
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
    owners: Option<Vec<usize>>,
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
    /// one on the other's edge, form one mat; between mats there is at least one empty cell. Edges inside the bounding
    /// rectangle, such as in an L, move to the nearest line between cells: see [`Plan::area_error`].
    ///
    /// # Errors
    /// [`Error::Input`] for less than two cells; [`Error::Size`] for no faces; [`Error::Memory`];
    /// [`Error::Item`], [`PlanError::NoCells`], [`PlanError::TooClose`], [`PlanError::Uncovered`].
    pub fn on_faces(faces: &[Vec<[f64; 2]>], cells: usize) -> Result<Self> {
        check_faces(faces.len())?;
        let faces: Result<Vec<_>> =
            faces.iter().enumerate().map(|(number, corners)| Face::new(number, corners)).collect();
        Self::covering(faces?, cells, OVERHANG)
    }

    /// A disc of the cells of a `cells` × `cells` square whose centres lie on it, scaled to the same area.
    ///
    /// # Errors
    /// [`Error::Input`] for less than two cells, or a centre or radius not finite and positive; [`Error::Memory`].
    pub fn disc(center: [f64; 2], radius: f64, cells: usize) -> Result<Self> {
        finite("x of the centre of a disc", center[0])?;
        finite("y of the centre of a disc", center[1])?;
        positive("radius of a disc", radius)?;
        check_count(cells, [cells; 2])?;
        let middle = 0.5 * cells as f64;
        let from = |n: usize| n as f64 + 0.5 - middle;
        let inside = |place: usize| {
            from(place % cells).hypot(from(place / cells)) <= middle * (1.0 + ROUNDING)
        };
        let mask: Vec<bool> = (0..cells * cells).map(inside).collect();
        let count = mask.iter().filter(|on| **on).count();
        let side = radius * (std::f64::consts::PI / count as f64).sqrt();
        Self::masked(center.map(|x| x - middle * side), [side; 2], cells, &mask)
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
            let (found, needed) = (mask.len(), rows * columns.max(1));
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
        let counts = [right + 1 - left, back + 1 - front];
        let area = pitch[0] * pitch[1] * cells.len() as f64;
        Ok(Self {
            corner: [corner[0] + pitch[0] * left as f64, corner[1] + pitch[1] * front as f64],
            cells: mat_by_mat(&cells).into_iter().map(|[i, j]| [i - left, j - front]).collect(),
            lattice: Lattice { pitch, counts },
            overhang: 0.0,
            area,
            faces: (vec![], 0),
            owners: None,
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
    /// not wholly on the mat, and for outermost elements wider than a cell: the mat's edge would be theirs.
    pub fn with_unions(self, along: &[usize], across: &[usize]) -> Result<Self> {
        let owners = Some(Unions::owners(self.lattice.counts, &self.cells, [along, across])?);
        Ok(Self { owners, ..self })
    }

    /// Cuts the cells of the edge off at the outline.
    ///
    /// Exact for given pressures and on springs; for a rigid mat on soil an error of first order. No effect on discs.
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
        Self::covering(faces, cells, 0.0)
    }

    /// Cells under the faces of a structure, with `cells` along the shorter side of all: [`Plan::on_faces`].
    ///
    /// Under flexible faces there are at least as many cells as faces (two triangles count as one), since between cells
    /// only the structure holds its nodes. This raises the number to 1000 cells at most: a base that needs more causes
    /// an error or a warning of the build ([`Warning::CoarseBase`](crate::coupled::Warning::CoarseBase)).
    ///
    /// # Errors
    /// As for [`Plan::on_faces`].
    pub fn under(structure: &dyn Structure, cells: usize) -> Result<Self> {
        let Base::Faces(bodies) = structure.base() else {
            return Self::on_faces(&[], cells);
        };
        let corners = |face: &Vec<BaseNode>| face.iter().map(BaseNode::place).collect();
        let corners: Vec<Vec<_>> = bodies.iter().map(corners).collect();
        let faces = corners.iter().enumerate().map(|(number, own)| Face::new(number, own));
        let faces = faces.collect::<Result<Vec<_>>>()?;
        check_faces(faces.len())?;
        let mats = Face::mats(&faces);
        let mut most = cells;
        for mat in 0..=mats.iter().copied().max().unwrap_or(0) {
            let own = || (0..mats.len()).filter(|face| mats[*face] == mat);
            let nodes: Vec<_> = own().flat_map(|face| bodies[face].iter().cloned()).collect();
            if cells > 1 && !BaseNode::are_flat(&nodes) {
                let pieces: f64 = own().map(|face| 0.5 * (corners[face].len() as f64 - 2.0)).sum();
                let area = own().map(|face| faces[face].area()).sum::<f64>();
                let sides = Face::bounds(&faces).map(|[least, greatest]| greatest - least);
                let along = sides[0].min(sides[1]) * f64::sqrt(pieces / area);
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "> 0")]
                let along = (along * (1.0 - 1e-9)).ceil() as usize;
                let ratio = sides[0].max(sides[1]) / sides[0].min(sides[1]);
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "> 0")]
                let limit = (MOST_RAISED / ratio).sqrt() as usize;
                most = most.max(along.min(limit));
            }
        }
        Self::covering(faces, most, OVERHANG)
    }

    /// Cells under the faces of a structure; `None` for a structure in the plane.
    pub(in crate::bem) fn of_base(structure: &dyn Structure, cells: usize) -> Result<Option<Self>> {
        let is_in_plan = matches!(structure.base(), Base::Faces(_));
        is_in_plan.then(|| Self::under(structure, cells)).transpose()
    }

    fn covering(faces: Vec<Face>, cells: usize, overhang: f64) -> Result<Self> {
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
        let corner = [0, 1].map(|axis| {
            let middle = 0.5 * (bounds[axis][0] + bounds[axis][1]);
            middle - 0.5 * pitch[axis] * counts[axis] as f64
        });
        let mats = Face::mats(&faces);
        let owners = owners(&faces, &mats, [corner, pitch], counts, overhang)?;
        apart(&owners, counts[0], pitch)?;
        for mat in 0..=mats.iter().copied().max().unwrap_or(0) {
            if !owners.contains(&Some(mat)) {
                return Err(PlanError::NoCells { mat, pitch }.into());
            }
        }
        let mask: Vec<bool> = owners.iter().map(Option::is_some).collect();
        let area = faces.iter().map(Face::area).sum();
        let plan = Self::masked(corner, pitch, counts[0], &mask)?;
        let plan = Self { overhang, area, faces: (faces, cells), ..plan };
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

    /// Relative error of the area inside the outline, due to inner edges that lie between cell lines.
    pub fn area_error(&self) -> f64 {
        self.inside().iter().sum::<f64>() / self.area - 1.0
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
        Self { lattice, cells, overhang: 0.0, faces: (vec![], 0), owners, ..self.clone() }
    }

    /// Contact elements of several cells; `None` if each cell is one.
    pub(in crate::bem) fn unions(&self) -> Option<Unions> {
        self.owners.as_deref().map(Unions::new)
    }

    /// The contact elements.
    pub(in crate::bem) fn elements(&self) -> Vec<ContactElement> {
        let ends = |axis: usize, cell: &[usize; 2]| {
            [0, 1]
                .map(|end| self.corner[axis] + self.lattice.pitch[axis] * (cell[axis] + end) as f64)
        };
        let mut all: Vec<[[f64; 2]; 2]> = vec![];
        for (number, cell) in self.cells.iter().enumerate() {
            let own = [0, 1].map(|axis| ends(axis, cell));
            // Cells of a mat come row by row, and the first cell of an element before its others.
            match all.get_mut(self.owner(number)) {
                Some(sides) => (0..2).for_each(|k| sides[k][1] = sides[k][1].max(own[k][1])),
                None => all.push(own),
            }
        }
        let elements = all.into_iter().zip(self.fractions_inside());
        let element = |([along, across], inside): ([[f64; 2]; 2], f64)| {
            ContactElement::in_plan(along, across).with_fraction_inside(inside)
        };
        elements.map(element).collect()
    }

    /// Fraction of the area of each contact element that is inside the outline.
    fn fractions_inside(&self) -> Vec<f64> {
        let [a, b] = self.lattice.pitch;
        let mut sums: Vec<[f64; 2]> = vec![];
        for (number, inside) in self.inside().into_iter().enumerate() {
            let owner = self.owner(number);
            sums.resize(sums.len().max(owner + 1), [0.0; 2]);
            sums[owner][0] += inside;
            sums[owner][1] += a * b;
        }
        sums.into_iter().map(|[inside, all]| inside / all).collect()
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
fn check_faces(count: usize) -> Result<()> {
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
