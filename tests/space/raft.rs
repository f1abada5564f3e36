//! A flexible raft of shells under a load on its middle, on springs and on a half-space.
//!
//! Reference: a Ritz solution in Legendre polynomials of degree 36 for the plate on springs; shells and cell means of
//! an independent program on the half-space.

use basemat::bem::plan::Plan;
use basemat::bem::{ElasticGround, Ground, SpringGround};
use basemat::coupled::{Load, SimulationBuilder};
use basemat::fem::{Direction, Element, Material, Mesh, Shell};
use basemat::interface::Coulomb;
use basemat::structure::FemModel;
use basemat::{Simulation, Soil};

/// Side and thickness of the raft, m; load on the middle 1.5 m × 1.5 m, N.
const SIDE: f64 = 12.0;
const THICKNESS: f64 = 0.8;
const LOAD: f64 = 4.0e6;
/// Elements along a side.
const COUNT: usize = 16;

fn raft() -> FemModel {
    let concrete = Material::new(30.0e9, 0.2, 2400.0).unwrap();
    let mut mesh = Mesh::in_space();
    let place = |k: usize| SIDE * (k as f64 / COUNT as f64 - 0.5);
    let grid = mesh
        .add_grid(COUNT + 1, COUNT + 1, |row, column| [place(column), place(row), 0.0])
        .unwrap();
    for (_, cell) in grid.cells() {
        mesh.add(Shell::new(cell, concrete, THICKNESS).unwrap()).unwrap();
    }
    FemModel::on_base(mesh).unwrap()
}

/// Settlements of the middle, the middle of a side and a corner, mm, and the moment m_x in the middle, kNm/m.
fn loaded(ground: impl Ground + 'static) -> [f64; 4] {
    let model = raft();
    let node = |x: f64, y: f64| model.mesh().node_at_point([x, y, 0.0]).unwrap();
    let cell = SIDE / COUNT as f64;
    // The load in the middles of two elements by two, by their shape functions.
    let loads = [-1.0_f64, 0.0, 1.0].into_iter().flat_map(|i| {
        [-1.0_f64, 0.0, 1.0].map(|j| (i, j, LOAD / 16.0 * (2.0 - i.abs()) * (2.0 - j.abs())))
    });
    let loads = loads.map(|(i, j, force)| {
        let row = model.row(node(i * cell, j * cell), Direction::Z).unwrap();
        Load::constant(row, -force)
    });
    let builder = Simulation::builder(0.01).structure(model.clone()).ground(ground).gravity(1e-6);
    // Smooth, and held down wherever the raft bends up.
    let law = Coulomb::new(0.0).unwrap().with_tensile_strength(1.0e9).unwrap();
    let simulation = loads.fold(builder, SimulationBuilder::load).interface(law).build();
    let simulation = simulation.unwrap();
    let displacement = simulation.static_displacement();
    let half = 0.5 * SIDE;
    let [middle, side, corner] = [[0.0, 0.0], [half, 0.0], [half, half]].map(|[x, y]| {
        let row = model.row(node(x, y), Direction::Z).unwrap();
        -1e3 * row.value(displacement)
    });
    let center = node(0.0, 0.0);
    let around = |(_, element): &(usize, &dyn Element)| element.nodes().contains(&center);
    let around: Vec<usize> =
        model.mesh().elements().enumerate().filter(around).map(|(index, _)| index).collect();
    assert_eq!(around.len(), 4);
    let rows = model.shell_rows(&around, |_| [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]).unwrap();
    let own = rows.iter().find(|own| own.node == center).unwrap();
    [middle, side, corner, 1e-3 * own.value(displacement).moments[0]]
}

fn plan() -> Plan {
    let half = 0.5 * SIDE;
    Plan::rectangle(-half..half, -half..half, COUNT).unwrap().without_overhang().unwrap()
}

/// The load bends a raft on springs so much that its corners rise.
#[test]
fn on_springs() {
    let springs = SpringGround::in_plan(plan(), [20.0e6, 1.0e6, 1.0e6]).unwrap();
    let found = loaded(springs);
    // Springs under a cell hold its mean displacement: errors are parts of the largest settlement.
    for (found, exact) in found.into_iter().zip([3.487_449, 0.743_579_3, -0.495_681_2]) {
        assert!((found - exact).abs() < 0.01 * 3.487, "{found} {exact}");
    }
    assert!((found[3] / 729.3671 - 1.0).abs() < 0.15, "{}", found[3]);
}

/// On the half-space: the same shells, cell means and limit.
#[test]
fn on_a_half_space() {
    let soil = Soil::new(80.0e6 / 2.6, 0.3, 1900.0).unwrap();
    let found = loaded(ElasticGround::in_plan(soil, plan()).unwrap());
    for ((found, exact), gate) in found
        .into_iter()
        .zip([6.008_884, 3.081_029, 1.677_95, 651.0484])
        .zip([2e-3, 2e-3, 5e-3, 1e-2])
    {
        assert!((found / exact - 1.0).abs() < gate, "{found} {exact}");
    }
}
