//! GOAL: static push-over by displacement behind the largest load, where the structure falls.
//! SCENE: a cantilever with a plastic hinge, or of fibres, under its weight with P–Δ; a short column of concrete that crushes.
//! REFERENCE: equilibrium of the rigid–plastic cantilever in closed form; the concrete's law times its area.

use basemat::analyses::{PushOver, push_over_by_displacement};
use basemat::bem::SpringGround;
use basemat::coupled::SimulationBuilder;
use basemat::fem::{
    Beam, BeamFormulation, BeamQuadrature, BilinearMoment, BilinearSteel, Concrete, Direction,
    FiberBeam, FiberSection, Hinge, LumpedMass, Material, Mesh, UniaxialMaterial,
};
use basemat::interface::Bonded;
use basemat::structure::{DofCombination, FemModel};
use basemat::{Result, Simulation};
use basemat_problems::scenes::SCENE_GRAVITY;

const COLUMN_HEIGHT: f64 = 4.0;
/// Plastic moment of the hinge, and of the section of fibres without an axial force, N m.
const PLASTIC_MOMENT: f64 = 200.0e3;
const ALL_FORMULATIONS: [BeamFormulation; 2] =
    [BeamFormulation::DisplacementBased, BeamFormulation::ForceBased];

/// A footing 2 m wide; returns its nodes, the middle between its ends.
fn add_footing(mesh: &mut Mesh) -> Result<[usize; 3]> {
    let nodes = [mesh.add_node(-1.0, 0.0)?, mesh.add_node(0.0, 0.0)?, mesh.add_node(1.0, 0.0)?];
    for ends in nodes.windows(2) {
        mesh.add(Beam::new([ends[0], ends[1]], 1.0e13, 1.0, 0.1, 2500.0)?)?;
    }
    Ok(nodes)
}

/// The model bonded to stiff springs.
fn bonded(model: FemModel, gravity: f64) -> Result<SimulationBuilder> {
    let ground = SpringGround::under(&model, 4, 1.0e11, 1.0e11)?;
    let builder = Simulation::builder(0.01).ground(ground).structure(model);
    Ok(builder.interface(Bonded).gravity(gravity))
}

fn pushed(builder: SimulationBuilder, row: &DofCombination, displacements: &[f64]) -> PushOver {
    let curve = push_over_by_displacement(builder, row, row, displacements).unwrap();
    assert!(curve.cause.is_none(), "{:?} after {} points", curve.cause, curve.points.len());
    curve
}

/// (M_p − P Δ)/L behind the peak, down to forces that must hold the column back; unloading and the other direction.
#[test]
fn a_hinged_cantilever_falls_by_p_delta() {
    let weight = 400.0e3;
    let mut mesh = Mesh::new();
    let footing = add_footing(&mut mesh).unwrap();
    let foot = mesh.add_node(0.0, 0.0).unwrap();
    let law = BilinearMoment::new(PLASTIC_MOMENT, 1e4 * PLASTIC_MOMENT, 0.0).unwrap();
    mesh.add(Hinge::new([footing[1], foot], 1.0e12, law).unwrap()).unwrap();
    let top = mesh.add_node(0.0, COLUMN_HEIGHT).unwrap();
    mesh.add(Beam::new([foot, top], 1.0e13, 0.5, 0.01, 0.0).unwrap()).unwrap();
    mesh.add(LumpedMass::new(top, weight / SCENE_GRAVITY).unwrap()).unwrap();
    let model = FemModel::on_foundations(mesh, &[footing.to_vec()]).unwrap();
    let model = model.with_p_delta(SCENE_GRAVITY).unwrap();
    let row = model.row(top, Direction::X).unwrap();
    let displacements = [0.002, 0.02, 0.1, 0.3, 0.5, 0.8, 0.1, -0.3];
    let curve = pushed(bonded(model, SCENE_GRAVITY).unwrap(), &row, &displacements);
    let scale = PLASTIC_MOMENT / COLUMN_HEIGHT;
    for (point, sign) in curve.points[1..].iter().zip([1.0, 1.0, 1.0, 1.0, 1.0, 1.0, -1.0, -1.0]) {
        let expected = (sign * PLASTIC_MOMENT - weight * point.displacement) / COLUMN_HEIGHT;
        let error = (point.force - expected) / scale;
        println!("Δ {:.3} m: H {:.4e}, off by {error:.1e}", point.displacement, point.force);
        assert!(error.abs() < 1e-3, "{point:?} {expected}");
    }
    // The load has fallen to nothing at M_p/P, and is negative beyond.
    assert!(curve.points[6].force < -0.5 * scale);
}

/// A cantilever of beams by forces with P–Δ, divided at its foot, falls like its plastic hinge.
///
/// Beams by displacements have one axial strain along an element in which the curvature changes: beside an axial force, a hinge
/// of them carries more than its plastic moment.
#[test]
fn a_cantilever_of_fibres_falls_by_p_delta() {
    let width = 0.1;
    let depth = 0.2;
    let yield_stress = 4.0 * PLASTIC_MOMENT / (width * depth * depth);
    let steel = BilinearSteel::new(yield_stress, 210.0e9, 1e-9).unwrap();
    let corners = [[-0.5 * depth, -0.5 * width], [0.5 * depth, 0.5 * width]];
    let section = FiberSection::new().with_rectangle(corners, [40, 1], steel).unwrap();
    let weight = 200.0e3;
    let mut mesh = Mesh::new();
    let footing = add_footing(&mut mesh).unwrap();
    let mut below = footing[1];
    for y in [0.004, 0.012, 0.03, 0.1, 0.3, 1.0, COLUMN_HEIGHT] {
        let above = mesh.add_node(0.0, y).unwrap();
        let column = FiberBeam::new([below, above], &section, BeamQuadrature::Lobatto(5), 0.0);
        let column = column.unwrap().with_formulation(BeamFormulation::ForceBased);
        mesh.add(column).unwrap();
        below = above;
    }
    mesh.add(LumpedMass::new(below, weight / SCENE_GRAVITY).unwrap()).unwrap();
    let model = FemModel::on_foundations(mesh, &[footing.to_vec()]).unwrap();
    let model = model.with_p_delta(SCENE_GRAVITY).unwrap();
    let row = model.row(below, Direction::X).unwrap();
    let displacements = [0.02, 0.05, 0.1, 0.2, 0.4, 0.6];
    let curve = pushed(bonded(model, SCENE_GRAVITY).unwrap(), &row, &displacements);
    let axial_ratio = weight / (yield_stress * width * depth);
    let moment = PLASTIC_MOMENT * (1.0 - axial_ratio * axial_ratio);
    for point in &curve.points[4..] {
        let expected = (moment - weight * point.displacement) / COLUMN_HEIGHT;
        let error = (point.force - expected) * COLUMN_HEIGHT / moment;
        println!("Δ {:.3} m: H {:.4e}, off by {error:.1e}", point.displacement, point.force);
        assert!(error.abs() < 1e-3, "{point:?} {expected}");
    }
}

/// A short column of concrete in an elastic cage has the force A σ(Δ/L) of its law, behind the strength and back.
#[test]
fn a_column_of_concrete_crushes_by_its_law() {
    let concrete = Concrete::new(30.0e6, 0.002, 6.0e6, 0.006).unwrap();
    let cage = Material::new(1.0e9, 0.2, 1.0).unwrap();
    let area = 0.09;
    let cage_area = 0.002;
    let length = 0.5;
    // The cage stands far out: the column does not bend.
    let section = FiberSection::new()
        .with_rectangle([[-0.15, -0.15], [0.15, 0.15]], [6, 1], concrete)
        .and_then(|section| section.with_bars([[-3.0, 0.0], [3.0, 0.0]], 2, cage_area, cage))
        .unwrap();
    for formulation in ALL_FORMULATIONS {
        let mut mesh = Mesh::new();
        let footing = add_footing(&mut mesh).unwrap();
        let top = mesh.add_node(0.0, length).unwrap();
        let column =
            FiberBeam::new([footing[1], top], &section, BeamQuadrature::Lobatto(3), 0.0).unwrap();
        mesh.add(column.with_formulation(formulation)).unwrap();
        mesh.add(LumpedMass::new(top, 1.0).unwrap()).unwrap();
        let model = FemModel::on_foundations(mesh, &[footing.to_vec()]).unwrap();
        let down = -model.row(top, Direction::Y).unwrap();
        let base = -model.row(footing[1], Direction::Y).unwrap();
        let shortening = down.clone() - base;
        let strains = [0.001, 0.002, 0.003, 0.004, 0.0055, 0.008, 0.006, 0.004, 0.009];
        let displacements = strains.map(|strain| strain * length);
        let builder = bonded(model, 0.0).unwrap();
        let curve = push_over_by_displacement(builder, &down, &shortening, &displacements).unwrap();
        assert!(curve.cause.is_none(), "{formulation:?}: {:?}", curve.cause);
        let mut variables = vec![0.0; concrete.variable_count()];
        concrete.initialize(&mut variables);
        for (point, strain) in curve.points[1..].iter().zip(strains) {
            let stress = concrete.response(-strain, &variables).unwrap().stress;
            concrete.commit(-strain, &mut variables);
            let expected = -area * stress + 2.0 * cage_area * 1.0e9 * strain;
            let error = (point.force - expected) / (area * 30.0e6);
            println!("{formulation:?}, strain {strain}: off by {error:.1e}");
            assert!(error.abs() < 1e-6, "{formulation:?}, {strain}: {point:?} {expected}");
        }
        // It falls by more than half.
        assert!(curve.points[6].force < 0.45 * curve.points[2].force);
    }
}
