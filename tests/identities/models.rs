//! Finite-element models of scenes.

use super::blueprint::{Blueprint, Piece, QuadLaw};
use super::numbers::Numbers;

/// Young's modulus of a model with about this frequency (Hz) as a cantilever of the numbers' size, Pa.
fn young(numbers: &Numbers) -> f64 {
    // Shear beam: f = √(G/ρ)/(4 h).
    let shear = numbers.density * (4.0 * numbers.height * numbers.frequency).powi(2);
    // Bases bend little on their elements.
    (2.4 * shear).max(3.0 * numbers.modulus)
}

/// Columns and rows of a structure of quadrilaterals.
const QUAD_COLUMNS: usize = 3;
const QUAD_ROWS: usize = 2;

/// Quadrilaterals of four or eight nodes on a base along x.
pub(crate) fn quads(numbers: &Numbers, has_eight_nodes: bool) -> Blueprint {
    // Intervals between nodes along a side.
    let parts = if has_eight_nodes { 2 } else { 1 };
    let mut plan = Blueprint::new(false, young(numbers), numbers.density);
    let mut nodes = vec![vec![usize::MAX; parts * QUAD_COLUMNS + 1]; parts * QUAD_ROWS + 1];
    for (row, line) in nodes.iter_mut().enumerate() {
        for (column, node) in line.iter_mut().enumerate() {
            if row % parts == 0 || column % parts == 0 {
                let x = numbers.sides[0] * (column as f64 / (parts * QUAD_COLUMNS) as f64 - 0.5);
                // The rows are shifted sideways with height.
                let z = numbers.height * row as f64 / (parts * QUAD_ROWS) as f64;
                *node = plan.point([x + 0.1 * z * numbers.eccentricity[0], 0.0, z]);
            }
        }
    }
    for row in 0..QUAD_ROWS {
        for column in 0..QUAD_COLUMNS {
            let r = parts * row;
            let c = parts * column;
            let corners =
                [[0, 0], [0, 1], [1, 1], [1, 0]].map(|[i, j]| nodes[r + parts * i][c + parts * j]);
            if has_eight_nodes {
                let middles = [[0, 1], [1, 2], [2, 1], [1, 0]].map(|[i, j]| nodes[r + i][c + j]);
                let mut points = [0; 8];
                points[..4].copy_from_slice(&corners);
                points[4..].copy_from_slice(&middles);
                plan.pieces.push(Piece::Quad8(points));
            } else {
                plan.pieces.push(Piece::Quad(corners));
            }
        }
    }
    plan.damping = 0.03;
    plan.top = nodes[parts * QUAD_ROWS][parts * QUAD_COLUMNS];
    plan
}

/// Quadrilaterals of clay that yields under its weight and the shaking, and carries both.
pub(crate) fn clay(numbers: &Numbers) -> Blueprint {
    Blueprint { quad_law: QuadLaw::Clay(1.5 * numbers.pressure()), ..quads(numbers, true) }
}

/// Quadrilaterals of sand with cohesion that yields under its weight and the shaking, and carries both.
pub(crate) fn sand(numbers: &Numbers) -> Blueprint {
    Blueprint { quad_law: QuadLaw::Sand(0.8 * numbers.pressure()), ..quads(numbers, false) }
}

/// A plane frame of two bays on a stiff base, with masses that are not symmetric.
pub(crate) fn frame(numbers: &Numbers) -> Blueprint {
    let mut plan = Blueprint::new(false, 30e9, 2500.0);
    let x = [-0.5, 0.0, 0.5].map(|part| part * numbers.sides[0]);
    let levels = [0.0, 0.45, 1.0].map(|part| part * numbers.height);
    let nodes = levels.map(|z| x.map(|x| plan.point([x, 0.0, z])));
    for level in 0..3 {
        let depth = if level == 0 { 1.0 } else { 0.4 };
        for bay in 0..2 {
            let ends = [nodes[level][bay], nodes[level][bay + 1]];
            plan.pieces.push(Piece::Beam(ends, depth));
        }
    }
    for column in 0..3 {
        for storey in 0..2 {
            let ends = [nodes[storey][column], nodes[storey + 1][column]];
            plan.pieces.push(Piece::Beam(ends, 0.25 + 0.05 * column as f64));
        }
    }
    let mass = 0.1 * numbers.mass(false);
    plan.pieces.push(Piece::Mass(nodes[2][0], 1.2 * mass));
    plan.pieces.push(Piece::Mass(nodes[2][2], mass));
    plan.pieces.push(Piece::Dashpot([nodes[0][0], nodes[2][2]], 0.2 * mass));
    plan.top = nodes[2][1];
    plan
}

/// A raft of shells with columns, beams and masses on its corners.
pub(crate) fn raft(numbers: &Numbers) -> Blueprint {
    let mut plan = Blueprint::new(true, 30e9, 2500.0);
    let rows = plan.grid(numbers.sides, [2, 2], 0.0);
    for corners in Blueprint::cells(&rows) {
        plan.pieces.push(Piece::Shell(corners.to_vec(), 1.0));
    }
    let feet = [rows[0][0], rows[0][2], rows[2][2], rows[2][0]];
    let tops: Vec<usize> = feet
        .iter()
        .map(|foot| {
            let foot = plan.points[*foot];
            plan.point([foot[0], foot[1], numbers.height])
        })
        .collect();
    let masses = [1.0, 0.4, 0.8, 0.6];
    for k in 0..4 {
        let side = 0.3 + 0.1 * masses[k];
        plan.pieces.push(Piece::SpaceBeam([feet[k], tops[k]], side, [1.0, 0.3, 0.0]));
        let ends = [tops[k], tops[(k + 1) % 4]];
        plan.pieces.push(Piece::SpaceBeam(ends, 0.4, [0.0, 0.0, 1.0]));
        plan.pieces.push(Piece::Mass(tops[k], 0.1 * masses[k] * numbers.mass(true)));
    }
    plan.pieces.push(Piece::Truss([feet[0], tops[1]], 4e-3));
    plan.top = tops[1];
    plan
}

/// Points of a brick between two cells.
pub(crate) fn brick_points(below: [usize; 4], above: [usize; 4]) -> [usize; 8] {
    let mut points = [0; 8];
    points[..4].copy_from_slice(&below);
    points[4..].copy_from_slice(&above);
    points
}

/// Bricks in two layers on a base of 2 × 2 faces.
pub(crate) fn bricks(numbers: &Numbers) -> Blueprint {
    let mut plan = Blueprint::new(true, young(numbers), numbers.density);
    let levels: Vec<Vec<Vec<usize>>> = (0..3)
        .map(|level| plan.grid(numbers.sides, [2, 2], 0.5 * numbers.height * f64::from(level)))
        .collect();
    for pair in levels.windows(2) {
        for (below, above) in Blueprint::cells(&pair[0]).into_iter().zip(Blueprint::cells(&pair[1]))
        {
            plan.pieces.push(Piece::Brick(brick_points(below, above)));
        }
    }
    plan.pieces.push(Piece::Mass(levels[2][0][0], 0.1 * numbers.mass(true)));
    plan.pieces
        .push(Piece::Spring([levels[0][0][0], levels[2][2][2]], 1e-3 * plan.young));
    plan.damping = 0.03;
    plan.top = levels[2][2][2];
    plan
}

/// A raft that a rigid link makes rigid, with a mast.
pub(crate) fn linked(numbers: &Numbers) -> Blueprint {
    let mut plan = Blueprint::new(true, 30e9, 2500.0);
    let rows = plan.grid(numbers.sides, [2, 2], 0.0);
    for corners in Blueprint::cells(&rows) {
        plan.pieces.push(Piece::Shell(corners.to_vec(), 1.0));
    }
    let foot = rows[1][1];
    let top = plan.point([0.0, 0.0, numbers.height]);
    plan.pieces.push(Piece::SpaceBeam([foot, top], 0.8, [1.0, 0.3, 0.0]));
    plan.pieces.push(Piece::Mass(top, 0.2 * numbers.mass(true)));
    let followers = rows.iter().flatten().copied().filter(|node| *node != foot).collect();
    plan.link = Some((foot, followers));
    plan.top = top;
    plan
}
