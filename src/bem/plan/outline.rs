//! Cells cut at the outline of mats.
//!
//! In the soil a cut cell has the traction of a whole cell, in series with a spring. With the fraction g of the cell
//! inside, the spring increases the compliance C to about C/g, so that the force is proportional to the area inside. The
//! contact element is a rectangle of this area, whose centre is the centre of area. Pressures then have the resultants
//! of the outline.
//!
//! Oblique edges of rigid mats are shifted outwards by less than the overhang. The distance decreases with the number of
//! cells. Static stiffnesses of turned squares, polygons and discs then decrease steadily as the number of cells grows.
//! Oblique edges of flexible mats are shifted further, and the distance increases with the mat's flexibility: a load is
//! then in equilibrium with the pressure near it, and pressures at the edge have more influence. The distance and the
//! results are continuous in D.

use super::boundary::MatBoundary;
use super::region::{AREA_TOLERANCE, CellPart, PlanGrid, Region};

/// Overhang of outer cells beyond the outline of a rigid mat, as a fraction of their side.
pub(super) const RIGID_MAT_OVERHANG: f64 = 0.105;
/// Outward shift of oblique edges of rigid mats on many cells, in cells.
///
/// Fitted to discs and squares at several angles.
const RIGID_EDGE_SHIFT: f64 = 0.03;
/// Additional shift on few cells, in cells, times √n for n cells along the shorter side.
const FEW_CELLS_EDGE_SHIFT: f64 = 0.15;
/// Additional shift under very flexible mats, in cells.
///
/// Fitted to circular and turned square plates under loads on the edge, on walls and on the whole area, and to
/// containments that rock on rafts of D/(G R³) from 0.002 to 1. Rafts that rock under stiff walls confirm the value.
const SOFT_EDGE_SHIFT: f64 = 0.06;
/// Relative rigidity D/(G R³) that halves the additional shift under flexible mats; fitted with it.
const HALF_SHIFT_RIGIDITY: f64 = 0.15;
/// Largest shift of oblique edges of flexible mats, in cells; fitted to the same plates.
const MAX_EDGE_SHIFT: f64 = 0.12;
/// Largest shift of oblique edges of flexible mats, relative to the overhang; fitted to the same plates.
const MAX_SHIFT_PER_OVERHANG: f64 = 2.0;
/// Sine of the angle to the lattice at which an edge has the full shift of oblique edges.
const OBLIQUE_EDGE_SINE: f64 = 0.1;
/// Smallest fraction of a contact element's cell inside the shifted outline, because slivers would have very soft springs.
const MIN_INSIDE_FRACTION: f64 = 0.02;
/// Smallest area of a cut cell, relative to its part inside the shifted outline.
const MIN_CUT_AREA_RATIO: f64 = 0.25;
/// Smallest area of a mat with cells, relative to its area with shifted edges; a narrower mat has no cells.
const MIN_MAT_AREA_RATIO: f64 = 0.5;
/// Fraction by which the spring's compliance exceeds C/g − C if the cell is cut along a side, or nearly whole or empty.
const CUT_CELL_SOFTENING: f64 = 0.3;
/// Smallest area of a cut cell after the correction, relative to its smallest area before.
///
/// The latter is the product of the smallest ratio and the smallest fraction inside.
const MIN_CUT_AREA_MARGIN: f64 = 0.1;
/// Smallest fraction of a cell inside a mat for which the cell belongs to the mat: half, reduced by the rounding error.
const MIN_MEMBER_FRACTION: f64 = 0.5 - AREA_TOLERANCE;

/// A cell of a mat whose outline cuts cells.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CutCell {
    /// Ends along x and along y of the rectangle that is the contact element, m.
    pub(super) ends: [[f64; 2]; 2],
    /// Area of the rectangle, relative to a whole cell.
    pub(super) area_ratio: f64,
    /// Fraction of the rectangle inside the outline.
    pub(super) inside_fraction: f64,
    /// Compliance of the spring, relative to the cell's static compliance; zero for a whole cell.
    pub(super) spring_ratio: f64,
}

/// Mat of each cell of the lattice, and the cells of each mat.
pub(super) struct MatCells {
    /// Mat with most of each cell; `None` for a cell without a mat.
    pub(super) cell_mats: Vec<Option<usize>>,
    /// Cells of each mat; a mat that is too narrow has no cells.
    pub(super) mats: Vec<CellsOfMat>,
}

/// Cells of a mat row by row, each with its contact element.
#[derive(Default)]
pub(super) struct CellsOfMat {
    /// Column and row of each cell.
    pub(super) cells: Vec<[usize; 2]>,
    /// Contact element of each cell; empty if all cells of all mats are whole.
    pub(super) cut_cells: Vec<CutCell>,
}

/// A cell of a mat.
#[derive(Clone, Copy)]
struct MatCell {
    /// Column and row.
    cell: [usize; 2],
    /// Part inside the shifted outline.
    shifted_part: CellPart,
    /// Fraction inside the outline.
    inside_fraction: f64,
}

impl MatCell {
    /// Area of the cell's contact element before the correction for slivers and shared cells, in cells.
    fn uncorrected_area(&self) -> f64 {
        if self.shifted_part.is_cut() {
            self.inside_fraction.max(MIN_CUT_AREA_RATIO * self.shifted_part.area)
        } else {
            self.inside_fraction
        }
    }

    /// Weight of a cut cell in the correction of areas; largest for half a cell.
    fn correction_weight(&self) -> f64 {
        if self.shifted_part.is_cut() {
            self.uncorrected_area() * (1.0 - self.uncorrected_area())
        } else {
            0.0
        }
    }
}

/// Assigns each cell of a lattice to a mat, and cuts the cells at the outlines of the mats.
///
/// `rigidity`: D/(G R³), infinite for rigid mats.
pub(super) fn assign_cells(
    mats: &[MatBoundary],
    grid: PlanGrid,
    overhang: f64,
    rigidity: f64,
) -> MatCells {
    let oblique_shift = oblique_edge_shift(grid, overhang, rigidity);
    let edge_shift = |normal: [f64; 2]| {
        // From 1 for an edge along the lattice to 0 for an oblique edge.
        let parallelism = (1.0 - normal[0].abs().min(normal[1].abs()) / OBLIQUE_EDGE_SINE).max(0.0);
        let shift = oblique_shift + (overhang - oblique_shift) * parallelism;
        shift * (normal[0] * grid.pitch[0]).hypot(normal[1] * grid.pitch[1])
    };
    let mut regions = vec![];
    let mut shifted_regions = vec![];
    for mat in mats {
        regions.push(Region::new(&mat.loops, grid));
        shifted_regions.push(Region::new(&mat.shifted_outwards(edge_shift), grid));
    }
    let mut areas = vec![0.0; mats.len()];
    let mut mat_cells: Vec<Vec<MatCell>> = mats.iter().map(|_| vec![]).collect();
    let mut cell_mats = vec![None; grid.counts[0] * grid.counts[1]];
    for (index, cell_mat) in cell_mats.iter_mut().enumerate() {
        let cell = [index % grid.counts[0], index / grid.counts[0]];
        let mut largest_mat = 0;
        let mut largest_part =
            MatCell { cell, shifted_part: CellPart::EMPTY_PART, inside_fraction: 0.0 };
        for (mat, area) in areas.iter_mut().enumerate() {
            let shifted_part = shifted_regions[mat].part(cell);
            if !shifted_part.is_empty() {
                let inside_fraction = regions[mat].part(cell).area;
                *area += inside_fraction;
                if shifted_part.area > largest_part.shifted_part.area {
                    largest_mat = mat;
                    largest_part = MatCell { cell, shifted_part, inside_fraction };
                }
            }
        }
        let largest_area = largest_part.shifted_part.area;
        *cell_mat = (largest_area >= MIN_MEMBER_FRACTION).then_some(largest_mat);
        if largest_area >= MIN_INSIDE_FRACTION {
            mat_cells[largest_mat].push(largest_part);
        }
    }
    let has_cut_cells = mat_cells.iter().flatten().any(|mat_cell| mat_cell.shifted_part.is_cut());
    let mut cells_of_mats = vec![];
    for (mat_cells, area) in mat_cells.iter().zip(areas) {
        let shifted_area = mat_cells.iter().map(|mat_cell| mat_cell.shifted_part.area).sum::<f64>();
        if area < MIN_MAT_AREA_RATIO * shifted_area {
            cells_of_mats.push(CellsOfMat::default());
            continue;
        }
        let cells = mat_cells.iter().map(|mat_cell| mat_cell.cell).collect();
        let cut_cells = if has_cut_cells { grid.cut_cells(mat_cells, area) } else { vec![] };
        cells_of_mats.push(CellsOfMat { cells, cut_cells });
    }
    MatCells { cell_mats, mats: cells_of_mats }
}

/// Outward shift of oblique edges, in cells.
fn oblique_edge_shift(grid: PlanGrid, overhang: f64, rigidity: f64) -> f64 {
    let shorter_side_cells = grid.counts[0].min(grid.counts[1]) as f64;
    let flexibility_shift = SOFT_EDGE_SHIFT / (1.0 + rigidity / HALF_SHIFT_RIGIDITY);
    let shift =
        RIGID_EDGE_SHIFT + FEW_CELLS_EDGE_SHIFT / shorter_side_cells.sqrt() + flexibility_shift;
    if rigidity.is_infinite() {
        shift.min(overhang)
    } else {
        shift.min(MAX_EDGE_SHIFT.min(MAX_SHIFT_PER_OVERHANG * overhang))
    }
}

impl PlanGrid {
    /// Contact elements of the cells of a mat with this area, in cells.
    ///
    /// The area of slivers and of cells shared with other mats is added to the other cut cells, mostly to half cells.
    fn cut_cells(&self, cells: &[MatCell], area: f64) -> Vec<CutCell> {
        let missing_area = area - cells.iter().map(MatCell::uncorrected_area).sum::<f64>();
        let weight_sum: f64 = cells.iter().map(MatCell::correction_weight).sum();
        let correction = if weight_sum > 0.0 { missing_area / weight_sum } else { 0.0 };
        let mut cut_cells: Vec<CutCell> = cells
            .iter()
            .map(|mat_cell| {
                let cell_area =
                    mat_cell.uncorrected_area() + correction * mat_cell.correction_weight();
                self.cut_cell(mat_cell.cell, &mat_cell.shifted_part, cell_area)
            })
            .collect();
        // Cells that lie in the overhang alone make the total area too large: the areas of whole cells are reduced.
        let mut whole_area = 0.0;
        let mut cut_area = 0.0;
        for cut_cell in &cut_cells {
            let sum = if cut_cell.spring_ratio == 0.0 { &mut whole_area } else { &mut cut_area };
            *sum += cut_cell.area_ratio * cut_cell.inside_fraction;
        }
        let reduction = (area - cut_area) / whole_area;
        for cut_cell in cut_cells.iter_mut().filter(|cut_cell| cut_cell.spring_ratio == 0.0) {
            cut_cell.inside_fraction = (reduction * cut_cell.inside_fraction).min(1.0);
        }
        cut_cells
    }

    /// Contact element of a cell with this `area` (in cells): the cell itself, or a rectangle about the centre of area.
    fn cut_cell(&self, cell: [usize; 2], part: &CellPart, area: f64) -> CutCell {
        let mut center = [0.5; 2];
        let mut half_sides = [0.5; 2];
        let mut spring_ratio = 0.0;
        let mut inside_fraction = area.min(1.0);
        if part.is_cut() {
            let min_area = MIN_CUT_AREA_MARGIN * MIN_CUT_AREA_RATIO * MIN_INSIDE_FRACTION;
            let rectangle_area = area.clamp(min_area, 1.0);
            half_sides = rectangle_half_sides(part.center, rectangle_area);
            center = [0, 1].map(|k| part.center[k].clamp(half_sides[k], 1.0 - half_sides[k]));
            let distance_from_half = 2.0 * part.area - 1.0;
            let softening =
                if part.is_rectangle { 1.0 } else { distance_from_half * distance_from_half };
            spring_ratio = (1.0 / part.area - 1.0) * (1.0 + CUT_CELL_SOFTENING * softening);
            inside_fraction = 1.0;
        }
        let ends = [0, 1].map(|k| {
            [-half_sides[k], half_sides[k]].map(|half_side| {
                self.corner[k] + self.pitch[k] * (cell[k] as f64 + center[k] + half_side)
            })
        });
        let area_ratio = 4.0 * half_sides[0] * half_sides[1];
        CutCell { ends, area_ratio, inside_fraction, spring_ratio }
    }
}

/// Half sides of a rectangle of an `area` (in cells) about a centre, no longer than half a cell.
///
/// Their ratio is the ratio of the distances from the centre to the nearest sides of the cell.
fn rectangle_half_sides(center: [f64; 2], area: f64) -> [f64; 2] {
    let side_distances = center.map(|x| x.min(1.0 - x));
    let scale = (0.25 * area / (side_distances[0] * side_distances[1])).sqrt();
    let mut half_sides = side_distances.map(|x| x * scale);
    for axis in 0..2 {
        if half_sides[axis] > 0.5 {
            half_sides[axis] = 0.5;
            half_sides[1 - axis] = 0.5 * area;
        }
    }
    half_sides
}
