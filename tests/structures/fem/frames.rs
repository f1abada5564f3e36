//! GOAL: beam–columns, rotary inertia and rigid links.
//! SCENE: compressed and leaning columns, simply supported beams, rigid arms and blocks.
//! REFERENCE: Euler, Engesser, Timoshenko 1921, and closed-form sway.

use basemat::Error;
use basemat::fem::{Beam, Direction, Layer, LumpedMass, MassKind, Material, Mesh};
use basemat::structure::{BaseNode, DofCombination, FemModel, RigidBlock, Structure};
use basemat_problems::dense::{
    dot, eigenvalues, form, largest, mass, multiply, solve_with_prescribed, stiffness, submatrix,
};

const YOUNG_MODULUS: f64 = 30.0e9;
const SECTION_AREA: f64 = 0.4;
const SECOND_MOMENT: f64 = 0.02;
const MASS_DENSITY: f64 = 2400.0;
const COLUMN_LENGTH: f64 = 8.0;
const SHEAR_STIFFNESS: f64 = 4.0e8;

/// Column of beams on node 0, with a second foot for the base; `change` alters each beam.
fn column(elements: usize, change: impl Fn(Beam) -> Beam) -> FemModel {
    let mut mesh = Mesh::new();
    for k in 0..=elements {
        mesh.add_node(0.0, COLUMN_LENGTH * k as f64 / elements as f64).unwrap();
    }
    for k in 0..elements {
        let beam = Beam::new([k, k + 1], YOUNG_MODULUS, SECTION_AREA, SECOND_MOMENT, MASS_DENSITY)
            .unwrap();
        mesh.add(change(beam)).unwrap();
    }
    let other_node = mesh.add_node(1.0, 0.0).unwrap();
    mesh.add(LumpedMass::new(other_node, 1.0).unwrap()).unwrap();
    FemModel::new(mesh, &[0, other_node]).unwrap()
}

/// Degrees of freedom above the clamped foot.
fn above(model: &FemModel) -> Vec<usize> {
    (3..model.dofs() - 2).collect()
}

/// Euler's load of a cantilever, by Engesser with shear: P_E/(1 + P_E/(G A_s)).
#[test]
fn columns_buckle_under_eulers_load() {
    let euler = std::f64::consts::PI.powi(2) * YOUNG_MODULUS * SECOND_MOMENT
        / (4.0 * COLUMN_LENGTH * COLUMN_LENGTH);
    for shear in [None, Some(SHEAR_STIFFNESS)] {
        let critical = shear.map_or(euler, |stiffness| euler / (1.0 + euler / stiffness));
        for (factor, stands) in [(0.999, true), (1.001, false)] {
            let model = column(8, |beam| {
                let beam = match shear {
                    Some(stiffness) => beam.with_shear_stiffness(stiffness).unwrap(),
                    None => beam,
                };
                beam.with_compression(factor * critical).unwrap()
            });
            let free = above(&model);
            let lowest_square = eigenvalues(
                &submatrix(&stiffness(&model), &free),
                &submatrix(&mass(&model), &free),
            )[0];
            assert_eq!(lowest_square > 0.0, stands, "{shear:?} {factor}: {lowest_square}");
        }
    }
}

/// Sway under a load H across: H/P (tan kL/k − L), k² = P/EI; hyperbolic in tension.
#[test]
fn beam_columns_sway_by_their_closed_form() {
    let load = 1000.0;
    for compression in [2.0e7, -2.0e7_f64] {
        let model = column(20, |beam| beam.with_compression(compression).unwrap());
        let n = model.dofs();
        let mut force = vec![0.0; n];
        let tip = model.dof(20, Direction::X).unwrap();
        force[tip] = load;
        let fixed: Vec<_> = [0, 1, 2, n - 2, n - 1].map(|k| (k, 0.0)).to_vec();
        let computed = solve_with_prescribed(&stiffness(&model), &force, &fixed)[tip];
        let k = (compression.abs() / (YOUNG_MODULUS * SECOND_MOMENT)).sqrt();
        let curve = if compression > 0.0 {
            (k * COLUMN_LENGTH).tan()
        } else {
            (k * COLUMN_LENGTH).tanh()
        };
        let expected = load / compression * (curve / k - COLUMN_LENGTH);
        assert!((computed / expected - 1.0).abs() < 1e-6, "{compression}: {computed} {expected}");
    }
}

/// A translation meets no force, a rotation ψ the moment −P L ψ of a leaning column.
#[test]
fn leaning_columns_overturn() {
    let compression = 3.0e6;
    let model = column(3, |beam| {
        let shear_flexible_beam = beam.with_shear_stiffness(SHEAR_STIFFNESS).unwrap();
        shear_flexible_beam.with_compression(compression).unwrap()
    });
    let matrix = stiffness(&model);
    for direction in [Direction::X, Direction::Y] {
        let shift = model.rigid_motion(direction, [0.0; 3]);
        assert!(largest(&multiply(&matrix, &shift)) < 1e-12 * YOUNG_MODULUS);
    }
    let turn = model.rigid_motion(Direction::Rotation, [0.0; 3]);
    let moment = form(&turn, &matrix, &turn);
    assert!(
        (moment + compression * COLUMN_LENGTH).abs() < 1e-9 * YOUNG_MODULUS * SECTION_AREA,
        "{moment}"
    );
}

/// Simply supported Timoshenko beam with rotary inertia (Timoshenko 1921): with k = nπ/L,
/// ω⁴ ρI/(G A_s) − ω² (1 + k² I/A + k² EI/(G A_s)) + EI k⁴/(ρA) = 0, the lower root.
#[test]
fn rotary_inertia_and_shear_lower_the_frequencies_as_they_should() {
    for (shear, rotary) in [(SHEAR_STIFFNESS, true), (SHEAR_STIFFNESS, false), (1e15, true)] {
        let errors = [12, 24].map(|elements| {
            let model = column(elements, |beam| {
                let beam = beam.with_shear_stiffness(shear).unwrap();
                if rotary { beam.with_rotary_inertia() } else { beam }
            });
            let fixed = [(0, Direction::X), (0, Direction::Y), (elements, Direction::X)]
                .map(|(node, direction)| model.dof(node, direction).unwrap());
            let free: Vec<usize> =
                (0..model.dofs() - 2).filter(|dof| !fixed.contains(dof)).collect();
            let computed = eigenvalues(
                &submatrix(&stiffness(&model), &free),
                &submatrix(&mass(&model), &free),
            );
            [1.0, 2.0, 3.0].map(|n| {
                let k = n * std::f64::consts::PI / COLUMN_LENGTH;
                let turn = if rotary { k * k * SECOND_MOMENT / SECTION_AREA } else { 0.0 };
                let b = 1.0 + turn + k * k * YOUNG_MODULUS * SECOND_MOMENT / shear;
                let a = if rotary { MASS_DENSITY * SECOND_MOMENT / shear } else { 0.0 };
                let c = YOUNG_MODULUS * SECOND_MOMENT * k.powi(4) / (MASS_DENSITY * SECTION_AREA);
                let square = 2.0 * c / (b + (b * b - 4.0 * a * c).sqrt());
                // The nearest one: axial vibrations are among them.
                let errors = computed.iter().map(|x| x / square - 1.0);
                errors.min_by(|x, y| x.abs().total_cmp(&y.abs())).unwrap()
            })
        });
        println!("{shear:e} {rotary}: {errors:?}");
        // The shear strain is constant in an element, so that the error falls with the square of its
        // length, and two meshes extrapolate; without shear it falls with the fourth power.
        for (coarse, fine) in errors[0].into_iter().zip(errors[1]) {
            if shear < 1e10 {
                let limit = (4.0 * fine - coarse) / 3.0;
                assert!(limit.abs() < 3e-3 * coarse, "{shear:e} {rotary}: {limit:e}");
            } else {
                assert!(fine.abs() < 1e-4 && fine.abs() < 0.1 * coarse.abs(), "{errors:?}");
            }
        }
    }
}

fn trace(matrix: &[Vec<f64>]) -> f64 {
    (0..matrix.len()).map(|i| matrix[i][i]).sum()
}

#[test]
fn lumped_rotary_inertia_is_that_of_the_sections() {
    let with_rotary_inertia = column(2, Beam::with_rotary_inertia).with_mass(MassKind::Lumped);
    let without_rotary_inertia = column(2, |beam| beam).with_mass(MassKind::Lumped);
    let rotary_inertia = trace(&mass(&with_rotary_inertia)) - trace(&mass(&without_rotary_inertia));
    assert!(
        (rotary_inertia / (MASS_DENSITY * SECOND_MOMENT * COLUMN_LENGTH) - 1.0).abs() < 1e-9,
        "{rotary_inertia}"
    );
}

/// All nodes of a block of quadrilaterals tied to one: the rigid block of the same shape.
#[test]
fn a_block_of_followers_is_a_rigid_block() {
    let material = Material::new(1e9, 0.3, 2000.0).unwrap();
    let mut mesh = Mesh::layered_block(-2.0..2.0, 4, &[Layer::new(6.0, 5, material)]).unwrap();
    let leader = mesh.node_at(0.0, 0.0).unwrap();
    let mark = LumpedMass::new(leader, 1e-12).unwrap().with_rotary_inertia(1e-12).unwrap();
    mesh.add(mark).unwrap();
    let followers: Vec<usize> = (0..mesh.nodes().len()).filter(|node| *node != leader).collect();
    let linked = FemModel::on_base(mesh).unwrap().with_rigid_link(leader, &followers).unwrap();
    assert_eq!(linked.dofs(), 3);
    let block = RigidBlock::new(4.0, 6.0, 2000.0).unwrap();
    let computed = mass(&linked);
    let expected = mass(&block);
    for i in 0..3 {
        for j in 0..3 {
            assert!((computed[i][j] - expected[i][j]).abs() < 1e-9 * expected[2][2], "{i} {j}");
        }
        assert!(largest(&stiffness(&linked)[i]) < 1e-4);
    }
    let base = linked.base();
    let feet: Vec<_> = base.nodes().collect();
    assert_eq!(feet.len(), 5);
    assert_eq!(*feet[0], BaseNode::rigid(-2.0, 0.0, [0, 1, 2]));
    assert_eq!(feet[2].vertical, DofCombination::from(1));
    // The section at the base has the same resultants in either numbering.
    let section = linked.section(0.0, 0.0).unwrap();
    let up = [0.0, 1.0, 0.0];
    let weight = section.compression.value(&[0.0; 3], &[0.0; 3], &up);
    assert!(weight > 0.0);
}

/// Weighted sum of the displacements.
fn row_value(row: &DofCombination, displacement: &[f64]) -> f64 {
    row.iter().map(|&(i, w)| w * displacement[i]).sum()
}

/// A beam with a rigid arm at its tip: H (L³/3 + L² a + L a²)/EI at the arm's end.
#[test]
fn arms_lengthen_a_cantilever() {
    let arm = 1.5;
    let mut mesh = Mesh::new();
    let nodes: Vec<usize> = [0.0, COLUMN_LENGTH, COLUMN_LENGTH + arm, COLUMN_LENGTH + 2.0 * arm]
        .map(|y| mesh.add_node(0.0, y).unwrap())
        .to_vec();
    let other_node = mesh.add_node(1.0, 0.0).unwrap();
    mesh.add(LumpedMass::new(other_node, 1.0).unwrap()).unwrap();
    mesh.add(LumpedMass::new(nodes[2], 1.0).unwrap()).unwrap();
    mesh.add(Beam::new([0, 1], YOUNG_MODULUS, SECTION_AREA, SECOND_MOMENT, MASS_DENSITY).unwrap())
        .unwrap();
    // A beam between the arm and a free end strains nothing and checks the rotation.
    mesh.add(Beam::new([2, 3], YOUNG_MODULUS, SECTION_AREA, SECOND_MOMENT, MASS_DENSITY).unwrap())
        .unwrap();
    let model = FemModel::new(mesh, &[0, other_node])
        .unwrap()
        .with_rigid_link(1, &[nodes[2]])
        .unwrap();
    assert_eq!(model.dof(2, Direction::X), None);
    let n = model.dofs();
    let row = model.row(2, Direction::X).unwrap();
    // The leader's motion and its turn times the arm.
    let leader = model.row(1, Direction::X).unwrap();
    let turn = model.row(1, Direction::Rotation).unwrap();
    assert_eq!(row, leader + -arm * turn);
    let mut force = vec![0.0; n];
    for &(index, weight) in &row {
        force[index] += 1000.0 * weight;
    }
    let fixed: Vec<_> = [0, 1, 2, n - 2, n - 1].map(|k| (k, 0.0)).to_vec();
    let computed = solve_with_prescribed(&stiffness(&model), &force, &fixed);
    let deflection = row_value(&row, &computed);
    let l = COLUMN_LENGTH;
    let a = arm;
    let expected =
        1000.0 * (l.powi(3) / 3.0 + l * l * a + l * a * a) / (YOUNG_MODULUS * SECOND_MOMENT);
    assert!((deflection / expected - 1.0).abs() < 1e-10);
    let turn = row_value(&model.row(2, Direction::Rotation).unwrap(), &computed);
    let tip = computed[model.dof(3, Direction::X).unwrap()];
    assert!((tip - (deflection - arm * turn)).abs() < 1e-10 * expected);
    // A rigid motion is still one.
    let shift = model.rigid_motion(Direction::Rotation, [0.0; 3]);
    assert!(largest(&multiply(&stiffness(&model), &shift)) < 1e-12 * YOUNG_MODULUS);
    assert!(dot(&shift, &shift) > 0.0);
}

/// Sides of a column that are tied at each height move as the soil in vertically propagating shear waves: with n linear
/// elements of height h and consistent mass, ω = c √(6 (1 − cos kh)/(2 + cos kh))/h at k = π/(2H).
#[test]
fn a_column_with_tied_sides_is_a_shear_beam() {
    const ROW_COUNT: usize = 10;
    const COLUMN_HEIGHT: f64 = 20.0;
    let soil = Material::new(104.0e6, 0.3, 2000.0).unwrap();
    let layer = Layer::new(COLUMN_HEIGHT, ROW_COUNT, soil);
    let mesh = Mesh::layered_block(0.0..1.5, 1, &[layer]).unwrap();
    let mut column = FemModel::on_base(mesh).unwrap();
    for row in 1..=ROW_COUNT {
        column = column.with_tied_nodes(2 * row, &[2 * row + 1]).unwrap();
    }
    let shear_wave_speed = (40.0e6_f64 / 2000.0).sqrt();
    let row_height = COLUMN_HEIGHT / ROW_COUNT as f64;
    let wave_number = 0.5 * std::f64::consts::PI / COLUMN_HEIGHT;
    let cosine = (wave_number * row_height).cos();
    let expected = shear_wave_speed * (6.0 * (1.0 - cosine) / (2.0 + cosine)).sqrt() / row_height;
    // Rayleigh's quotient of the exact mode shape sin kz.
    let mut mode = vec![0.0; column.dofs()];
    for row in 1..=ROW_COUNT {
        let dof = column.dof(2 * row, Direction::X).unwrap();
        mode[dof] = (wave_number * row as f64 * row_height).sin();
        assert_eq!(column.dof(2 * row + 1, Direction::X), None);
    }
    let forces = multiply(&stiffness(&column), &mode);
    let inertia = multiply(&mass(&column), &mode);
    let squared_frequency = dot(&mode, &forces) / dot(&mode, &inertia);
    assert!((squared_frequency.sqrt() - expected).abs() < 1e-12 * expected);
    for (i, inertia) in inertia.iter().enumerate().skip(4) {
        assert!((forces[i] - squared_frequency * inertia).abs() < 1e-9 * largest(&forces));
    }
    let different_heights = column.with_tied_nodes(0, &[2]);
    assert!(is_scene(&different_heights));
}

fn is_scene(result: &basemat::Result<FemModel>) -> bool {
    matches!(result, Err(Error::Scene { .. }))
}

#[test]
fn bad_frames_are_errors() {
    let beam = Beam::new([0, 1], YOUNG_MODULUS, SECTION_AREA, SECOND_MOMENT, MASS_DENSITY).unwrap();
    for invalid_value in [f64::NAN, f64::INFINITY] {
        assert!(matches!(beam.clone().with_compression(invalid_value), Err(Error::Input { .. })));
    }
    let model = column(3, |beam| beam);
    for (leader, follower) in [(9, 0), (0, 9)] {
        let linked = model.clone().with_rigid_link(leader, &[follower]);
        assert!(matches!(linked, Err(Error::Index { index: 9, .. })));
    }
    assert!(is_scene(&model.clone().with_rigid_link(4, &[0])), "no rotation");
    assert!(is_scene(&model.clone().with_rigid_link(1, &[1])));
    assert!(is_scene(&model.clone().with_rigid_link(1, &[2, 2])));
    let linked = model.with_rigid_link(1, &[2]).unwrap();
    assert!(is_scene(&linked.clone().with_rigid_link(2, &[3])), "a follower leads nobody");
    assert!(is_scene(&linked.clone().with_rigid_link(3, &[1])), "a leader follows nobody");
    assert!(is_scene(&linked.clone().with_rigid_link(3, &[2])));
    assert!(linked.with_rigid_link(1, &[3]).is_ok());
}
