//! Structures of shells in space.

use std::collections::HashMap;

use basemat::fem::{Direction, Material, Mesh, Shell};
use basemat::structure::{FemModel, RayleighDamping};

/// A core of walls under a heavy roof on a raft of 18 × 18 m.
///
/// The arguments are the number of elements across, and the number of rows of a wall in the side of an element.
pub(super) fn building(
    [cells, rows_per_side, ..]: [usize; 4],
) -> basemat::Result<(FemModel, usize)> {
    const RAFT_SIDE: f64 = 18.0;
    let concrete = Material::new(30.0e9, 0.2, 2500.0)?;
    let roof = Material::new(30.0e9, 0.2, 6000.0)?;
    let mut mesh = Mesh::in_space();
    let mut nodes = HashMap::new();
    let side = RAFT_SIDE / cells as f64;
    let mut node = |mesh: &mut Mesh, place: [usize; 3]| -> basemat::Result<usize> {
        if let Some(node) = nodes.get(&place) {
            return Ok(*node);
        }
        let [x, y, z] = place.map(|count| side * count as f64);
        let node =
            mesh.add_node_at([x - 0.5 * RAFT_SIDE, y - 0.5 * RAFT_SIDE, z / rows_per_side as f64])?;
        nodes.insert(place, node);
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
    let edge = cells / 6;
    let core = 2 * cells / 3;
    let rows = rows_per_side * 2 * cells / 3;
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
    let top = nodes[&[cells / 2, cells / 2, rows]];
    on_base(mesh, top)
}

/// The containment of the example of that name: sectors, and rows of elements in raft, wall and dome.
///
/// The raft bends most near the wall, so that the widths of its rows decrease to zero towards it.
pub(super) fn containment(
    [sectors, raft, wall, dome]: [usize; 4],
) -> basemat::Result<(FemModel, usize)> {
    const WALL_RADIUS: f64 = 20.0;
    const WALL_HEIGHT: f64 = 30.0;
    let concrete = Material::new(32.0e9, 0.2, 2450.0)?;
    let fraction = |row: usize, rows: usize| row as f64 / rows as f64;
    let base = (0..raft).map(|i| [WALL_RADIUS * (1.0 - (1.0 - fraction(i, raft)).powi(2)), 0.0]);
    let shaft = (0..wall).map(|i| [WALL_RADIUS, WALL_HEIGHT * fraction(i, wall)]);
    let roof = (0..=dome).map(|i| {
        let angle = std::f64::consts::FRAC_PI_2 * fraction(i, dome);
        let radius = if i == dome { 0.0 } else { WALL_RADIUS * angle.cos() };
        [radius, WALL_HEIGHT + WALL_RADIUS * angle.sin()]
    });
    let meridian: Vec<_> = base.chain(shaft).chain(roof).collect();
    let mut mesh = Mesh::in_space();
    let surface = mesh.revolve([0.0; 2], &meridian, sectors)?;
    let shells = surface.shells(concrete, |row| match row {
        row if row < raft => 3.0,
        row if row < raft + wall => 1.2,
        _ => 1.0,
    })?;
    for shell in shells {
        mesh.add(shell)?;
    }
    let pole = mesh.nodes().len() - 1;
    on_base(mesh, pole)
}

/// A mesh on its base with damping by stiffness alone, 5 % at 5 Hz; the degree of freedom of the node `top` along x.
fn on_base(mesh: Mesh, top: usize) -> basemat::Result<(FemModel, usize)> {
    let damping = RayleighDamping::new(0.0, 0.1 / (std::f64::consts::TAU * 5.0))?;
    let model = FemModel::on_base(mesh)?.with_rayleigh(damping);
    let dof = model
        .dof(top, Direction::X)
        .ok_or(basemat::Error::part("top", "no motion along x"))?;
    Ok((model, dof))
}
