//! GOAL: plates vibrate and bend as the theory says, from thin to thick.
//! SCENE: square plates of 8 × 8 cells, cantilevered, simply supported and clamped.
//! REFERENCE: NAFEMS FV16 and test 21, the same formulation in Python, Timoshenko's clamped plate.

use super::{ALL_DIRECTIONS, Assembly, CellPattern, RX, RY, RZ, X, Y, Z, dof, material};
use basemat::fem::{Element, MassKind};
use basemat_problems::dense::{
    DenseMatrix, eigenvalues, form, inverse, multiply, noise, submatrix,
};
use basemat_problems::table::assert_close;
use std::f64::consts::PI;

/// A plate 10 × 10 m that moves across its plane only.
struct Plate {
    assembly: Assembly,
    nodes: Vec<Vec<usize>>,
}

fn plate(thickness: f64, pattern: CellPattern) -> Plate {
    let mut assembly = Assembly::new();
    let steel = (material(200.0e9, 0.3, 8000.0), thickness);
    let nodes = assembly.grid([8, 8], pattern, steel, |x, y| [10.0 * x, 10.0 * y, 0.0]);
    for &node in nodes.iter().flatten() {
        assembly.fix(node, &[X, Y, RZ]);
    }
    Plate { assembly, nodes }
}

/// φᵢᵀ A φⱼ for all pairs of shapes.
fn projected(matrix: &DenseMatrix, shapes: &DenseMatrix) -> DenseMatrix {
    let images: DenseMatrix = shapes.iter().map(|shape| multiply(matrix, shape)).collect();
    shapes.iter().map(|shape| multiply(&images, shape)).collect()
}

/// The lowest frequencies in Hz, ascending, by iteration of a subspace.
fn frequencies(plate: &Assembly) -> Vec<f64> {
    let mut is_free = vec![true; plate.load.len()];
    for (index, _) in &plate.prescribed {
        is_free[*index] = false;
    }
    let free: Vec<usize> = (0..plate.load.len()).filter(|index| is_free[*index]).collect();
    let stiffness = submatrix(&plate.stiffness(), &free);
    let mass = submatrix(&plate.mass(MassKind::Consistent), &free);
    let flexibility: DenseMatrix = inverse(&stiffness.concat(), free.len())
        .chunks(free.len())
        .map(<[f64]>::to_vec)
        .collect();
    let mut shapes: DenseMatrix = (0..16).map(|k| noise(free.len(), k)).collect();
    for _ in 0..30 {
        for k in 0..shapes.len() {
            let mut shape = multiply(&flexibility, &multiply(&mass, &shapes[k]));
            for computed in &shapes[..k] {
                let ratio = form(computed, &mass, &shape);
                shape
                    .iter_mut()
                    .zip(computed)
                    .for_each(|(value, submatrix)| *value -= ratio * submatrix);
            }
            let size = form(&shape, &mass, &shape).sqrt();
            shapes[k] = shape.into_iter().map(|value| value / size).collect();
        }
    }
    let squares = eigenvalues(&projected(&stiffness, &shapes), &projected(&mass, &shapes));
    squares.into_iter().map(|square| square.sqrt() / (2.0 * PI)).collect()
}

#[test]
fn cantilevered_plate() {
    for (pattern, expected) in [
        (CellPattern::Quads, [0.419_066, 1.029_92, 2.656_43, 3.3569, 3.847_29, 6.777_28]),
        (CellPattern::Rising, [0.419_128, 1.035_43, 2.638_15, 3.376_16, 3.879_05, 6.980_55]),
    ] {
        let Plate { mut assembly, nodes } = plate(0.05, pattern);
        for &node in &nodes[0] {
            assembly.fix(node, &ALL_DIRECTIONS);
        }
        let computed = frequencies(&assembly);
        for (mode, (found, expected)) in computed.into_iter().zip(expected).enumerate() {
            assert_close(&format!("{pattern:?}, mode {mode}, Hz"), found, expected, 0.0, 1e-5);
        }
    }
}

#[test]
fn simply_supported_thick_plate() {
    for (pattern, expected) in [
        (CellPattern::Quads, [46.6749, 115.991, 115.991, 178.445]),
        (CellPattern::Rising, [47.5096, 117.403, 120.089, 189.537]),
    ] {
        let Plate { mut assembly, nodes } = plate(1.0, pattern);
        for k in 0..=8 {
            for node in [nodes[0][k], nodes[8][k]] {
                assembly.fix(node, &[Z, RX]);
            }
            for node in [nodes[k][0], nodes[k][8]] {
                assembly.fix(node, &[Z, RY]);
            }
        }
        let computed = frequencies(&assembly);
        for (mode, (found, expected)) in computed.into_iter().zip(expected).enumerate() {
            assert_close(&format!("{pattern:?}, mode {mode}, Hz"), found, expected, 0.0, 1e-5);
        }
    }
}

/// A clamped square under a uniform load: 0.00126532 q L⁴/D in its middle, however thin.
#[test]
fn thin_plates_do_not_lock() {
    for (pattern, ratios) in [
        (CellPattern::Quads, [0.990_384_530, 0.988_436_978, 0.988_436_978]),
        (CellPattern::Rising, [0.926_335_171, 0.923_031_958, 0.923_031_958]),
    ] {
        for (slenderness, ratio) in [1e-2, 1e-4, 1e-6].into_iter().zip(ratios) {
            let thickness = 10.0 * slenderness;
            let Plate { mut assembly, nodes } = plate(thickness, pattern);
            for k in 0..=8 {
                for node in [nodes[0][k], nodes[8][k], nodes[k][0], nodes[k][8]] {
                    assembly.fix(node, &ALL_DIRECTIONS);
                }
            }
            for shell in &assembly.shells {
                let points = assembly.points(shell.nodes());
                for (&node, [.., force]) in
                    shell.nodes().iter().zip(shell.pressure_forces(&points, 1.0).unwrap())
                {
                    assembly.load[dof(node, Z)] += force;
                }
            }
            let stiffness = 200.0e9 * thickness.powi(3) / 12.0 / (1.0 - 0.09);
            let deflection = assembly.solve()[dof(nodes[4][4], Z)];
            let computed = deflection * stiffness / (0.001_265_32 * 1e4);
            // The ratio of shear and bending stiffness, 1e12 for the thinnest plate, costs digits.
            let digits = if slenderness < 1e-5 { 1e-3 } else { 1e-6 };
            assert_close(
                &format!("{pattern:?}, t/L = {slenderness}"),
                computed,
                ratio,
                0.0,
                digits,
            );
        }
    }
}
