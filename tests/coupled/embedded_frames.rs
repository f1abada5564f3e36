//! GOAL: finite-element models touch the ground with walls and base that bend.
//! SCENE: solids, walls on a slab and a box of beams in a trench, on springs and in soil.
//! REFERENCE: the rigid block with walls; bending of cantilevers; Euler's load; balances of energy and of forces.

use basemat::bem::embedded::{Trench, TrenchGround};
use basemat::bem::{ContactElement, SharedKernels};
use basemat::coupled::{CoarseBaseError, Face, Load, State, Warning};
use basemat::fem::{Beam, Direction, LumpedMass, Material, Mesh, Quad4, QuadFormulation};
use basemat::interface::Coulomb;
use basemat::motion::{STANDARD_GRAVITY, VerticalIncidence, el_centro_1940};
use basemat::site::TrenchMotion;
use basemat::structure::{DofCombination, FemModel, RigidBlock, Structure};
use basemat::{Error, Result, Simulation, unobserved};

use super::trench_springs::{
    BLOCK_HEIGHT, SOIL_DENSITY, TRENCH_DEPTH, TRENCH_WIDTH, TrenchSprings, friction_laws, soil,
    trench_elements, trench_motion, walled_block,
};

/// Young's modulus of concrete in plane strain, Pa.
const YOUNG_MODULUS: f64 = 31.0e9;

/// Box in a trench: its dimensions in metres and its numbers of intervals.
#[derive(Clone, Copy)]
struct TrenchOutline {
    width: f64,
    depth: f64,
    base_intervals: usize,
    wall_intervals: usize,
}

impl TrenchOutline {
    /// The outline of the trench of these tests.
    fn of_trench(base_intervals: usize, wall_intervals: usize) -> Self {
        Self { width: TRENCH_WIDTH, depth: TRENCH_DEPTH, base_intervals, wall_intervals }
    }

    /// Adds the nodes of the outline down the left wall, to the right and up.
    fn add_nodes(self, mesh: &mut Mesh) -> Vec<usize> {
        let Self { width, depth, base_intervals, wall_intervals } = self;
        let mut places = Vec::new();
        for k in 0..wall_intervals {
            places.push([-0.5 * width, -depth * fraction(k, wall_intervals)]);
        }
        for k in 0..base_intervals {
            places.push([width * (fraction(k, base_intervals) - 0.5), -depth]);
        }
        for k in (0..=wall_intervals).rev() {
            places.push([0.5 * width, -depth * fraction(k, wall_intervals)]);
        }
        places.into_iter().map(|[x, y]| mesh.add_node(x, y).unwrap()).collect()
    }
}

fn fraction(part: usize, count: usize) -> f64 {
    part as f64 / count as f64
}

/// Adds beams of this thickness along `nodes`.
fn add_beams(mesh: &mut Mesh, nodes: &[usize], thickness: f64, density: f64) {
    for ends in nodes.windows(2) {
        let inertia = thickness.powi(3) / 12.0;
        let beam = Beam::new([ends[0], ends[1]], YOUNG_MODULUS, thickness, inertia, density);
        mesh.add(beam.unwrap()).unwrap();
    }
}

/// A box of slab, walls and roof at the surface.
fn box_of_beams(thickness: f64, outline: TrenchOutline) -> FemModel {
    let mut mesh = Mesh::new();
    let nodes = outline.add_nodes(&mut mesh);
    add_beams(&mut mesh, &nodes, thickness, 2500.0);
    let mut roof = vec![nodes[0]];
    for k in 1..outline.base_intervals {
        let x = outline.width * (fraction(k, outline.base_intervals) - 0.5);
        roof.push(mesh.add_node(x, 0.0).unwrap());
    }
    roof.push(nodes[nodes.len() - 1]);
    add_beams(&mut mesh, &roof, thickness, 2500.0);
    FemModel::in_trench(mesh, &nodes).unwrap()
}

/// The rigid block of these tests as stiff solids.
fn solid_block() -> FemModel {
    let material = Material::new(1e14, 0.2, 900.0).unwrap();
    let mut mesh = Mesh::new();
    for row in 0..9 {
        for column in 0..7 {
            let x = TRENCH_WIDTH * (f64::from(column) / 6.0 - 0.5);
            let y = BLOCK_HEIGHT * f64::from(row) / 8.0;
            mesh.add_node(x, y - TRENCH_DEPTH).unwrap();
        }
    }
    for row in 0..8 {
        for column in 0..6 {
            let lower = 7 * row + column;
            let nodes = [lower, lower + 1, lower + 8, lower + 7];
            mesh.add(Quad4::new(nodes, material, QuadFormulation::default())).unwrap();
        }
    }
    // Two rows of nodes are below the surface.
    let nodes = [14, 7, 0, 1, 2, 3, 4, 5, 6, 13, 20];
    FemModel::in_trench(mesh, &nodes).unwrap()
}

/// A structure on springs in its trench under strong shaking, horizontal and vertical.
fn shaken_in_trench(structure: Box<dyn Structure>) -> Simulation {
    let record = el_centro_1940().scaled(2.0).unwrap().padded(0.5, 0.5).unwrap();
    let vertical = Some(record.scaled(0.6).unwrap());
    let motion = trench_motion(VerticalIncidence { horizontal: Some(record), vertical });
    Simulation::builder(0.01)
        .structure(structure)
        .motion(motion)
        .ground(TrenchSprings::new(&trench_elements(), 4e7, 4e5))
        .interfaces(friction_laws())
        .build()
        .unwrap()
}

/// Displacement of the top, rotation, forces, and open fractions of the right wall and the base.
fn response(state: &State, top: &DofCombination) -> [f64; 8] {
    let wall = state.face(Face::RightWall);
    [
        top.value(state.absolute_displacement()),
        state.base_rotation,
        state.base_shear,
        state.base_moment,
        wall.thrust,
        wall.shear,
        wall.open_fraction,
        state.face(Face::Base).open_fraction,
    ]
}

/// A block of stiff solids and the rigid block have the same openings, slips, rotations and pressures.
#[test]
fn stiff_solids_move_as_the_rigid_block() {
    let solid_top = solid_block().row(7 * 8 + 3, Direction::X).unwrap();
    let rigid_block = RigidBlock::new(TRENCH_WIDTH, BLOCK_HEIGHT, 900.0).unwrap();
    let rigid_top = rigid_block.horizontal_at(BLOCK_HEIGHT);
    let mut solids = shaken_in_trench(Box::new(solid_block()));
    let mut rigid_simulation = shaken_in_trench(Box::new(walled_block()));
    let mut largest = [0.0_f64; 8];
    let mut difference = [0.0_f64; 8];
    for _ in 0..600 {
        let computed = response(solids.step().unwrap(), &solid_top);
        let expected = response(rigid_simulation.step().unwrap(), &rigid_top);
        for k in 0..8 {
            largest[k] = largest[k].max(expected[k].abs());
            difference[k] = difference[k].max((computed[k] - expected[k]).abs());
        }
    }
    // Both open a wall and the base.
    assert!(largest[6] > 0.2 && largest[7] > 0.1, "{largest:?}");
    for k in 0..8 {
        assert!(difference[k] < 1e-4 * largest[k], "{k}: {difference:?} {largest:?}");
    }
}

/// Deflection of the tip of a cantilever under a force at the height z, integrated over z from 0.
///
/// A force at the height z bends the tip of a wall of height h by z² (3h − z)/(6EI).
fn deflection_integral(height: f64, bending_stiffness: f64) -> f64 {
    height.powi(3) * (TRENCH_DEPTH - 0.25 * height) / (6.0 * bending_stiffness)
}

/// Deflection of a wall's tip by the pressure at rest on an element (m).
fn deflection_by_element(element: &ContactElement, bending_stiffness: f64) -> f64 {
    let middle = element.center()[2] + TRENCH_DEPTH;
    let half_length = 0.5 * element.length();
    let pressure = 0.5 * SOIL_DENSITY * STANDARD_GRAVITY * (TRENCH_DEPTH - middle);
    pressure
        * (deflection_integral(middle + half_length, bending_stiffness)
            - deflection_integral(middle - half_length, bending_stiffness))
}

/// Walls on a rigid slab bend as cantilevers under the pressure at rest; the base alone carries the weight.
#[test]
fn walls_bend_as_cantilevers_under_the_pressure_at_rest() {
    let mut mesh = Mesh::new();
    let thickness = 0.4;
    let nodes = TrenchOutline::of_trench(6, 40).add_nodes(&mut mesh);
    add_beams(&mut mesh, &nodes, thickness, 2500.0);
    let slab = &nodes[40..=46];
    let middle = slab[3];
    let other_nodes: Vec<usize> = slab.iter().copied().filter(|node| *node != middle).collect();
    let model = FemModel::in_trench(mesh, &nodes).unwrap().with_rigid_link(middle, &other_nodes);
    let model = model.unwrap();
    let rows = [nodes[0], nodes[nodes.len() - 1], middle].map(|node| model.row(node, Direction::X));
    let rows = rows.map(Result::unwrap);
    let simulation = Simulation::builder(0.01)
        .structure(model)
        .ground(TrenchSprings::new(&trench_elements(), 4e7, 4e5))
        .interfaces(friction_laws())
        .build()
        .unwrap();
    let displacements = rows.map(|row| row.value(simulation.static_displacement()));
    let left = displacements[0] - displacements[2];
    let right = displacements[1] - displacements[2];
    let bending_stiffness = YOUNG_MODULUS * thickness.powi(3) / 12.0;
    let deflection: f64 = trench_elements().elements()[..4]
        .iter()
        .map(|element| deflection_by_element(element, bending_stiffness))
        .sum();
    assert!((left / deflection - 1.0).abs() < 1e-3, "{left} {deflection}");
    assert!((right / -deflection - 1.0).abs() < 1e-3, "{right} {deflection}");
    // A pressure that grows with depth bends by K₀ ρ g h⁵/(30 EI); constant on four elements, 8 % more.
    let deflection =
        0.5 * SOIL_DENSITY * STANDARD_GRAVITY * TRENCH_DEPTH.powi(5) / (30.0 * bending_stiffness);
    assert!((left / deflection - 1.0).abs() < 0.1, "{left} {deflection}");
    let state = simulation.state();
    let weight = 2500.0 * thickness * (TRENCH_WIDTH + 2.0 * TRENCH_DEPTH) * STANDARD_GRAVITY;
    assert!((state.face(Face::Base).thrust / weight - 1.0).abs() < 1e-9);
    for wall in [Face::LeftWall, Face::RightWall] {
        let thrust = 0.25 * SOIL_DENSITY * STANDARD_GRAVITY * TRENCH_DEPTH * TRENCH_DEPTH;
        assert!((state.face(wall).thrust / thrust - 1.0).abs() < 1e-12);
    }
}

/// Walls carry the weight on them down to the base: their axial forces and the load at which they buckle.
#[test]
fn weight_on_walls_counts_in_p_delta() {
    let mut mesh = Mesh::new();
    let nodes = TrenchOutline::of_trench(2, 4).add_nodes(&mut mesh);
    add_beams(&mut mesh, &nodes, 0.1, 0.0);
    let tops = [nodes[0], nodes[nodes.len() - 1]];
    for top in tops {
        mesh.add(LumpedMass::new(top, 20.0e3).unwrap()).unwrap();
    }
    let model = FemModel::in_trench(mesh, &nodes).unwrap();
    let model = model.with_rigid_link(nodes[5], &[nodes[4], nodes[6]]).unwrap();
    let model = model.with_p_delta(STANDARD_GRAVITY).unwrap();
    let weight = 20.0e3 * STANDARD_GRAVITY;
    let forces: Vec<f64> =
        model.mesh().elements().filter_map(basemat::fem::Element::compression).collect();
    for wall in [0..4, 6..10] {
        for force in &forces[wall] {
            assert!((force / weight - 1.0).abs() < 1e-9, "{forces:?}");
        }
    }
    let stiffness = YOUNG_MODULUS * 0.1_f64.powi(3) / 12.0;
    let euler = std::f64::consts::PI.powi(2) * stiffness / (4.0 * TRENCH_DEPTH * TRENCH_DEPTH);
    assert!((model.buckling_factor().unwrap() * weight / euler - 1.0).abs() < 1e-3);
}

/// Motions of a point fixed to the base are those of its floor, with walls and without.
#[test]
fn walls_change_no_motion_of_the_base() {
    let displacement = [0.3, -0.1, 0.02];
    let point = [2.0, 0.0, 7.0];
    let rigid_block = RigidBlock::new(TRENCH_WIDTH, BLOCK_HEIGHT, 900.0).unwrap();
    let with_walls = DofCombination::of_base(&walled_block(), point).unwrap();
    let without_walls = DofCombination::of_base(&rigid_block, point).unwrap();
    for (computed, expected) in with_walls.iter().zip(&without_walls) {
        let difference = computed.value(&displacement) - expected.value(&displacement);
        assert!(difference.abs() < 1e-12, "{difference}");
    }
}

/// Energy and forces balance while a box of beams opens and slides, and the soil only absorbs energy.
#[test]
fn a_box_of_beams_opens_and_slides_and_its_balances_close() {
    let elements = Trench::new(-0.5 * TRENCH_WIDTH..0.5 * TRENCH_WIDTH, TRENCH_DEPTH).unwrap();
    let elements = elements.elements(4, 3).unwrap();
    let laws = elements.interfaces(Coulomb::new(0.5).unwrap(), Coulomb::new(0.3).unwrap());
    let ground = TrenchGround::new(soil(), elements).unwrap().with_pressure_at_rest(0.5).unwrap();
    let record = el_centro_1940().scaled(3.0).unwrap().padded(0.2, 0.0).unwrap();
    let motion = TrenchMotion::new(&ground, record, &mut unobserved).unwrap();
    let model = box_of_beams(0.5, TrenchOutline::of_trench(8, 6));
    let model = model.with_p_delta(STANDARD_GRAVITY).unwrap();
    let mut simulation = Simulation::builder(0.02)
        .structure(model)
        .ground(ground)
        .interfaces(laws)
        .motion(motion)
        .expected_steps(256)
        .build()
        .unwrap();
    let mut smallest_energy = 0.0_f64;
    let mut largest_energy = 0.0_f64;
    let mut wall_opening = 0.0_f64;
    let mut slips = 0;
    let run = simulation
        .run(256, |state| {
            smallest_energy = smallest_energy.min(state.energy_balance.soil);
            largest_energy = largest_energy.max(state.energy_balance.soil);
            let left_wall = state.face(Face::LeftWall);
            let right_wall = state.face(Face::RightWall);
            wall_opening = wall_opening.max(left_wall.open_fraction);
            slips += state.modes.iter().filter(|mode| mode.is_slip()).count();
            let shear = right_wall.thrust - left_wall.thrust + state.face(Face::Base).shear;
            assert!((state.base_shear - shear).abs() < 1e-9 * state.normal_force);
        })
        .unwrap();
    assert!(run.energy_error < 1e-9, "{}", run.energy_error);
    assert!(smallest_energy > -1e-12 * largest_energy, "{smallest_energy} {largest_energy}");
    assert!(wall_opening > 0.3 && slips > 10, "{wall_opening} {slips}");
}

/// Distance by which struts push the walls apart, and warnings of walls with few elements.
///
/// Struts act between the middles of both walls, which have so many elements and this thickness (m).
fn strutted_box(
    wall_elements: usize,
    thickness: f64,
    kernels: &SharedKernels,
) -> Result<(f64, Vec<Warning>)> {
    let elements = Trench::new(-4.0..4.0, 8.0)?.elements(8, wall_elements)?;
    let outline = TrenchOutline { width: 8.0, depth: 8.0, base_intervals: 32, wall_intervals: 32 };
    let model = box_of_beams(thickness, outline);
    let struts = [16, 32 + 32 + 16].map(|node| model.row(node, Direction::X).unwrap());
    let strut = struts[1].clone() - struts[0].clone();
    let ground = TrenchGround::new(soil(), elements)?.with_pressure_at_rest(0.0)?;
    let mut simulation = Simulation::builder(0.02)
        .structure(model)
        .ground(ground.with_shared_kernels(kernels))
        .interface(Coulomb::new(0.5)?)
        .load(Load::constant(strut.clone(), 100.0e3))
        .expected_steps(1)
        .build()?;
    let extension = strut.value(simulation.static_displacement());
    let mut warnings = simulation.run(1, |_| {})?.warnings;
    warnings.retain(|warning| matches!(warning, Warning::CoarseBase { axis: Some('z'), .. }));
    Ok((extension, warnings))
}

/// A run has a warning with the number of elements that flexible walls need for errors below 3 %.
///
/// A wall of one element causes a warning, too; a wall that is eight times as thin is an error.
#[test]
fn walls_on_too_few_elements_are_told() {
    let kernels = SharedKernels::default();
    let (reference, warnings) = strutted_box(8, 0.4, &kernels).unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
    for (wall_elements, expected_need) in [(2, 7..=7), (1, 3..=9)] {
        let (coarse, warnings) = strutted_box(wall_elements, 0.4, &kernels).unwrap();
        assert!((coarse / reference - 1.0).abs() > 0.15, "{coarse} {reference}");
        let [Warning::CoarseBase { foundation: 0, elements, needed, .. }] = warnings[..] else {
            panic!("{warnings:?}")
        };
        assert!(elements == wall_elements && expected_need.contains(&needed), "{warnings:?}");
        let (sufficient, _) = strutted_box(needed, 0.4, &kernels).unwrap();
        assert!((sufficient / reference - 1.0).abs() < 0.03, "{sufficient} {reference}");
    }
    let Err(Error::CoarseBase(CoarseBaseError {
        foundation: 0,
        elements: 1,
        needed,
        difference,
        ..
    })) = strutted_box(1, 0.05, &kernels)
    else {
        panic!("a thin wall on one element")
    };
    assert!(needed > 30 && difference.is_some_and(|value| value > 0.3), "{needed} {difference:?}");
}

/// A model of walls and base whose list of nodes is changed.
fn model_with_outline(change: impl Fn(&mut Vec<usize>)) -> Result<FemModel> {
    let mut mesh = Mesh::new();
    let mut nodes = TrenchOutline::of_trench(2, 2).add_nodes(&mut mesh);
    add_beams(&mut mesh, &nodes, 0.4, 2500.0);
    change(&mut nodes);
    FemModel::in_trench(mesh, &nodes)
}

/// Outlines in another order, and nodes that do not exist or do not move, are errors.
#[test]
fn wrong_outlines_are_errors() {
    assert!(model_with_outline(|_| {}).is_ok());
    assert!(model_with_outline(|nodes| nodes.truncate(3)).is_ok());
    for change in [
        &|nodes: &mut Vec<usize>| nodes.reverse(),
        &|nodes: &mut Vec<usize>| nodes.swap(0, 1),
        &|nodes: &mut Vec<usize>| nodes.retain(|node| *node != 2),
        &|nodes: &mut Vec<usize>| nodes.insert(1, 0),
    ] as [&dyn Fn(&mut Vec<usize>); 4]
    {
        let error = model_with_outline(change).err();
        let names_outline =
            matches!(error, Some(Error::Scene { quantity: "outline in a trench", .. }));
        assert!(names_outline, "{error:?}");
    }
    let unknown_node = model_with_outline(|nodes| nodes.push(99));
    assert!(matches!(unknown_node, Err(Error::Index { .. })));
    let single_node = model_with_outline(|nodes| nodes.truncate(1));
    assert!(matches!(single_node, Err(Error::Size { .. })));
    let space = FemModel::in_trench(Mesh::in_space(), &[0, 1]);
    assert!(matches!(space, Err(Error::Scene { .. })));
}
