//! Hinges in models: errors of the input, ties, damping, states.

use crate::error::Error;
use crate::fem::{
    AxialMomentSurface, Beam, BilinearMoment, Direction, Element, Hinge, InteractionHinge,
    LumpedMass, Mesh, SpaceHinge,
};
use crate::linalg::Triplets;
use crate::structure::{FemModel, RayleighDamping, Structure};

/// A column on a base with a hinge at its foot.
struct HingedColumn {
    model: FemModel,
    /// Nodes of the hinge.
    ends: [usize; 2],
}

/// A column with this hinge at its foot.
fn column(hinge: impl Fn([usize; 2]) -> Box<dyn Element>) -> HingedColumn {
    let mut mesh = Mesh::new();
    let line = [-1.0, 0.0, 1.0].map(|x| mesh.add_node(x, 0.0).unwrap());
    let ends = [line[1], mesh.add_node(0.0, 0.0).unwrap()];
    let top = mesh.add_node(0.0, 3.0).unwrap();
    for ends in [[line[0], line[1]], [line[1], line[2]], [ends[1], top]] {
        mesh.add(Beam::new(ends, 30.0e9, 0.1, 1.0e-3, 2400.0).unwrap()).unwrap();
    }
    mesh.add(LumpedMass::new(top, 5.0e3).unwrap()).unwrap();
    mesh.add(hinge(ends)).unwrap();
    HingedColumn { model: FemModel::new(mesh, &line).unwrap(), ends }
}

fn bilinear(nodes: [usize; 2]) -> Box<dyn Element> {
    let law = BilinearMoment::new(400.0e3, 40.0e6, 0.01).unwrap();
    Box::new(Hinge::new(nodes, 1.0e10, law).unwrap())
}

#[test]
fn ties_must_leave_the_deformations_that_yield() {
    let HingedColumn { model, ends } = column(bilinear);
    // Tied displacements leave the rotation.
    let tied_model = model.clone().with_tied_nodes(ends[0], &[ends[1]]).unwrap();
    assert_eq!(tied_model.dofs() + 2, model.dofs());
    assert!(tied_model.dof(ends[1], Direction::Rotation).is_some());
    let rigid_link_error = model.with_rigid_link(ends[0], &[ends[1]]).unwrap_err();
    assert!(rigid_link_error.to_string().contains("links or ties"), "{rigid_link_error}");
    let HingedColumn { model, ends } = column(|nodes| {
        let surface = AxialMomentSurface::ellipse(2.0e6, 300.0e3).unwrap();
        let hinge = InteractionHinge::new(nodes, [0.0, 1.0], [1.0e10; 2], 1.0e8, surface);
        Box::new(hinge.unwrap())
    });
    let error = model.with_tied_nodes(ends[0], &[ends[1]]).unwrap_err();
    assert!(matches!(error, Error::Part { .. }), "{error}");
}

/// Stiffness-proportional damping would give a hinge that rotates plastically a moment without limit.
#[test]
fn hinges_have_no_stiffness_damping() {
    let damping = RayleighDamping::new(0.0, 1e-2).unwrap();
    let HingedColumn { model, ends } = column(bilinear);
    let model = model.with_rayleigh(damping);
    let mut matrix = Triplets::new(model.dofs());
    model.damping(&mut matrix).unwrap();
    let rotation = [0, 1].map(|k| model.dof(ends[k], Direction::Rotation).unwrap());
    let couples = |&&(i, j, _): &&(usize, usize, f64)| [i, j] == rotation || [j, i] == rotation;
    assert!(matrix.entries().iter().find(couples).is_none());
    assert!(!matrix.entries().is_empty());
}

#[test]
fn states_are_those_of_hinges_alone() {
    let HingedColumn { mut model, ends } = column(bilinear);
    assert!(matches!(model.hinge_state(0), Err(Error::Part { .. })));
    assert!(matches!(model.hinge_state(9), Err(Error::Index { .. })));
    let mut displacement = vec![0.0; model.dofs()];
    displacement[model.dof(ends[1], Direction::Rotation).unwrap()] = 0.03;
    displacement[model.dof(ends[1], Direction::Y).unwrap()] = 1e-6;
    model.nonlinear_mut().unwrap().commit(&displacement);
    let state = model.hinge_state(4).unwrap();
    assert!((state.moment[2] - 408.0e3).abs() < 1e-6 && (state.force[1] - 1.0e4).abs() < 1e-9);
    assert!((state.plastic_rotation[2] - 0.0198).abs() < 1e-12);
    assert_eq!(state.position, [0.0; 3]);
}

#[test]
fn nodes_coincide_or_have_a_rigid_arm() {
    let mut mesh = Mesh::new();
    let nodes = [mesh.add_node(0.0, 3.0).unwrap(), mesh.add_node(0.0, 3.5).unwrap()];
    let law = BilinearMoment::new(400.0e3, 40.0e6, 0.01).unwrap();
    let hinge = Hinge::new(nodes, 1.0e10, law).unwrap();
    let error = mesh.add(hinge.clone()).unwrap_err();
    assert!(error.to_string().contains("distance of the nodes"), "{error}");
    mesh.add(hinge.with_rigid_arm()).unwrap();
    // A hinge of the plane is no element of space.
    let mut space = Mesh::in_space();
    let nodes = [0, 1].map(|_| space.add_node_at([0.0; 3]).unwrap());
    assert!(space.add(Hinge::new(nodes, 1.0e10, law).unwrap()).is_err());
    let axes = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]];
    space.add(SpaceHinge::new(nodes, axes, 1.0, [1.0; 3], [1.0; 2]).unwrap()).unwrap();
}

#[test]
fn errors_name_quantity_and_need() {
    let law = BilinearMoment::new(400.0e3, 40.0e6, 0.01).unwrap();
    let surface = AxialMomentSurface::ellipse(1.0, 1.0).unwrap();
    let axes = [[0.0, 0.0, 1.0], [0.0, 0.0, -2.0]];
    let texts = [
        BilinearMoment::new(0.0, 1.0, 0.0).unwrap_err().to_string(),
        BilinearMoment::new(1.0, 1.0, 1.0).unwrap_err().to_string(),
        Hinge::new([0, 1], f64::NAN, law).unwrap_err().to_string(),
        InteractionHinge::new([0, 1], [0.0; 2], [1.0; 2], 1.0, surface.clone())
            .unwrap_err()
            .to_string(),
        InteractionHinge::new([0, 1], [1.0, f64::NAN], [1.0; 2], 1.0, surface)
            .unwrap_err()
            .to_string(),
        SpaceHinge::new([0, 1], axes, 1.0, [1.0; 3], [1.0; 2]).unwrap_err().to_string(),
        AxialMomentSurface::polygon(&[[1.0, 0.0], [0.0, 1.0]]).unwrap_err().to_string(),
        AxialMomentSurface::polygon(&[[1.0, 0.0], [0.0, f64::NAN], [-1.0, 0.0]])
            .unwrap_err()
            .to_string(),
        // Zero outside; a dent; twice around.
        AxialMomentSurface::polygon(&[[1.0, 1.0], [2.0, 1.0], [1.0, 2.0]])
            .unwrap_err()
            .to_string(),
        AxialMomentSurface::polygon(&[
            [1.0, -1.0],
            [1.0, 1.0],
            [0.0, 0.2],
            [-1.0, 1.0],
            [-1.0, -1.0],
        ])
        .unwrap_err()
        .to_string(),
        AxialMomentSurface::polygon(&pentagram()).unwrap_err().to_string(),
    ];
    let words = [
        "plastic moment of the hinge",
        "hardening ratio",
        "displacement stiffness",
        "length of the axis",
        "axis of a hinge",
        "orientation",
        "corners of the yield surface",
        "corner 2",
        "once around",
        "corner 3",
        "once around",
    ];
    for (text, word) in texts.iter().zip(words) {
        assert!(text.contains(word), "{text}: {word}");
    }
}

/// A star whose sides all bend to the left.
fn pentagram() -> Vec<[f64; 2]> {
    (0..5)
        .map(|k| {
            let angle = 0.8 * std::f64::consts::PI * f64::from(k);
            [angle.cos(), angle.sin()]
        })
        .collect()
}
