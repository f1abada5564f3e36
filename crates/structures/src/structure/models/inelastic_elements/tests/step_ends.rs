//! Ends of steps from the stresses of the last forces, against evaluations without stored stresses.

use super::displacements;
use crate::fem::{
    Beam, BeamFormulation, BeamQuadrature, Concrete, FiberBeam, FiberSection, LumpedMass,
    MenegottoPinto, Mesh,
};
use crate::structure::{FemModel, Structure};

/// A column of concrete with bars, and one of steel beside it, on a base.
fn columns(formulation: BeamFormulation) -> FemModel {
    let steel = MenegottoPinto::new(500.0e6, 200.0e9, 0.01).unwrap();
    let concrete = Concrete::new(30.0e6, 0.002, 25.0e6, 0.01).unwrap();
    let plain = FiberSection::new()
        .with_rectangle([[-0.2, -0.2], [0.2, 0.2]], [20, 1], steel)
        .unwrap();
    let reinforced = FiberSection::new()
        .with_rectangle([[-0.2, -0.2], [0.2, 0.2]], [12, 1], concrete)
        .unwrap()
        .with_bars([[-0.15, 0.0], [0.15, 0.0]], 3, 2.0e-3, steel)
        .unwrap();
    let mut mesh = Mesh::new();
    let line = [0.0, 2.0].map(|x| mesh.add_node(x, 0.0).unwrap());
    mesh.add(Beam::new(line, 30.0e9, 0.1, 1.0e-3, 2400.0).unwrap()).unwrap();
    for (foot, section) in line.into_iter().zip([plain, reinforced]) {
        let top = mesh.add_node(mesh.nodes()[foot][0], 2.0).unwrap();
        let column = FiberBeam::new([foot, top], &section, BeamQuadrature::Lobatto(4), 300.0);
        mesh.add(column.unwrap().with_formulation(formulation)).unwrap();
        mesh.add(LumpedMass::new(top, 5.0e3).unwrap()).unwrap();
    }
    FemModel::new(mesh, &line).unwrap()
}

/// Values and committed variables of a step: all by themselves, or each with what those before it have left.
#[test]
fn stresses_of_the_last_forces_change_no_bit_of_a_step() {
    for formulation in [BeamFormulation::DisplacementBased, BeamFormulation::ForceBased] {
        let mut model = columns(formulation);
        let n = model.dofs();
        let mut start = vec![0.0; n];
        for seed in 1..60 {
            let scale = if seed % 3 == 0 { 2e-4 } else { 4e-3 };
            let end = displacements(seed, n, scale);
            let midstep: Vec<f64> =
                start.iter().zip(&end).map(|(start, end)| 0.5 * (start + end)).collect();
            // Copies begin without stresses.
            let energy = model.clone().nonlinear().unwrap().energy(&end).unwrap();
            let remainder = model.clone().nonlinear().unwrap().remainder(&midstep, &end).unwrap();
            let mut committed = model.clone();
            committed.nonlinear_mut().unwrap().commit(&end);
            let nonlinear = model.nonlinear_mut().unwrap();
            // Forces somewhere else first, as in the iterations of a step.
            for displacement in [&end, &midstep] {
                nonlinear.force(displacement, &mut vec![0.0; n]).unwrap();
            }
            for repetition in 0..2 {
                let text = format!("{formulation:?}, step {seed}, repetition {repetition}");
                assert_eq!(nonlinear.remainder(&midstep, &end).unwrap(), remainder, "{text}");
                assert_eq!(nonlinear.energy(&end).unwrap(), energy, "{text}");
            }
            nonlinear.commit(&end);
            let saved = committed.nonlinear().unwrap().save().unwrap();
            assert_eq!(nonlinear.save().unwrap(), saved, "{formulation:?}, step {seed}");
            start = end;
        }
        assert!(model.nonlinear().unwrap().energy(&start).unwrap().dissipated > 1.0e3);
    }
}
