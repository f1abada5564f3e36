//! GOAL: loads, static stages and initial motion are what mechanics says, and the energy balance books them.
//! SCENE: blocks, frames and towers that are pushed, pulled, let go, thrown, tilted and dropped.
//! REFERENCE: statics, a structure with the same load of its own, energy, free fall, Housner's block.

use basemat::bem::{ElasticGround, SpringGround};
use basemat::coupled::StabilityError;
use basemat::coupled::{
    Change, DissipativeMidpoint, GravityStage, HhtAlpha, Load, Midpoint, Newmark,
    SimulationBuilder, TimeScheme,
};
use basemat::fem::{Beam, Material, Mesh, Quad4, QuadFormulation};
use basemat::interface::{Bonded, Cohesive, Coulomb, FrictionLimit, ThinLayer, Yielding};
use basemat::reference::RockingBlock;
use basemat::structure::{
    Bilinear, DofCombination, FemModel, RigidBlock, ShearBuilding, Storey, Structure,
    StructureGroup,
};
use basemat::{Error, Simulation, Soil};

use basemat_problems::wrapped::Pulled;

const GRAVITY: f64 = 9.80665;

fn soil() -> Soil {
    Soil::new(80.0e6, 0.33, 1900.0).unwrap()
}

fn block() -> RigidBlock {
    RigidBlock::new(6.0, 9.0, 2000.0).unwrap()
}

/// Weight of [`block`], N/m.
const WEIGHT: f64 = 6.0 * 9.0 * 2000.0 * GRAVITY;

fn on_half_plane(structure: impl Structure + 'static) -> SimulationBuilder {
    let ground = ElasticGround::under(soil(), &structure, 8).unwrap();
    Simulation::builder(0.005).ground(ground).structure(structure)
}

fn refused(builder: SimulationBuilder) -> StabilityError {
    match builder.build().map(|_| ()).unwrap_err() {
        Error::Stability(cause) => *cause,
        other => panic!("{other}"),
    }
}

#[test]
fn a_load_of_the_builder_is_one_of_the_structure() {
    let push = |t: f64| 150.0e3 * (1.0 + (8.0 * t).sin());
    let building =
        || ShearBuilding::new(8.0, 50.0e3, 4.0e5, &[Storey::new(3.0, 20.0e3, 4.0e6); 5]).unwrap();
    let roof = DofCombination::from(building().roof());
    let law = || Coulomb::new(0.6).unwrap();
    let pulled = Pulled { structure: building(), along: roof.clone(), force: push };
    let mut inside = on_half_plane(pulled).interface(law()).build().unwrap();
    // In two loads, of which one is rounded otherwise.
    let mut outside = on_half_plane(building())
        .interface(law())
        .load(Load::new(roof.clone(), move |t| 0.5 * push(t)))
        .load(Load::new(0.5 * roof, push))
        .build()
        .unwrap();
    let a = inside.run(600, |_| {}).unwrap();
    let b = outside.run(600, |_| {}).unwrap();
    assert!(a.whole.uplifted_fraction.largest().value > 0.1, "{a}");
    let [u, v] = [&inside, &outside].map(|simulation| simulation.state().displacement().to_vec());
    let largest = u.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    assert!(u.iter().zip(&v).all(|(a, b)| (a - b).abs() < 1e-10 * largest), "{u:?} {v:?}");
    assert!(a.energy_error < 1e-9 && b.energy_error < 1e-9);
    assert!(
        (inside.state().energy_balance.input / outside.state().energy_balance.input - 1.0).abs()
            < 1e-10
    );
}

/// Any horizontal load at t = 0, however small, is carried; its resultants follow statics.
#[test]
fn static_loads_are_carried_by_statics() {
    for (law, force) in [
        (Box::new(Coulomb::new(0.5).unwrap()) as Box<dyn basemat::interface::InterfaceLaw>, 26.0),
        (Box::new(Coulomb::new(0.5).unwrap()), 0.3 * WEIGHT),
        (Box::new(Coulomb::uplift_only()), -0.2 * WEIGHT),
        (Box::new(Bonded), 0.4 * WEIGHT),
    ] {
        let height = 3.0;
        let load = Load::constant(block().horizontal_at(height), force);
        let down = Load::constant(block().vertical_at(1.0), -1.0e5);
        let mut simulation =
            on_half_plane(block()).interface(law).load(load).load(down).build().unwrap();
        let state = simulation.state();
        let near = |found: f64, wanted: f64| (found - wanted).abs() < 1e-6 * WEIGHT;
        assert!(near(state.base_shear, force), "{} {force}", state.base_shear);
        assert!(near(state.normal_force, WEIGHT + 1.0e5), "{}", state.normal_force);
        // On the soil, counter-clockwise about the middle of the base.
        let moment = -force * height - 1.0e5;
        assert!(near(state.base_moment, moment), "{} {moment}", state.base_moment);
        let before = state.clone();
        let run = simulation.run(100, |_| {}).unwrap();
        // It stays where it is.
        assert!(near(run.whole.base_shear.magnitude(), force.abs()), "{run}");
        let moved = simulation.state().displacement().iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        assert!(moved < 1e-9, "{moved:e} from {before:?}");
    }
}

/// Beyond friction for some elements, but not for all: the edge elements slide a little while the
/// load comes on, and none breaks the friction cone.
#[test]
fn elements_slide_while_a_load_comes_on() {
    let load = Load::constant(block().horizontal_at(0.5), 0.45 * WEIGHT);
    let simulation =
        on_half_plane(block()).interface(Coulomb::new(0.5).unwrap()).load(load).build().unwrap();
    let at_limit = simulation.state().contact.iter().filter(|c| {
        assert!(c.shear.abs() <= 0.5 * c.pressure * (1.0 + 1e-9), "{c:?}");
        c.shear.abs() >= 0.5 * c.pressure * (1.0 - 1e-6)
    });
    let at_limit = at_limit.count();
    assert!(at_limit > 0 && at_limit < 8, "{at_limit}");
}

#[test]
fn what_cannot_stand_is_refused_with_its_cause() {
    let law = || Coulomb::new(0.5).unwrap();
    let pushed = |height: f64, force: f64| {
        let load = Load::constant(block().horizontal_at(height), force);
        on_half_plane(block()).interface(law()).load(load)
    };
    let StabilityError::Sliding { horizontal, normal, resistance, ratio, .. } =
        refused(pushed(0.0, -0.6 * WEIGHT))
    else {
        panic!()
    };
    assert!((horizontal / WEIGHT + 0.6).abs() < 1e-9 && (normal / WEIGHT - 1.0).abs() < 1e-9);
    assert!((resistance / WEIGHT - 0.5).abs() < 1e-9 && (ratio - 1.2).abs() < 1e-9);

    let StabilityError::Overturning { moment, eccentricity, ratio, .. } =
        refused(pushed(9.0, 0.4 * WEIGHT))
    else {
        panic!()
    };
    assert!((moment / WEIGHT + 3.6).abs() < 1e-6, "{moment}");
    assert!((eccentricity - 3.6).abs() < 1e-6 && (ratio - 1.2).abs() < 1e-6, "{eccentricity}");

    // On a base at rest the moment of a rigid block is F h, with P–Δ as without.
    for (height, force) in [(9.0, 0.4), (0.5, 7.0)] {
        let block = block().with_p_delta(GRAVITY).unwrap();
        let load = Load::constant(block.horizontal_at(height), force * WEIGHT);
        let law = Coulomb::new(f64::INFINITY).unwrap();
        let StabilityError::Overturning { moment, ratio, .. } =
            refused(on_half_plane(block).interface(law).load(load))
        else {
            panic!()
        };
        let known = force * height;
        assert!((moment / WEIGHT + known).abs() < 1e-5 * known, "{moment}");
        assert!((ratio - known / 3.0).abs() < 1e-5 * known, "{ratio}");
    }

    let up = Load::constant(block().vertical_at(0.0), 1.5 * WEIGHT);
    let StabilityError::Uplift { upward, .. } =
        refused(on_half_plane(block()).interface(law()).load(up))
    else {
        panic!()
    };
    assert!((upward / WEIGHT - 0.5).abs() < 1e-9);

    // Of a group, the member is named by its base.
    let group = StructureGroup::new().with(block(), 0.0).unwrap().with(block(), 20.0).unwrap();
    let push = group.row(1, block().horizontal_at(0.0)).unwrap();
    let load = Load::constant(push, 0.6 * WEIGHT);
    let StabilityError::Sliding { ends, ratio, .. } =
        refused(on_half_plane(group).interface(law()).load(load))
    else {
        panic!()
    };
    assert!(ends == [17.0, 23.0] && (ratio - 1.2).abs() < 1e-9, "{ends:?}");

    // Soil that bears 80 % of the weight; and enough of it, but not a metre from the middle, where
    // 6 − 2 m are left.
    for (share, push, needed, left) in [(0.8, 0.0, 1.25, 6.0), (1.2, 1.0, 1.25, 4.0)] {
        let soft = Yielding::new(share * WEIGHT / 6.0, 0.5).unwrap();
        let load = Load::constant(block().horizontal_at(9.0), push * WEIGHT / 9.0);
        let StabilityError::BearingFailure { ratio, width, .. } =
            refused(on_half_plane(block()).interface(soft).load(load))
        else {
            panic!()
        };
        assert!((ratio - needed).abs() < 1e-6 && (width - left).abs() < 1e-6, "{ratio} {width}");
    }

    // A column hinged on a footing: two trusses in line.
    let mut mesh = Mesh::new();
    let line: Vec<usize> =
        [-1.0, 0.0, 1.0].iter().map(|&x| mesh.add_node(x, 0.0).unwrap()).collect();
    for pair in line.windows(2) {
        mesh.add(Beam::new([pair[0], pair[1]], 30.0e9, 0.5, 0.01, 2400.0).unwrap()).unwrap();
    }
    let [hinge, top] = [mesh.add_node(0.0, 1.0).unwrap(), mesh.add_node(0.5, 4.0).unwrap()];
    mesh.add(Beam::new([line[1], hinge], 30.0e9, 0.5, 0.01, 2400.0).unwrap()).unwrap();
    mesh.add(basemat::fem::Truss::new([hinge, top], 30.0e9, 0.5, 2400.0).unwrap()).unwrap();
    let model = FemModel::new(mesh, &line).unwrap();
    let own = [basemat::fem::Direction::X, basemat::fem::Direction::Y]
        .map(|direction| model.dof(top, direction).unwrap());
    let StabilityError::Mechanism { dofs, place, massless: false } =
        refused(on_half_plane(model).interface(law()))
    else {
        panic!()
    };
    assert_eq!(dofs, own, "{place}");
    assert!(place.contains("(0.5, 4)"), "{place}");
}

/// Solids have no rotations: a beam on a single node of theirs turns freely, also where it stands
/// upright and nothing pushes it over. On two nodes it is clamped.
#[test]
fn a_beam_hinged_on_solids_is_a_mechanism() {
    let built = |clamped: bool, lean: f64| {
        let concrete = Material::new(30.0e9, 0.2, 2400.0).unwrap();
        let mut mesh = Mesh::new();
        let mut add = |x: f64, y: f64| mesh.add_node(x, y).unwrap();
        let rows = [0.0, 1.0, 2.0].map(|y| [-1.0, 0.0, 1.0].map(|x| add(x, y)));
        let (middle, top) = (add(0.5 * lean, 4.0), add(lean, 6.0));
        for pair in rows.windows(2) {
            for k in 0..2 {
                let nodes = [pair[0][k], pair[0][k + 1], pair[1][k + 1], pair[1][k]];
                let quad = Quad4::new(nodes, concrete, QuadFormulation::default());
                mesh.add(quad).unwrap();
            }
        }
        let mut beam = |a, b| {
            mesh.add(Beam::new([a, b], 30.0e9, 0.5, 0.01, 2400.0).unwrap()).unwrap();
        };
        beam(rows[2][1], middle);
        beam(middle, top);
        if clamped {
            beam(rows[1][1], rows[2][1]);
        }
        on_half_plane(FemModel::on_base(mesh).unwrap()).interface(Coulomb::new(0.5).unwrap())
    };
    for lean in [0.0, 1.0] {
        let StabilityError::Mechanism { place, massless: false, .. } = refused(built(false, lean))
        else {
            panic!()
        };
        let top = format!("({lean}, 6)");
        assert!(place.contains(&top) && !place.contains("(0, 0)"), "{place}");
        built(true, lean).build().unwrap();
    }
}

/// However slender it is, a structure that stands is not a mechanism.
#[test]
fn a_slender_column_of_many_beams_stands() {
    for (beams, length) in [(200, 0.25), (1000, 0.05), (5000, 0.01)] {
        let mut mesh = Mesh::new();
        let beam = |mesh: &mut Mesh, nodes, area, second_moment| {
            mesh.add(Beam::new(nodes, 30.0e9, area, second_moment, 2400.0).unwrap()).unwrap();
        };
        let foot = [-1.0, 0.0, 1.0].map(|x| mesh.add_node(x, 0.0).unwrap());
        beam(&mut mesh, [foot[0], foot[1]], 0.5, 0.01);
        beam(&mut mesh, [foot[1], foot[2]], 0.5, 0.01);
        let mut last = foot[1];
        for k in 1..=beams {
            let next = mesh.add_node(0.0, length * f64::from(k)).unwrap();
            beam(&mut mesh, [last, next], 0.05, 1e-5);
            last = next;
        }
        let model = FemModel::on_base(mesh).unwrap();
        on_half_plane(model).interface(Coulomb::new(0.5).unwrap()).build().unwrap();
    }
}

/// Interpolation between numbers that double precision has, but not their difference.
#[test]
fn tables_of_huge_values_stay_finite() {
    let load = Load::table(0, &[0.0, 1.0, 2.0], &[-1e308, 1e308, 0.0]).unwrap();
    let values = [0.0, 0.25, 0.5, 1.0, 1.5, 2.0].map(|time| load.value(time) / 1e308);
    assert_eq!(values, [-1.0, -0.5, 0.0, 1.0, 0.5, 0.0]);
}

/// Snap-back of a tower: what its spring stores is what it begins with.
#[test]
fn a_released_load_leaves_its_energy() {
    let building =
        || ShearBuilding::new(8.0, 5.0e5, 4.0e6, &[Storey::new(3.0, 20.0e3, 4.0e6)]).unwrap();
    let roof = DofCombination::from(building().roof());
    let force = 20.0e3;
    let mut simulation = on_half_plane(building())
        .interface(Bonded)
        .load(Load::released(roof.clone(), force))
        .build()
        .unwrap();
    let pulled = roof.value(simulation.static_displacement());
    let run = simulation.run(8000, |_| {}).unwrap();
    assert!(run.energy_error < 1e-9);
    // In the end it has gone back by F/k in the storey, and by what base and soil had given way.
    let moved = roof.value(simulation.state().displacement());
    assert!(pulled > force / 4.0e6 && moved < -force / 4.0e6, "{pulled} {moved}");
    // Half of the work of −F is stored there, the other half radiated.
    let energy_balance = simulation.state().energy_balance;
    let stored = 0.5 * 4.0e6 * (force / 4.0e6_f64).powi(2);
    assert!((energy_balance.strain / stored - 1.0).abs() < 1e-2, "{energy_balance}");
    assert!(
        energy_balance.soil > stored && energy_balance.soil < 2.0 * -force * moved,
        "{energy_balance}"
    );
}

#[test]
fn an_initial_velocity_is_the_energy_that_a_run_begins_with() {
    let building =
        || ShearBuilding::new(8.0, 50.0e3, 4.0e5, &[Storey::new(3.0, 20.0e3, 4.0e6); 3]).unwrap();
    let roof = building().roof();
    let mut velocity = vec![0.0; building().dofs()];
    velocity[roof] = 0.5;
    let mut displacement = vec![0.0; building().dofs()];
    displacement[roof] = 0.01;
    for coordinates in
        [basemat::coupled::Coordinates::Physical, basemat::coupled::Coordinates::Modes]
    {
        for newmark in [false, true] {
            let mut builder = on_half_plane(building())
                .interface(Coulomb::new(0.6).unwrap())
                .coordinates(coordinates)
                .initial_velocity(velocity.clone())
                .initial_displacement(displacement.clone());
            if newmark {
                builder = builder.scheme(basemat::coupled::Newmark::default());
            }
            let mut simulation = builder.build().unwrap();
            let begun = simulation.state().energy_balance;
            let (kinetic, strain) = (0.5 * 20.0e3 * 0.25, 0.5 * 4.0e6 * 1e-4);
            assert!((begun.kinetic / kinetic - 1.0).abs() < 1e-9, "{begun}");
            assert!((begun.strain / strain - 1.0).abs() < 1e-9, "{begun}");
            assert!((begun.input / (kinetic + strain) - 1.0).abs() < 1e-9, "{begun}");
            assert!((simulation.state().velocity()[roof] - 0.5).abs() < 1e-12);
            let acceleration = simulation.state().acceleration()[roof];
            let wanted = if newmark { -4.0e6 * 0.01 / 20.0e3 } else { 0.0 };
            assert!((acceleration - wanted).abs() < 1e-9, "{acceleration} {wanted}");
            let run = simulation.run(1000, |_| {}).unwrap();
            assert!(run.energy_error < 1e-9, "{run}");
            // The soil has taken the rest.
            let energy_balance = simulation.state().energy_balance;
            let left = energy_balance.kinetic + energy_balance.strain;
            assert!(left < 0.9 * (kinetic + strain) && energy_balance.soil > 0.0, "{run}");
        }
    }
}

/// A block falls freely until it lands: h = g t²/2, and then it bounces no higher.
#[test]
fn a_dropped_block_falls_freely_and_lands() {
    let height = 0.05;
    let mut simulation = on_half_plane(block())
        .interface(Coulomb::new(0.5).unwrap())
        .gravity_stage(GravityStage::Unloaded)
        .initial_displacement([0.0, height, 0.0])
        .build()
        .unwrap();
    let state = simulation.state();
    assert!((state.contact[3].gap - height).abs() < 1e-15 && state.uplifted_fraction == 1.0);
    assert_eq!(state.normal_force, 0.0);
    let fall = (2.0 * height / GRAVITY).sqrt();
    while simulation.state().time + 0.005 < fall {
        let state = simulation.step().unwrap();
        let wanted = height - 0.5 * GRAVITY * state.time.powi(2);
        assert!((state.displacement()[1] - wanted).abs() < 1e-12, "{}", state.time);
    }
    let mut highest = 0.0_f64;
    let run = simulation.run(600, |state| highest = highest.max(state.contact[3].gap)).unwrap();
    assert!(run.energy_error < 1e-9 && highest < 0.5 * height, "{highest}");
    // In the end the soil carries the weight.
    assert!((simulation.state().normal_force / WEIGHT - 1.0).abs() < 0.01, "{run}");
}

/// A load that is there at t = 0 accelerates from the first step on, with every scheme: a block without
/// weight is pulled off the ground by a constant force, u = F t²/2 m.
#[test]
fn a_load_at_the_start_accelerates_in_full() {
    let force = 1.0e5;
    let mass = WEIGHT / GRAVITY;
    let schemes: [Box<dyn TimeScheme>; 4] = [
        Box::new(Midpoint),
        Box::new(DissipativeMidpoint::new(0.8).unwrap()),
        Box::new(Newmark::default()),
        Box::new(HhtAlpha::new(-0.1).unwrap()),
    ];
    for (k, scheme) in schemes.into_iter().enumerate() {
        let mut simulation = on_half_plane(block())
            .gravity(0.0)
            .interface(Coulomb::new(0.5).unwrap())
            .load(Load::constant(block().vertical_at(1.0), force))
            .scheme(scheme)
            .build()
            .unwrap();
        for _ in 0..20 {
            let state = simulation.step().unwrap();
            let wanted = 0.5 * force / mass * state.time.powi(2);
            let found = state.displacement()[1];
            assert!(
                (found / wanted - 1.0).abs() < 1e-9,
                "{k} {}: {found:e} {wanted:e}",
                state.time
            );
        }
    }
}

#[test]
fn initial_motions_and_loads_that_make_no_sense_are_refused() {
    let scene = || on_half_plane(block()).interface(Coulomb::new(0.5).unwrap());
    let unloaded = || scene().gravity_stage(GravityStage::Unloaded);
    let text = |builder: SimulationBuilder| builder.build().map(|_| ()).unwrap_err().to_string();
    let own = [
        text(scene().initial_displacement([0.0, 0.0])),
        text(scene().initial_velocity([0.0, f64::NAN, 0.0])),
        text(scene().initial_displacement([0.0, 0.01, 0.0])),
        text(unloaded().initial_displacement([0.0, -0.01, 0.0])),
        text(unloaded().initial_displacement([0.0, 0.0, 0.01])),
        text(unloaded().interface(Bonded).initial_displacement([0.0, 0.1, 0.0])),
        text(scene().load(Load::constant(DofCombination::from(3), 1.0))),
        text(scene().load(Load::constant(DofCombination::from((0, f64::NAN)), 1.0))),
        text(scene().load(Load::new(DofCombination::from(0), |t| 1.0 / t))),
    ];
    for (text, word) in own.iter().zip([
        "initial displacement",
        "initial velocity",
        "Unloaded",
        "gap of an element",
        "gap of an element",
        "does not open",
        "degree of freedom of a load",
        "weight of a degree of freedom",
        "external load at t = 0",
    ]) {
        assert!(text.contains(word), "{text}: {word}");
    }
    let mut late = scene()
        .load(Load::new(DofCombination::from(0), |t| if t > 0.02 { f64::NAN } else { 0.0 }))
        .build()
        .unwrap();
    let error = late.run(100, |_| {}).unwrap_err();
    assert!(error.to_string().contains("external load"), "{error}");
    assert!(matches!(error, Error::Step { step: 5, .. }) && late.state().step == 4, "{error:?}");
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

/// A block leans on springs that are too soft for it (P–Δ): k_θ/(W h) of its weight would stand.
///
/// Before: "no static equilibrium", with a residual that told nothing.
#[test]
fn a_block_that_its_ground_cannot_hold_names_its_load_factor() {
    let (cells, bed) = (8, 2.0e5);
    let width = 6.0 / f64::from(cells);
    let squares = (0..cells).map(|k| (width * (f64::from(k) + 0.5) - 3.0).powi(2));
    let exact = bed * width * squares.sum::<f64>() / (WEIGHT * 4.5);
    let ground = SpringGround::new(-3.0..3.0, 8, bed, 0.5 * bed).unwrap();
    let builder = Simulation::builder(0.005)
        .ground(ground)
        .structure(block().with_p_delta(GRAVITY).unwrap())
        .gravity(GRAVITY)
        .interface(Bonded)
        .load(Load::new(0, |_| 1.0e4));
    let cause = refused(builder);
    let StabilityError::Buckling { factor } = cause else { panic!("{cause}") };
    assert!((factor / exact - 1.0).abs() < 1e-5, "{factor} {exact}");
}

/// A slender block tilted and let go on an edge: quarter period over Housner's, and the first
/// amplitude after an impact over the tilt.
fn rocked(shear_wave_speed: f64, elements: usize, step: f64) -> [f64; 2] {
    let housner = RockingBlock::new(0.5, 2.0, GRAVITY).unwrap();
    let tilt = 0.3 * housner.slenderness_angle();
    let quarter = 0.25 * housner.period(tilt).unwrap();
    let block = RigidBlock::new(1.0, 4.0, 2500.0).unwrap().with_p_delta(GRAVITY).unwrap();
    let soil = Soil::from_shear_wave_speed(shear_wave_speed, 0.3, 2000.0).unwrap();
    let mut simulation = Simulation::builder(step)
        .ground(ElasticGround::under(soil, &block, elements).unwrap())
        .structure(block)
        .interface(Coulomb::new(2.0).unwrap())
        .gravity_stage(GravityStage::Unloaded)
        .initial_displacement([0.0, 0.5 * tilt, tilt])
        .build()
        .unwrap();
    let (mut upright, mut before, mut far) = (0.0, tilt, 0.0_f64);
    let steps = simulation.steps_for(2.6 * quarter);
    let run = simulation
        .run(steps, |state| {
            let now = state.base_rotation;
            if upright == 0.0 && now <= 0.0 {
                upright = state.time + step * now / (before - now);
            }
            (before, far) = (now, far.min(now));
        })
        .unwrap();
    assert!(run.energy_error < 1e-9);
    [upright / quarter, -far / tilt]
}

/// The quarter period is Housner's within 1 % on stiff soil; what an impact takes converges, and
/// grows with the stiffness of the soil towards Housner's.
#[test]
fn a_tilted_block_rocks_as_housner_s_on_stiff_soil() {
    let mut taken = Vec::new();
    for (speed, step) in [(200.0, 1e-3), (400.0, 5e-4), (800.0, 2.5e-4)] {
        let [quarter, left] = rocked(speed, 32, step);
        assert!((quarter - 1.0).abs() < 0.01, "{speed}: {quarter}");
        let coarse = rocked(speed, 16, step)[1];
        let fine = rocked(speed, 32, 0.5 * step)[1];
        println!(
            "{speed} m/s: quarter {quarter:.4}, taken {:.4} ({coarse:.4} {fine:.4})",
            1.0 - left
        );
        for other in [coarse, fine] {
            assert!(((1.0 - other) / (1.0 - left) - 1.0).abs() < 0.05, "{speed}: {left} {other}");
        }
        taken.push(1.0 - left);
    }
    let housner = RockingBlock::new(0.5, 2.0, GRAVITY).unwrap();
    let tilt = 0.3 * housner.slenderness_angle();
    let rigid = 1.0 - housner.next_peak(tilt).unwrap() / tilt;
    assert!(
        taken.windows(2).all(|pair| pair[1] > pair[0]) && taken[2] < rigid,
        "{taken:?} {rigid}"
    );
}

/// A storey pulled beyond its yield force and let go unloads along its elastic branch: heat never
/// comes back.
#[test]
fn hysteretic_storeys_begin_where_statics_left_them() {
    let building =
        ShearBuilding::new(8.0, 50.0e3, 4.0e5, &[Storey::new(3.0, 20.0e3, 4.0e6)]).unwrap();
    let roof = DofCombination::from(building.roof());
    let law = Bilinear::new(4.0e6, 10.0e3, 0.2).unwrap();
    let structure = building.with_law(0, law).unwrap();
    let mut simulation = on_half_plane(structure)
        .interface(Bonded)
        .load(Load::released(roof.clone(), 15.0e3))
        .build()
        .unwrap();
    let mut heat = simulation.state().energy_balance.hysteresis;
    let run = simulation
        .run(400, |state| {
            assert!(state.energy_balance.hysteresis >= heat - 1e-9, "{}", state.energy_balance);
            heat = state.energy_balance.hysteresis;
        })
        .unwrap();
    assert!(run.energy_error < 1e-9);
    // The elastic branch: 15 kN less take 15/4 mm off the storey at most.
    let moved = roof.value(simulation.state().displacement());
    assert!(moved < 0.0 && moved > -2.0 * 15.0e3 / 4.0e6, "{moved}");
}

/// Saved and resumed with loads and an initial motion, to the last bit; another weight is refused.
#[test]
fn runs_with_loads_and_starts_resume() {
    let scene = |gravity: f64| {
        on_half_plane(block())
            .interface(Coulomb::new(0.5).unwrap())
            .gravity(gravity)
            .load(Load::new(block().horizontal_at(9.0), |t| 1.0e5 * (9.0 * t).sin()))
            .gravity_stage(GravityStage::Unloaded)
            .initial_displacement([0.0, 0.03, 0.01])
            .build()
            .unwrap()
    };
    let mut whole = scene(GRAVITY);
    whole.run(77, |_| {}).unwrap();
    let saved = whole.checkpoint().unwrap();
    whole.run(100, |_| {}).unwrap();
    let mut second = scene(GRAVITY);
    second.resume(&saved).unwrap();
    second.run(100, |_| {}).unwrap();
    assert_eq!(second.state(), whole.state());
    let error = scene(1.62).resume(&saved).unwrap_err();
    assert!(error.to_string().contains("static state"), "{error}");
}

/// Newmark's method falls from the first step on, moved or not.
#[test]
fn a_weight_that_acts_from_the_start_accelerates_at_once() {
    let scene = || {
        on_half_plane(block())
            .interface(Coulomb::new(0.5).unwrap())
            .gravity_stage(GravityStage::Unloaded)
            .scheme(basemat::coupled::Newmark::default())
    };
    let alone = scene().build().unwrap();
    let told = scene().initial_velocity([0.0; 3]).build().unwrap();
    for simulation in [&alone, &told] {
        assert!((simulation.state().acceleration()[1] + GRAVITY).abs() < 1e-9);
    }
    // A law that counts on static pressure is told that there is none.
    let layer =
        ThinLayer::new(soil(), 1.0, 0.4).unwrap().with_friction_limit(FrictionLimit::Static);
    assert!(scene().interface(layer).build().is_err());
}

/// A bond is not friction: the error of a bonded base that overturns does not mention sliding.
#[test]
fn glued_bases_are_not_said_to_slide() {
    let glued = |height: f64, share: f64| {
        let load = Load::constant(block().horizontal_at(height), share * WEIGHT);
        on_half_plane(block()).interface(Cohesive::new(1.0e3, 1.0e6, 0.3).unwrap()).load(load)
    };
    let simulation = glued(0.0, 0.4).build().unwrap();
    assert!((simulation.state().base_shear / WEIGHT - 0.4).abs() < 1e-6);
    let error = glued(9.0, 1.5).build().map(|_| ()).unwrap_err();
    assert!(!error.to_string().contains("pushes it off"), "{error}");
}

/// A load that is set before every step is one by a function; a checkpoint keeps what was set.
#[test]
fn a_load_that_is_set_acts_from_then_on() {
    let push = |time: f64| 200.0e3 * (12.0 * time).sin();
    let scene = |value: fn(f64) -> f64| {
        let block = block();
        let roof = block.horizontal_at(9.0);
        let loads = [Load::constant(roof.clone(), 30.0e3), Load::new(roof, value)];
        let builder = on_half_plane(block).interface(Coulomb::new(0.5).unwrap());
        loads.into_iter().fold(builder, SimulationBuilder::load).build().unwrap()
    };
    let mut known = scene(push);
    let mut set = scene(|_| 0.0);
    let start = set.checkpoint().unwrap();
    for _ in 0..200 {
        let middle = known.state().time + 0.5 * known.time_step();
        set.set_load(1, push(middle)).unwrap();
        known.step().unwrap();
        set.step().unwrap();
    }
    assert_eq!(set.state().displacement(), known.state().displacement());
    assert!(known.state().base_shear.abs() > 50.0e3);

    // Its own function again, by `None` and by a checkpoint.
    let mut rest = scene(|_| 0.0);
    set.resume(&start).unwrap();
    let mut other = scene(|_| 0.0);
    other.set_load(1, 1e6).unwrap();
    other.set_load(1, None).unwrap();
    for simulation in [&mut set, &mut other, &mut rest] {
        simulation.run(20, |_| {}).unwrap();
    }
    // A force that is set at a checkpoint acts on after it, in another simulation too.
    let mut pushed = scene(|_| 0.0);
    pushed.set_load(1, 100e3).unwrap();
    pushed.run(30, |_| {}).unwrap();
    let saved = pushed.checkpoint().unwrap();
    let mut resumed = scene(|_| 0.0);
    resumed.resume(&saved).unwrap();
    let mut changed = scene(|_| 0.0);
    changed.resume_changed(&saved, &[Change::Load]).unwrap();
    for simulation in [&mut pushed, &mut resumed, &mut changed] {
        simulation.run(20, |_| {}).unwrap();
    }
    assert_eq!(resumed.state(), pushed.state());
    assert_ne!(changed.state().displacement(), pushed.state().displacement());
    assert_eq!(set.state().displacement(), rest.state().displacement());
    assert_eq!(other.state().displacement(), rest.state().displacement());
    let unknown = rest.set_load(2, 1.0).unwrap_err();
    assert!(matches!(unknown, Error::Index { index: 2, bound: 2, .. }), "{unknown}");
    assert!(matches!(rest.set_load(0, f64::NAN), Err(Error::NotFinite { index: 0, .. })));
}
