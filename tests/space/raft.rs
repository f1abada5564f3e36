//! A flexible raft of shells under a load on its middle, on springs and on a half-space.
//!
//! Reference: Ritz solutions in Legendre polynomials; shells and cell means of an independent program on the half-space.

use std::f64::consts::PI;

use basemat::bem::plan::Plan;
use basemat::bem::{ElasticGround, Ground, SpringGround};
use basemat::coupled::{Load, SimulationBuilder};
use basemat::fem::{Direction, Element, Grid, Material, Mesh, Shell};
use basemat::interface::Coulomb;
use basemat::structure::{DofCombination, FemModel};
use basemat::{Simulation, Soil};

/// Side and thickness of the raft, m; load on the middle 1.5 m × 1.5 m, N.
const RAFT_SIDE: f64 = 12.0;
const RAFT_THICKNESS: f64 = 0.8;
const TOTAL_LOAD: f64 = 4.0e6;
const ELEMENTS_PER_SIDE: usize = 16;

/// Thickness of the shells of rafts whose bending stiffness is prescribed, m.
const THIN_SHELL: f64 = 0.3;
/// 12 (1 − ν²) for Poisson's ratio of the shells, 0.2.
const PLATE_FACTOR: f64 = 12.0 * 0.96;
/// Gravity so small that weight has no effect on the results of the loads, m/s².
const NEGLIGIBLE_GRAVITY: f64 = 1e-6;

/// A square raft of `count` × `count` shells.
fn square_raft(count: usize, young_modulus: f64, thickness: f64) -> FemModel {
    let concrete = Material::new(young_modulus, 0.2, 2400.0).unwrap();
    let mut mesh = Mesh::in_space();
    let lines: Vec<f64> =
        (0..=count).map(|k| RAFT_SIDE * (k as f64 / count as f64 - 0.5)).collect();
    let grid = mesh
        .add_grid(count + 1, count + 1, |row, column| [lines[column], lines[row], 0.0])
        .unwrap();
    for (_, cell) in grid.cells() {
        mesh.add(Shell::new(cell, concrete, thickness).unwrap()).unwrap();
    }
    FemModel::on_base(mesh).unwrap()
}

fn soil() -> Soil {
    Soil::new(80.0e6 / 2.6, 0.3, 1900.0).unwrap()
}

fn node_at(model: &FemModel, x: f64, y: f64) -> usize {
    model.mesh().node_at_point([x, y, 0.0]).unwrap()
}

/// Vertical displacement of a node.
fn vertical(model: &FemModel, node: usize) -> DofCombination {
    model.row(node, Direction::Z).unwrap()
}

/// A contact without friction whose tensile strength keeps the raft from lifting off.
fn frictionless_bond() -> Coulomb {
    Coulomb::new(0.0).unwrap().with_tensile_strength(1.0e9).unwrap()
}

/// The static state of a model under loads.
fn loaded_simulation(
    model: &FemModel,
    ground: impl Ground + 'static,
    gravity: f64,
    loads: impl Iterator<Item = Load>,
) -> Simulation {
    let builder = Simulation::builder(0.01).structure(model.clone()).ground(ground);
    let builder = builder.gravity(gravity).interface(frictionless_bond());
    loads.fold(builder, SimulationBuilder::load).build().unwrap()
}

/// Settlements of a square raft, mm, and the moment m_x in its middle, kNm/m.
#[derive(Debug, Clone, Copy)]
struct RaftResponse {
    middle: f64,
    side_middle: f64,
    corner: f64,
    middle_moment: f64,
}

impl RaftResponse {
    fn settlements(&self) -> [f64; 3] {
        [self.middle, self.side_middle, self.corner]
    }
}

/// Response to a load in the middle.
fn middle_load_response(ground: impl Ground + 'static) -> RaftResponse {
    let model = square_raft(ELEMENTS_PER_SIDE, 30.0e9, RAFT_THICKNESS);
    let cell = RAFT_SIDE / ELEMENTS_PER_SIDE as f64;
    // A uniform load on the four elements in the middle; their shape functions give the nodal forces.
    let mut loads = Vec::new();
    for i in [-1.0_f64, 0.0, 1.0] {
        for j in [-1.0_f64, 0.0, 1.0] {
            let force = TOTAL_LOAD / 16.0 * (2.0 - i.abs()) * (2.0 - j.abs());
            let row = vertical(&model, node_at(&model, i * cell, j * cell));
            loads.push(Load::constant(row, -force));
        }
    }
    response(&model, ground, loads.into_iter())
}

/// Response to any loads.
fn response(
    model: &FemModel,
    ground: impl Ground + 'static,
    loads: impl Iterator<Item = Load>,
) -> RaftResponse {
    let simulation = loaded_simulation(model, ground, NEGLIGIBLE_GRAVITY, loads);
    let displacement = simulation.static_displacement();
    let half = 0.5 * RAFT_SIDE;
    let [middle, side_middle, corner] = [[0.0, 0.0], [half, 0.0], [half, half]]
        .map(|[x, y]| -1e3 * vertical(model, node_at(model, x, y)).value(displacement));
    let center = node_at(model, 0.0, 0.0);
    let touches_center = |(_, element): &(usize, &dyn Element)| element.nodes().contains(&center);
    let elements = model.mesh().elements().enumerate();
    let around_center: Vec<usize> =
        elements.filter(touches_center).map(|(index, _)| index).collect();
    assert_eq!(around_center.len(), 4);
    let rows = model.shell_rows(&around_center, |_| [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]).unwrap();
    let center_rows = rows.iter().find(|rows| rows.node == center).unwrap();
    let middle_moment = 1e-3 * center_rows.value(displacement).moments[0];
    RaftResponse { middle, side_middle, corner, middle_moment }
}

/// Cells of the elements' size, up to the edge.
fn plan() -> Plan {
    let half = 0.5 * RAFT_SIDE;
    let plan = Plan::rectangle(-half..half, -half..half, ELEMENTS_PER_SIDE).unwrap();
    plan.without_overhang().unwrap()
}

/// On springs the load bends the raft so much that its corners rise.
#[test]
fn a_raft_on_springs_settles_as_the_ritz_solution() {
    let springs = SpringGround::in_plan(plan(), [20.0e6, 1.0e6, 1.0e6]).unwrap();
    let computed = middle_load_response(springs);
    // Springs under a cell have its mean displacement: errors are relative to the largest settlement.
    let expected = [3.487_449, 0.743_579_3, -0.495_681_2];
    for (computed, expected) in computed.settlements().into_iter().zip(expected) {
        assert!((computed - expected).abs() < 0.01 * 3.487, "{computed} {expected}");
    }
    let moment = computed.middle_moment;
    assert!((moment / 729.3671 - 1.0).abs() < 0.15, "{moment}");
}

/// On the half-space: an independent program with the same shells and cell means, and the limit of fine meshes.
#[test]
fn a_raft_on_a_half_space_settles_as_the_independent_program() {
    let computed = middle_load_response(ElasticGround::in_plan(soil(), plan()).unwrap());
    for (computed, expected, tolerance) in [
        (computed.middle, 6.008_884, 2e-3),
        (computed.side_middle, 3.081_029, 2e-3),
        (computed.corner, 1.677_95, 5e-3),
        (computed.middle_moment, 651.0484, 1e-2),
    ] {
        assert!((computed / expected - 1.0).abs() < tolerance, "{computed} {expected}");
    }
}

/// Errors of a raft loaded on its edges.
#[derive(Debug)]
struct EdgeLoadErrors {
    /// Largest of the three settlements, relative to the corner's.
    settlement: f64,
    /// Error of the moment in the middle.
    moment: f64,
}

/// Expected settlements times G B/P, and the moment in the middle over P.
struct EdgeLoadReference {
    settlements: [f64; 3],
    moment: f64,
}

impl EdgeLoadReference {
    /// Errors of a raft of 8 × 8 shells on this ground.
    fn errors(&self, model: &FemModel, ground: ElasticGround, soil: Soil) -> EdgeLoadErrors {
        let nodes = model.mesh().nodes().iter().enumerate();
        let outer_nodes =
            nodes.filter(|(_, place)| place.iter().any(|x| x.abs() > 0.499 * RAFT_SIDE));
        let loads = outer_nodes
            .map(|(node, _)| Load::constant(vertical(model, node), -TOTAL_LOAD / f64::from(4 * 8)));
        let computed = response(model, ground, loads);
        let scale = 1e-3 * soil.shear_modulus() * RAFT_SIDE / TOTAL_LOAD;
        let settlement_errors = (0..3).map(|k| {
            (computed.settlements()[k] * scale - self.settlements[k]).abs() / self.settlements[2]
        });
        let moment = computed.middle_moment * (1e3 / TOTAL_LOAD);
        EdgeLoadErrors {
            settlement: settlement_errors.fold(0.0, f64::max),
            moment: (moment / self.moment - 1.0).abs(),
        }
    }
}

/// A load of 4 MN on the edges of a raft, for two stiffnesses D/(G B³).
///
/// Cells that end at the outline let the edges sink too far.
///
/// Reference: Ritz solution of `tests/data/plan/plate_on_half_space.py`: settlements of the middle, the middle of a side
/// and a corner times G B/P, and the moment in the middle over P.
#[test]
fn loads_on_the_edges_of_a_stiff_raft_settle_it_as_the_ritz_solution() {
    let soil = Soil::new(30.0e6, 1.0 / 3.0, 1900.0).unwrap();
    for (stiffness, settlements, moment, tolerances) in [
        (1e-2, [0.193_53, 0.306_74, 0.388_93], -0.009_763, [0.03, 0.13]),
        (1e-1, [0.262_75, 0.290_62, 0.317_50], -0.031_03, [0.01, 0.09]),
    ] {
        let rigidity = stiffness * soil.shear_modulus() * RAFT_SIDE.powi(3);
        let young_modulus = PLATE_FACTOR * rigidity / THIN_SHELL.powi(3);
        let model = square_raft(8, young_modulus, THIN_SHELL);
        let reference = EdgeLoadReference { settlements, moment };
        let overhanging = ElasticGround::under(soil, &model, 8).unwrap();
        let overhanging = reference.errors(&model, overhanging, soil);
        let plan = Plan::under(&model, 8).unwrap();
        let flush = ElasticGround::in_plan(soil, plan).unwrap();
        let flush = reference.errors(&model, flush, soil);
        println!("{stiffness:e}: {overhanging:.4?}, without overhang {flush:.4?}");
        assert!(overhanging.settlement < tolerances[0], "{overhanging:?}");
        assert!(3.0 * overhanging.settlement < flush.settlement, "{overhanging:?} {flush:?}");
        // With 8 shells the moment is 6 % too large, whatever the ground.
        assert!(overhanging.moment < tolerances[1], "{overhanging:?}");
        assert!(1.6 * overhanging.moment < flush.moment, "{overhanging:?} {flush:?}");
    }
}

/// Number of sectors of a round raft.
const SECTOR_COUNT: usize = 24;
const SHELL_ROW_COUNT: usize = 6;
const ROUND_RAFT_RADIUS: f64 = 0.5 * RAFT_SIDE;

/// Soil under round rafts.
fn round_soil() -> Soil {
    Soil::new(30.0e6, 1.0 / 3.0, 1900.0).unwrap()
}

/// A round raft and the grid of its nodes.
struct RoundRaft {
    model: FemModel,
    surface: Grid,
}

impl RoundRaft {
    /// A circular raft with D/R³ of `stiffness`, under walls up to these heights that are ten times as stiff.
    fn new(stiffness: f64, wall_heights: &[f64]) -> Self {
        let young_modulus =
            PLATE_FACTOR * stiffness * ROUND_RAFT_RADIUS.powi(3) / THIN_SHELL.powi(3);
        // A polygon of the circle's area.
        let half_angle = PI / SECTOR_COUNT as f64;
        let outer_radius =
            ROUND_RAFT_RADIUS * (half_angle / (half_angle.sin() * half_angle.cos())).sqrt();
        let mut meridian: Vec<[f64; 2]> = (0..=SHELL_ROW_COUNT)
            .map(|k| [outer_radius * k as f64 / SHELL_ROW_COUNT as f64, 0.0])
            .collect();
        meridian.extend(wall_heights.iter().map(|z| [outer_radius, *z]));
        let mut mesh = Mesh::in_space();
        let surface = mesh.revolve([0.0; 2], &meridian, SECTOR_COUNT).unwrap();
        let [raft, walls] = [1.0, 10.0].map(|factor| {
            let concrete = Material::new(factor * young_modulus, 0.2, 2400.0).unwrap();
            surface.shells(concrete, |_| THIN_SHELL).unwrap()
        });
        let raft_shells = SECTOR_COUNT * SHELL_ROW_COUNT;
        for shell in raft.into_iter().take(raft_shells).chain(walls.into_iter().skip(raft_shells)) {
            mesh.add(shell).unwrap();
        }
        Self { model: FemModel::on_base(mesh).unwrap(), surface }
    }

    fn edge_nodes(&self) -> &[usize] {
        self.surface.row(SHELL_ROW_COUNT)
    }

    fn x(&self, node: usize) -> f64 {
        self.model.mesh().nodes()[node][0]
    }

    /// Rotation of the edge of the raft, bonded to the soil, by a moment of [`TOTAL_LOAD`] Nm on it.
    fn edge_rotation(&self, cells: usize, gravity: f64) -> f64 {
        let x_squares: f64 =
            self.edge_nodes().iter().map(|&node| self.x(node) * self.x(node)).sum();
        let ground = ElasticGround::under(round_soil(), &self.model, cells).unwrap();
        let loads = self.edge_nodes().iter().map(|&node| {
            let force = TOTAL_LOAD * self.x(node) / x_squares;
            Load::constant(vertical(&self.model, node), force)
        });
        let simulation = loaded_simulation(&self.model, ground, gravity, loads);
        let displacement = simulation.static_displacement();
        let moment: f64 = self
            .edge_nodes()
            .iter()
            .map(|&node| self.x(node) * vertical(&self.model, node).value(displacement))
            .sum();
        moment / x_squares
    }
}

/// A load on the edge of a circular raft with D/(G R³) = 0.02: the edge sinks 2 % too far below the middle, and 10 % if
/// oblique edges move outwards as little as under a rigid raft.
///
/// Reference: Ritz solution of `tests/data/plan/disc_on_half_space.py`, settlements times G R/P.
#[test]
fn a_load_on_the_edge_of_a_round_raft_settles_it_as_the_ritz_solution() {
    const EXPECTED_MIDDLE: f64 = 0.0963;
    const EXPECTED_EDGE: f64 = 0.2086;
    let soil = round_soil();
    let raft = RoundRaft::new(0.02 * soil.shear_modulus(), &[]);
    let edge_rows: Vec<DofCombination> =
        raft.edge_nodes().iter().map(|&node| vertical(&raft.model, node)).collect();
    let ground = ElasticGround::under(soil, &raft.model, 13).unwrap();
    let loads = edge_rows
        .iter()
        .map(|row| Load::constant(row.clone(), -TOTAL_LOAD / SECTOR_COUNT as f64));
    let simulation = loaded_simulation(&raft.model, ground, NEGLIGIBLE_GRAVITY, loads);
    let displacement = simulation.static_displacement();
    let scale = -soil.shear_modulus() * ROUND_RAFT_RADIUS / TOTAL_LOAD;
    let middle = scale * vertical(&raft.model, raft.surface.row(0)[0]).value(displacement);
    let edge_sum: f64 = edge_rows.iter().map(|row| scale * row.value(displacement)).sum();
    let edge = edge_sum / SECTOR_COUNT as f64;
    println!("middle {middle:.5}, edge {edge:.5}");
    assert!((edge / EXPECTED_EDGE - 1.0).abs() < 0.03, "{edge}");
    let bending_ratio = (edge - middle) / (EXPECTED_EDGE - EXPECTED_MIDDLE);
    assert!((bending_ratio - 1.0).abs() < 0.05, "{middle} {edge}");
}

/// A round raft with D/(G R³) = 0.06 rocks under a stiff wall on its edge: its stiffness is accurate on every number of
/// cells.
///
/// With the overhang of a rigid raft it is 1 % too soft.
/// Reference: Ritz solution of `tests/data/plan/disc_on_half_space.py`, moment over rotation and G R³.
#[test]
fn a_round_raft_rocks_under_its_wall() {
    let modulus = round_soil().shear_modulus();
    let raft = RoundRaft::new(0.06 * modulus, &[RAFT_SIDE]);
    for cells in [14, 16, 20] {
        let rotation = raft.edge_rotation(cells, NEGLIGIBLE_GRAVITY);
        let computed = TOTAL_LOAD / (rotation * modulus * ROUND_RAFT_RADIUS.powi(3));
        println!("{cells} cells: {computed:.5}");
        assert!((computed / 3.93322 - 1.0).abs() < 0.002, "{cells} cells: {computed}");
    }
}

/// The tensile strength of the contact has no effect on the accuracy of its forces: the raft stands under any small weight.
#[test]
fn results_do_not_depend_on_a_small_weight() {
    let raft = RoundRaft::new(0.001 * round_soil().shear_modulus(), &[]);
    let rotation_of_light_raft = raft.edge_rotation(12, 1e-3);
    let rotation_of_weightless_raft = raft.edge_rotation(12, 1e-9);
    assert!(
        (rotation_of_weightless_raft / rotation_of_light_raft - 1.0).abs() < 1e-6,
        "{rotation_of_light_raft} {rotation_of_weightless_raft}"
    );
}

/// The overhang under rafts of prescribed bending stiffness D, one shell on each cell.
#[test]
fn the_overhang_of_cells_grows_with_bending_stiffness() {
    /// Overhang under a rigid raft, in cells.
    const RIGID_OVERHANG: f64 = 0.105;
    let soil = Soil::new(80.0e6, 0.33, 1900.0).unwrap();
    for (shells, cells) in [(8, 8), (16, 16_usize)] {
        for x in [0.1, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0, 50.0] {
            let rigidity = soil.shear_modulus() * (x * RAFT_SIDE / cells as f64).powi(3);
            let young_modulus = PLATE_FACTOR * rigidity / THIN_SHELL.powi(3);
            let model = square_raft(shells, young_modulus, THIN_SHELL);
            let ground = ElasticGround::under(soil, &model, cells).unwrap();
            let overhang = 0.5 * (cells as f64 - RAFT_SIDE / ground.elements()[0].sides()[0]);
            let rule = RIGID_OVERHANG * x * x / (1.0 + x * x);
            println!("{shells} shells, {cells} cells, {x}: {overhang:.4} {rule:.4}");
            assert!((overhang - rule).abs() < 0.016, "{shells} {cells} {x}: {overhang} {rule}");
            let limit = if x > 1.0 { RIGID_OVERHANG } else { 0.0 };
            let is_between = (0.2..20.0).contains(&x);
            assert!(is_between || (overhang - limit).abs() < 1e-12, "{x}: {overhang}");
        }
    }
}
