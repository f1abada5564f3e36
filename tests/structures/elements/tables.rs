//! GOAL: matrices of beams and bricks in space.
//! SCENE: beams with taper, offsets and releases; a cube, a parallelepiped and a distorted brick.
//! REFERENCE: `tests/data/elements`, from an independent program.

use basemat::fem::{Element, Hex8, MassKind, Material, SpaceBeam};
use basemat_problems::bricks::DISTORTED_BRICK;
use basemat_problems::dense::largest;
use basemat_problems::space_beams::{concrete, section_with_shear};
use basemat_problems::supported::{ElementMatrix, RY, RZ};
use basemat_problems::table;

const CUBE_CORNERS: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [1.0, 1.0, 1.0],
    [0.0, 1.0, 1.0],
];
const PARALLELEPIPED_CORNERS: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [1.409_657, -0.350_151, -1.374_868],
    [1.150_313, 0.488_236, -1.854_294],
    [-0.259_343, 0.838_387, -0.479_426],
    [0.330_136, 0.258_097, 0.272_757],
    [1.739_792, -0.092_054, -1.102_111],
    [1.480_449, 0.746_333, -1.581_537],
    [0.070_792, 1.096_484, -0.206_669],
];

/// Compares the matrices of an element with a table of their upper triangles.
fn compare(file: &str, element: &dyn Element, points: &[[f64; 3]]) {
    element.check(points).unwrap();
    let table = table(&format!("elements/matrices_{file}.csv"));
    for (name, part) in [
        ("stiffness", ElementMatrix::Stiffness),
        ("geometric_stiffness", ElementMatrix::GeometricStiffness),
        ("mass", ElementMatrix::Mass(MassKind::Consistent)),
        ("lumped_mass", ElementMatrix::Mass(MassKind::Lumped)),
    ] {
        let reference = table.symmetric(name, element.order());
        let computed = part.of(element, points);
        let scale = largest(&reference);
        let pairs = computed.iter().zip(&reference);
        let error = pairs.fold(0.0_f64, |largest, (a, b)| largest.max((a - b).abs()));
        println!("{name}: {error:e} of {scale:e}");
        assert!(error <= 1e-13 * scale, "{name}: {error:e} of {scale:e}");
    }
}

fn beam(orientation: [f64; 3]) -> SpaceBeam {
    SpaceBeam::new([0, 1], concrete(), section_with_shear(), orientation)
        .unwrap()
        .with_rotary_inertia()
}

#[test]
fn beams_have_the_matrices_of_the_tables() {
    let level = [[0.0; 3], [4.0, 0.0, 0.0]];
    compare("beam3d_1", &beam([0.0, 0.0, 1.0]), &level);

    // The beam carries 2.5 MN by its shortening, and 0.4 MN more at its foot by gravity.
    let along = [1.5, -1.0, 3.0];
    let strain = 2.5e6 / (30.0e9 * 0.12);
    let mut displacement = [0.0; 12];
    displacement[6..9].copy_from_slice(&along.map(|component| -strain * component));
    let gravity = 0.4e6 / (2500.0 * 0.12 * along[2]);
    let points = [[1.0, 2.0, 0.0], [2.5, 1.0, 3.0]];
    let compressed = beam([1.0, 1.0, 0.0]).in_static_state(&points, &displacement, gravity);
    compare("beam3d_2", &compressed.unwrap(), &points);

    let hinged_beam = beam([1.0, 0.0, 0.0])
        .with_compression(1.0e6)
        .and_then(|beam| beam.with_offsets([[0.0, 0.0, 0.4], [0.1, -0.2, -0.3]]))
        .and_then(|beam| beam.with_releases(1, &[RY, RZ]));
    compare("beam3d_3", &hinged_beam.unwrap(), &[[0.0; 3], [0.0, 0.0, 4.0]]);
}

#[test]
fn bricks_have_the_matrices_of_the_tables() {
    for (poisson, points, file) in [
        (0.2, CUBE_CORNERS, "hex8_1"),
        (0.2, PARALLELEPIPED_CORNERS, "hex8_2"),
        (0.3, DISTORTED_BRICK, "hex8_3"),
    ] {
        let material = Material::new(30.0e9, poisson, 2500.0).unwrap();
        compare(file, &Hex8::new([0, 1, 2, 3, 4, 5, 6, 7], material), &points);
    }
}
