//! GOAL: trusses, springs, dashpots and masses in space.
//! SCENE: single elements of any direction, and the same in a plane.
//! REFERENCE: closed forms, the elements of the plane.

use basemat::fem::{Dashpot, Element, LumpedMass, MassKind, Spring, Truss};
use basemat_problems::supported::{CLAMPED_DIRECTIONS, ElementMatrix, assert_near};

use super::{add, inner};

const END_POINTS: [[f64; 3]; 2] = [[1.0, 2.0, 0.0], [2.5, 1.0, 3.0]];

struct BarAxis {
    length: f64,
    along: [f64; 3],
}

fn bar_axis([first, second]: [[f64; 3]; 2]) -> BarAxis {
    let span = add(second, -1.0, first);
    let length = inner(span, span).sqrt();
    BarAxis { length, along: span.map(|component| component / length) }
}

/// Asserts that a matrix is ± `block` between the displacements of two nodes.
fn assert_pair(matrix: &[f64], block: impl Fn(usize, usize) -> f64) {
    let scale = (0..3).map(|k| block(k, k).abs()).fold(0.0, f64::max);
    for (index, value) in matrix.iter().enumerate() {
        let row = index / 6;
        let column = index % 6;
        let sign = if (row < 3) == (column < 3) { 1.0 } else { -1.0 };
        let expected = sign * block(row % 3, column % 3);
        assert!((value - expected).abs() < 1e-14 * scale, "({row}, {column}): {value}, {expected}");
    }
}

#[test]
fn a_truss_stretches_and_sways_in_space() {
    let truss = Truss::in_space([0, 1], 200.0e9, 1.0e-3, 7800.0).unwrap();
    for points in [END_POINTS, [[0.0; 3], [0.0, 0.0, 2.0]], [[0.0; 3], [3.0, 0.0, 0.0]]] {
        let BarAxis { length, along } = bar_axis(points);
        let stiffness = 200.0e6 / length;
        assert_pair(&ElementMatrix::Stiffness.of(&truss, &points), |i, j| {
            stiffness * along[i] * along[j]
        });
        let shortened = [[0.0; 3], along.map(|component| -1e-3 * component)].concat();
        let compressed = truss.in_static_state(&points, &shortened, 9.81).unwrap();
        let force = compressed.compression().unwrap();
        assert_near("compression", force, 1e-3 * stiffness, 1e-13);
        assert_pair(&ElementMatrix::GeometricStiffness.of(&compressed, &points), |i, j| {
            let unit = if i == j { 1.0 } else { 0.0 };
            -force / length * (unit - along[i] * along[j])
        });
        for kind in [MassKind::Consistent, MassKind::Lumped] {
            let mass = ElementMatrix::Mass(kind).of(&truss, &points);
            assert_near("mass", mass.iter().sum::<f64>(), 3.0 * 7.8 * length, 1e-14);
        }
    }
}

#[test]
fn axial_springs_and_dashpots_act_along_their_line_in_space() {
    let along = bar_axis(END_POINTS).along;
    let spring = Spring::axial_in_space([0, 1], 5.0).unwrap();
    assert_pair(&ElementMatrix::Stiffness.of(&spring, &END_POINTS), |i, j| {
        5.0 * along[i] * along[j]
    });
    let dashpot = Dashpot::axial_in_space([0, 1], 3.0).unwrap();
    let mut damping = vec![0.0; 36];
    dashpot.damping(&END_POINTS, &mut damping);
    assert_pair(&damping, |i, j| 3.0 * along[i] * along[j]);
    for direction in CLAMPED_DIRECTIONS {
        let spring = Spring::new([0, 1], direction, 5.0).unwrap();
        assert_eq!(spring.directions(), [direction]);
        assert_eq!(ElementMatrix::Stiffness.of(&spring, &END_POINTS), [5.0, -5.0, -5.0, 5.0]);
        let mut damping = vec![0.0; 4];
        Dashpot::new([0, 1], direction, 3.0).unwrap().damping(&END_POINTS, &mut damping);
        assert_eq!(damping, [3.0, -3.0, -3.0, 3.0]);
    }
}

#[test]
fn bars_in_a_plane_are_the_bars_of_the_plane() {
    let points = [[1.0, -2.0, 0.0], [4.5, 1.0, 0.0]];
    let pairs: [[Box<dyn Element>; 2]; 2] = [
        [
            Box::new(Truss::new([0, 1], 200.0e9, 1.0e-3, 7800.0).unwrap()),
            Box::new(Truss::in_space([0, 1], 200.0e9, 1.0e-3, 7800.0).unwrap()),
        ],
        [
            Box::new(Spring::axial([0, 1], 5.0).unwrap()),
            Box::new(Spring::axial_in_space([0, 1], 5.0).unwrap()),
        ],
    ];
    for [plane, space] in pairs {
        for part in [ElementMatrix::Stiffness, ElementMatrix::Mass(MassKind::Consistent)] {
            let plane = part.of(&plane, &points);
            let space = part.of(&space, &points);
            for i in 0..4 {
                for j in 0..4 {
                    let place = 6 * (i + i / 2) + j + j / 2;
                    assert_eq!(plane[4 * i + j], space[place], "({i}, {j})");
                }
            }
        }
    }
}

#[test]
fn a_mass_in_space_has_three_rotary_inertias() {
    let at = [[0.0, 0.0, 3.0]];
    let part = ElementMatrix::Mass(MassKind::Lumped);
    let point = LumpedMass::in_space(0, 100.0, [0.0; 3]).unwrap();
    assert_eq!(point.directions(), &CLAMPED_DIRECTIONS[..3]);
    assert_eq!(part.of(&point, &at), [100.0, 0.0, 0.0, 0.0, 100.0, 0.0, 0.0, 0.0, 100.0]);
    let slab = part.of(&LumpedMass::in_space(0, 100.0, [30.0, 40.0, 0.0]).unwrap(), &at);
    let diagonal: Vec<f64> = slab.iter().step_by(7).copied().collect();
    assert_eq!(diagonal, [100.0, 100.0, 100.0, 30.0, 40.0, 0.0]);
    assert_eq!(slab.iter().filter(|value| **value != 0.0).count(), 5);
}
