//! GOAL: an error names an impossible part of a user; unusual parts are accepted.
//! SCENE: a base of many nodes; a stored energy that is not finite; grounds that are not passive.
//! REFERENCE: the same body on two nodes; the wrong number; the limit of passivity.

use basemat::bem::{ContactElement, Ground};
use basemat::coupled::Load;
use basemat::interface::Bonded;
use basemat::structure::{Base, BaseNode, InternalEnergy, NonlinearForce, Structure, Triplets};
use basemat::{Error, Observer, Result, Simulation};

use super::blame::block;
use super::{NOT_FINITE, error_with};
use basemat_problems::block_on_springs::bed;
use basemat_problems::own_force;

/// A rigid body on this number of nodes.
struct BodyOnManyNodes(usize);

impl Structure for BodyOnManyNodes {
    fn dofs(&self) -> usize {
        3
    }

    fn base(&self) -> Base {
        let mut nodes = Vec::new();
        for k in 0..self.0 {
            let x = 4.0 * k as f64 / (self.0 - 1) as f64 - 2.0;
            nodes.push(BaseNode::rigid(x, 0.0, [0, 1, 2]));
        }
        nodes.into()
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        (0..3).for_each(|i| matrix.add(i, i, 1e4));
        Ok(())
    }

    fn stiffness(&self, _: &mut Triplets) -> Result<()> {
        Ok(())
    }
}

/// Pressure below a pushed body on one element.
fn pressure_on_nodes(nodes: usize) -> f64 {
    let builder = Simulation::builder(1e-3).structure(BodyOnManyNodes(nodes)).ground(bed(1));
    let load = Load::constant((0, 1.0), 1e3);
    let mut simulation = builder.interface(Bonded).load(load).build().unwrap();
    simulation.run(10, |_| {}).unwrap();
    simulation.state().contact[0].pressure
}

/// Sums over many nodes have more rounding errors, and are accepted nevertheless.
#[test]
fn a_base_of_many_nodes_is_accepted() {
    let reference = pressure_on_nodes(2);
    for nodes in [20_001, 60_001] {
        assert!((pressure_on_nodes(nodes) / reference - 1.0).abs() < 1e-9);
    }
}

/// A mass on a spring whose nonlinear force stores this energy, J/m.
struct OscillatorWithEnergy(f64);

impl Structure for OscillatorWithEnergy {
    fn dofs(&self) -> usize {
        4
    }

    fn base(&self) -> Base {
        BaseNode::rigid_base(-2.0, 2.0, [0, 1, 2]).into()
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        (0..4).for_each(|i| matrix.add(i, i, 1e4));
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        matrix.add_outer([(0, -1.0), (3, 1.0)], 1e6);
        Ok(())
    }

    own_force!();
}

impl NonlinearForce for OscillatorWithEnergy {
    fn force(&self, _: &[f64], _: &mut [f64]) -> Result<()> {
        Ok(())
    }

    fn tangent(&self, _: &[f64], _: &mut Triplets) -> Result<()> {
        Ok(())
    }

    fn energy(&self, _: &[f64]) -> Option<InternalEnergy> {
        Some(InternalEnergy { stored: self.0, dissipated: 0.0 })
    }
}

fn build_with_energy(energy: f64) -> Result<Simulation> {
    let builder = Simulation::builder(1e-3).structure(OscillatorWithEnergy(energy));
    builder.ground(bed(4)).interface(Bonded).build()
}

/// An energy that is not finite is an error, not an energy that is left out.
#[test]
fn an_energy_that_is_not_finite_at_the_start_is_named() {
    build_with_energy(0.0).unwrap();
    for energy in NOT_FINITE {
        let error =
            error_with("stored energy of the nonlinear force at t = 0", build_with_energy(energy));
        assert!(matches!(error, Error::Input { value, .. } if value.to_bits() == energy.to_bits()));
    }
}

/// A ground without history whose step compliance is any matrix.
struct GroundWithMatrix {
    elements: Vec<ContactElement>,
    step_compliance: Vec<f64>,
}

impl Ground for GroundWithMatrix {
    fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    fn prepare(&mut self, _: f64, _: Option<usize>, _: &mut Observer<'_>) -> Result<()> {
        Ok(())
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        matrix.copy_from_slice(&self.step_compliance);
        Ok(())
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        displacement.fill(0.0);
        Ok(())
    }

    fn commit(&mut self, _: &[f64]) {}

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        (0..16).for_each(|k| matrix[k] = if k % 5 == 0 { 1e-8 } else { 0.0 });
        Ok(())
    }
}

/// Builds a block on two elements with this diagonal compliance and this coupling of their pressures.
///
/// `symmetry`: 1 for a reciprocal ground, −1 for a coupling that does no work.
fn build_with_compliance(diagonal: f64, coupling: f64, symmetry: f64) -> Result<Simulation> {
    let elements = vec![ContactElement::new(-2.0, 1.0), ContactElement::new(1.0, 2.0)];
    let mut matrix = vec![0.0; 16];
    (0..4).for_each(|i| matrix[5 * i] = diagonal / elements[i % 2].length());
    // Lengths times the entries are symmetric in a reciprocal ground.
    matrix[1] = coupling / elements[0].length();
    matrix[4] = symmetry * coupling / elements[1].length();
    let ground = GroundWithMatrix { elements, step_compliance: matrix };
    Simulation::builder(1e-3).structure(block()).interface(Bonded).ground(ground).build()
}

#[test]
fn a_ground_that_is_not_passive_is_named() {
    // A ground at the limit; and one with a strong coupling that does no work.
    for (diagonal, coupling, symmetry) in [(1e-8, 1e-8, 1.0), (1e-8, 3e-8, -1.0)] {
        build_with_compliance(diagonal, coupling, symmetry).unwrap();
    }
    for (diagonal, coupling) in [(-1e-8, 0.0), (1e-8, 1.01e-8), (0.0, 1e-8)] {
        let result = build_with_compliance(diagonal, coupling, 1.0);
        let error = error_with("step compliance of the ground", result);
        assert!(matches!(error, Error::Indefinite { row: 0..=1, .. }), "{error:?}");
    }
}
