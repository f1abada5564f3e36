//! GOAL: rigid motions cause no force.
//! SCENE: random models in space, all structures of the table, reduced models and a mesh from Gmsh; with P–Δ the motions
//! that leave columns upright.
//! REFERENCE: zero force; the number of zero eigenvalues.

use basemat::fem::{BeamSection, Direction, Material};
use basemat::io::{GmshPart, GmshSpaceMesh};
use basemat::structure::{CraigBampton, FemModel, Structure};
use basemat_problems::dense::{eigenpairs, largest, product, stiffness};
use basemat_problems::directions::NODE_DIRECTIONS;
use basemat_problems::random::Random;

use super::blueprint::{Blueprint, Piece};
use super::models::brick_points;
use super::numbers::Numbers;
use super::parts::{BodyPart, Choice, Space, covering};
use super::structures;
use super::tally::{IdentityTally, scenes};
use super::view::PLAIN_VIEW;

/// Rounding of a force, relative to the sum of magnitudes of its terms.
const FORCE_ROUNDING: f64 = 1e-12;

/// Largest force by a motion, relative to the largest sum of magnitudes of its terms.
fn relative_force(structure: &dyn Structure, motion: &[f64]) -> f64 {
    let mut matrix = basemat::structure::Triplets::new(structure.dofs());
    structure.stiffness(&mut matrix).unwrap();
    let forces = product(&matrix, motion);
    let mut magnitudes = vec![0.0; motion.len()];
    for &(row, column, value) in matrix.entries() {
        magnitudes[row] += (value * motion[column]).abs();
    }
    largest(&forces) / largest(&magnitudes)
}

/// A raft with random columns, braces, walls and bricks, leaning and with random masses.
fn building(random: &mut Random) -> Blueprint {
    let mut plan = Blueprint::new(true, 30e9, 2500.0);
    let sides = [random.within(6.0, 14.0), random.within(5.0, 10.0)];
    let height = random.within(4.0, 15.0);
    let below = plan.grid(sides, [2, 2], 0.0);
    let above = plan.grid(sides, [2, 2], height);
    for corners in Blueprint::cells(&below) {
        plan.pieces.push(Piece::Shell(corners.to_vec(), 1.0));
    }
    for node in above.iter().flatten() {
        for axis in 0..3 {
            plan.points[*node][axis] += random.within(-0.6, 0.6);
        }
    }
    let pairs: Vec<[usize; 2]> = below
        .iter()
        .flatten()
        .zip(above.iter().flatten())
        .map(|(foot, top)| [*foot, *top])
        .collect();
    for &[foot, top] in &pairs {
        let side = random.within(0.3, 0.9);
        plan.pieces.push(Piece::SpaceBeam([foot, top], side, [1.0, 0.3, 0.1]));
        plan.pieces.push(Piece::Mass(top, random.log_within(1e4, 3e5)));
    }
    for row in &above {
        for ends in row.windows(2) {
            plan.pieces.push(Piece::SpaceBeam([ends[0], ends[1]], 0.4, [0.0, 0.1, 1.0]));
        }
    }
    for column in 0..3 {
        for ends in above.windows(2) {
            let ends = [ends[0][column], ends[1][column]];
            plan.pieces.push(Piece::SpaceBeam(ends, 0.4, [0.1, 0.0, 1.0]));
        }
    }
    if random.chance(0.5) {
        plan.pieces.push(Piece::Truss([pairs[0][0], pairs[1][1]], 5e-3));
    }
    if random.chance(0.4) {
        let wall = vec![below[0][0], below[0][1], above[0][1], above[0][0]];
        // A wall is flat.
        for k in [2, 3] {
            plan.points[wall[k]][1] = plan.points[wall[0]][1];
        }
        plan.pieces.push(Piece::Shell(wall, 0.2));
    }
    if random.chance(0.3) {
        let points = brick_points(Blueprint::cells(&below)[3], Blueprint::cells(&above)[3]);
        plan.pieces.push(Piece::Brick(points));
    }
    if random.chance(0.3) {
        let leader = above[1][1];
        let followers = above.iter().flatten().copied().filter(|node| *node != leader).collect();
        plan.link = Some((leader, followers));
    }
    plan
}

/// Whether a motion causes no force: with P–Δ, whether it leaves columns upright.
fn is_free(direction: Direction, has_p_delta: bool) -> bool {
    !has_p_delta || !matches!(direction, Direction::RotationX | Direction::RotationY)
}

/// GOAL: rigid motions of random models in space cause no force.
#[test]
fn models_in_space_turn_freely() {
    let mut tally = IdentityTally::new("rigid motions: models in space");
    let mut random = Random(731);
    for number in 0..scenes(20, 400) {
        let mut plan = building(&mut random);
        plan.p_delta = number % 2 == 1;
        let name = if plan.p_delta { "with P–Δ" } else { "without P–Δ" };
        tally.scene(&["shells and beams", name]);
        let model = match plan.model(&PLAIN_VIEW) {
            Ok(model) => model,
            Err(error) => {
                tally.add_error(format!("{number}: {error}"));
                continue;
            }
        };
        let middle = [random.within(-5.0, 5.0), random.within(-5.0, 5.0), 0.0];
        for direction in NODE_DIRECTIONS {
            if is_free(direction, plan.p_delta) {
                let force = relative_force(&model, &model.rigid_motion(direction, middle));
                tally.within(&format!("{number}: {direction:?} {name}"), force, FORCE_ROUNDING);
            }
        }
    }
    tally.close(0.8);
}

/// Number of motions without force, by the eigenvalues of the matrix scaled to a unit diagonal.
fn free_motion_count(structure: &dyn Structure) -> usize {
    let mut matrix = stiffness(structure);
    let max_magnitude = (0..matrix.len()).fold(0.0, |max: f64, k| max.max(matrix[k][k]));
    if max_magnitude == 0.0 {
        return matrix.len();
    }
    let scales: Vec<f64> = (0..matrix.len())
        .map(|k| {
            if matrix[k][k] > 1e-14 * max_magnitude {
                matrix[k][k].sqrt()
            } else {
                max_magnitude.sqrt()
            }
        })
        .collect();
    for (i, row) in matrix.iter_mut().enumerate() {
        for (j, value) in row.iter_mut().enumerate() {
            *value /= scales[i] * scales[j];
        }
    }
    eigenpairs(&matrix).0.iter().filter(|value| value.abs() < 1e-11).count()
}

/// GOAL: all structures have three rigid motions in the plane and six in space; with P–Δ those that leave columns upright.
#[test]
fn every_structure_has_all_rigid_motions() {
    let mut tally = IdentityTally::new("rigid motions: all structures");
    for space in [Space::Plane, Space::Plan] {
        for choice in bodies(space) {
            tally.scene(&[choice.body.word()]);
            let numbers = Numbers::draw(choice.seed);
            let structure =
                structures::structure(&choice, &numbers, &PLAIN_VIEW).unwrap().structure;
            let has_p_delta = matches!(
                choice.body,
                BodyPart::Slender | BodyPart::SlenderFloors | BodyPart::SlenderFrame
            );
            let expected = match (space, has_p_delta) {
                (Space::Plan, false) => 6,
                (Space::Plan, true) => 4,
                (_, false) if choice.body == BodyPart::Pair => 6,
                (_, false) => 3,
                (_, true) => 2,
            };
            if choice.body.is_nonlinear() {
                continue;
            }
            let count = free_motion_count(structure.as_ref());
            if count != expected {
                tally.fail(format!("{}: {count} rigid motions, not {expected}", choice.name()));
            }
        }
    }
    tally.close(1.0);
}

/// A few choices of each structure.
fn bodies(space: Space) -> Vec<Choice> {
    let mut chosen_scenes: Vec<Choice> = Vec::new();
    for choice in covering(space, 77, 120) {
        if chosen_scenes.iter().filter(|other| other.body == choice.body).count() < scenes(2, 8) {
            chosen_scenes.push(choice);
        }
    }
    chosen_scenes
}

/// GOAL: reduced models keep six rigid motions.
#[test]
fn reduced_models_keep_them() {
    let mut tally = IdentityTally::new("rigid motions: reduced models");
    let mut random = Random(733);
    for number in 0..scenes(6, 60) {
        let mut plan = building(&mut random);
        plan.link = None;
        tally.scene(&["reduced model", "shells and beams"]);
        let model = plan.model(&PLAIN_VIEW).unwrap();
        match CraigBampton::new(4).reduce(model) {
            Ok(reduced) => {
                let count = free_motion_count(&reduced);
                if count != 6 {
                    tally.fail(format!("{number}: {count} rigid motions, not 6"));
                }
            }
            Err(error) => tally.add_error(format!("{number}: {error}")),
        }
    }
    tally.close(0.8);
}

/// GOAL: rigid motions of a mesh from Gmsh cause no force.
#[test]
fn meshes_from_gmsh_turn_freely() {
    let mut tally = IdentityTally::new("rigid motions: meshes from Gmsh");
    let concrete = Material::new(30.0e9, 0.2, 2500.0).unwrap();
    let section = BeamSection::new(0.2, [0.002, 0.004], 0.003).unwrap();
    let parts = [
        ("block", GmshPart::Solid(concrete)),
        ("wall", GmshPart::Shell(concrete, 0.25)),
        ("column", GmshPart::Beam(concrete, section, [1.0, 0.0, 0.0])),
        ("beam", GmshPart::Beam(concrete, section, [0.0, 0.0, 1.0])),
    ];
    let file = GmshSpaceMesh::read(basemat_problems::data_path("gmsh/space.msh")).unwrap();
    for p_delta in [false, true] {
        tally.scene(&["Gmsh", if p_delta { "with P–Δ" } else { "without P–Δ" }]);
        let base = file.cells(2, "base").unwrap();
        let model = FemModel::on_faces(file.mesh(&parts).unwrap(), &base).unwrap();
        let model = if p_delta { model.with_p_delta(9.81).unwrap() } else { model };
        for direction in NODE_DIRECTIONS {
            if is_free(direction, p_delta) {
                let force =
                    relative_force(&model, &model.rigid_motion(direction, [1.0, -2.0, 0.5]));
                tally.within(&format!("{direction:?}, P–Δ {p_delta}"), force, FORCE_ROUNDING);
            }
        }
    }
    tally.close(1.0);
}
