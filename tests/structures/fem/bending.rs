//! GOAL: quadrilaterals in bending: shear and volumetric locking, and their cure.
//! SCENE: cantilevers and single rectangles of any aspect ratio, ν up to nearly ½.
//! REFERENCE: beam theory and closed-form energies.

use basemat::fem::{Direction, Element, Layer, Material, Mesh, Quad4, QuadFormulation};
use basemat::structure::{FemModel, Structure};
use basemat_problems::dense::{dot, form, solve_with_prescribed, stiffness};

const YOUNG_MODULUS: f64 = 1.0e7;

/// Column of `length` and unit width, fixed at its base.
fn column(length: f64, [across, along]: [usize; 2], nu: f64, kind: QuadFormulation) -> FemModel {
    let material = Material::new(YOUNG_MODULUS, nu, 1.0).unwrap();
    let layer = Layer { formulation: kind, ..Layer::new(length, along, material) };
    FemModel::on_base(Mesh::layered_block(-0.5..0.5, across, &[layer]).unwrap()).unwrap()
}

fn fixed_base(model: &FemModel) -> Vec<(usize, f64)> {
    let base = model.base();
    base.nodes()
        .flat_map(|node| [(node.horizontal[0].0, 0.0), (node.vertical[0].0, 0.0)])
        .collect()
}

/// Tip deflection under a unit shear, relative to Timoshenko's beam in plane strain.
fn tip_ratio(mesh: [usize; 2], nu: f64, kind: QuadFormulation) -> f64 {
    let length = 10.0;
    let model = column(length, mesh, nu, kind);
    let mut load = vec![0.0; model.dofs()];
    let top = model.mesh().nodes_at_height(length, 1e-9).unwrap();
    for (place, &node) in top.iter().enumerate() {
        let part = if place == 0 || place + 1 == top.len() { 0.5 } else { 1.0 };
        load[model.dof(node, Direction::X).unwrap()] = part / (top.len() - 1) as f64;
    }
    let computed = solve_with_prescribed(&stiffness(&model), &load, &fixed_base(&model));
    let bending = length.powi(3) / (3.0 * YOUNG_MODULUS / (1.0 - nu * nu) / 12.0);
    let shear = length / (5.0 / 6.0 * 0.5 * YOUNG_MODULUS / (1.0 + nu));
    dot(&load, &computed) / (bending + shear)
}

#[test]
fn cantilever_locks_with_full_integration_and_not_with_incompatible_modes() {
    let full_integration = QuadFormulation::Full;
    let free = QuadFormulation::IncompatibleModes;
    let table = [[1, 10], [2, 20], [4, 40]].map(|mesh| {
        let row = [full_integration, free, QuadFormulation::OnePoint]
            .map(|kind| tip_ratio(mesh, 0.3, kind));
        println!("{mesh:?}: full, incompatible, one point: {row:?}");
        row
    });
    for (row, lower_bound) in table.iter().zip([0.6, 0.85, 0.95]) {
        assert!(row[0] > lower_bound && row[0] < 0.99, "full: too stiff, converging from below");
    }
    assert!(table[0][0] < 0.7, "one full element across locks");
    for row in table {
        assert!((row[1] - 1.0).abs() < 0.015, "incompatible modes: right at once");
    }
    assert!(table[0][2] > 1e6, "one row of one-point elements is a mechanism in bending");
    assert!(table[1][2] > 1.3 && table[2][2] > 1.05, "several rows bend too easily");
    assert!(table[2][2] < 1.07, "and converge from above");
}

#[test]
fn nearly_incompressible_material_locks_only_with_full_integration() {
    assert!(tip_ratio([2, 20], 0.4999, QuadFormulation::Full) < 0.5);
    let coarse_ratio = tip_ratio([2, 20], 0.4999, QuadFormulation::IncompatibleModes);
    let fine_ratio = tip_ratio([4, 40], 0.4999, QuadFormulation::IncompatibleModes);
    println!("incompatible modes at 0.4999: {coarse_ratio} {fine_ratio}");
    // A fixed base also hinders the strain across it, which beam theory leaves out.
    assert!(
        (coarse_ratio - fine_ratio).abs() < 0.02 && (fine_ratio - 1.0).abs() < 0.05,
        "{coarse_ratio} {fine_ratio}"
    );
}

#[test]
fn mean_dilatation_does_not_lock_in_nearly_incompressible_material() {
    let ratios = [[2, 20], [4, 40], [8, 80]].map(|mesh| {
        [0.3, 0.49, 0.4999].map(|nu| tip_ratio(mesh, nu, QuadFormulation::MeanDilatation))
    });
    println!("mean dilatation at 0.3, 0.49, 0.4999: {ratios:?}");
    // Two elements across the column are too soft; four are accurate. A fixed base also hinders the strain across it.
    for (row, tolerance) in ratios.iter().zip([0.1, 0.02, 0.02]) {
        assert!(row.iter().all(|ratio| (ratio - 1.0).abs() < tolerance), "{row:?}");
        assert!((row[2] - row[1]).abs() < 2e-3, "{row:?}");
    }
    assert!(tip_ratio([4, 40], 0.4999, QuadFormulation::Full) < 0.5);
}

/// Rectangles in pure bending are exact: rotation at the end M L / (E' I), any aspect ratio.
#[test]
fn pure_bending_of_rectangles_is_exact() {
    for (rows, nu) in [(1, 0.3), (3, 0.0), (7, 0.45)] {
        let length = 6.0;
        let model = column(length, [1, rows], nu, QuadFormulation::IncompatibleModes);
        let mut load = vec![0.0; model.dofs()];
        for (x, sign) in [(-0.5, -1.0), (0.5, 1.0)] {
            let node = model.mesh().node_at(x, length).unwrap();
            load[model.dof(node, Direction::Y).unwrap()] = sign;
        }
        // The base may widen: only its left node is fixed sideways.
        let fixed: Vec<(usize, f64)> =
            fixed_base(&model).into_iter().filter(|&(index, _)| index != 2).collect();
        let computed = solve_with_prescribed(&stiffness(&model), &load, &fixed);
        let rotation = length / (YOUNG_MODULUS / (1.0 - nu * nu) / 12.0);
        // The couple of two unit forces 1 m apart does work on the end's rotation.
        assert!((dot(&load, &computed) / rotation - 1.0).abs() < 1e-10);
    }
}

fn element_matrix(kind: QuadFormulation, [a, b]: [f64; 2], nu: f64) -> Vec<Vec<f64>> {
    let quad = Quad4::new([0, 1, 2, 3], Material::new(YOUNG_MODULUS, nu, 1.0).unwrap(), kind);
    let mut matrix = vec![0.0; 64];
    quad.stiffness(&[[0.0; 3], [a, 0.0, 0.0], [a, b, 0.0], [0.0, b, 0.0]], &mut matrix);
    matrix.chunks(8).map(<[f64]>::to_vec).collect()
}

const HOURGLASS_PATTERN: [f64; 8] = [1.0, 0.0, -1.0, 0.0, 1.0, 0.0, -1.0, 0.0];

/// Energy of the bending pattern `u_x = 4 x y/(a b)`: `ε_x = κ y` and γ = κ x with κ = 4/(a b) for
/// full integration; E' I κ² a/2 for a beam.
#[test]
fn locking_of_one_rectangle_is_that_of_its_closed_form() {
    let a = 2.0_f64;
    let b = 0.7;
    let nu = 0.3;
    let direct_modulus = YOUNG_MODULUS * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
    let shear = YOUNG_MODULUS / (2.0 * (1.0 + nu));
    let twice_energy = (4.0 / (a * b)).powi(2) * a * b / 12.0;
    let fully_integrated = form(
        &HOURGLASS_PATTERN,
        &element_matrix(QuadFormulation::Full, [a, b], nu),
        &HOURGLASS_PATTERN,
    );
    let locked_energy = twice_energy * (direct_modulus * b * b + shear * a * a);
    assert!((fully_integrated / locked_energy - 1.0).abs() < 1e-12);
    let with_incompatible_modes = element_matrix(QuadFormulation::IncompatibleModes, [a, b], nu);
    let exact = twice_energy * YOUNG_MODULUS / (1.0 - nu * nu) * b * b;
    assert!(
        (form(&HOURGLASS_PATTERN, &with_incompatible_modes, &HOURGLASS_PATTERN) / exact - 1.0)
            .abs()
            < 1e-12
    );
    let one_point_matrix = element_matrix(QuadFormulation::OnePoint, [a, b], nu);
    assert!(
        form(&HOURGLASS_PATTERN, &one_point_matrix, &HOURGLASS_PATTERN).abs() < 1e-9 * exact,
        "no resistance"
    );
    for percent in [1, 5, 100] {
        let with_hourglass_stiffness =
            element_matrix(QuadFormulation::Hourglass { percent }, [a, b], nu);
        let expected = 0.01 * f64::from(percent) * locked_energy;
        assert!(
            (form(&HOURGLASS_PATTERN, &with_hourglass_stiffness, &HOURGLASS_PATTERN) / expected
                - 1.0)
                .abs()
                < 1e-9,
            "{percent}"
        );
    }
}

/// On a rectangle, incompatible modes add only hourglass stiffness to the one-point element.
#[test]
fn incompatible_modes_are_one_point_plus_hourglass_stiffness() {
    let one_point_matrix = element_matrix(QuadFormulation::OnePoint, [2.0, 0.7], 0.3);
    let with_incompatible_modes =
        element_matrix(QuadFormulation::IncompatibleModes, [2.0, 0.7], 0.3);
    for i in 0..8 {
        for j in 0..8 {
            let difference = with_incompatible_modes[i % 2][i % 2] - one_point_matrix[i % 2][i % 2];
            let sign = HOURGLASS_PATTERN[2 * (i / 2)] * HOURGLASS_PATTERN[2 * (j / 2)];
            let expected = if i % 2 == j % 2 { sign * difference } else { 0.0 };
            assert!(
                (with_incompatible_modes[i][j] - one_point_matrix[i][j] - expected).abs()
                    < 1e-9 * YOUNG_MODULUS,
                "({i}, {j})"
            );
        }
    }
}
