//! Structures of shells in three directions.

use std::collections::HashMap;

use basemat::fem::{Direction, Material, Mesh, Shell};
use basemat::structure::{FemModel, RayleighDamping};

/// A core of walls under a heavy roof on a raft of 18 × 18 m: elements across, and rows of a wall in the side of one.
pub(super) fn building([cells, each, ..]: [usize; 4]) -> basemat::Result<(FemModel, usize)> {
    const SIDE: f64 = 18.0;
    let concrete = Material::new(30.0e9, 0.2, 2500.0)?;
    let roof = Material::new(30.0e9, 0.2, 6000.0)?;
    let mut mesh = Mesh::in_space();
    let mut known = HashMap::new();
    let side = SIDE / cells as f64;
    let mut node = |mesh: &mut Mesh, place: [usize; 3]| -> basemat::Result<usize> {
        if let Some(node) = known.get(&place) {
            return Ok(*node);
        }
        let [x, y, z] = place.map(|count| side * count as f64);
        let node = mesh.add_node_at([x - 0.5 * SIDE, y - 0.5 * SIDE, z / each as f64])?;
        known.insert(place, node);
        Ok(node)
    };
    let mut add = |corners: [[usize; 3]; 4], material, thickness| -> basemat::Result<()> {
        let corners = corners.map(|place| node(&mut mesh, place));
        let corners = corners.into_iter().collect::<basemat::Result<Vec<_>>>()?;
        mesh.add(Shell::new(corners, material, thickness)?).map(|_| ())
    };
    let level = |i, j, k| [[i, j, k], [i + 1, j, k], [i + 1, j + 1, k], [i, j + 1, k]];
    for place in 0..cells * cells {
        add(level(place % cells, place / cells, 0), concrete, 0.8)?;
    }
    let (edge, core, rows) = (cells / 6, 2 * cells / 3, each * 2 * cells / 3);
    for (along, row) in (0..core).flat_map(|along| (0..rows).map(move |row| (edge + along, row))) {
        for across in [edge, edge + core] {
            let wall = |place: fn(usize, usize, usize) -> [usize; 3]| {
                let ends = [(along, row), (along + 1, row), (along + 1, row + 1), (along, row + 1)];
                ends.map(|(along, row)| place(along, across, row))
            };
            add(wall(|along, across, row| [along, across, row]), concrete, 0.3)?;
            add(wall(|along, across, row| [across, along, row]), concrete, 0.3)?;
        }
    }
    for place in 0..core * core {
        add(level(edge + place % core, edge + place / core, rows), roof, 0.6)?;
    }
    let top = known[&[cells / 2, cells / 2, rows]];
    standing(mesh, top)
}

/// The containment of the example of that name: sectors, and rows of elements in raft, wall and dome.
///
/// The raft bends most near the wall: widths of its rows fall to zero towards it.
pub(super) fn containment([sectors, rows @ ..]: [usize; 4]) -> basemat::Result<(FemModel, usize)> {
    const RADIUS: f64 = 20.0;
    const HEIGHT: f64 = 30.0;
    let concrete = Material::new(32.0e9, 0.2, 2450.0)?;
    let [raft, wall, dome] = rows;
    let part = |index: usize, rows: usize| index as f64 / rows as f64;
    let base = (0..raft).map(|i| [RADIUS * (1.0 - (1.0 - part(i, raft)).powi(2)), 0.0]);
    let shaft = (0..wall).map(|i| [RADIUS, HEIGHT * part(i, wall)]);
    let roof = (0..=dome).map(|i| {
        let angle = std::f64::consts::FRAC_PI_2 * part(i, dome);
        let radius = if i == dome { 0.0 } else { RADIUS * angle.cos() };
        [radius, HEIGHT + RADIUS * angle.sin()]
    });
    let meridian: Vec<_> = base.chain(shaft).chain(roof).collect();
    let mut mesh = Mesh::in_space();
    let surface = mesh.revolve([0.0; 2], &meridian, sectors)?;
    let thickness = |row: usize| match row {
        row if row < raft => 3.0,
        row if row < raft + wall => 1.2,
        _ => 1.0,
    };
    for shell in surface.shells(concrete, thickness)? {
        mesh.add(shell)?;
    }
    let pole = mesh.nodes().len() - 1;
    standing(mesh, pole)
}

/// A mesh on its base with damping by stiffness alone, 5 % at 5 Hz; the degree of freedom of the node `top` along x.
fn standing(mesh: Mesh, top: usize) -> basemat::Result<(FemModel, usize)> {
    let damping = RayleighDamping::new(0.0, 0.1 / (std::f64::consts::TAU * 5.0))?;
    let model = FemModel::on_base(mesh)?.with_rayleigh(damping);
    let dof =
        model.dof(top, Direction::X).ok_or(basemat::Error::part("top", "no motion along x"))?;
    Ok((model, dof))
}
