//! GOAL: a foundation, welded or in contact, moves on a box of the same soil as without the box; clay limits the
//! moment.
//! SCENE: blocks on a box of elastic soil and of clay, under Ricker's wavelet and El Centro.
//! REFERENCE: the same blocks on the half-plane; the moment capacity of the effective width.

use basemat::bem::embedded::NearField;
use basemat::coupled::{Joint, Probe};
use basemat::fem::{Material, Mesh};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::{STANDARD_GRAVITY, VerticalIncidence, el_centro_1940};
use basemat::site::TrenchMotion;
use basemat::structure::{FemModel, RigidBlock, StructureGroup};
use basemat::{Result, Simulation, Soil, unobserved};
use basemat_problems::near_field::{
    HALF_WIDTH, near_field, on_box, on_half_plane, probe_series, relative_difference, ricker, soil,
    welded_block_differences,
};

/// GOAL: with six elements under the block the error of its top is below 0.3 %, that of the vertical motion of its
/// corner below 3 %.
#[test]
fn a_block_on_a_box_of_the_same_soil_moves_as_on_the_half_plane() -> Result<()> {
    let [top, corner] = welded_block_differences()?;
    println!("top {:.3} %, corner {:.3} %", 100.0 * top, 100.0 * corner);
    assert!(top < 0.003, "{top}");
    assert!(corner < 0.03, "{corner}");
    Ok(())
}

/// Height of a block that lifts off, m.
const TALL_HEIGHT: f64 = 24.0;

/// GOAL: a block that lifts off rocks as on the half-plane within 3 %.
#[test]
fn a_block_lifts_off_a_box_as_off_the_half_plane() -> Result<()> {
    let block = RigidBlock::new(2.0 * HALF_WIDTH, TALL_HEIGHT, 1500.0)?;
    let law = Coulomb::new(0.7)?;
    let model = FemModel::on_soil_at_rest(near_field().mesh()?)?;
    let lower = model.contact_nodes(&near_field().foundation_nodes(model.mesh())?)?;
    let upper = block.contact_nodes(&[[-HALF_WIDTH, 0.0], [HALF_WIDTH, 0.0]])?;
    let group = StructureGroup::new().with(model, 0.0)?.with_above(block.clone(), [0.0, 0.0])?;
    let joint =
        Joint::around_nodes(group.contact_nodes(1, upper)?, group.contact_nodes(0, lower)?)?;
    let rotation = group.row(1, 2)?;
    let boxed = on_box(ricker(6.0))?
        .structure(group)
        .interface(Bonded)
        .joint(joint.with_law(law))
        .probe(Probe::displacement("rotation", rotation));
    let computed = probe_series(boxed)?;

    let on_surface = on_half_plane(ricker(6.0))?
        .structure(block)
        .interface(law)
        .probe(Probe::displacement("rotation", [(2, 1.0)]));
    let expected = probe_series(on_surface)?;
    let bonded = on_half_plane(ricker(6.0))?
        .structure(RigidBlock::new(2.0 * HALF_WIDTH, TALL_HEIGHT, 1500.0)?)
        .interface(Bonded)
        .probe(Probe::displacement("rotation", [(2, 1.0)]));
    let bonded = probe_series(bonded)?;
    let difference = relative_difference(&computed[0], &expected[0]);
    let uplift = relative_difference(&bonded[0], &expected[0]);
    println!("rotation {:.3} %; bonded {:.1} %", 100.0 * difference, 100.0 * uplift);
    assert!(uplift > 0.1, "the block does not lift off");
    assert!(difference < 0.03, "{difference}");
    Ok(())
}

/// GOAL: the base moment is at most 5 % above (N B/2)(1 − N/N_u), with N of each instant; the energy balance closes.
#[test]
fn clay_limits_the_moment_of_a_block_in_an_earthquake() -> Result<()> {
    let half_width = 3.0;
    let strength = 60.0e3;
    let soil = Soil::from_shear_wave_speed(150.0, 0.45, 1800.0)?;
    let near_field = NearField::new(soil, half_width)?
        .with_strength_profile(move |_| strength)
        .with_pressure_at_rest(STANDARD_GRAVITY, 0.8)?;
    let block = RigidBlock::new(2.0 * half_width, 10.0, 1250.0)?;
    let model = FemModel::on_soil_at_rest(near_field.mesh()?)?;
    let lower = model.contact_nodes(&near_field.foundation_nodes(model.mesh())?)?;
    let upper = block.contact_nodes(&[[-half_width, 0.0], [half_width, 0.0]])?;
    let group = StructureGroup::new().with(model, 0.0)?.with_above(block, [0.0, 0.0])?;
    let joint =
        Joint::around_nodes(group.contact_nodes(1, upper)?, group.contact_nodes(0, lower)?)?;
    let row = |dof: usize| group.row(1, dof);
    let probes = [Probe::displacement("up", row(1)?), Probe::displacement("rotation", row(2)?)];
    let ground = near_field.ground()?;
    let record = el_centro_1940().scaled(1.5)?.padded(0.1, 0.0)?;
    let motion = TrenchMotion::new(&ground, VerticalIncidence::from(record), &mut unobserved)?;
    let mut simulation = Simulation::builder(0.02)
        .ground(ground)
        .structure(group)
        .interface(Bonded)
        .joint(joint.with_law(Coulomb::new(0.7)?))
        .motion(motion)
        .probes(probes)
        .expected_steps(200)
        .build()?;
    let bearing_force = (2.0 + std::f64::consts::PI) * strength * 2.0 * half_width;
    let mut largest_ratio = 0.0_f64;
    let run = simulation.run(200, |state| {
        let normal_force = state.joints[0].normal_force;
        let capacity = normal_force * half_width * (1.0 - normal_force / bearing_force);
        largest_ratio = largest_ratio.max(state.joints[0].moment.abs() / capacity);
    })?;
    let state = simulation.state();
    println!(
        "N_u/N {:.2}, moment over capacity {largest_ratio:.3}, settlement {:.1} mm, rotation {:.2} mrad, open by {:.1e}, \
         hysteresis {:.3} of {:.3e}",
        bearing_force / state.joints[0].normal_force,
        -1e3 * state.probes[0],
        1e3 * state.probes[1],
        run.energy_error,
        run.energy_balance.hysteresis / run.energy_balance.largest,
        run.energy_balance.largest,
    );
    assert!(largest_ratio < 1.05, "{largest_ratio}");
    assert!(largest_ratio > 0.6, "{largest_ratio}");
    assert!(run.energy_error < 1e-9, "{:e}", run.energy_error);
    assert!(run.energy_balance.hysteresis > 0.01 * run.energy_balance.largest);
    Ok(())
}

/// GOAL: boxes that cannot be made are errors, with quantity, value and need.
#[test]
fn boxes_that_cannot_be_made_are_errors() -> Result<()> {
    let text = |result: Result<NearField>| result.expect_err("an error").to_string();
    for half_width in [0.0, f64::NAN, f64::INFINITY] {
        assert!(text(NearField::new(soil(), half_width)).contains("half width"));
    }
    assert!(text(near_field().with_size(6.0, 3.0)).contains("half width of the box"));
    assert!(text(near_field().with_size(8.0, 0.0)).contains("depth of the box"));
    for count in [0, 3] {
        assert!(text(near_field().with_foundation_elements(count)).contains("even"));
    }
    assert!(text(near_field().with_pressure_at_rest(9.81, -0.1)).contains("pressure at rest"));
    let mesh_in_weak_soil = near_field().with_strength_profile(|_| 1.0e3).mesh();
    assert!(mesh_in_weak_soil.expect_err("an error").to_string().contains("depth of"));
    let mesh_of_negative_strength =
        near_field().with_strength_profile(|depth| 1.0e3 - 1.0e3 * depth).mesh();
    assert!(
        mesh_of_negative_strength
            .expect_err("an error")
            .to_string()
            .contains("strength of the soil")
    );
    let near_field_of_many_elements = near_field().with_foundation_elements(2_000_000_000)?;
    assert!(
        near_field_of_many_elements.mesh().is_err()
            && near_field_of_many_elements.ground().is_err()
    );
    let wide_near_field = near_field().with_size(1e300, 1.0)?;
    assert!(wide_near_field.mesh().is_err() && wide_near_field.ground().is_err());
    let other_mesh = Mesh::quad8_block(&[-1.0, 1.0], &[-1.0, 0.0], |_, _| {
        Material::new(1.0e6, 0.3, 2000.0).unwrap()
    })?;
    let nodes = near_field().foundation_nodes(&other_mesh).expect_err("an error").to_string();
    assert!(nodes.contains("list of nodes"), "{nodes}");
    let layer = basemat::soil::SoilProfile::on_rigid_bedrock().with_layer(soil(), 4.0)?;
    let deep_near_field = NearField::new(layer, HALF_WIDTH)?;
    let depth = deep_near_field.mesh().expect_err("an error").to_string();
    assert!(depth.contains("depth of the box"), "{depth}");
    assert!(deep_near_field.ground().is_err());
    Ok(())
}
