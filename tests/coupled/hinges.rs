//! GOAL: concentrated hinges in runs: rigid–plastic motion, mechanisms of frames, energy with uplift and slip.
//! SCENE: a cantilever under a pulse; portals pushed and shaken, with hinges at the ends of their columns.
//! REFERENCE: closed forms of rigid–plastic bodies; the same column without a hinge; balance of energy.

use std::any::Any;

use basemat::analyses::push_over_by_displacement;
use basemat::bem::SpringGround;
use basemat::coupled::{Load, Probe};
use basemat::fem::{
    AxialMomentSurface, Beam, BilinearMoment, Direction, Element, Hinge, InteractionHinge,
    LumpedMass, MenegottoPinto, Mesh,
};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::el_centro_1940;
use basemat::structure::{FemModel, RayleighDamping};
use basemat::{Result, Simulation};
use basemat_problems::scenes::SCENE_GRAVITY;

const COLUMN_HEIGHT: f64 = 4.0;
const BAY_WIDTH: f64 = 6.0;
const PLASTIC_MOMENT: f64 = 200.0e3;
/// Mass at each end of the footing of a cantilever, kg per metre.
const FOOTING_MASS: f64 = 2.0e3;
/// Stiffness of all hinges between the displacements of their nodes, N/m per metre.
const DISPLACEMENT_STIFFNESS: f64 = 1.0e11;

/// Element between two nodes of a hinge.
type MakeHinge<'a> = &'a dyn Fn([usize; 2]) -> Result<Box<dyn Element>>;

/// Beam of this modulus, 1 m × 0.5 m, without mass.
fn beam(ends: [usize; 2], young_modulus: f64) -> Result<Beam> {
    Beam::new(ends, young_modulus, 0.5, 0.01, 0.0)
}

/// A mass on a column with a hinge at its foot, or none, on a footing 2 m wide; returns the mass's node, too.
fn cantilever(
    young_modulus: f64,
    mass: f64,
    hinge: Option<MakeHinge<'_>>,
) -> Result<(FemModel, usize)> {
    let mut mesh = Mesh::new();
    let line = [-1.0, 0.0, 1.0].map(|x| mesh.add_node(x, 0.0));
    let line = line.into_iter().collect::<Result<Vec<_>>>()?;
    let mut column_foot = line[1];
    if let Some(hinge) = hinge {
        column_foot = mesh.add_node(0.0, 0.0)?;
        mesh.add(hinge([line[1], column_foot])?)?;
    }
    let top = mesh.add_node(0.0, COLUMN_HEIGHT)?;
    for ends in [[line[0], line[1]], [line[1], line[2]], [column_foot, top]] {
        mesh.add(beam(ends, young_modulus)?)?;
    }
    for node in [line[0], line[2]] {
        mesh.add(LumpedMass::new(node, FOOTING_MASS)?)?;
    }
    mesh.add(LumpedMass::new(top, mass)?)?;
    Ok((FemModel::new(mesh, &line)?, top))
}

/// A rigid–plastic cantilever under a force F for a time T turns by F (F h − M_p) T²/(2 m h M_p).
#[test]
fn a_rigid_plastic_cantilever_turns_by_its_closed_form() {
    let mass = 20.0e3;
    let force = 2.0 * PLASTIC_MOMENT / COLUMN_HEIGHT;
    let duration = 0.8;
    // The elastic rotation at yield of 1e-6 delays the plastic moment, which adds some 0.2 % to the rotation.
    let law = BilinearMoment::new(PLASTIC_MOMENT, 1e6 * PLASTIC_MOMENT, 0.0).unwrap();
    let hinge = |nodes| -> Result<Box<dyn Element>> {
        Ok(Box::new(Hinge::new(nodes, DISPLACEMENT_STIFFNESS, law)?))
    };
    let (model, top) = cantilever(1.0e14, mass, Some(&hinge)).unwrap();
    let row = model.row(top, Direction::X).unwrap();
    let load = move |time: f64| if time > 0.0 && time < duration { force } else { 0.0 };
    let mut simulation = Simulation::builder(5e-4)
        .ground(SpringGround::under(&model, 4, 4.0e8, 4.0e8).unwrap())
        .structure(model)
        .interface(Bonded)
        .load(Load::new(row.clone(), load))
        .probe(Probe::displacement("top", row))
        .on_fixed_base()
        .build()
        .unwrap();
    let run = simulation.run(4000, |_| {}).unwrap();
    let peak = run.probe("top").unwrap().highest.value / COLUMN_HEIGHT;
    let excess_moment = force * COLUMN_HEIGHT - PLASTIC_MOMENT;
    let expected =
        force * excess_moment * duration * duration / (2.0 * mass * COLUMN_HEIGHT * PLASTIC_MOMENT);
    println!("{peak} for {expected}, energy open by {:.1e}", run.energy_error);
    assert!((peak / expected - 1.0).abs() < 5e-3, "{peak} {expected}");
    assert!(run.energy_error < 1e-9, "{:e}", run.energy_error);
    let structure: &dyn Any = simulation.structure();
    let state = structure.downcast_ref::<FemModel>().unwrap().hinge_state(0).unwrap();
    assert!((state.plastic_rotation[2] / -expected - 1.0).abs() < 5e-3, "{state:?}");
    // All plastic work is hysteresis.
    let work = PLASTIC_MOMENT * state.plastic_rotation[2].abs();
    assert!((run.energy_balance.hysteresis / work - 1.0).abs() < 1e-2);
}

/// A portal on two footings, with hinges at both ends of both columns; returns the right end of its beam, too.
fn portal(young_modulus: f64, roof_mass: f64, hinge: MakeHinge<'_>) -> Result<(FemModel, usize)> {
    let mut mesh = Mesh::new();
    let mut lines = Vec::new();
    let mut tops = Vec::new();
    for x in [0.0, BAY_WIDTH] {
        let line = [x - 1.0, x, x + 1.0].map(|x| mesh.add_node(x, 0.0));
        let line = line.into_iter().collect::<Result<Vec<_>>>()?;
        let foot = mesh.add_node(x, 0.0)?;
        let head = mesh.add_node(x, COLUMN_HEIGHT)?;
        let top = mesh.add_node(x, COLUMN_HEIGHT)?;
        mesh.add(hinge([line[1], foot])?)?;
        mesh.add(hinge([head, top])?)?;
        for ends in [[line[0], line[1]], [line[1], line[2]], [foot, head]] {
            mesh.add(beam(ends, young_modulus)?)?;
        }
        mesh.add(LumpedMass::new(top, roof_mass)?)?;
        lines.push(line);
        tops.push(top);
    }
    mesh.add(beam([tops[0], tops[1]], young_modulus)?)?;
    Ok((FemModel::on_foundations(mesh, &lines)?, tops[1]))
}

/// Force at the roof for a displacement of a portal or a cantilever, bonded to a stiff bed.
fn pushed(model: &FemModel, top: usize, displacement: f64) -> f64 {
    let row = model.row(top, Direction::X).unwrap();
    let ground = SpringGround::under(model, 4, 1.0e10, 1.0e10).unwrap();
    let builder = Simulation::builder(0.01)
        .gravity(SCENE_GRAVITY)
        .ground(ground)
        .structure(model.clone())
        .interface(Bonded);
    let displacements = [0.25 * displacement, 0.5 * displacement, displacement];
    let curve = push_over_by_displacement(builder, &row, &row, &displacements).unwrap();
    assert!(curve.cause.is_none(), "{:?}", curve.cause);
    curve.points[displacements.len()].force
}

/// Four plastic hinges of a portal make a mechanism: H h = 4 M_p, with hardening 4 (M_p + b k (Δ/h − M_p/k)).
#[test]
fn a_portal_becomes_a_mechanism_of_four_hinges() {
    let stiffness = 1e3 * PLASTIC_MOMENT;
    let hardening_ratio = 1e-3;
    let law = BilinearMoment::new(PLASTIC_MOMENT, stiffness, hardening_ratio).unwrap();
    let hinge = |nodes| -> Result<Box<dyn Element>> {
        Ok(Box::new(Hinge::new(nodes, DISPLACEMENT_STIFFNESS, law)?))
    };
    let (model, top) = portal(1.0e13, 1.0e3, &hinge).unwrap();
    let displacement = 0.08;
    let force = pushed(&model, top, displacement);
    let plastic_rotation = displacement / COLUMN_HEIGHT - PLASTIC_MOMENT / stiffness;
    let moment = PLASTIC_MOMENT + hardening_ratio * stiffness * plastic_rotation;
    let expected = 4.0 * moment / COLUMN_HEIGHT;
    println!("{force} for {expected}");
    assert!((force / expected - 1.0).abs() < 1e-3, "{force} {expected}");
}

/// Under its weight N = N_p/2 a column of rectangular section falls by H h = M_p (1 − 1/4) + b k Δ/h.
#[test]
fn the_weight_of_a_column_lowers_its_plastic_moment() {
    let axial_strength = 4.0e6;
    let stiffness = 1e3 * PLASTIC_MOMENT;
    // Its axial part changes the moment by 3e-4.
    let hardening_ratio = 1e-4;
    let surface = AxialMomentSurface::rectangle(axial_strength, PLASTIC_MOMENT).unwrap();
    let hinge = |nodes| -> Result<Box<dyn Element>> {
        let displacement_stiffness = [1.0e10, DISPLACEMENT_STIFFNESS];
        let surface = surface.clone();
        let hinge =
            InteractionHinge::new(nodes, [0.0, 1.0], displacement_stiffness, stiffness, surface)?;
        Ok(Box::new(hinge.with_hardening(hardening_ratio)?))
    };
    let mass = 0.5 * axial_strength / SCENE_GRAVITY;
    let (model, top) = cantilever(1.0e13, mass, Some(&hinge)).unwrap();
    let displacement = 0.08;
    let force = pushed(&model, top, displacement);
    let hardening = hardening_ratio * stiffness * displacement / COLUMN_HEIGHT;
    let expected = (0.75 * PLASTIC_MOMENT + hardening) / COLUMN_HEIGHT;
    println!("{force} for {expected}");
    assert!((force / expected - 1.0).abs() < 1e-3, "{force} {expected}");
}

/// Portals whose hinges yield, on footings that lift off and slide, close the energy.
#[test]
fn portals_that_yield_and_lift_off_close_the_energy() {
    let bilinear = BilinearMoment::new(PLASTIC_MOMENT, 400.0 * PLASTIC_MOMENT, 0.02).unwrap();
    let curved = MenegottoPinto::new(PLASTIC_MOMENT, 400.0 * PLASTIC_MOMENT, 0.02).unwrap();
    let surface = AxialMomentSurface::ellipse(1.2e6, PLASTIC_MOMENT).unwrap();
    let kinds: [(&str, MakeHinge<'_>); 3] = [
        ("bilinear", &|nodes| Ok(Box::new(Hinge::new(nodes, DISPLACEMENT_STIFFNESS, bilinear)?))),
        ("curved", &|nodes| Ok(Box::new(Hinge::new(nodes, DISPLACEMENT_STIFFNESS, curved)?))),
        ("interaction", &|nodes| {
            let stiffness = 400.0 * PLASTIC_MOMENT;
            let displacements = [1.0e10, DISPLACEMENT_STIFFNESS];
            let surface = surface.clone();
            let hinge =
                InteractionHinge::new(nodes, [0.0, 1.0], displacements, stiffness, surface)?;
            Ok(Box::new(hinge.with_hardening(0.01)?))
        }),
    ];
    for (name, hinge) in kinds {
        let model = portal(30.0e9, 40.0e3, hinge).unwrap().0;
        let model = model.with_rayleigh(RayleighDamping::new(0.0, 1e-3).unwrap());
        let mut simulation = Simulation::builder(0.005)
            .ground(SpringGround::under(&model, 4, 4.0e8, 4.0e8).unwrap())
            .structure(model)
            .interface(Coulomb::new(0.5).unwrap())
            .motion(el_centro_1940().scaled(3.0).unwrap())
            .build()
            .unwrap();
        let run = simulation.run(1200, |_| {}).unwrap();
        let balance = &run.energy_balance;
        let hysteresis = balance.hysteresis / balance.input;
        let friction = balance.contact / balance.input;
        println!(
            "{name}: open by {:.1e}, hysteresis {hysteresis:.3}, friction {friction:.3}, remainder {:.1e}",
            run.energy_error,
            balance.midstep_remainder / balance.input
        );
        assert!(run.energy_error < 1e-9, "{name}: {:e}", run.energy_error);
        assert!(hysteresis > 0.02, "{name}: {hysteresis}");
        assert!(name == "curved" || balance.midstep_remainder >= 0.0, "{name}");
    }
}

/// Displacements of a mass on a column in an earthquake.
fn shaken_displacements(hinge: Option<MakeHinge<'_>>) -> Vec<f64> {
    let (model, top) = cantilever(30.0e9, 40.0e3, hinge).unwrap();
    let roof = Probe::displacement("top", model.row(top, Direction::X).unwrap());
    let mut simulation = Simulation::builder(0.005)
        .ground(SpringGround::under(&model, 4, 4.0e8, 4.0e8).unwrap())
        .structure(model)
        .interface(Coulomb::new(0.5).unwrap())
        .motion(el_centro_1940())
        .probe(roof)
        .build()
        .unwrap();
    let mut displacements = Vec::new();
    simulation.run(1000, |state| displacements.push(state.probes[0])).unwrap();
    displacements
}

/// A hinge that is stiff and does not yield is no hinge.
#[test]
fn a_stiff_hinge_changes_nothing() {
    let law = BilinearMoment::new(1.0e12, 1.0e14, 0.0).unwrap();
    let hinge =
        |nodes| -> Result<Box<dyn Element>> { Ok(Box::new(Hinge::new(nodes, 1.0e14, law)?)) };
    let expected = shaken_displacements(None);
    let computed = shaken_displacements(Some(&hinge));
    let peak = expected.iter().fold(0.0_f64, |max, u| max.max(u.abs()));
    let errors = computed.iter().zip(&expected).map(|(a, b)| (a - b).abs() / peak);
    let error = errors.fold(0.0, f64::max);
    println!("differ by {error:.1e}");
    assert!(error < 1e-4, "{error}");
}
