//! GOAL: impossible shells are typed errors that name their nodes.
//! SCENE: bad numbers of nodes, thicknesses and shapes.
//! REFERENCE: the fields of the error.

use super::material;
use basemat::Error;
use basemat::fem::{Element, Mesh, Shell};

/// The fault inside an error about the shell on `nodes`.
fn fault(result: basemat::Result<impl std::fmt::Debug>, nodes: &str) -> Error {
    match result {
        Err(Error::Item { item, source }) => {
            assert_eq!(item, format!("shell on nodes {nodes}"));
            *source
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn constructor_checks_nodes_and_thickness() {
    let concrete = material(30.0e9, 0.2, 2500.0);
    for nodes in [&[][..], &[1, 2], &[1, 2, 3, 4, 5]] {
        let error = fault(Shell::new(nodes, concrete, 0.2), &format!("{nodes:?}"));
        assert!(matches!(error, Error::Size { found, .. } if found == nodes.len()), "{error}");
    }
    let error = fault(Shell::new([4, 7, 4], concrete, 0.2), "[4, 7, 4]");
    assert!(matches!(error, Error::Scene { .. }), "{error}");
    // The last two have a stiffness that is not a number, and none.
    for thickness in [0.0, -0.2, f64::NAN, f64::INFINITY, 1e120, 1e-120] {
        let error = fault(Shell::new([4, 5, 6, 7], concrete, thickness), "[4, 5, 6, 7]");
        assert!(matches!(error, Error::Input { .. }), "{error}");
    }
}

fn warped_square(height: f64) -> Vec<[f64; 3]> {
    vec![[0.0, 0.0, height], [1.0, 0.0, -height], [1.0, 1.0, height], [0.0, 1.0, -height]]
}

#[test]
fn shapes_are_checked_when_a_shell_joins_a_mesh() {
    let invalid_shells: [(&str, Vec<[f64; 3]>); 9] = [
        ("coincident", vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]),
        ("reflex", vec![[0.0; 3], [2.0, 0.0, 0.0], [0.4, 0.4, 0.0], [0.0, 2.0, 0.0]]),
        ("straight corner", vec![[0.0; 3], [2.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 2.0, 0.0]]),
        ("crossed", vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]]),
        ("on a line", vec![[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 0.0, 0.0]]),
        ("warped", warped_square(0.4)),
        ("folded", vec![[0.0; 3], [1.0, 0.0, 0.0], [0.5, 0.1, 3.0], [0.0, 1.0, 0.0]]),
        ("coincident", vec![[0.0; 3], [0.0; 3], [1.0, 0.0, 0.0]]),
        ("on a line", vec![[0.0; 3], [1.0, 1.0, 1.0], [3.0, 3.0, 3.0]]),
    ];
    for (kind, points) in invalid_shells {
        let mut mesh = Mesh::in_space();
        mesh.add_node_at([9.0, 9.0, 9.0]).unwrap();
        let nodes: Vec<usize> = points.iter().map(|&p| mesh.add_node_at(p).unwrap()).collect();
        let shell = Shell::new(&nodes, material(1.0, 0.0, 1.0), 0.1).unwrap();
        let error = fault(mesh.add(shell.clone()), &format!("{nodes:?}"));
        assert!(matches!(error, Error::Input { .. }), "{kind}: {error}");
        // Resultants and loads check the nodes, too.
        let rest = vec![0.0; shell.order()];
        assert!(shell.resultants(&points, &rest).is_err(), "{kind}");
        assert!(shell.areas(&points).is_err() && shell.pressure_forces(&points, 1.0).is_err());
    }
    // Slender, much distorted and warped shells are legal.
    for points in [
        vec![[0.0; 3], [1000.0, 0.0, 0.0], [1000.0, 0.1, 0.0], [0.0, 0.1, 0.0]],
        vec![[0.0; 3], [2.0, 0.0, 0.0], [1.01, 1.01, 0.0], [0.0, 2.0, 0.0]],
        warped_square(0.2),
        vec![[0.0; 3], [1000.0, 0.0, 0.0], [500.0, 0.1, 0.0]],
    ] {
        let mut mesh = Mesh::in_space();
        let nodes: Vec<usize> = points.iter().map(|&p| mesh.add_node_at(p).unwrap()).collect();
        mesh.add(Shell::new(&nodes, material(1.0, 0.0, 1.0), 0.1).unwrap()).unwrap();
    }
}

#[test]
fn lists_of_wrong_length_are_errors() {
    let shell = Shell::new([0, 1, 2], material(1.0, 0.0, 1.0), 0.1).unwrap();
    let triangle = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let quadrilateral = [triangle[0], triangle[1], [1.0, 1.0, 0.0], triangle[2]];
    assert!(matches!(
        fault(shell.check(&quadrilateral), "[0, 1, 2]"),
        Error::Size { found: 4, needed: 3, .. }
    ));
    assert!(matches!(shell.resultants(&triangle, &[0.0; 17]), Err(Error::Size { found: 17, .. })));
    let mut invalid_displacements = [0.0; 18];
    invalid_displacements[4] = f64::NAN;
    assert!(matches!(
        shell.resultants(&triangle, &invalid_displacements),
        Err(Error::NotFinite { index: 4, .. })
    ));
}

#[test]
fn axes_must_fit_the_shell() {
    let shell = Shell::new([0, 1, 2], material(1.0, 0.0, 1.0), 0.1).unwrap();
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let resultants = shell.resultants(&corners, &[0.0; 18]).unwrap()[0];
    let up = [0.0, 0.0, 1.0];
    for (along, outward) in
        [(up, up), ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]), ([0.0; 3], up), ([1.0; 3], [0.0; 3])]
    {
        let computed = resultants.in_axes(along, outward);
        assert!(
            matches!(computed, Err(Error::Input { .. })),
            "{along:?} {outward:?}: {computed:?}"
        );
    }
    assert!(resultants.in_axes([f64::NAN, 0.0, 0.0], up).is_err());
}

fn square_shell(nodes: [usize; 4], thickness: f64) -> Shell {
    Shell::new(nodes, material(1.0e6, 0.2, 1.0), thickness).unwrap()
}

#[test]
fn equal_shells_on_the_same_nodes_count_twice() {
    let mut mesh = Mesh::in_space();
    for point in [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]] {
        mesh.add_node_at(point).unwrap();
    }
    mesh.add(square_shell([0, 1, 2, 3], 0.1)).unwrap();
    assert!(mesh.add(square_shell([2, 1, 0, 3], 0.1)).is_err());
    // A layer of another thickness acts in parallel.
    mesh.add(square_shell([0, 1, 2, 3], 0.2)).unwrap();
}
