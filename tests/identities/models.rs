//! Finite-element models of scenes.

use super::blueprint::{Blueprint, Piece};
use super::numbers::Numbers;

/// Young's modulus of a model with about this frequency (Hz) as a cantilever of the numbers' size, Pa.
fn young(numbers: &Numbers) -> f64 {
    // Shear beam: f = √(G/ρ)/(4 h).
    let shear = numbers.density * (4.0 * numbers.height * numbers.frequency).powi(2);
    // Bases bend little on their elements.
    (2.4 * shear).max(3.0 * numbers.modulus)
}

/// Quadrilaterals of four or eight nodes, `columns` × `rows`, on a base along x.
pub(crate) fn quads(numbers: &Numbers, eight: bool) -> (Blueprint, usize) {
    let (columns, rows, parts) = (3, 2, if eight { 2 } else { 1 });
    let mut plan = Blueprint::new(false, young(numbers), numbers.density);
    let mut nodes = vec![vec![usize::MAX; parts * columns + 1]; parts * rows + 1];
    for (row, line) in nodes.iter_mut().enumerate() {
        for (column, node) in line.iter_mut().enumerate() {
            if row % parts == 0 || column % parts == 0 {
                let x = numbers.sides[0] * (column as f64 / (parts * columns) as f64 - 0.5);
                // The top leans.
                let z = numbers.height * row as f64 / (parts * rows) as f64;
                *node = plan.point([x + 0.1 * z * numbers.eccentricity[0], 0.0, z]);
            }
        }
    }
    for row in 0..rows {
        for column in 0..columns {
            let (r, c) = (parts * row, parts * column);
            let corners =
                [[0, 0], [0, 1], [1, 1], [1, 0]].map(|[i, j]| nodes[r + parts * i][c + parts * j]);
            if eight {
                let [a, b, d, e] = corners;
                let middles = [[0, 1], [1, 2], [2, 1], [1, 0]].map(|[i, j]| nodes[r + i][c + j]);
                let [ab, bc, cd, da] = middles;
                plan.pieces.push(Piece::Quad8([a, b, d, e, ab, bc, cd, da]));
            } else {
                plan.pieces.push(Piece::Quad(corners));
            }
        }
    }
    plan.damping = 0.03;
    let top = nodes[parts * rows][parts * columns];
    (plan, top)
}

/// A plane frame of two bays on a stiff base, with masses that are not symmetric.
pub(crate) fn frame(numbers: &Numbers) -> (Blueprint, usize) {
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
    (plan, nodes[2][1])
}

/// A raft of shells with columns, beams and masses on its corners.
pub(crate) fn raft(numbers: &Numbers) -> (Blueprint, usize) {
    let mut plan = Blueprint::new(true, 30e9, 2500.0);
    let rows = plan.grid(numbers.sides, [2, 2], 0.0);
    for corners in Blueprint::cells(&rows) {
        plan.pieces.push(Piece::Shell(corners.to_vec(), 1.0));
    }
    let feet = [rows[0][0], rows[0][2], rows[2][2], rows[2][0]];
    let tops: Vec<usize> = feet
        .iter()
        .map(|foot| {
            let [x, y, _] = plan.points[*foot];
            plan.point([x, y, numbers.height])
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
    (plan, tops[1])
}

/// Bricks in two layers on a base of 2 × 2 faces.
pub(crate) fn bricks(numbers: &Numbers) -> (Blueprint, usize) {
    let mut plan = Blueprint::new(true, young(numbers), numbers.density);
    let levels: Vec<Vec<Vec<usize>>> = (0..3)
        .map(|level| plan.grid(numbers.sides, [2, 2], 0.5 * numbers.height * f64::from(level)))
        .collect();
    for pair in levels.windows(2) {
        for (below, above) in Blueprint::cells(&pair[0]).into_iter().zip(Blueprint::cells(&pair[1]))
        {
            let [a, b, c, d] = below;
            let [e, f, g, h] = above;
            plan.pieces.push(Piece::Brick([a, b, c, d, e, f, g, h]));
        }
    }
    plan.pieces.push(Piece::Mass(levels[2][0][0], 0.1 * numbers.mass(true)));
    plan.pieces.push(Piece::Spring([levels[0][0][0], levels[2][2][2]], 1e-3 * plan.young));
    plan.damping = 0.03;
    (plan, levels[2][2][2])
}

/// A raft that a rigid link makes rigid, with a mast.
pub(crate) fn linked(numbers: &Numbers) -> (Blueprint, usize) {
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
    (plan, top)
}
