//! Part of a cell inside closed lines.

use crate::geometry::span;
use crate::linalg::gauss::Rule;

/// Bound of the rounding error of the area of a part of a cell, in cells.
pub(super) const AREA_TOLERANCE: f64 = 1e-9;
/// Number of Gauss points between two levels.
///
/// Three points are exact for the moments of segments whose ends are linear in y.
const LEVEL_POINT_COUNT: usize = 3;

/// Lattice in plan.
#[derive(Clone, Copy)]
pub(super) struct PlanGrid {
    /// Smallest coordinates, m.
    pub(super) corner: [f64; 2],
    /// Sides of a cell, m.
    pub(super) pitch: [f64; 2],
    /// Numbers of columns and rows.
    pub(super) counts: [usize; 2],
}

/// Inside of closed lines, from which the part inside each cell of a lattice is computed.
///
/// A point is inside if the sum of the lines' counter-clockwise turns about it is at least one.
pub(super) struct Region {
    /// Edges of the lines in each row, relative to the corner of the row's first cell in units of the cells' sides.
    rows: Vec<Vec<CellEdge>>,
}

/// Ends of an edge, in units of the cells' sides.
type CellEdge = [[f64; 2]; 2];

/// Part of a unit cell inside an outline.
#[derive(Clone, Copy)]
pub(super) struct CellPart {
    /// Area, in cells.
    pub(super) area: f64,
    /// Centre of area, from the cell's first corner in units of its sides.
    pub(super) center: [f64; 2],
    /// Whether the part is a rectangle along the cell's sides.
    pub(super) is_rectangle: bool,
}

impl PlanGrid {
    /// Coordinates of a point from the corner, in units of the cells' sides.
    fn cell_coordinates(&self, point: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|k| (point[k] - self.corner[k]) / self.pitch[k])
    }
}

impl Region {
    /// Inside of closed `lines`, m.
    pub(super) fn new(lines: &[Vec<[f64; 2]>], grid: PlanGrid) -> Self {
        let mut rows = vec![vec![]; grid.counts[1]];
        for corners in lines {
            for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
                let edge = [a, b].map(|point| grid.cell_coordinates(*point));
                let y_range = span(edge.iter().map(|point| point[1]));
                for (row, edges) in rows.iter_mut().enumerate() {
                    let row_start = row as f64;
                    if y_range[0] <= row_start + 1.0 && y_range[1] >= row_start {
                        edges.push(edge.map(|[x, y]| [x, y - row_start]));
                    }
                }
            }
        }
        Self { rows }
    }

    /// The part inside the lines of the cell in this column and row.
    pub(super) fn part(&self, [column, row]: [usize; 2]) -> CellPart {
        let column_start = column as f64;
        let edges: Vec<CellEdge> =
            self.rows[row].iter().map(|edge| edge.map(|[x, y]| [x - column_start, y])).collect();
        let mut area = 0.0;
        let mut moments = [0.0; 2];
        let mut x_extent = [f64::INFINITY, 0.0_f64];
        let mut y_extent = [f64::INFINITY, 0.0_f64];
        let rule = Rule::new(LEVEL_POINT_COUNT);
        let mut crossings = Vec::with_capacity(edges.len());
        // Between levels the ends of each segment inside are linear in y.
        for interval in levels(&edges).windows(2).filter(|ends| ends[1] > ends[0]) {
            for (fraction, rule_weight) in rule.points_on_unit_interval() {
                let y = interval[0] + fraction * (interval[1] - interval[0]);
                let weight = rule_weight * (interval[1] - interval[0]);
                find_crossings(&edges, y, &mut crossings);
                let mut turn_count = 0;
                let mut segment_start = 0.0;
                for &(x, turn) in &crossings {
                    let was_inside = turn_count > 0;
                    turn_count += turn;
                    if !was_inside {
                        segment_start = x;
                    }
                    let min_x = segment_start.clamp(0.0, 1.0);
                    let max_x = x.clamp(0.0, 1.0);
                    if was_inside && turn_count <= 0 && max_x > min_x {
                        area += weight * (max_x - min_x);
                        moments[0] += weight * 0.5 * (max_x * max_x - min_x * min_x);
                        moments[1] += weight * (max_x - min_x) * y;
                        x_extent = [x_extent[0].min(min_x), x_extent[1].max(max_x)];
                        y_extent = [y_extent[0].min(interval[0]), y_extent[1].max(interval[1])];
                    }
                }
            }
        }
        let rectangle_area = (x_extent[1] - x_extent[0]) * (y_extent[1] - y_extent[0]);
        let is_rectangle = area > rectangle_area - AREA_TOLERANCE;
        CellPart { area, center: moments.map(|moment| moment / area), is_rectangle }
    }
}

impl CellPart {
    /// Part of a cell outside the outline.
    pub(super) const EMPTY_PART: Self = Self { area: 0.0, center: [0.5; 2], is_rectangle: false };

    /// Whether some of the cell lies outside the outline.
    pub(super) fn is_cut(&self) -> bool {
        self.area < 1.0 - AREA_TOLERANCE
    }

    /// Whether the whole cell lies outside the outline.
    pub(super) fn is_empty(&self) -> bool {
        self.area <= AREA_TOLERANCE
    }
}

/// Values of y between which no edge in the unit cell ends, crosses a side of the cell or crosses another edge.
///
/// Ascending, from 0 to 1.
fn levels(edges: &[CellEdge]) -> Vec<f64> {
    let overlaps_cell = |edge: &CellEdge| {
        let x_range = span(edge.iter().map(|point| point[0]));
        x_range[1] >= 0.0 && x_range[0] <= 1.0
    };
    let cell_edges: Vec<&CellEdge> = edges.iter().filter(|edge| overlaps_cell(edge)).collect();
    let mut levels = vec![0.0, 1.0];
    for (k, [a, b]) in cell_edges.iter().enumerate() {
        let edge = [b[0] - a[0], b[1] - a[1]];
        levels.extend([a[1], b[1]]);
        levels.extend([0.0, 1.0].map(|x| a[1] + (x - a[0]) / edge[0] * edge[1]));
        for [c, d] in &cell_edges[..k] {
            let other_edge = [d[0] - c[0], d[1] - c[1]];
            let sine = edge[0] * other_edge[1] - edge[1] * other_edge[0];
            let offset = [c[0] - a[0], c[1] - a[1]];
            let fraction = (offset[0] * other_edge[1] - offset[1] * other_edge[0]) / sine;
            let other_fraction = (offset[0] * edge[1] - offset[1] * edge[0]) / sine;
            if (0.0..=1.0).contains(&fraction) && (0.0..=1.0).contains(&other_fraction) {
                levels.push(a[1] + fraction * edge[1]);
            }
        }
    }
    levels.retain(|y| (0.0..=1.0).contains(y));
    levels.sort_by(f64::total_cmp);
    levels
}

/// Overwrites `crossings` with the x at which edges cross a line of constant y, ascending.
///
/// Each crossing has the change of the number of turns about points to its right: 1 or −1.
fn find_crossings(edges: &[CellEdge], y: f64, crossings: &mut Vec<(f64, i32)>) {
    crossings.clear();
    for [a, b] in edges {
        if (a[1] < y) != (b[1] < y) {
            let x = a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
            crossings.push((x, if b[1] < a[1] { 1 } else { -1 }));
        }
    }
    crossings.sort_by(|one, other| one.0.total_cmp(&other.0));
}
