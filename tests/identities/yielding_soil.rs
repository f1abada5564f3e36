//! GOAL: bodies of soil that yields are the same whichever way they are written.
//! SCENE: random scenes of all laws, grounds, motions and schemes with a body of clay or sand.
//! REFERENCE: linear meshes for soil that never yields; meshes in one piece, from a builder or node by node; each body of a
//! group alone on its springs.

use basemat::Result;
use basemat::Simulation;
use basemat::bem::SpringGround;
use basemat::coupled::SimulationBuilder;
use basemat::fem::{Direction, Mesh, Quad8};
use basemat::interface::{Bonded, Coulomb};
use basemat::structure::{DofCombination, FemModel, Structure, StructureGroup};
use basemat_problems::random::Random;
use basemat_problems::scenes::SCENE_GRAVITY;

use super::blueprint::{Blueprint, Piece, QuadLaw};
use super::compare::{ComparedGroups, compare_response, relative_difference, usual_response};
use super::grounds::record;
use super::models;
use super::numbers::{Numbers, RUN_STEPS};
use super::parts::{BodyPart, Choice, CoordinatePart, Space, covering};
use super::scene::run_with;
use super::structures::{ProbedStructure, of_blueprint};
use super::tally::{IdentityTally, scenes};
use super::view::PLAIN_VIEW;

/// Largest relative difference; static states are accurate to 1e-10, steps to Newton's tolerance.
const DIFFERENCE_LIMIT: f64 = 1e-7;
/// Strength of soil that never yields, relative to the pressure of its weight.
const BOUNDLESS_STRENGTH: f64 = 1e7;

/// Choices of all parts around a body in physical coordinates.
fn choices(body: BodyPart, seed: u64, count: usize) -> Vec<Choice> {
    let choices = covering(Space::Plane, seed, count).into_iter();
    let coordinate = CoordinatePart::Physical;
    choices.map(|choice| Choice { body, coordinate, ..choice }).collect()
}

/// Runs a choice on a blueprint, and compares the response with the usual one of the choice.
fn compare_plan(
    choice: &Choice,
    plan: impl Fn(&Numbers) -> Blueprint,
    groups_to_compare: &ComparedGroups,
    tally: &mut IdentityTally,
) {
    let Some(usual) = usual_response(choice, tally) else { return };
    let numbers = Numbers::draw(choice.seed);
    let response = of_blueprint(&plan(&numbers), &PLAIN_VIEW)
        .and_then(|made| run_with(choice, &numbers, &PLAIN_VIEW, made));
    let place = format!("{}: {}", groups_to_compare.place, choice.name());
    let groups_to_compare = ComparedGroups { place: &place, ..*groups_to_compare };
    compare_response(choice, &usual, &groups_to_compare, response, DIFFERENCE_LIMIT, tally);
}

/// GOAL: clay far from its strength gives the response of the linear mesh.
#[test]
fn soil_that_never_yields_is_linear() {
    let mut tally = IdentityTally::new("yielding soil: far from its strength");
    // The stored energy of a yielding solid contains that of the static state, the strain energy of a linear mesh does not.
    let groups = &["forces", "moments", "rotations", "top"];
    for choice in choices(BodyPart::Quads8, 171, scenes(16, 300)) {
        let strong_clay = |numbers: &Numbers| Blueprint {
            quad_law: QuadLaw::Clay(BOUNDLESS_STRENGTH * numbers.pressure()),
            ..models::quads(numbers, true)
        };
        let place = "clay far from its strength";
        compare_plan(&choice, strong_clay, &ComparedGroups { place, groups }, &mut tally);
        let strong_sand = |numbers: &Numbers| Blueprint {
            quad_law: QuadLaw::Sand(BOUNDLESS_STRENGTH * numbers.pressure()),
            ..models::quads(numbers, true)
        };
        let place = "sand far from its strength";
        compare_plan(&choice, strong_sand, &ComparedGroups { place, groups }, &mut tally);
    }
    tally.close(0.75);
}

/// The blueprint in two parts below and above a height, whose nodes at this height are tied.
fn divided(plan: &Blueprint, height: f64) -> Blueprint {
    let mut divided_plan = plan.clone();
    let is_at_height = |point: usize| (plan.points[point][2] - height).abs() < 1e-9 * height;
    let mut upper_points: Vec<usize> = (0..plan.points.len()).collect();
    for point in (0..plan.points.len()).filter(|point| is_at_height(*point)) {
        upper_points[point] = divided_plan.point(plan.points[point]);
        divided_plan.ties.push([point, upper_points[point]]);
    }
    for piece in &mut divided_plan.pieces {
        let Piece::Quad8(points) = piece else { continue };
        let mean_height = points.iter().map(|point| plan.points[*point][2]).sum::<f64>() / 8.0;
        if mean_height > height {
            *points = points.map(|point| upper_points[point]);
        }
    }
    assert!(!divided_plan.ties.is_empty());
    divided_plan
}

/// GOAL: a mesh is the same as two meshes whose common nodes are tied.
#[test]
fn one_mesh_is_two_tied_meshes() {
    let mut tally = IdentityTally::new("yielding soil: one mesh, and two that are tied");
    for choice in choices(BodyPart::Clay, 172, scenes(12, 200)) {
        let in_two_parts =
            |numbers: &Numbers| divided(&models::clay(numbers), 0.5 * numbers.height);
        compare_plan(&choice, in_two_parts, &ComparedGroups::all("two tied meshes"), &mut tally);
    }
    tally.close(0.75);
}

/// Columns and rows of the block.
const BLOCK_COLUMNS: usize = 3;
const BLOCK_ROWS: usize = 2;

/// A block of clay between the lines of a grid by the builder of blocks.
fn built_block(numbers: &Numbers) -> Result<FemModel> {
    let material = models::clay(numbers).quad_material(&PLAIN_VIEW)?;
    let x_lines: Vec<f64> = (0..=BLOCK_COLUMNS)
        .map(|k| numbers.sides[0] * (k as f64 / BLOCK_COLUMNS as f64 - 0.5))
        .collect();
    let y_lines: Vec<f64> =
        (0..=BLOCK_ROWS).map(|k| numbers.height * k as f64 / BLOCK_ROWS as f64).collect();
    FemModel::on_base(Mesh::quad8_block(&x_lines, &y_lines, |_, _| material.clone())?)
}

/// The same block node by node, column by column from the right, with elements from the top.
fn block_by_hand(numbers: &Numbers) -> Result<FemModel> {
    let material = models::clay(numbers).quad_material(&PLAIN_VIEW)?;
    let mut mesh = Mesh::new();
    let mut nodes = [[usize::MAX; 2 * BLOCK_ROWS + 1]; 2 * BLOCK_COLUMNS + 1];
    for i in (0..=2 * BLOCK_COLUMNS).rev() {
        for j in 0..=2 * BLOCK_ROWS {
            if i % 2 == 0 || j % 2 == 0 {
                let x = numbers.sides[0] * (i as f64 / (2 * BLOCK_COLUMNS) as f64 - 0.5);
                let y = numbers.height * j as f64 / (2 * BLOCK_ROWS) as f64;
                nodes[i][j] = mesh.add_node(x, y)?;
            }
        }
    }
    for row in (0..BLOCK_ROWS).rev() {
        for column in 0..BLOCK_COLUMNS {
            let steps = [[0, 0], [2, 0], [2, 2], [0, 2], [1, 0], [2, 1], [1, 2], [0, 1]];
            let corners = steps.map(|[i, j]| nodes[2 * column + i][2 * row + j]);
            mesh.add(Quad8::new(corners, material.clone()))?;
        }
    }
    FemModel::on_base(mesh)
}

/// A model with its displacements at the upper right corner.
fn with_top(numbers: &Numbers, model: FemModel) -> Result<ProbedStructure> {
    let node = model.mesh().node_at(0.5 * numbers.sides[0], numbers.height)?;
    let top =
        [model.row(node, Direction::X)?, DofCombination::default(), model.row(node, Direction::Y)?];
    Ok(ProbedStructure::new(model, top))
}

/// GOAL: a block from the builder is the same as one node by node in another order.
#[test]
fn blocks_are_their_nodes_and_elements() {
    let mut tally = IdentityTally::new("yielding soil: blocks, and node by node");
    for choice in choices(BodyPart::Clay, 173, scenes(12, 200)) {
        super::grounds::clear_shared_kernels();
        let numbers = Numbers::draw(choice.seed);
        tally.scene(&choice.words());
        let place = choice.name();
        let results = [built_block(&numbers), block_by_hand(&numbers)]
            .map(|model| run_with(&choice, &numbers, &PLAIN_VIEW, with_top(&numbers, model?)?));
        match results {
            [Ok(usual), response] => {
                // Perturbed scenes are those of the choice, whose body leans a little.
                let compared_groups = ComparedGroups::all(&place);
                compare_response(
                    &choice,
                    &usual,
                    &compared_groups,
                    response,
                    DIFFERENCE_LIMIT,
                    &mut tally,
                );
            }
            [Err(error), Err(_)] => tally.add_error(format!("{place}: {error}")),
            [Err(error), Ok(_)] => tally.fail(format!("{place}: one alone is an error, {error}")),
        }
    }
    tally.close(0.75);
}

/// A scene of a structure on springs, shaken along x.
fn on_springs(
    numbers: &Numbers,
    friction: Option<f64>,
    structure: Box<dyn Structure>,
) -> Result<SimulationBuilder> {
    let stiffness = numbers.modulus / numbers.sides[0];
    let bed = SpringGround::under(structure.as_ref(), 5, 2.0 * stiffness, 1.5 * stiffness)?;
    let builder = Simulation::builder(numbers.time_step)
        .gravity(SCENE_GRAVITY)
        .ground(bed.with_dashpots(0.01 * stiffness, 0.01 * stiffness)?)
        .structure(structure)
        .motion(record(numbers, numbers.peaks[0], &PLAIN_VIEW)?);
    Ok(match friction {
        Some(friction) => builder.interface(Coulomb::new(friction)?),
        None => builder.interface(Bonded),
    })
}

/// Shear force, normal force and moment over the width under each foundation, all steps of one after the other.
fn foundation_forces(numbers: &Numbers, builder: SimulationBuilder) -> Result<Vec<Vec<f64>>> {
    let mut simulation = builder.build()?;
    let mut lists = vec![Vec::new(); simulation.state().foundations.len()];
    for _ in 0..RUN_STEPS {
        let state = simulation.step()?;
        for (list, foundation) in lists.iter_mut().zip(&state.foundations) {
            list.push(foundation.base_shear);
            list.push(foundation.normal_force);
            list.push(foundation.base_moment / numbers.sides[0]);
        }
    }
    Ok(lists)
}

/// GOAL: springs do not couple bodies: each body of a group moves as if it stood alone.
#[test]
fn bodies_of_a_group_on_springs_stand_alone() {
    let mut tally = IdentityTally::new("yielding soil: group on springs");
    let mut random = Random(174);
    for number in 0..scenes(10, 150) {
        let numbers = Numbers::draw(random.bits());
        let friction = random.chance(0.6).then_some(numbers.friction);
        let bodies = || -> Result<[Box<dyn Structure>; 2]> {
            let clay = of_blueprint(&models::clay(&numbers), &PLAIN_VIEW)?.structure;
            let sand = of_blueprint(&models::sand(&numbers), &PLAIN_VIEW)?.structure;
            Ok([clay, sand])
        };
        let together = || -> Result<Vec<Vec<f64>>> {
            let mut group = StructureGroup::new();
            for (index, body) in bodies()?.into_iter().enumerate() {
                group = group.with(body, 3.0 * index as f64 * numbers.sides[0])?;
            }
            foundation_forces(&numbers, on_springs(&numbers, friction, Box::new(group))?)
        };
        let alone = || -> Result<Vec<Vec<f64>>> {
            let mut lists = Vec::new();
            for body in bodies()? {
                lists.extend(foundation_forces(&numbers, on_springs(&numbers, friction, body)?)?);
            }
            Ok(lists)
        };
        let law = if friction.is_some() { "Coulomb" } else { "bonded" };
        tally.scene(&["clay that yields", "sand that yields", "springs", law]);
        let place = format!("{number}: {law}, {:.2?} m", numbers.sides);
        tally.compare(&place, [alone(), together()], |tally, expected, computed| {
            for (index, (one, other)) in expected.iter().zip(&computed).enumerate() {
                let difference = relative_difference(one, other);
                tally.within(&format!("body {index}, {place}"), difference, DIFFERENCE_LIMIT);
            }
        });
    }
    tally.close(0.75);
}
