//! GOAL: frames of fibres that may lift off their ground: linear limit, both formulations, energy.
//! SCENE: a portal on two footings on springs, bonded or with friction, shaken.
//! REFERENCE: the same portal of linear beams; the other formulation; balance of energy.

use basemat::bem::SpringGround;
use basemat::coupled::Probe;
use basemat::fem::{
    Beam, BeamFormulation, BeamQuadrature, BilinearSteel, Concrete, Direction, FiberBeam,
    FiberSection, LumpedMass, Material, MenegottoPinto, Mesh,
};
use basemat::interface::{Bonded, Coulomb, InterfaceLaw};
use basemat::motion::el_centro_1940;
use basemat::structure::{FemModel, RayleighDamping};
use basemat::{Result, Simulation};

const COLUMN_HEIGHT: f64 = 4.0;
const BAY_WIDTH: f64 = 6.0;
/// Mass at each end of the beam, kg per metre of thickness.
const ROOF_MASS: f64 = 30.0e3;

const ALL_FORMULATIONS: [BeamFormulation; 2] =
    [BeamFormulation::DisplacementBased, BeamFormulation::ForceBased];

/// Elements and material of the columns.
#[derive(Clone, Copy)]
enum PortalColumns<'a> {
    Linear { young_modulus: f64, area: f64, second_moment: f64 },
    Fibers { section: &'a FiberSection, formulation: BeamFormulation },
}

/// A portal on footings 2 m wide whose columns have elements of these lengths; returns the right end of its beam, too.
fn portal(columns: PortalColumns<'_>, lengths: &[f64]) -> Result<(FemModel, usize)> {
    let mut mesh = Mesh::new();
    let stiff_beam = |ends| Beam::new(ends, 30.0e9, 0.5, 0.01, 0.0);
    let mut lines = Vec::new();
    let mut tops = Vec::new();
    for x in [0.0, BAY_WIDTH] {
        let left = mesh.add_node(x - 1.0, 0.0)?;
        let foot = mesh.add_node(x, 0.0)?;
        let right = mesh.add_node(x + 1.0, 0.0)?;
        mesh.add(stiff_beam([left, foot])?)?;
        mesh.add(stiff_beam([foot, right])?)?;
        lines.push(vec![left, foot, right]);
        let mut below = foot;
        let mut height = 0.0;
        for length in lengths {
            height += length;
            let above = mesh.add_node(x, height)?;
            match columns {
                PortalColumns::Linear { young_modulus, area, second_moment } => {
                    let density = 500.0 / area;
                    mesh.add(Beam::new(
                        [below, above],
                        young_modulus,
                        area,
                        second_moment,
                        density,
                    )?)?;
                }
                PortalColumns::Fibers { section, formulation } => {
                    let beam =
                        FiberBeam::new([below, above], section, BeamQuadrature::Lobatto(5), 500.0)?;
                    mesh.add(beam.with_formulation(formulation))?;
                }
            }
            below = above;
        }
        mesh.add(LumpedMass::new(below, ROOF_MASS)?)?;
        tops.push(below);
    }
    mesh.add(stiff_beam([tops[0], tops[1]])?)?;
    let model = FemModel::on_foundations(mesh, &lines)?;
    Ok((model.with_rayleigh(RayleighDamping::new(0.0, 1e-3)?), tops[1]))
}

/// Section of steel with this hardening, 0.3 m deep in 30 layers.
fn steel_section(hardening_ratio: f64) -> Result<FiberSection> {
    let steel = BilinearSteel::new(355.0e6, 210.0e9, hardening_ratio)?;
    FiberSection::new().with_rectangle([[-0.15, -0.05], [0.15, 0.05]], [30, 1], steel)
}

/// Displacements of the roof in an earthquake on springs, with the energy of the run.
fn shaken(
    columns: PortalColumns<'_>,
    lengths: &[f64],
    law: impl InterfaceLaw + 'static,
    factor: f64,
) -> Result<Shaken> {
    let (model, top) = portal(columns, lengths)?;
    let roof = Probe::displacement("roof", model.row(top, Direction::X)?);
    let mut simulation = Simulation::builder(0.005)
        .ground(SpringGround::under(&model, 4, 4.0e8, 4.0e8)?)
        .structure(model)
        .interface(law)
        .motion(el_centro_1940().scaled(factor)?)
        .probe(roof)
        .build()?;
    let mut displacements = Vec::new();
    let run = simulation.run(1200, |state| displacements.push(state.probes[0]))?;
    let balance = run.energy_balance;
    Ok(Shaken {
        displacements,
        energy_error: run.energy_error,
        hysteresis: balance.hysteresis / balance.input,
    })
}

struct Shaken {
    displacements: Vec<f64>,
    energy_error: f64,
    /// Plastic work over the energy input.
    hysteresis: f64,
}

/// Largest difference of two series, relative to the peak.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    let peak = a.iter().fold(0.0_f64, |max, value| max.max(value.abs()));
    a.iter().zip(b).map(|(x, y)| (x - y).abs() / peak).fold(0.0, f64::max)
}

/// Elastic fibres move as linear beams of their area and second moment.
#[test]
fn a_frame_of_elastic_fibres_is_the_linear_frame() {
    let elastic = Material::new(210.0e9, 0.0, 0.0).unwrap();
    let section = FiberSection::new()
        .with_rectangle([[-0.15, -0.05], [0.15, 0.05]], [10, 1], elastic)
        .unwrap();
    let second_moment: f64 = (0..10).map(|i| 0.003 * (-0.135 + 0.03 * f64::from(i)).powi(2)).sum();
    let linear_columns =
        PortalColumns::Linear { young_modulus: 210.0e9, area: 0.03, second_moment };
    let expected = shaken(linear_columns, &[2.0, 2.0], Bonded, 1.0).unwrap();
    for formulation in ALL_FORMULATIONS {
        let fibers = PortalColumns::Fibers { section: &section, formulation };
        let computed = shaken(fibers, &[2.0, 2.0], Bonded, 1.0).unwrap();
        let error = difference(&expected.displacements, &computed.displacements);
        println!("{formulation:?}: {error:.1e}; energy open by {:.1e}", computed.energy_error);
        assert!(error < 1e-9, "{formulation:?}: {error:e}");
        assert!(computed.energy_error < 1e-9, "{formulation:?}: {:e}", computed.energy_error);
    }
}

/// A column of one element by forces yields as one of nine elements by displacements.
#[test]
fn both_formulations_yield_alike() {
    let section = steel_section(0.01).unwrap();
    let graded_lengths = [0.1, 0.2, 0.4, 0.6, 1.4, 0.6, 0.4, 0.2, 0.1];
    let [by_displacements, by_forces] = ALL_FORMULATIONS
        .map(|formulation| PortalColumns::Fibers { section: &section, formulation });
    let expected = shaken(by_displacements, &graded_lengths, Bonded, 2.0).unwrap();
    let computed = shaken(by_forces, &[COLUMN_HEIGHT], Bonded, 2.0).unwrap();
    for run in [&expected, &computed] {
        println!("energy open by {:.1e}, hysteresis {:.2}", run.energy_error, run.hysteresis);
        assert!(run.energy_error < 1e-9, "{:e}", run.energy_error);
        assert!(run.hysteresis > 0.5, "{}", run.hysteresis);
    }
    let error = difference(&expected.displacements, &computed.displacements);
    println!("formulations differ by {error:.1e}");
    assert!(error < 0.1, "{error}");
}

/// Columns of steel that yield on footings that lift off and slide.
#[test]
fn frames_that_yield_and_lift_off_close_the_energy() {
    let section = steel_section(0.01).unwrap();
    for formulation in ALL_FORMULATIONS {
        let columns = PortalColumns::Fibers { section: &section, formulation };
        let run = shaken(columns, &[0.2, 1.8, 1.8, 0.2], Coulomb::new(0.7).unwrap(), 3.0).unwrap();
        println!("{formulation:?}: {:.1e}, {:.2}", run.energy_error, run.hysteresis);
        assert!(run.energy_error < 1e-9, "{formulation:?}: {:e}", run.energy_error);
        assert!(run.hysteresis > 0.02, "{formulation:?}: {}", run.hysteresis);
    }
}

/// Concrete columns with bars crack and yield.
#[test]
fn frames_of_reinforced_concrete_close_the_energy() {
    let concrete = Concrete::new(30.0e6, 0.002, 12.0e6, 0.01).unwrap();
    let bars = MenegottoPinto::new(500.0e6, 200.0e9, 0.01).unwrap();
    let section = FiberSection::new()
        .with_rectangle([[-0.2, -0.15], [0.2, 0.15]], [20, 1], concrete)
        .and_then(|section| section.with_bars([[-0.16, -0.1], [-0.16, 0.1]], 3, 4e-4, bars))
        .and_then(|section| section.with_bars([[0.16, -0.1], [0.16, 0.1]], 3, 4e-4, bars))
        .unwrap();
    for formulation in ALL_FORMULATIONS {
        let columns = PortalColumns::Fibers { section: &section, formulation };
        let law = Coulomb::new(0.7).unwrap();
        let run = shaken(columns, &[0.5, 1.5, 1.5, 0.5], law, 1.0).unwrap();
        println!("{formulation:?}: {:.1e}, {:.2}", run.energy_error, run.hysteresis);
        assert!(run.energy_error < 1e-9, "{formulation:?}: {:e}", run.energy_error);
        assert!(run.hysteresis > 0.02, "{formulation:?}: {}", run.hysteresis);
    }
}
