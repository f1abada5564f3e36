//! A column cut in two halves that a bonded joint connects, and the same column whole.

use basemat::bem::ElasticGround;
use basemat::coupled::{Joint, Probe};
use basemat::fem::{Beam, Direction, LumpedMass, Mesh};
use basemat::interface::Coulomb;
use basemat::motion::el_centro_1940;
use basemat::structure::{FemModel, RayleighDamping};
use basemat::{Result, Simulation, Soil};

use super::assert_same_responses;

/// A column 10 m high on a rigid basemat, with a mass on its top, its top node, and the joint if it is cut.
fn column(is_cut: bool) -> Result<(FemModel, usize, Option<Joint>)> {
    let mut mesh = Mesh::new();
    let left = mesh.add_node(-1.0, 0.0)?;
    let foot = mesh.add_node(0.0, 0.0)?;
    let right = mesh.add_node(1.0, 0.0)?;
    let lower = mesh.add_node(0.0, 5.0)?;
    let upper = if is_cut { mesh.add_node(0.0, 5.0)? } else { lower };
    let top = mesh.add_node(0.0, 10.0)?;
    for ends in [[left, foot], [foot, right], [foot, lower], [upper, top]] {
        mesh.add(Beam::new(ends, 30.0e9, 0.5, 0.01, 2400.0)?)?;
    }
    mesh.add(LumpedMass::new(top, 20.0e3)?)?;
    // Rigid sections at the cut, with masses at their ends.
    let mut sides = Vec::new();
    for _ in 0..2 {
        let ends = [mesh.add_node(-0.5, 5.0)?, mesh.add_node(0.5, 5.0)?];
        for end in ends {
            mesh.add(LumpedMass::new(end, 500.0)?)?;
        }
        sides.push(ends);
    }
    let model = FemModel::new(mesh, &[left, foot, right])?
        .with_rigid_link(foot, &[left, right])?
        .with_rigid_link(lower, &sides[0])?
        .with_rigid_link(upper, &sides[1])?
        .with_rayleigh(RayleighDamping::new(0.5, 1e-3)?);
    let mut joint = None;
    if is_cut {
        let lower_side = model.contact_nodes(&sides[0])?;
        joint = Some(Joint::between(model.contact_nodes(&sides[1])?, lower_side, 2)?);
    }
    Ok((model, top, joint))
}

/// Displacement of the top and base shear at every step.
fn responses(is_cut: bool) -> Result<[Vec<f64>; 2]> {
    let (model, top, joint) = column(is_cut)?;
    let mut builder = Simulation::builder(0.01)
        .ground(ElasticGround::under(Soil::new(80.0e6, 0.33, 1900.0)?, &model, 8)?)
        .probe(Probe::displacement("top", model.row(top, Direction::X)?))
        .structure(model)
        .interface(Coulomb::new(0.5)?)
        .motion(el_centro_1940());
    if let Some(joint) = joint {
        builder = builder.joint(joint);
    }
    let mut simulation = builder.build()?;
    let mut responses = [Vec::new(), Vec::new()];
    let run = simulation.run(1000, |state| {
        responses[0].push(state.probes[0]);
        responses[1].push(state.base_shear);
    })?;
    assert!(run.energy_error < 1e-9, "{}", run.energy_error);
    Ok(responses)
}

/// REFERENCE: the column without a cut.
#[test]
fn a_bonded_joint_does_not_change_a_column() -> Result<()> {
    let responses_of_whole_column = responses(false)?;
    let cut = responses(true)?;
    assert_same_responses(&responses_of_whole_column, &cut, 1e-9);
    Ok(())
}
