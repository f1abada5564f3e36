//! GOAL: invalid elements in space are errors.
//! SCENE: beams along their orientation, without length, with mechanisms; inverted bricks; negative values.
//! REFERENCE: the texts of the errors.

use basemat::fem::{BeamSection, Direction, Hex8, LumpedMass, Mesh, SpaceBeam, Spring, Truss};
use basemat_problems::space_beams::{concrete, section};
use basemat_problems::supported::{CLAMPED_DIRECTIONS, RX, RY, RZ, X, Y, Z};

fn beam(orientation: [f64; 3]) -> basemat::Result<SpaceBeam> {
    SpaceBeam::new([0, 1], concrete(), section(), orientation)
}

fn text<T>(result: basemat::Result<T>) -> String {
    result.map(|_| ()).unwrap_err().to_string()
}

#[test]
fn a_beam_needs_a_length_and_an_orientation_across_it() {
    let mut mesh = Mesh::in_space();
    for z in [0.0, 3.0] {
        mesh.add_node_at([0.0, 0.0, z]).unwrap();
    }
    let along = text(beam([0.0, 0.0, -2.0]).and_then(|beam| mesh.add(beam)));
    assert_eq!(
        along,
        "beam between nodes 0 and 1: sine of the angle between the beam and its orientation is 0, but must be above \
         1e-6: an orientation that is not along the beam"
    );
    let arms = [[0.0, 0.0, 1.0], [0.0, 0.0, -2.0]];
    let short_beam = beam([1.0, 0.0, 0.0]).and_then(|beam| beam.with_offsets(arms));
    assert_eq!(
        text(short_beam.and_then(|beam| mesh.add(beam))),
        "beam between nodes 0 and 1: length of the beam is 0, but must be finite and above zero"
    );
    assert!(text(beam([0.0; 3])).contains("length of the beam's orientation is 0"));
    assert!(text(beam([0.0, f64::NAN, 0.0])).contains("orientation of the beam is not finite"));
    let offsets = [[0.0, f64::INFINITY, 0.0], [0.0; 3]];
    let offset = beam([1.0, 0.0, 0.0]).and_then(|beam| beam.with_offsets(offsets));
    assert!(text(offset).contains("offsets of the beam is not finite"));
    let compressed = beam([1.0, 0.0, 0.0]).and_then(|beam| beam.with_compression(f64::NAN));
    assert!(text(compressed).contains("axial force of the beam is NaN"));
}

fn released_beam(first: &[Direction], second: &[Direction]) -> basemat::Result<SpaceBeam> {
    beam([1.0, 0.0, 0.0])
        .and_then(|beam| beam.with_releases(0, first))
        .and_then(|beam| beam.with_releases(1, second))
}

#[test]
fn releases_that_leave_a_mechanism_are_errors() {
    for (first, second) in [
        (&[X][..], &[X][..]),
        (&[RX], &[RX]),
        (&[Y], &[Y]),
        (&[Z], &[Z]),
        (&[Y, RZ], &[RZ]),
        (&[RY], &[Z, RY]),
    ] {
        let text = text(released_beam(first, second));
        assert!(text.starts_with("beam between nodes 0 and 1: releases of the beam"), "{text}");
    }
    // Releases in different planes and of a whole end are valid.
    for (first, second) in [
        (&[RY, RZ][..], &[RY, RZ, RX][..]),
        (&[Y, Z], &[RY, RZ]),
        (&CLAMPED_DIRECTIONS, &[]),
        (&[Y, RZ], &[Z, RY]),
    ] {
        released_beam(first, second).unwrap();
    }
    let plane =
        beam([1.0, 0.0, 0.0]).and_then(|beam| beam.with_releases(0, &[Direction::Rotation]));
    assert!(text(plane).contains("released direction of the beam"));
    let third = beam([1.0, 0.0, 0.0]).and_then(|beam| beam.with_releases(2, &[X]));
    assert!(text(third).contains("released end of the beam: index 2 must be below 2"));
}

fn section_error(area: f64, moments: [f64; 2], torsion: f64) -> String {
    text(BeamSection::new(area, moments, torsion))
}

fn shear_area_error(areas: [f64; 2]) -> String {
    text(BeamSection::new(1.0, [1.0; 2], 1.0).and_then(|section| section.with_shear_areas(areas)))
}

#[test]
fn invalid_values_are_errors() {
    for (error, beginning) in [
        (section_error(0.0, [1.0; 2], 1.0), "area of the section is 0"),
        (section_error(1.0, [-1.0, 1.0], 1.0), "second moment I_y of the section is -1"),
        (section_error(1.0, [1.0, -1.0], 1.0), "second moment I_z of the section is -1"),
        (section_error(1.0, [1.0; 2], f64::NAN), "torsion constant of the section"),
        (shear_area_error([0.0, 1.0]), "shear area along y of the section is 0"),
        (shear_area_error([1.0, -1.0]), "shear area along z of the section is -1"),
    ] {
        assert!(error.starts_with(beginning), "{error}");
    }
    assert!(text(Truss::in_space([0, 1], 1.0, -1.0, 1.0)).contains("area of the truss"));
    assert!(text(Spring::axial_in_space([0, 1], 0.0)).contains("coefficient of the spring"));
    assert!(text(LumpedMass::in_space(0, -1.0, [0.0; 3])).contains("lumped mass"));
    assert!(text(LumpedMass::in_space(0, 1.0, [0.0, 0.0, -1.0])).contains("rotary inertia"));
    let mass_with_plane_inertia =
        LumpedMass::in_space(0, 1.0, [0.0; 3]).and_then(|m| m.with_rotary_inertia(1.0));
    assert!(text(mass_with_plane_inertia).contains("LumpedMass::in_space"));
}

fn add_brick(nodes: [usize; 8], height: f64) -> basemat::Result<usize> {
    let mut mesh = Mesh::in_space();
    for z in [0.0, height] {
        for [x, y] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
            mesh.add_node_at([x, y, z]).unwrap();
        }
    }
    mesh.add(Hex8::new(nodes, concrete()))
}

#[test]
fn a_brick_needs_its_nodes_in_order_and_a_volume() {
    add_brick([0, 1, 2, 3, 4, 5, 6, 7], 1.0).unwrap();
    for (nodes, height) in [
        ([0, 3, 2, 1, 4, 7, 6, 5], 1.0),
        ([4, 5, 6, 7, 0, 1, 2, 3], 1.0),
        ([0, 2, 1, 3, 4, 6, 5, 7], 1.0),
        ([0, 1, 2, 3, 4, 5, 6, 7], 0.0),
    ] {
        let text = text(add_brick(nodes, height));
        assert!(text.starts_with(&format!("brick on nodes {nodes:?}: Jacobian")), "{text}");
        assert!(text.contains("counter-clockwise from above"), "{text}");
    }
    let cube = Hex8::new([0, 1, 2, 3, 4, 5, 6, 7], concrete());
    assert!(text(cube.stresses(&[[0.0; 3]; 4], &[0.0; 24])).contains("coordinates of a brick"));
}
