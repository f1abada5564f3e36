//! Models with elements that yield inside groups, wrappers and reductions, with links and P–Δ.

use std::any::Any;

use super::{
    assembled, assert_near, displacements, force, mesh, relative_difference, with_link, yielding,
};
use crate::error::Error;
use crate::fem::hardening::{Hardening, HiddenElastic};
use crate::fem::{Direction, Layer, Material, Mesh, Quad4, QuadFormulation};
use crate::structure::{
    Bilinear, CraigBampton, DofCombination, FemModel, ModalDamping, NonlinearForce, Structure,
    StructureGroup, WithModalDamping, WithSprings,
};

#[test]
fn members_of_a_group_have_their_forces() {
    let mut group =
        StructureGroup::new().with(yielding(), 0.0).unwrap().with(yielding(), 10.0).unwrap();
    let mut separate_models = [yielding(), yielding()];
    let n = separate_models[0].dofs();
    let mut u = displacements(1, 2 * n, 4e-3);
    group.nonlinear_mut().unwrap().commit(&u);
    for (k, model) in separate_models.iter_mut().enumerate() {
        model.nonlinear_mut().unwrap().commit(&u[k * n..(k + 1) * n]);
    }
    let midstep = u.clone();
    u = displacements(5, 2 * n, 5e-3);
    let expected =
        [force(&separate_models[0], &u[..n]), force(&separate_models[1], &u[n..])].concat();
    assert_eq!(force(&group, &u), expected);
    let forces = separate_models.each_ref().map(|model| model.nonlinear().unwrap());
    let remainders = [0, 1].map(|k| {
        let range = k * n..(k + 1) * n;
        forces[k].remainder(&midstep[range.clone()], &u[range]).unwrap()
    });
    let group_force = group.nonlinear().unwrap();
    let group_remainder = group_force.remainder(&midstep, &u).unwrap();
    assert!(
        (group_remainder - remainders[0] - remainders[1]).abs() < 1e-12 * group_remainder.abs()
    );
    let text = group_force.describe_state(&u, &[n + 3, 2]).unwrap();
    let separate_text = forces[1].describe_state(&u[n..], &[3]).unwrap();
    assert_eq!(text, format!("structure 1: {separate_text}"));
}

/// The model inside a wrapper has the variables of the last step.
#[test]
fn states_are_read_inside_groups_and_wrappers() {
    let damped_structure = ModalDamping::new(&[0.05]).unwrap().on_fixed_base(yielding()).unwrap();
    let mut group = StructureGroup::new()
        .with(yielding(), 0.0)
        .unwrap()
        .with(damped_structure, 10.0)
        .unwrap();
    let n = yielding().dofs();
    let u = displacements(1, 2 * n, 4e-3);
    group.nonlinear_mut().unwrap().commit(&u);
    let wrapper: &dyn Any = group.structure(1).unwrap();
    let wrapper = wrapper.downcast_ref::<WithModalDamping>().unwrap();
    let model: &dyn Any = wrapper.structure();
    let mut separate_model = yielding();
    separate_model.nonlinear_mut().unwrap().commit(&u[n..]);
    let points = model.downcast_ref::<FemModel>().unwrap().solid_points(3).unwrap();
    assert_eq!(points, separate_model.solid_points(3).unwrap());
    assert!(points.iter().any(|point| point.state.plastic_strain > 0.0));
    assert!(matches!(group.structure(2), Err(Error::Index { .. })));
    let sprung_model = WithSprings::new(separate_model.clone());
    let model: &dyn Any = sprung_model.structure();
    let inner_points = model.downcast_ref::<FemModel>().unwrap().solid_points(3);
    assert_eq!(inner_points.unwrap(), points);
}

#[test]
fn springs_and_elements_act_together() {
    let model = yielding();
    let n = model.dofs();
    let drift = DofCombination::from(n - 2) - DofCombination::from(0);
    let spring = Bilinear::new(5.0e6, 2.0e4, 0.0).unwrap();
    let with_springs =
        WithSprings::new(model.clone()).spring(drift.clone(), spring.clone()).unwrap();
    let rigid_block = FemModel::on_base(mesh(Material::new(20.0e6, 0.3, 1900.0).unwrap())).unwrap();
    let spring_alone = WithSprings::new(rigid_block).spring(drift, spring).unwrap();
    let u = displacements(6, n, 4e-3);
    let pairs = force(&model, &u).into_iter().zip(force(&spring_alone, &u));
    let expected: Vec<f64> = pairs.map(|(model, spring)| model + spring).collect();
    assert_near(&force(&with_springs, &u), &expected, 1e-15);
    let combined_force = with_springs.nonlinear().unwrap();
    let energy = combined_force.energy(&u).unwrap();
    let sum = model.nonlinear().unwrap().energy(&u).unwrap() + spring_alone.energy(&u).unwrap();
    assert_eq!(energy, sum);
    assert!(combined_force.describe_state(&u, &[2]).is_some());
    assert!(combined_force.has_symmetric_tangent());
}

/// REFERENCE: the work of the midstep force less the changes of the energies, and the remainder of the model alone.
#[test]
fn springs_around_elements_have_the_remainder_of_both() {
    let mut model = yielding();
    let n = model.dofs();
    let drift = DofCombination::from(n - 2) - DofCombination::from(0);
    let spring = Bilinear::new(5.0e6, 2.0e4, 0.1).unwrap();
    let with_springs = || WithSprings::new(yielding()).spring(drift.clone(), spring.clone());
    let mut sprung_model = with_springs().unwrap();
    // The first step starts at zero displacement.
    let mut start = vec![0.0; n];
    let mut spring_remainder = 0.0_f64;
    for (k, size) in [(2, 5e-3), (7, 2e-2), (4, 1e-2), (6, 4e-3)] {
        let end = displacements(k, n, size);
        let midstep: Vec<f64> = start.iter().zip(&end).map(|(a, b)| 0.5 * (a + b)).collect();
        let sprung_force = sprung_model.nonlinear().unwrap();
        let work: f64 = force(&sprung_model, &midstep)
            .iter()
            .zip(end.iter().zip(&start))
            .map(|(force, (end, start))| force * (end - start))
            .sum();
        let start_energy = sprung_force.energy(&start).unwrap();
        let end_energy = sprung_force.energy(&end).unwrap();
        let energy_change = end_energy.stored + end_energy.dissipated
            - start_energy.stored
            - start_energy.dissipated;
        let remainder = sprung_force.remainder(&midstep, &end).unwrap();
        assert!((remainder - work + energy_change).abs() < 1e-11 * work.abs(), "{remainder}");
        let model_remainder = model.nonlinear().unwrap().remainder(&midstep, &end).unwrap();
        spring_remainder = spring_remainder.max((remainder - model_remainder) / remainder);
        sprung_model.nonlinear_mut().unwrap().commit(&end);
        model.nonlinear_mut().unwrap().commit(&end);
        start = end;
    }
    assert!(spring_remainder > 1e-6, "{spring_remainder}");
    // The displacement at the end of the last step is among the saved variables.
    let mut restored_model = with_springs().unwrap();
    restored_model.nonlinear_mut().unwrap().commit(&vec![0.0; n]);
    let values = sprung_model.nonlinear().unwrap().save().unwrap();
    restored_model.nonlinear_mut().unwrap().restore(&values).unwrap();
    let end = displacements(3, n, 5e-3);
    let remainders =
        [&sprung_model, &restored_model].map(|s| s.nonlinear().unwrap().remainder(&end, &end));
    assert!(remainders[0].is_some() && remainders[0] == remainders[1]);
    let error = restored_model.nonlinear_mut().unwrap().restore(&values[1..]).unwrap_err();
    assert!(matches!(error, Error::Checkpoint(_)), "{error}");
    assert_eq!(restored_model.nonlinear().unwrap().remainder(&end, &end), remainders[0]);
}

#[test]
fn p_delta_takes_the_forces_of_small_displacements() {
    let material = Material::new(20.0e6, 0.3, 1900.0).unwrap();
    let user_model = with_link(HiddenElastic(material)).with_p_delta(9.81).unwrap();
    let elastic = with_link(material).with_p_delta(9.81).unwrap();
    let n = user_model.dofs();
    let geometric = |model: &FemModel| assembled(|m| model.geometric_stiffness(m).unwrap(), n);
    assert!(relative_difference(&geometric(&user_model), &geometric(&elastic)) < 1e-12);
    assert!(user_model.nonlinear().is_some());
}

#[test]
fn sections_and_reductions_refuse_elements_with_variables() {
    let error = yielding().section(2.0, 0.0).unwrap_err();
    assert!(error.to_string().contains("element 4 above it has internal variables"), "{error}");
    // Below the section they change nothing.
    let mut layers = mesh(Hardening::FIRM_SOIL);
    let roof = Material::new(30.0e9, 0.2, 2400.0).unwrap();
    let left_node = layers.node_at(0.0, 4.0).unwrap();
    let right_node = layers.node_at(1.0, 4.0).unwrap();
    let top = [layers.add_node(1.0, 5.0).unwrap(), layers.add_node(0.0, 5.0).unwrap()];
    let quad =
        Quad4::new([left_node, right_node, top[0], top[1]], roof, QuadFormulation::default());
    layers.add(quad).unwrap();
    assert!(FemModel::on_base(layers).unwrap().section(4.0, 0.0).is_ok());
    let error = CraigBampton::new(2).reduce(yielding()).unwrap_err();
    assert!(error.to_string().contains("internal variables"), "{error}");
}

#[test]
fn merged_nodes_join_yielding_blocks() {
    let whole_model = yielding();
    // The same block in two parts on separate nodes, merged.
    let mut parts = Mesh::new();
    for y_lines in [&[0.0, 1.0][..], &[1.0, 2.0, 4.0]] {
        let part =
            Mesh::quad8_block(&[0.0, 1.0, 3.0], y_lines, |_, _| Hardening::FIRM_SOIL).unwrap();
        let first_node = parts.nodes().len();
        for [x, y, _] in part.nodes() {
            parts.add_node(*x, *y).unwrap();
        }
        for element in part.elements() {
            let nodes: Vec<usize> = element.nodes().iter().map(|node| first_node + node).collect();
            parts.add(element.with_nodes(&nodes).unwrap()).unwrap();
        }
    }
    parts.merge_nodes(1e-6).unwrap();
    let joined_model = FemModel::on_base(parts).unwrap();
    let n = whole_model.dofs();
    assert_eq!(joined_model.dofs(), n);
    let displacement_at = |[x, y, _]: [f64; 3]| [3e-3 * (x * y).sin(), 4e-3 * (x - y).cos()];
    let forces = [&whole_model, &joined_model].map(|model| {
        let mut u = vec![0.0; n];
        for (node, point) in model.mesh().nodes().iter().enumerate() {
            for (direction, value) in
                [Direction::X, Direction::Y].into_iter().zip(displacement_at(*point))
            {
                u[model.dof(node, direction).unwrap()] = value;
            }
        }
        let forces = force(model, &u);
        let point_force = |x, y| {
            let node = model.mesh().node_at(x, y).unwrap();
            forces[model.dof(node, Direction::X).unwrap()]
        };
        [point_force(0.0, 1.0), point_force(0.5, 1.0), point_force(3.0, 4.0), point_force(2.0, 0.0)]
    });
    assert_near(&forces[1], &forces[0], 1e-13);
}

#[test]
fn layers_of_linear_quadrilaterals_stay_linear() {
    let layer = Layer::new(2.0, 2, Material::new(30.0e9, 0.2, 2400.0).unwrap());
    let model = FemModel::on_base(Mesh::layered_block(0.0..4.0, 4, &[layer]).unwrap()).unwrap();
    assert!(model.nonlinear().is_none());
}
