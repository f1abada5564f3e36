//! GOAL: scenes without a static state, and impossible loads and initial motions, are errors with their cause.
//! SCENE: blocks pushed off, turned over, lifted or on weak soil; mechanisms; springs too soft for their weight.
//! REFERENCE: statics of the rigid block; Euler's load on springs.

use basemat::bem::SpringGround;
use basemat::coupled::{GravityStage, Load, SimulationBuilder, StabilityError};
use basemat::fem::{Beam, Direction, Material, Mesh, Quad4, QuadFormulation, Truss};
use basemat::interface::{Bonded, Cohesive, Coulomb, Yielding};
use basemat::motion::STANDARD_GRAVITY;
use basemat::structure::{DofCombination, FemModel, StructureGroup};
use basemat::{Error, Simulation};

use super::loads::{BLOCK_WEIGHT, block, on_half_plane};

/// The cause of the error of a scene without a static state.
fn stability_error(builder: SimulationBuilder) -> StabilityError {
    match builder.build().map(|_| ()).unwrap_err() {
        Error::Stability(cause) => *cause,
        other => panic!("{other}"),
    }
}

fn coulomb() -> Coulomb {
    Coulomb::new(0.5).unwrap()
}

/// The block under a horizontal force, N/m, at this height, m.
fn pushed(height: f64, force: f64) -> SimulationBuilder {
    let load = Load::constant(block().horizontal_at(height), force);
    on_half_plane(block()).interface(coulomb()).load(load)
}

#[test]
fn sliding_is_an_error_with_its_resistance() {
    let StabilityError::Sliding { horizontal, normal, resistance, ratio, .. } =
        stability_error(pushed(0.0, -0.6 * BLOCK_WEIGHT))
    else {
        panic!()
    };
    assert!((horizontal / BLOCK_WEIGHT + 0.6).abs() < 1e-9);
    assert!((normal / BLOCK_WEIGHT - 1.0).abs() < 1e-9);
    assert!((resistance / BLOCK_WEIGHT - 0.5).abs() < 1e-9 && (ratio - 1.2).abs() < 1e-9);

    // In a group the error names the member by the ends of its base.
    let group = StructureGroup::new().with(block(), 0.0).unwrap().with(block(), 20.0).unwrap();
    let push = group.row(1, block().horizontal_at(0.0)).unwrap();
    let load = Load::constant(push, 0.6 * BLOCK_WEIGHT);
    let StabilityError::Sliding { ends, ratio, .. } =
        stability_error(on_half_plane(group).interface(coulomb()).load(load))
    else {
        panic!()
    };
    assert!(ends == [17.0, 23.0] && (ratio - 1.2).abs() < 1e-9, "{ends:?}");
}

#[test]
fn overturning_is_an_error_with_its_moment() {
    let StabilityError::Overturning { moment, eccentricity, ratio, .. } =
        stability_error(pushed(9.0, 0.4 * BLOCK_WEIGHT))
    else {
        panic!()
    };
    assert!((moment / BLOCK_WEIGHT + 3.6).abs() < 1e-6, "{moment}");
    assert!((eccentricity - 3.6).abs() < 1e-6 && (ratio - 1.2).abs() < 1e-6, "{eccentricity}");

    // On a base at rest the moment of a rigid block is F h, with and without P–Δ.
    for (height, force) in [(9.0, 0.4), (0.5, 7.0)] {
        let block = block().with_p_delta(STANDARD_GRAVITY).unwrap();
        let load = Load::constant(block.horizontal_at(height), force * BLOCK_WEIGHT);
        let law = Coulomb::new(f64::INFINITY).unwrap();
        let StabilityError::Overturning { moment, ratio, .. } =
            stability_error(on_half_plane(block).interface(law).load(load))
        else {
            panic!()
        };
        let expected = force * height;
        assert!((moment / BLOCK_WEIGHT + expected).abs() < 1e-5 * expected, "{moment}");
        assert!((ratio - expected / 3.0).abs() < 1e-5 * expected, "{ratio}");
    }
}

#[test]
fn a_lifted_block_is_an_error_with_its_upward_force() {
    let lift = Load::constant(block().vertical_at(0.0), 1.5 * BLOCK_WEIGHT);
    let StabilityError::Uplift { upward, .. } =
        stability_error(on_half_plane(block()).interface(coulomb()).load(lift))
    else {
        panic!()
    };
    assert!((upward / BLOCK_WEIGHT - 0.5).abs() < 1e-9);
}

/// Soil bears 0.8 of the weight; or 1.2 of it, but 6 − 2 m of soil bear a weight that is one metre off the middle.
#[test]
fn bearing_failure_is_an_error_with_its_width() {
    for (bearing_ratio, eccentricity, expected_ratio, expected_width) in
        [(0.8, 0.0, 1.25, 6.0), (1.2, 1.0, 1.25, 4.0)]
    {
        let weak_soil = Yielding::new(bearing_ratio * BLOCK_WEIGHT / 6.0, 0.5).unwrap();
        let force = eccentricity * BLOCK_WEIGHT / 9.0;
        let load = Load::constant(block().horizontal_at(9.0), force);
        let StabilityError::BearingFailure { ratio, width, .. } =
            stability_error(on_half_plane(block()).interface(weak_soil).load(load))
        else {
            panic!()
        };
        assert!((ratio - expected_ratio).abs() < 1e-6, "{ratio} {width}");
        assert!((width - expected_width).abs() < 1e-6, "{ratio} {width}");
    }
}

/// Adds a concrete beam of 0.5 m².
fn add_beam(mesh: &mut Mesh, nodes: [usize; 2]) {
    mesh.add(Beam::new(nodes, 30.0e9, 0.5, 0.01, 2400.0).unwrap()).unwrap();
}

/// A column hinged on a footing turns about the hinge: its two trusses are in line.
#[test]
fn a_mechanism_is_an_error_with_its_place() {
    let mut mesh = Mesh::new();
    let footing = [-1.0, 0.0, 1.0].map(|x| mesh.add_node(x, 0.0).unwrap());
    for pair in footing.windows(2) {
        add_beam(&mut mesh, [pair[0], pair[1]]);
    }
    let hinge = mesh.add_node(0.0, 1.0).unwrap();
    let top = mesh.add_node(0.5, 4.0).unwrap();
    add_beam(&mut mesh, [footing[1], hinge]);
    mesh.add(Truss::new([hinge, top], 30.0e9, 0.5, 2400.0).unwrap()).unwrap();
    let model = FemModel::new(mesh, &footing).unwrap();
    let free_dofs =
        [Direction::X, Direction::Y].map(|direction| model.dof(top, direction).unwrap());
    let StabilityError::Mechanism { dofs, place, massless: false } =
        stability_error(on_half_plane(model).interface(coulomb()))
    else {
        panic!()
    };
    assert_eq!(dofs, free_dofs, "{place}");
    assert!(place.contains("(0.5, 4)"), "{place}");
}

/// A leaning mast of two beams on a block of solids, on one of its nodes or on two.
fn mast_on_solids(clamped: bool, lean: f64) -> SimulationBuilder {
    let concrete = Material::new(30.0e9, 0.2, 2400.0).unwrap();
    let mut mesh = Mesh::new();
    let rows = [0.0, 1.0, 2.0].map(|y| [-1.0, 0.0, 1.0].map(|x| mesh.add_node(x, y).unwrap()));
    let middle = mesh.add_node(0.5 * lean, 4.0).unwrap();
    let top = mesh.add_node(lean, 6.0).unwrap();
    for pair in rows.windows(2) {
        for column in 0..2 {
            let nodes =
                [pair[0][column], pair[0][column + 1], pair[1][column + 1], pair[1][column]];
            mesh.add(Quad4::new(nodes, concrete, QuadFormulation::default())).unwrap();
        }
    }
    add_beam(&mut mesh, [rows[2][1], middle]);
    add_beam(&mut mesh, [middle, top]);
    if clamped {
        add_beam(&mut mesh, [rows[1][1], rows[2][1]]);
    }
    on_half_plane(FemModel::on_base(mesh).unwrap()).interface(coulomb())
}

/// Solids have no rotations: a beam on one of their nodes turns freely, on two it is clamped.
///
/// The same holds for an upright beam, on which no moment acts.
#[test]
fn a_beam_hinged_on_solids_is_a_mechanism() {
    for lean in [0.0, 1.0] {
        let StabilityError::Mechanism { place, massless: false, .. } =
            stability_error(mast_on_solids(false, lean))
        else {
            panic!()
        };
        let top = format!("({lean}, 6)");
        assert!(place.contains(&top) && !place.contains("(0, 0)"), "{place}");
        mast_on_solids(true, lean).build().unwrap();
    }
}

/// However slender it is, a structure that stands is not a mechanism.
#[test]
fn a_slender_column_of_many_beams_stands() {
    for (beams, length) in [(200, 0.25), (1000, 0.05), (5000, 0.01)] {
        let mut mesh = Mesh::new();
        let footing = [-1.0, 0.0, 1.0].map(|x| mesh.add_node(x, 0.0).unwrap());
        add_beam(&mut mesh, [footing[0], footing[1]]);
        add_beam(&mut mesh, [footing[1], footing[2]]);
        let mut lower = footing[1];
        for k in 1..=beams {
            let upper = mesh.add_node(0.0, length * f64::from(k)).unwrap();
            let beam = Beam::new([lower, upper], 30.0e9, 0.05, 1e-5, 2400.0).unwrap();
            mesh.add(beam).unwrap();
            lower = upper;
        }
        let model = FemModel::on_base(mesh).unwrap();
        on_half_plane(model).interface(coulomb()).build().unwrap();
    }
}

fn standing_block() -> SimulationBuilder {
    on_half_plane(block()).interface(coulomb())
}

fn unloaded_block() -> SimulationBuilder {
    standing_block().gravity_stage(GravityStage::Unloaded)
}

#[test]
fn initial_motions_and_loads_that_make_no_sense_are_errors() {
    let bonded = unloaded_block().interface(Bonded);
    for (builder, reason) in [
        (standing_block().initial_displacement([0.0, 0.0]), "initial displacement"),
        (standing_block().initial_velocity([0.0, f64::NAN, 0.0]), "initial velocity"),
        (standing_block().initial_displacement([0.0, 0.01, 0.0]), "Unloaded"),
        (unloaded_block().initial_displacement([0.0, -0.01, 0.0]), "gap of an element"),
        (unloaded_block().initial_displacement([0.0, 0.0, 0.01]), "gap of an element"),
        (bonded.initial_displacement([0.0, 0.1, 0.0]), "does not open"),
        (
            standing_block().load(Load::constant(DofCombination::from(3), 1.0)),
            "degree of freedom of a load",
        ),
        (
            standing_block().load(Load::constant(DofCombination::from((0, f64::NAN)), 1.0)),
            "weight of a degree of freedom",
        ),
        (
            standing_block().load(Load::new(DofCombination::from(0), |t| 1.0 / t)),
            "external load at t = 0",
        ),
    ] {
        let error = builder.build().map(|_| ()).unwrap_err().to_string();
        assert!(error.contains(reason), "{error}: {reason}");
    }
}

#[test]
fn loads_that_are_not_finite_later_fail_in_their_step() {
    let mut simulation = standing_block()
        .load(Load::new(DofCombination::from(0), |t| if t > 0.02 { f64::NAN } else { 0.0 }))
        .build()
        .unwrap();
    let error = simulation.run(100, |_| {}).unwrap_err();
    assert!(error.to_string().contains("external load"), "{error}");
    assert!(matches!(error, Error::Step { step: 5, .. }), "{error:?}");
    assert_eq!(simulation.state().step, 4, "{error:?}");
}

#[test]
fn tables_of_loads_interpolate_or_are_errors() {
    for (times, forces) in
        [(vec![], vec![]), (vec![0.0, 0.0], vec![1.0, 1.0]), (vec![0.0], vec![f64::INFINITY])]
    {
        assert!(Load::table(0, &times, &forces).is_err());
    }
    let table = Load::table(0, &[1.0, 2.0, 4.0], &[0.0, 10.0, 20.0]).unwrap();
    for (time, value) in [(0.5, 0.0), (1.5, 5.0), (2.0, 10.0), (3.0, 15.0), (4.0, 20.0), (4.1, 0.0)]
    {
        assert!((table.value(time) - value).abs() < 1e-14, "{time}");
    }
}

/// A block on springs too soft for it (P–Δ) is an error with the load factor k_θ/(W h).
#[test]
fn a_block_that_its_ground_cannot_support_names_its_load_factor() {
    let springs = 8;
    let bedding = 2.0e5;
    let spacing = 6.0 / f64::from(springs);
    let squares = (0..springs).map(|k| (spacing * (f64::from(k) + 0.5) - 3.0).powi(2));
    let expected = bedding * spacing * squares.sum::<f64>() / (BLOCK_WEIGHT * 4.5);
    let ground = SpringGround::new(-3.0..3.0, 8, bedding, 0.5 * bedding).unwrap();
    let builder = Simulation::builder(0.005)
        .ground(ground)
        .structure(block().with_p_delta(STANDARD_GRAVITY).unwrap())
        .gravity(STANDARD_GRAVITY)
        .interface(Bonded)
        .load(Load::new(0, |_| 1.0e4));
    let error = stability_error(builder);
    let StabilityError::Buckling { factor } = error else { panic!("{error}") };
    assert!((factor / expected - 1.0).abs() < 1e-5, "{factor} {expected}");
}

/// The block with a cohesive bond under a force, in weights, at this height, m.
fn cohesive_block(height: f64, force: f64) -> SimulationBuilder {
    let load = Load::constant(block().horizontal_at(height), force * BLOCK_WEIGHT);
    on_half_plane(block())
        .interface(Cohesive::new(1.0e3, 1.0e6, 0.3).unwrap())
        .load(load)
}

/// A bond is not friction: the error of a bonded base that overturns does not mention sliding.
#[test]
fn bonded_bases_are_not_said_to_slide() {
    let simulation = cohesive_block(0.0, 0.4).build().unwrap();
    assert!((simulation.state().base_shear / BLOCK_WEIGHT - 0.4).abs() < 1e-6);
    let error = cohesive_block(9.0, 1.5).build().map(|_| ()).unwrap_err();
    assert!(!error.to_string().contains("pushes it off"), "{error}");
}
