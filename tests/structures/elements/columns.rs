//! GOAL: buckling loads of columns in space.
//! SCENE: columns on three kinds of supports, under their own weight, with a rigid upper part.
//! REFERENCE: Euler, Engesser, Greenhill, and an independent program of the same formulation.

use basemat::fem::{BeamSection, Direction, Element, Mesh, SpaceBeam};
use basemat::structure::FemModel;
use basemat_problems::stiff_element::StiffElement;

use super::{concrete, section, sheared};
use crate::space_support::{CLAMPED, RX, RY, RZ, Supported, X, Y, Z, near};

/// Bending stiffness about the weak axis.
const EI: f64 = 30.0e9 * 0.9e-3;
const LENGTH: f64 = 4.0;
/// Greenhill 1881: q L³/EI of the uniform cantilever that buckles under its own weight q per length.
const GREENHILL: f64 = 7.837_347_438_943_484;
const PI: f64 = std::f64::consts::PI;

fn beam(k: usize, section: BeamSection) -> SpaceBeam {
    SpaceBeam::new([k, k + 1], concrete(), section, [1.0, 0.0, 0.0]).unwrap()
}

fn nodes(scene: &mut Supported, length: f64, count: usize) {
    for k in 0..=count {
        scene.node([0.0, 0.0, length * k as f64 / count as f64]);
    }
}

/// Buckling load of a column between two supports.
fn load(section: BeamSection, count: usize, foot: &[Direction], head: &[Direction]) -> f64 {
    let mut scene = Supported::new();
    nodes(&mut scene, LENGTH, count);
    for k in 0..count {
        scene.add(beam(k, section).with_compression(1.0).unwrap());
    }
    scene.hold(0, foot);
    scene.hold(count, head);
    scene.buckling()
}

/// PROBLEM: cantilever, hinged and clamped column. RESULT: the tables' values, and Euler's and Engesser's loads
/// within 0.2 % with 4 beams (8 with shear), 2 % if clamped at both ends.
#[test]
fn columns_buckle_as_euler_and_engesser_say() {
    type Case = ([f64; 2], f64, &'static [Direction], &'static [Direction], f64);
    let cases: [Case; 3] = [
        ([4_163_876.0, 4_149_969.0], 2.0, &CLAMPED, &[], 2e-3),
        ([16_663_490.0, 16_439_210.0], 1.0, &[X, Y, Z, RZ], &[X, Y], 2e-3),
        ([67_120_970.0, 63_430_700.0], 0.5, &CLAMPED, &[X, Y, RX, RY, RZ], 2e-2),
    ];
    for (table, effective, foot, head, tolerance) in cases {
        let euler = EI * (PI / (effective * LENGTH)).powi(2);
        let engesser = euler / (1.0 + euler / (12.5e9 * 0.1));
        let found = load(section(), 4, foot, head);
        near("Euler's column, table", found, table[0], 1e-6);
        near("Euler's column", found, euler, tolerance);
        let found = load(sheared(), 8, foot, head);
        near("Engesser's column, table", found, table[1], 1e-6);
        near("Engesser's column", found, engesser, tolerance);
    }
}

/// PROBLEM: a cantilever under its own weight. RESULT: the table's values, and Greenhill's weight 7.8373 EI/L² within
/// 0.2 % with 4 beams.
#[test]
fn a_column_in_space_buckles_under_its_own_weight() {
    for (count, table) in [(2, 1.32587e7), (4, 1.32282e7), (8, 1.32257e7)] {
        let height = LENGTH / count as f64;
        let weight = 2500.0 * 0.12;
        let mut scene = Supported::new();
        nodes(&mut scene, LENGTH, count);
        for k in 0..count {
            // Shortening of the beam by the weight above its middle.
            let above = weight * (LENGTH - height * (k as f64 + 0.5));
            let mut displacement = [0.0; 12];
            displacement[8] = -above * height / (30.0e9 * 0.12);
            let beam = beam(k, section());
            let points = scene.points(beam.nodes());
            scene.add(beam.in_static_state(&points, &displacement, 1.0).unwrap());
        }
        scene.hold(0, &CLAMPED);
        let found = scene.buckling() * weight * LENGTH;
        near("own weight, table", found, table, 1e-6);
        if count == 4 {
            near("Greenhill", found, GREENHILL * EI / LENGTH.powi(2), 2e-3);
        }
    }
}

/// PROBLEM: the same column as a structure on a rigid mat. RESULT: the beams carry the weight above their middles, and
/// the buckling factor is Greenhill's.
#[test]
fn the_weight_of_a_structure_in_space_compresses_its_beams() {
    const COUNT: usize = 8;
    let mut mesh = Mesh::in_space();
    for k in 0..=COUNT {
        mesh.add_node_at([0.0, 0.0, LENGTH * k as f64 / COUNT as f64]).unwrap();
    }
    for k in 0..COUNT {
        mesh.add(beam(k, section())).unwrap();
    }
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        .map(|[x, y]| mesh.add_node_at([x, y, 0.0]).unwrap());
    mesh.add(StiffElement::shell(&corners, 0.5, 1.0e9, 1000.0)).unwrap();
    let critical = GREENHILL * EI / LENGTH.powi(3) / (2500.0 * 0.12);
    let model = FemModel::on_base(mesh)
        .and_then(|model| model.with_rigid_link(0, &corners))
        .and_then(|model| model.with_p_delta(0.4 * critical))
        .unwrap();
    for (k, element) in model.mesh().elements().take(COUNT).enumerate() {
        let above = LENGTH * (1.0 - (k as f64 + 0.5) / COUNT as f64);
        let weight = 2500.0 * 0.12 * above * 0.4 * critical;
        near("compression", element.compression().unwrap(), weight, 1e-9);
    }
    near("buckling factor", model.buckling_factor().unwrap(), 2.5, 3e-5);
}

/// PROBLEM: a cantilever of 2.5 m under a rigid arm of 1.5 m. RESULT: the table's values; the closed form is
/// k L tan(k L) = L/a.
#[test]
fn a_rigid_arm_bears_on_the_column_below_it() {
    for (count, table) in [(1, 4_511_159.0), (2, 4_504_775.0), (4, 4_504_377.0)] {
        let mut scene = Supported::new();
        for k in 0..count {
            scene.node([0.0, 0.0, 2.5 * k as f64 / count as f64]);
        }
        scene.node([0.0, 0.0, LENGTH]);
        for k in 0..count {
            let arm = if k + 1 == count { -1.5 } else { 0.0 };
            let beam = beam(k, section())
                .with_compression(1.0)
                .and_then(|beam| beam.with_offsets([[0.0; 3], [0.0, 0.0, arm]]));
            scene.add(beam.unwrap());
        }
        scene.hold(0, &CLAMPED);
        let found = scene.buckling();
        near("rigid arm, table", found, table, 1e-6);
        let bend = 2.5 * (found / EI).sqrt();
        near("rigid arm, closed form", bend * bend.tan(), 2.5 / 1.5, 5e-3);
    }
}
