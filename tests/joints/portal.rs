//! A portal on two foundations whose beam lies on its columns by bonded joints, and the portal without joints.

use basemat::bem::ElasticGround;
use basemat::coupled::{Coordinates, Joint, Probe};
use basemat::fem::{Beam, Direction, LumpedMass, Mesh};
use basemat::interface::Bonded;
use basemat::motion::{FreeField, TravellingWave, el_centro_1940};
use basemat::structure::{FemModel, RayleighDamping};
use basemat::{Result, Simulation, Soil};

use super::assert_same_responses;

const COLUMN_HEIGHT: f64 = 6.0;

/// The portal, the middle of its beam, and the joints if it is cut.
fn portal(is_cut: bool) -> Result<(FemModel, usize, Vec<Joint>)> {
    let mut mesh = Mesh::new();
    let beam = |ends| Beam::new(ends, 30.0e9, 0.5, 0.02, 2400.0);
    let mut lines = Vec::new();
    let mut beam_ends = Vec::new();
    let mut links = Vec::new();
    let mut cuts = Vec::new();
    for x in [-5.0, 5.0] {
        let left = mesh.add_node(x - 1.0, 0.0)?;
        let foot = mesh.add_node(x, 0.0)?;
        let right = mesh.add_node(x + 1.0, 0.0)?;
        let top = mesh.add_node(x, COLUMN_HEIGHT)?;
        let beam_end = if is_cut { mesh.add_node(x, COLUMN_HEIGHT)? } else { top };
        for ends in [[left, foot], [foot, right], [foot, top]] {
            mesh.add(beam(ends)?)?;
        }
        links.push((foot, [left, right]));
        let mut sides = Vec::new();
        for leader in [top, beam_end] {
            let ends =
                [mesh.add_node(x - 0.4, COLUMN_HEIGHT)?, mesh.add_node(x + 0.4, COLUMN_HEIGHT)?];
            for end in ends {
                mesh.add(LumpedMass::new(end, 500.0)?)?;
            }
            links.push((leader, ends));
            sides.push(ends);
        }
        cuts.push(sides);
        lines.push(vec![left, foot, right]);
        beam_ends.push(beam_end);
    }
    let middle = mesh.add_node(0.0, COLUMN_HEIGHT)?;
    for end in beam_ends {
        mesh.add(beam([end, middle])?)?;
    }
    let mut model = FemModel::on_foundations(mesh, &lines)?;
    for (leader, followers) in links {
        model = model.with_rigid_link(leader, &followers)?;
    }
    // Damping in proportion to the mass depends on the ground of each part.
    let model = model.with_rayleigh(RayleighDamping::new(0.0, 2e-3)?);
    let mut joints = Vec::new();
    for sides in cuts.into_iter().filter(|_| is_cut) {
        let lower = model.contact_nodes(&sides[0])?;
        joints.push(Joint::between(model.contact_nodes(&sides[1])?, lower, 2)?);
    }
    Ok((model, middle, joints))
}

/// Motion of the beam's middle and shears of both foundations at every step.
fn responses(
    is_cut: bool,
    motion: impl FreeField + 'static,
    coordinates: Coordinates,
) -> Result<[Vec<f64>; 3]> {
    let (model, middle, joints) = portal(is_cut)?;
    let mut builder = Simulation::builder(0.01)
        .ground(ElasticGround::under(Soil::new(60.0e6, 0.33, 1900.0)?, &model, 6)?)
        .probe(Probe::absolute_displacement("middle", model.row(middle, Direction::X)?))
        .structure(model)
        .interface(Bonded)
        .coordinates(coordinates)
        .motion(motion);
    for joint in joints {
        builder = builder.joint(joint);
    }
    let mut simulation = builder.build()?;
    let mut responses = [Vec::new(), Vec::new(), Vec::new()];
    let run = simulation.run(800, |state| {
        responses[0].push(state.probes[0]);
        for k in 0..2 {
            responses[1 + k].push(state.foundations[k].base_shear);
        }
    })?;
    assert!(run.energy_error < 1e-9, "{}", run.energy_error);
    Ok(responses)
}

/// The beam does not stand on the ground: it moves with the mean of both foundations' grounds, which differ under the
/// wave.
///
/// REFERENCE: the portal without joints.
#[test]
fn bonded_joints_do_not_change_a_portal_under_a_travelling_wave() -> Result<()> {
    let wave = || TravellingWave::new(el_centro_1940(), 300.0, -6.0);
    let responses_of_whole_portal = responses(false, wave()?, Coordinates::Physical)?;
    let cut = responses(true, wave()?, Coordinates::Physical)?;
    assert_same_responses(&responses_of_whole_portal, &cut, 1e-7);
    Ok(())
}

/// REFERENCE: degrees of freedom.
#[test]
fn a_portal_with_joints_moves_the_same_in_modes() -> Result<()> {
    let physical = responses(true, el_centro_1940(), Coordinates::Physical)?;
    assert_same_responses(&physical, &responses(true, el_centro_1940(), Coordinates::Modes)?, 1e-7);
    let reduced_coordinates = Coordinates::Reduced { tolerance: 1e-5 };
    assert_same_responses(
        &physical,
        &responses(true, el_centro_1940(), reduced_coordinates)?,
        1e-3,
    );
    Ok(())
}
