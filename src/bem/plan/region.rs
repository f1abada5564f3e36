//! Part of a cell inside closed lines.

use crate::geometry::span;
use crate::linalg::gauss::Rule;

/// Area that counts as rounding, in cells.
const AREA_TOLERANCE: f64 = 1e-9;

/// Lattice with its place: corner (m), sides of a cell (m), columns and rows.
#[derive(Clone, Copy)]
pub(super) struct PlanGrid {
    pub(super) corner: [f64; 2],
    pub(super) pitch: [f64; 2],
    pub(super) counts: [usize; 2],
}

/// Points about which closed lines turn counter-clockwise at least once, row by row of a lattice.
pub(super) struct Region {
    /// Edges of the lines in each row, from its first corner in units of the cells' sides.
    rows: Vec<Vec<CellEdge>>,
}

/// Ends of an edge.
type CellEdge = [[f64; 2]; 2];

/// Part of a unit cell.
#[derive(Clone, Copy)]
pub(super) struct CellPart {
    pub(super) area: f64,
    pub(super) center: [f64; 2],
    pub(super) is_rectangle: bool,
}

impl PlanGrid {
    /// A point in units of the cells' sides.
    fn place(&self, point: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|k| (point[k] - self.corner[k]) / self.pitch[k])
    }
}

impl Region {
    /// Inside of closed `lines`, m.
    pub(super) fn new(lines: &[Vec<[f64; 2]>], grid: PlanGrid) -> Self {
        let mut rows = vec![vec![]; grid.counts[1]];
        for corners in lines {
            for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
                let edge = [a, b].map(|p| grid.place(*p));
                let rows_of_edge = span(edge.iter().map(|p| p[1]));
                for (row, edges) in rows.iter_mut().enumerate() {
                    let row = row as f64;
                    if rows_of_edge[0] <= row + 1.0 && rows_of_edge[1] >= row {
                        edges.push(edge.map(|[x, y]| [x, y - row]));
                    }
                }
            }
        }
        Self { rows }
    }

    /// The part inside the lines of the cell in this column and row.
    pub(super) fn part(&self, [column, row]: [usize; 2]) -> CellPart {
        let column = column as f64;
        let edges: Vec<CellEdge> =
            self.rows[row].iter().map(|edge| edge.map(|[x, y]| [x - column, y])).collect();
        let levels = levels(&edges);
        let mut area = 0.0;
        let mut moments = [0.0; 2];
        let mut across = [f64::INFINITY, 0.0_f64];
        let mut along = [f64::INFINITY, 0.0_f64];
        let rule = Rule::new(3);
        let mut crossings = Vec::with_capacity(edges.len());
        // Between levels the ends of each span are linear in y.
        for pair in levels.windows(2).filter(|pair| pair[1] > pair[0]) {
            for (x, weight) in rule.points_on_unit_interval() {
                let y = pair[0] + x * (pair[1] - pair[0]);
                let weight = weight * (pair[1] - pair[0]);
                cross(&edges, y, &mut crossings);
                let mut turns = 0;
                let mut begin = 0.0;
                for &(x, turn) in &crossings {
                    let was_inside = turns > 0;
                    turns += turn;
                    if !was_inside {
                        begin = x;
                    }
                    let low = begin.clamp(0.0, 1.0);
                    let high = x.clamp(0.0, 1.0);
                    if was_inside && turns <= 0 && high > low {
                        area += weight * (high - low);
                        moments[0] += weight * 0.5 * (high * high - low * low);
                        moments[1] += weight * (high - low) * y;
                        across = [across[0].min(low), across[1].max(high)];
                        along = [along[0].min(pair[0]), along[1].max(pair[1])];
                    }
                }
            }
        }
        let is_rectangle = area > (across[1] - across[0]) * (along[1] - along[0]) - AREA_TOLERANCE;
        CellPart { area, center: moments.map(|moment| moment / area), is_rectangle }
    }
}

impl CellPart {
    pub(super) const EMPTY_PART: Self = Self { area: 0.0, center: [0.5; 2], is_rectangle: false };

    pub(super) fn is_cut(&self) -> bool {
        self.area < 1.0 - AREA_TOLERANCE
    }

    pub(super) fn is_empty(&self) -> bool {
        self.area <= AREA_TOLERANCE
    }
}

/// Heights in the unit cell at which edges end, cross its sides or each other, ascending, with its lower and upper end.
fn levels(edges: &[CellEdge]) -> Vec<f64> {
    let beside = |edge: &CellEdge| {
        let columns = span(edge.iter().map(|p| p[0]));
        columns[1] >= 0.0 && columns[0] <= 1.0
    };
    let near: Vec<&CellEdge> = edges.iter().filter(|edge| beside(edge)).collect();
    let mut levels = vec![0.0, 1.0];
    for (k, [a, b]) in near.iter().enumerate() {
        let step = [b[0] - a[0], b[1] - a[1]];
        levels.extend([a[1], b[1]]);
        levels.extend([0.0, 1.0].map(|x| a[1] + (x - a[0]) / step[0] * step[1]));
        for [c, d] in &near[..k] {
            let other = [d[0] - c[0], d[1] - c[1]];
            let sine = step[0] * other[1] - step[1] * other[0];
            let apart = [c[0] - a[0], c[1] - a[1]];
            let ratio = (apart[0] * other[1] - apart[1] * other[0]) / sine;
            let beyond = (apart[0] * step[1] - apart[1] * step[0]) / sine;
            if [ratio, beyond].iter().all(|part| (0.0..=1.0).contains(part)) {
                levels.push(a[1] + ratio * step[1]);
            }
        }
    }
    levels.retain(|y| (0.0..=1.0).contains(y));
    levels.sort_by(f64::total_cmp);
    levels
}

/// Places where edges cross a line of constant y, from left to right, and by how much the turns about a point rise there.
fn cross(edges: &[CellEdge], y: f64, crossings: &mut Vec<(f64, i32)>) {
    crossings.clear();
    for [a, b] in edges {
        if (a[1] < y) != (b[1] < y) {
            let x = a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
            crossings.push((x, if b[1] < a[1] { 1 } else { -1 }));
        }
    }
    crossings.sort_by(|one, other| one.0.total_cmp(&other.0));
}
