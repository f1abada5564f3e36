//! Cells cut at the outline of mats.
//!
//! A cut cell has the traction of a whole cell in the soil, in series with a spring: with the fraction g of the cell
//! inside, its compliance C becomes about C/g, so that its force is proportional to the area inside. In the scene it is
//! a rectangle of this area, whose centre is the centre of area. Pressures then have the resultants of the outline.
//!
//! Oblique edges of rigid mats are moved outwards by less than the overhang, and by a smaller distance on more cells.
//! Static stiffnesses of turned squares, polygons and discs then decrease steadily as the number of cells grows. Oblique
//! edges of flexible mats move further, and the more so the softer the mat is: a load is then in equilibrium with the
//! pressure near it, and pressures at the edge have more influence. The distance is continuous in D, and so are results.

use super::boundary::MatBoundary;
use super::region::{CellPart, PlanGrid, Region};

/// Overhang of outer cells beyond the outline of a rigid mat, as a fraction of their side.
pub(super) const RIGID_MAT_OVERHANG: f64 = 0.105;
/// Distance by which oblique edges of rigid mats on many cells move outwards, in cells.
///
/// Fitted to discs and squares at several angles.
const RIGID_EDGE_SHIFT: f64 = 0.03;
/// Additional distance on few cells, in cells: it is divided by √n for n cells along the shorter side.
const FEW_CELLS_EDGE_SHIFT: f64 = 0.15;
/// Additional distance under very soft mats, in cells.
///
/// Fitted to circular plates and turned square ones under loads on the edge, on walls and everywhere, and to
/// containments that rock on rafts of D/(G R³) from 0.002 to 1. Rafts that rock under stiff walls confirm it.
const SOFT_EDGE_SHIFT: f64 = 0.06;
/// D/(G R³) that halves the additional distance under soft mats.
const HALF_SHIFT_RIGIDITY: f64 = 0.15;
/// Largest distance by which oblique edges of flexible mats move, in cells.
const MAX_EDGE_SHIFT: f64 = 0.12;
/// Largest distance by which oblique edges of flexible mats move, relative to the overhang.
const MAX_SHIFT_PER_OVERHANG: f64 = 2.0;
/// Sine of the angle to the lattice from which an edge is oblique.
const OBLIQUE_EDGE_SINE: f64 = 0.1;
/// Smallest fraction of a cell inside that makes it a contact element.
const MIN_INSIDE_FRACTION: f64 = 0.02;
/// Smallest area of a cut cell, relative to its part inside the moved outline.
const MIN_CUT_AREA_RATIO: f64 = 0.25;
/// Smallest area of a mat, relative to its area with edges moved outwards.
const MIN_MAT_AREA_RATIO: f64 = 0.5;
/// Fraction by which the spring of a cell is softer than C/g − C if it is cut along a side, or nearly whole or empty.
const CUT_CELL_SOFTENING: f64 = 0.3;
/// Fraction of a cell that counts as rounding.
const AREA_TOLERANCE: f64 = 1e-9;
/// Fraction of a cell inside a mat above which the cell belongs to it.
const MEMBER_FRACTION: f64 = 0.5 - AREA_TOLERANCE;

/// A cell of a mat whose outline cuts cells.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CutCell {
    /// Ends along x and along y of the rectangle that is the contact element, m.
    pub(super) ends: [[f64; 2]; 2],
    /// Ratio of the rectangle's area to the whole cell's.
    pub(super) size: f64,
    /// Fraction of the rectangle inside the outline.
    pub(super) inside: f64,
    /// Compliance of the spring, relative to the cell's static compliance; zero for a whole cell.
    pub(super) softness: f64,
}

/// Cells of a mat row by row, and their cuts.
#[derive(Default)]
pub(super) struct CellsOfMat {
    pub(super) cells: Vec<[usize; 2]>,
    /// Empty if all cells of all mats are whole.
    pub(super) cuts: Vec<CutCell>,
}

/// A cell of a mat.
#[derive(Clone, Copy)]
struct MatCell {
    /// Column and row.
    cell: [usize; 2],
    /// Part inside the moved outline.
    part: CellPart,
    /// Fraction inside the outline.
    inside: f64,
}

impl MatCell {
    /// First guess of the cell's area in the scene, in cells.
    fn first_area(&self) -> f64 {
        if self.part.is_cut() {
            self.inside.max(MIN_CUT_AREA_RATIO * self.part.area)
        } else {
            self.inside
        }
    }

    /// Weight with which a cut cell takes area that the first guesses leave; largest for half a cell.
    fn correction_weight(&self) -> f64 {
        if self.part.is_cut() { self.first_area() * (1.0 - self.first_area()) } else { 0.0 }
    }
}

/// Mat to which most of each cell belongs, and the cells of each mat.
///
/// `rigidity`: D/(G R³), infinite for rigid mats. A mat that is too narrow has no cells.
pub(super) fn cells_of_mats(
    mats: &[MatBoundary],
    grid: PlanGrid,
    overhang: f64,
    rigidity: f64,
) -> (Vec<Option<usize>>, Vec<CellsOfMat>) {
    let oblique_shift = oblique_edge_shift(grid, overhang, rigidity);
    let edge_shift = |normal: [f64; 2]| {
        let parallel = (1.0 - normal[0].abs().min(normal[1].abs()) / OBLIQUE_EDGE_SINE).max(0.0);
        let shift = oblique_shift + (overhang - oblique_shift) * parallel;
        shift * (normal[0] * grid.pitch[0]).hypot(normal[1] * grid.pitch[1])
    };
    let mut inner = vec![];
    let mut outer = vec![];
    for mat in mats {
        inner.push(Region::new(&mat.loops, grid));
        outer.push(Region::new(&mat.moved_outwards(edge_shift), grid));
    }
    let mut areas = vec![0.0; mats.len()];
    let mut found: Vec<Vec<MatCell>> = mats.iter().map(|_| vec![]).collect();
    let mut owners = vec![None; grid.counts[0] * grid.counts[1]];
    for (place, owner) in owners.iter_mut().enumerate() {
        let cell = [place % grid.counts[0], place / grid.counts[0]];
        let mut best_mat = 0;
        let mut best = MatCell { cell, part: CellPart::EMPTY_PART, inside: 0.0 };
        for (mat, area) in areas.iter_mut().enumerate() {
            let part = outer[mat].part(cell);
            if !part.is_empty() {
                let inside = inner[mat].part(cell).area;
                *area += inside;
                if part.area > best.part.area {
                    best_mat = mat;
                    best = MatCell { cell, part, inside };
                }
            }
        }
        *owner = (best.part.area >= MEMBER_FRACTION).then_some(best_mat);
        if best.part.area >= MIN_INSIDE_FRACTION {
            found[best_mat].push(best);
        }
    }
    let is_cut = found.iter().flatten().any(|mat_cell| mat_cell.part.is_cut());
    let mut cells_of_mats = vec![];
    for (mat_cells, area) in found.iter().zip(areas) {
        let part_area = mat_cells.iter().map(|mat_cell| mat_cell.part.area).sum::<f64>();
        if area < MIN_MAT_AREA_RATIO * part_area {
            cells_of_mats.push(CellsOfMat::default());
            continue;
        }
        let cells = mat_cells.iter().map(|mat_cell| mat_cell.cell).collect();
        let cuts = if is_cut { grid.cuts(mat_cells, area) } else { vec![] };
        cells_of_mats.push(CellsOfMat { cells, cuts });
    }
    (owners, cells_of_mats)
}

/// Distance by which oblique edges move outwards, in cells.
fn oblique_edge_shift(grid: PlanGrid, overhang: f64, rigidity: f64) -> f64 {
    let cells_along = grid.counts[0].min(grid.counts[1]) as f64;
    let soft_shift = SOFT_EDGE_SHIFT / (1.0 + rigidity / HALF_SHIFT_RIGIDITY);
    let shift = RIGID_EDGE_SHIFT + FEW_CELLS_EDGE_SHIFT / cells_along.sqrt() + soft_shift;
    if rigidity.is_infinite() {
        shift.min(overhang)
    } else {
        shift.min(MAX_EDGE_SHIFT.min(MAX_SHIFT_PER_OVERHANG * overhang))
    }
}

impl PlanGrid {
    /// Cuts of the cells of a mat with this area, in cells.
    ///
    /// The area of slivers and of cells shared with other mats is added to the other cut cells, mostly to half cells.
    fn cuts(&self, cells: &[MatCell], area: f64) -> Vec<CutCell> {
        let missing = area - cells.iter().map(MatCell::first_area).sum::<f64>();
        let weights: f64 = cells.iter().map(MatCell::correction_weight).sum();
        let ratio = if weights > 0.0 { missing / weights } else { 0.0 };
        let mut cuts: Vec<CutCell> = cells
            .iter()
            .map(|mat_cell| {
                let cell_area = mat_cell.first_area() + ratio * mat_cell.correction_weight();
                self.cut(mat_cell.cell, &mat_cell.part, cell_area)
            })
            .collect();
        // Cells that lie in the overhang alone have too much area together: whole cells are reduced for it.
        let mut whole_area = 0.0;
        let mut cut_area = 0.0;
        for cut in &cuts {
            let sum = if cut.softness == 0.0 { &mut whole_area } else { &mut cut_area };
            *sum += cut.size * cut.inside;
        }
        let ratio = (area - cut_area) / whole_area;
        for cut in cuts.iter_mut().filter(|cut| cut.softness == 0.0) {
            cut.inside = (ratio * cut.inside).min(1.0);
        }
        cuts
    }

    /// Contact element of a cell: the cell, or a rectangle of this `area` (in cells) about the centre of area.
    fn cut(&self, cell: [usize; 2], part: &CellPart, area: f64) -> CutCell {
        let mut center = [0.5; 2];
        let mut half_sides = [0.5; 2];
        let mut softness = 0.0;
        if part.is_cut() {
            let area = area.clamp(0.1 * MIN_CUT_AREA_RATIO * MIN_INSIDE_FRACTION, 1.0);
            half_sides = part.center.map(|x| x.min(1.0 - x));
            let scale = (0.25 * area / (half_sides[0] * half_sides[1])).sqrt();
            half_sides = half_sides.map(|x| x * scale);
            for axis in 0..2 {
                if half_sides[axis] > 0.5 {
                    half_sides[axis] = 0.5;
                    half_sides[1 - axis] = 0.5 * area;
                }
            }
            center = [0, 1].map(|k| part.center[k].clamp(half_sides[k], 1.0 - half_sides[k]));
            let from_half = 2.0 * part.area - 1.0;
            let softening = if part.is_rectangle { 1.0 } else { from_half * from_half };
            softness = (1.0 / part.area - 1.0) * (1.0 + CUT_CELL_SOFTENING * softening);
        }
        let ends = [0, 1].map(|k| {
            [-half_sides[k], half_sides[k]]
                .map(|side| self.corner[k] + self.pitch[k] * (cell[k] as f64 + center[k] + side))
        });
        let inside = if part.is_cut() { 1.0 } else { area.min(1.0) };
        CutCell { ends, size: 4.0 * half_sides[0] * half_sides[1], inside, softness }
    }
}
