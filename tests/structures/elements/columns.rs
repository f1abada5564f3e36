//! GOAL: buckling loads of columns in space.
//! SCENE: columns on three kinds of supports, under their weight, with a rigid upper part.
//! REFERENCE: Euler, Engesser, Greenhill, and an independent program of the same formulation.

use std::f64::consts::PI;

use basemat::fem::{Direction, Mesh};
use basemat::structure::FemModel;
use basemat_problems::columns::{COLUMN_LENGTH, beam, rigid_head, self_weight_buckling, supported};
use basemat_problems::space_beams::{section, section_with_shear};
use basemat_problems::stiff_element::StiffElement;
use basemat_problems::supported::{CLAMPED_DIRECTIONS, RX, RY, RZ, X, Y, Z, assert_near};

/// Bending stiffness about the weak axis.
const BENDING_STIFFNESS: f64 = 30.0e9 * 0.9e-3;
/// Greenhill 1881: q L³/EI of the uniform cantilever that buckles under its weight q per length.
const GREENHILL_FACTOR: f64 = 7.837_347_438_943_484;

/// PROBLEM: cantilever, hinged and clamped column. RESULT: the tables' values, and Euler's and Engesser's loads
/// within 0.2 % with 4 beams (8 with shear), 2 % if clamped at both ends.
#[test]
fn columns_have_the_buckling_loads_of_euler_and_engesser() {
    type ColumnCase = ([f64; 2], f64, &'static [Direction], &'static [Direction], f64);
    let cases: [ColumnCase; 3] = [
        ([4_163_876.0, 4_149_969.0], 2.0, &CLAMPED_DIRECTIONS, &[], 2e-3),
        ([16_663_490.0, 16_439_210.0], 1.0, &[X, Y, Z, RZ], &[X, Y], 2e-3),
        ([67_120_970.0, 63_430_700.0], 0.5, &CLAMPED_DIRECTIONS, &[X, Y, RX, RY, RZ], 2e-2),
    ];
    for (table, effective, foot, head, tolerance) in cases {
        let euler = BENDING_STIFFNESS * (PI / (effective * COLUMN_LENGTH)).powi(2);
        let engesser = euler / (1.0 + euler / (12.5e9 * 0.1));
        let computed = supported(section(), 4, foot, head);
        assert_near("Euler's column, table", computed, table[0], 1e-6);
        assert_near("Euler's column", computed, euler, tolerance);
        let computed = supported(section_with_shear(), 8, foot, head);
        assert_near("Engesser's column, table", computed, table[1], 1e-6);
        assert_near("Engesser's column", computed, engesser, tolerance);
    }
}

/// PROBLEM: a cantilever under its weight. RESULT: the table's values, and Greenhill's weight 7.8373 EI/L² within
/// 0.2 % with 4 beams.
#[test]
fn a_column_in_space_buckles_under_its_own_weight() {
    for (count, table) in [(2, 1.32587e7), (4, 1.32282e7), (8, 1.32257e7)] {
        let computed = self_weight_buckling(count);
        assert_near("column under its weight, table", computed, table, 1e-6);
        if count == 4 {
            assert_near(
                "Greenhill",
                computed,
                GREENHILL_FACTOR * BENDING_STIFFNESS / COLUMN_LENGTH.powi(2),
                2e-3,
            );
        }
    }
}

/// PROBLEM: the same column as a structure on a rigid mat. RESULT: the beams carry the weight above their middles, and
/// the buckling factor is Greenhill's.
#[test]
fn the_weight_of_a_structure_in_space_compresses_its_beams() {
    const BEAM_COUNT: usize = 8;
    let mut mesh = Mesh::in_space();
    for k in 0..=BEAM_COUNT {
        mesh.add_node_at([0.0, 0.0, COLUMN_LENGTH * k as f64 / BEAM_COUNT as f64]).unwrap();
    }
    for k in 0..BEAM_COUNT {
        mesh.add(beam(k, section())).unwrap();
    }
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        .map(|[x, y]| mesh.add_node_at([x, y, 0.0]).unwrap());
    mesh.add(StiffElement::shell(&corners, 0.5, 1.0e9, 1000.0)).unwrap();
    let critical = GREENHILL_FACTOR * BENDING_STIFFNESS / COLUMN_LENGTH.powi(3) / (2500.0 * 0.12);
    let model = FemModel::on_base(mesh)
        .and_then(|model| model.with_rigid_link(0, &corners))
        .and_then(|model| model.with_p_delta(0.4 * critical))
        .unwrap();
    for (k, element) in model.mesh().elements().take(BEAM_COUNT).enumerate() {
        let above = COLUMN_LENGTH * (1.0 - (k as f64 + 0.5) / BEAM_COUNT as f64);
        let weight = 2500.0 * 0.12 * above * 0.4 * critical;
        assert_near("compression", element.compression().unwrap(), weight, 1e-9);
    }
    assert_near("buckling factor", model.buckling_factor().unwrap(), 2.5, 3e-5);
}

/// PROBLEM: a cantilever of 2.5 m under a rigid arm of 1.5 m. RESULT: the table's values; the closed form is
/// k L tan(k L) = L/a.
#[test]
fn a_rigid_arm_bears_on_the_column_below_it() {
    for (count, table) in [(1, 4_511_159.0), (2, 4_504_775.0), (4, 4_504_377.0)] {
        let computed = rigid_head(count);
        assert_near("rigid arm, table", computed, table, 1e-6);
        let bend = 2.5 * (computed / BENDING_STIFFNESS).sqrt();
        assert_near("rigid arm, closed form", bend * bend.tan(), 2.5 / 1.5, 5e-3);
    }
}
