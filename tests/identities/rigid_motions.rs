//! Rigid motions meet no force: in stiffness matrices, with P–Δ where the motion leaves the columns upright, reduced, and
//! of meshes from Gmsh.

use basemat::fem::{BeamSection, Direction, Material};
use basemat::io::{GmshPart, GmshSpaceMesh};
use basemat::structure::{CraigBampton, FemModel, Structure};
use basemat_problems::dense::{eigenpairs, product, stiffness};
use basemat_problems::directions::IN_SPACE;
use basemat_problems::random::Random;

use super::blueprint::{Blueprint, Piece};
use super::numbers::Numbers;
use super::parts::{Body, Choice, Space, covering};
use super::structures;
use super::tally::{Tally, scenes};
use super::view::PLAIN;

/// Rounding of a force, of the sum of its parts' magnitudes.
const ROUNDING: f64 = 1e-12;

/// Largest force by a motion, of the sum of magnitudes from which it is computed.
fn force(structure: &dyn Structure, motion: &[f64]) -> f64 {
    let mut matrix = basemat::structure::Triplets::new(structure.dofs());
    structure.stiffness(&mut matrix).unwrap();
    let forces = product(&matrix, motion);
    let mut magnitudes = vec![0.0; motion.len()];
    for &(row, column, value) in matrix.entries() {
        magnitudes[row] += (value * motion[column]).abs();
    }
    let scale = magnitudes.iter().fold(0.0, |scale: f64, value| scale.max(*value));
    forces.iter().fold(0.0, |largest: f64, value| largest.max(value.abs())) / scale
}

/// A raft with random columns, braces, walls and bricks, leaning and with masses anywhere.
fn building(random: &mut Random) -> Blueprint {
    let mut plan = Blueprint::new(true, 30e9, 2500.0);
    let sides = [random.within(6.0, 14.0), random.within(5.0, 10.0)];
    let height = random.within(4.0, 15.0);
    let below = plan.grid(sides, [2, 2], 0.0);
    let above = plan.grid(sides, [2, 2], height);
    let cells = |rows: &[Vec<usize>]| Blueprint::cells(rows);
    for corners in cells(&below) {
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
        let [a, b, c, d] = cells(&below)[3];
        let [e, f, g, h] = cells(&above)[3];
        plan.pieces.push(Piece::Brick([a, b, c, d, e, f, g, h]));
    }
    if random.chance(0.3) {
        let leader = above[1][1];
        let followers = above.iter().flatten().copied().filter(|node| *node != leader).collect();
        plan.link = Some((leader, followers));
    }
    plan
}

/// Motions that leave a structure with P–Δ in equilibrium.
fn upright(direction: Direction) -> bool {
    !matches!(direction, Direction::RotationX | Direction::RotationY)
}

#[test]
fn models_in_space_turn_freely() {
    let mut tally = Tally::new("rigid motions: models in space");
    let mut random = Random(731);
    for number in 0..scenes(20, 400) {
        let mut plan = building(&mut random);
        plan.p_delta = number % 2 == 1;
        let name = if plan.p_delta { "with P–Δ" } else { "without P–Δ" };
        tally.scene(&["shells and beams", name]);
        let model = match plan.model(&PLAIN) {
            Ok(model) => model,
            Err(error) => {
                tally.refuse(format!("{number}: {error}"));
                continue;
            }
        };
        let middle = [random.within(-5.0, 5.0), random.within(-5.0, 5.0), 0.0];
        for direction in IN_SPACE.into_iter().filter(|own| !plan.p_delta || upright(*own)) {
            let value = force(&model, &model.rigid_motion(direction, middle));
            tally.within(&format!("{number}: {direction:?} {name}"), value, ROUNDING);
        }
    }
    tally.close(0.8);
}

/// Number of motions without force, by the eigenvalues of the matrix scaled to a diagonal of one.
fn free_motions(structure: &dyn Structure) -> usize {
    let mut matrix = stiffness(structure);
    let largest = (0..matrix.len()).fold(0.0, |largest: f64, k| largest.max(matrix[k][k]));
    if largest == 0.0 {
        return matrix.len();
    }
    let scales: Vec<f64> = (0..matrix.len())
        .map(|k| if matrix[k][k] > 1e-14 * largest { matrix[k][k].sqrt() } else { largest.sqrt() })
        .collect();
    for (i, row) in matrix.iter_mut().enumerate() {
        for (j, value) in row.iter_mut().enumerate() {
            *value /= scales[i] * scales[j];
        }
    }
    let (values, _) = eigenpairs(&matrix);
    values.iter().filter(|value| value.abs() < 1e-11).count()
}

/// All structures of the table have three rigid motions in the plane and six in space, and with P–Δ those that leave
/// columns upright.
#[test]
fn every_structure_has_all_rigid_motions() {
    let mut tally = Tally::new("rigid motions: all structures");
    for space in [Space::Plane, Space::Plan] {
        for choice in bodies(space) {
            tally.scene(&[choice.body.word()]);
            let numbers = Numbers::draw(choice.seed);
            let structure = structures::structure(&choice, &numbers, &PLAIN).unwrap().structure;
            let slender =
                matches!(choice.body, Body::Slender | Body::SlenderFloors | Body::SlenderFrame);
            let needed = match (space, slender) {
                (Space::Plan, false) => 6,
                (Space::Plan, true) => 4,
                (_, false) if choice.body == Body::Pair => 6,
                (_, false) => 3,
                (_, true) => 2,
            };
            if choice.body.is_nonlinear() {
                continue;
            }
            let found = free_motions(structure.as_ref());
            if found != needed {
                tally.fail(format!("{}: {found} rigid motions, not {needed}", choice.name()));
            }
        }
    }
    tally.close(1.0);
}

/// A choice of each structure.
fn bodies(space: Space) -> Vec<Choice> {
    let mut chosen: Vec<Choice> = Vec::new();
    for choice in covering(space, 77, 120) {
        if chosen.iter().filter(|own| own.body == choice.body).count() < scenes(2, 8) {
            chosen.push(choice);
        }
    }
    chosen
}

#[test]
fn reduced_models_keep_them() {
    let mut tally = Tally::new("rigid motions: reduced models");
    let mut random = Random(733);
    for number in 0..scenes(6, 60) {
        let mut plan = building(&mut random);
        plan.link = None;
        tally.scene(&["reduced model", "shells and beams"]);
        let model = plan.model(&PLAIN).unwrap();
        match CraigBampton::new(4).reduce(model) {
            Ok(reduced) => {
                let found = free_motions(&reduced);
                if found != 6 {
                    tally.fail(format!("{number}: {found} rigid motions, not 6"));
                }
            }
            Err(error) => tally.refuse(format!("{number}: {error}")),
        }
    }
    tally.close(0.8);
}

#[test]
fn meshes_from_gmsh_turn_freely() {
    let mut tally = Tally::new("rigid motions: meshes from Gmsh");
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
        for direction in IN_SPACE.into_iter().filter(|own| !p_delta || upright(*own)) {
            let value = force(&model, &model.rigid_motion(direction, [1.0, -2.0, 0.5]));
            tally.within(&format!("{direction:?}, P–Δ {p_delta}"), value, ROUNDING);
        }
    }
    tally.close(1.0);
}
