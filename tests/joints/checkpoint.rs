//! Checkpoints, series and warnings of a scene with joints.

use basemat::bem::ElasticGround;
use basemat::coupled::{Joint, SimulationBuilder, State, Warning};
use basemat::fem::{Layer, Material, Mesh};
use basemat::interface::{Cohesive, Coulomb};
use basemat::motion::el_centro_1940;
use basemat::results::{JointQuantity, Recorder, TimeSeries};
use basemat::structure::{FemModel, RigidBlock, StructureGroup};
use basemat::{Result, Simulation, Soil};

fn block_on_wall(elements: usize) -> Result<SimulationBuilder> {
    let concrete = Material::new(30.0e9, 0.2, 2400.0)?;
    let mesh = Mesh::layered_block(-1.0..1.0, 4, &[Layer::new(3.0, 4, concrete)])?;
    let wall = FemModel::on_base(mesh)?;
    let top = [-1.0, -0.5, 0.0, 0.5, 1.0].map(|x| wall.mesh().node_at(x, 3.0));
    let top = wall.contact_nodes(&top.into_iter().collect::<Result<Vec<_>>>()?)?;
    let block = RigidBlock::new(2.0, 3.0, 2000.0)?;
    let bottom = block.contact_nodes(&[[-1.0, 0.0], [1.0, 0.0]])?;
    let group = StructureGroup::new().with(wall, 0.0)?.with_above(block, [0.0, 3.0])?;
    let upper = group.contact_nodes(1, bottom)?;
    let joint = Joint::between(upper, group.contact_nodes(0, top)?, elements)?;
    Ok(Simulation::builder(0.005)
        .ground(ElasticGround::under(Soil::new(80.0e6, 0.33, 1900.0)?, &group, 6)?)
        .structure(group)
        .interface(Coulomb::new(0.6)?)
        .joint(joint.with_law(Cohesive::new(20.0e3, 60.0e3, 0.4)?))
        .motion(el_centro_1940().scaled(1.5)?))
}

#[test]
fn a_resumed_run_has_the_same_bits() -> Result<()> {
    let mut simulation = block_on_wall(4)?.build()?;
    let mut series = Recorder::new().start(&simulation)?;
    let run = simulation.run(600, |state| series.record(state))?;
    assert!(run.energy_error < 1e-9, "{}", run.energy_error);
    let checkpoint = simulation.checkpoint()?;
    simulation.run(400, |state| series.record(state))?;
    let mut other_simulation = block_on_wall(4)?.build()?;
    other_simulation.resume(&checkpoint)?;
    other_simulation.run(400, |_| {})?;
    assert_eq!(other_simulation.state(), simulation.state());

    let state = &simulation.state().joints[0];
    println!("{state:?}");
    for quantity in JointQuantity::ALL_QUANTITIES {
        let values = series.joint_series(0, quantity)?;
        assert_eq!(values.len(), 1001);
        assert_eq!(values.last(), Some(&quantity.value(state)));
    }
    assert!(series.joint_series(1, JointQuantity::Moment).is_err());
    let heading = series.csv().lines().next().unwrap_or_default().to_owned();
    assert!(heading.contains(",joint_0_normal_force_n_per_m,"), "{heading}");
    // The energies of the joints are part of the balance.
    let balance = &simulation.state().energy_balance;
    assert!(
        state.contact_energy >= 0.0
            && state.contact_energy <= balance.contact + 1e-9 * balance.largest
    );
    // Another number of elements is another scene.
    assert!(block_on_wall(3)?.build()?.resume(&checkpoint).is_err());
    Ok(())
}

/// REFERENCE: the states of the run.
#[test]
fn frames_and_envelopes_of_a_joint_follow_its_elements() -> Result<()> {
    let mut simulation = block_on_wall(4)?.build()?;
    let mut series = Recorder::new().contact(5).start(&simulation)?;
    let mut states = vec![simulation.state().clone()];
    let run = simulation.run(400, |state| {
        states.push(state.clone());
        series.record(state)
    })?;
    let frames: Vec<_> = series.joint_frames(0)?.collect();
    assert_eq!(frames.len(), 81);
    for (frame, state) in frames.iter().zip(states.iter().step_by(5)) {
        assert_eq!((frame.time, frame.states), (state.time, &state.joints[0].contact[..]));
        assert_eq!(frame.modes, state.joints[0].modes);
    }
    // Frames of the base have the elements of the base alone.
    for (frame, state) in series.contact_frames().zip(states.iter().step_by(5)) {
        assert_eq!((frame.states, frame.modes), (&state.contact[..], &state.modes[..]));
    }
    let [elements] = series.joint_elements() else { panic!("one joint") };
    let ends: Vec<_> = elements.iter().map(|element| [element.left(), element.right()]).collect();
    assert_eq!(ends, [[-1.0, -0.5], [-0.5, 0.0], [0.0, 0.5], [0.5, 1.0]]);
    assert!(elements.iter().all(|element| element.heights() == [3.0; 2]));

    let [envelopes] = &run.joint_envelopes[..] else { panic!("one joint") };
    for (element, envelope) in envelopes.iter().enumerate() {
        let contact = states.iter().map(|state| &state.joints[0].contact[element]);
        let largest_gap = contact.clone().fold(0.0, |max: f64, contact| max.max(contact.gap));
        let max_pressure = contact.fold(f64::MIN, |max, contact| max.max(contact.pressure));
        assert_eq!(
            (envelope.gap.value, envelope.pressure.highest.value),
            (largest_gap, max_pressure)
        );
        let is_open = |state: &&State| !state.joints[0].modes[element].is_closed();
        let open_time = 0.005 * states[1..].iter().filter(is_open).count() as f64;
        assert!((envelope.open - open_time).abs() < 1e-9, "{} of {open_time}", envelope.open);
    }
    assert!(envelopes.iter().any(|envelope| envelope.open > 0.0));
    assert!(run.to_string().contains("\nJoint "), "{run}");

    let heading =
        "time_s,element,left_m,right_m,bottom_m,top_m,mode,gap_m,slip_m,pressure_pa,shear_pa";
    let csv = series.joint_csv(0)?;
    assert_eq!(csv.lines().next(), Some(heading));
    assert_eq!(csv.lines().count(), 1 + 81 * 4);
    let csv = run.joint_envelope_csv(0)?;
    assert!(csv.starts_with("element,left_m,right_m,bottom_m,top_m,static_pressure_pa,"), "{csv}");
    assert_eq!(csv.lines().count(), 5);
    assert!(series.joint_frames(1).is_err() && run.joint_envelope_csv(1).is_err());

    let text = serde_json::to_string(&series).unwrap();
    let series_read: TimeSeries = serde_json::from_str(&text).unwrap();
    assert_eq!(series_read.joint_frames(0)?.collect::<Vec<_>>(), frames);
    assert_eq!(series_read.bytes(), series.bytes());
    Ok(())
}

#[test]
fn few_elements_along_a_flexible_side_are_a_warning() -> Result<()> {
    let warnings = |elements: usize| -> Result<Vec<Warning>> {
        let mut warnings = block_on_wall(elements)?.build()?.run(1, |_| {})?.warnings;
        warnings.retain(|warning| matches!(warning, Warning::CoarseJoint { .. }));
        Ok(warnings)
    };
    assert_eq!(warnings(2)?, [Warning::CoarseJoint { joint: 0, elements: 2, needed: 4 }]);
    assert_eq!(warnings(4)?, []);
    Ok(())
}

/// The weight of what stands above is on the joint and on the ground, also with a bonded joint.
#[test]
fn the_static_state_loads_joint_and_ground() -> Result<()> {
    let weight = 2.0 * 3.0 * 2000.0 * basemat::motion::STANDARD_GRAVITY;
    let simulation = block_on_wall(4)?.build()?;
    let joint = &simulation.state().joints[0];
    assert!((joint.normal_force / weight - 1.0).abs() < 1e-7, "{}", joint.normal_force);
    assert!(joint.shear_force.abs() < 1e-6 * weight && joint.moment.abs() < 1e-6 * weight);
    let wall_weight = 2.0 * 3.0 * 2400.0 * basemat::motion::STANDARD_GRAVITY;
    let normal_force = simulation.state().normal_force;
    assert!((normal_force / (weight + wall_weight) - 1.0).abs() < 1e-7, "{normal_force}");
    Ok(())
}
