//! GOAL: beams of fibres on a structure by matrices act as in a finite-element model.
//! SCENE: a column of fibres on a mat that may lift off, with a rigid arm to its mass; shaken.
//! REFERENCE: the same column as a `FemModel`.

use basemat::bem::SpringGround;
use basemat::coupled::Probe;
use basemat::fem::{
    Beam, BeamFormulation, BeamQuadrature, BilinearSteel, Concrete, Direction, FiberBeam,
    FiberSection, LumpedMass, Mesh,
};
use basemat::interface::Coulomb;
use basemat::motion::el_centro_1940;
use basemat::structure::{
    Bilinear, FemModel, MatrixModel, Structure, Triplets, WithElements, WithSprings,
};
use basemat::{Error, Result, Simulation};

/// Mass of the column per length and per metre of depth, kg/m².
const COLUMN_MASS: f64 = 800.0;

fn section() -> Result<FiberSection> {
    let steel = BilinearSteel::new(420.0e6, 200.0e9, 0.01)?;
    let concrete = Concrete::new(30.0e6, 0.002, 6.0e6, 0.006)?;
    FiberSection::new()
        .with_rectangle([[-0.3, -0.5], [0.3, 0.5]], [12, 1], concrete)?
        .with_bars([[-0.25, -0.4], [-0.25, 0.4]], 3, 800.0e-6, steel)?
        .with_bars([[0.25, -0.4], [0.25, 0.4]], 3, 800.0e-6, steel)
}

/// Node of the mass on a rigid arm.
const ARM_NODE: usize = 5;

/// The mat and the masses, with or without the column of fibres.
fn model(formulation: BeamFormulation, has_column: bool) -> Result<FemModel> {
    let mut mesh = Mesh::new();
    for x in [-2.0, 0.0, 2.0] {
        mesh.add_node(x, 0.0)?;
    }
    let foot = 1;
    for ends in [[0, foot], [foot, 2]] {
        mesh.add(Beam::new(ends, 30.0e9, 1.0, 0.1, 2500.0)?)?;
    }
    let middle = mesh.add_node(0.0, 3.0)?;
    let top = mesh.add_node(0.0, 6.0)?;
    let arm = mesh.add_node(1.0, 6.0)?;
    for node in [middle, top] {
        mesh.add(LumpedMass::new(node, 1.0e3)?.with_rotary_inertia(10.0)?)?;
    }
    mesh.add(LumpedMass::new(arm, 50.0e3)?)?;
    if has_column {
        for ends in [[foot, middle], [middle, top]] {
            let beam = FiberBeam::new(ends, &section()?, BeamQuadrature::Lobatto(4), COLUMN_MASS)?;
            mesh.add(beam.with_formulation(formulation))?;
        }
    }
    assert_eq!(arm, ARM_NODE);
    FemModel::on_base(mesh)?.with_rigid_link(top, &[arm])
}

/// Matrices of the linear elements, with the column of fibres on them.
fn on_matrices(formulation: BeamFormulation) -> Result<WithElements> {
    let model_with_column = model(formulation, true)?;
    let linear_model = model(formulation, false)?;
    assert_eq!(model_with_column.dofs(), linear_model.dofs());
    let mut mass = Triplets::new(linear_model.dofs());
    linear_model.mass(&mut mass)?;
    let mut stiffness = Triplets::new(linear_model.dofs());
    linear_model.stiffness(&mut stiffness)?;
    let matrices = MatrixModel::new(mass, stiffness, model_with_column.base())?;
    let mut mesh = Mesh::new();
    let mut nodes = Vec::new();
    for [x, y, _] in model_with_column.mesh().nodes() {
        nodes.push(mesh.add_node(*x, *y)?);
    }
    for ends in [[1, 3], [3, 4]] {
        let ends = ends.map(|node: usize| nodes[node]);
        let beam = FiberBeam::new(ends, &section()?, BeamQuadrature::Lobatto(4), COLUMN_MASS)?;
        mesh.add(beam.with_formulation(formulation))?;
    }
    WithElements::new(matrices, mesh, |node, direction| model_with_column.row(node, direction))
}

fn shaken(structure: impl Structure + 'static) -> Result<Simulation> {
    let reference = model(BeamFormulation::default(), true)?;
    Simulation::builder(0.005)
        .ground(SpringGround::under(&reference, 8, 60.0e6, 60.0e6)?)
        .structure(structure)
        .interface(Coulomb::new(0.6)?)
        .motion(el_centro_1940().scaled(1.5)?)
        .probe(Probe::displacement("top", reference.row(ARM_NODE, Direction::X)?))
        .build()
}

#[test]
fn fibres_on_matrices_move_as_in_a_finite_element_model() -> Result<()> {
    for formulation in [BeamFormulation::DisplacementBased, BeamFormulation::ForceBased] {
        let mut simulation_of_the_model = shaken(model(formulation, true)?)?;
        let mut parts = shaken(on_matrices(formulation)?)?;
        let mut max_top = 0.0_f64;
        let mut max_difference = 0.0_f64;
        for _ in 0..600 {
            let expected = simulation_of_the_model.step()?.probes[0];
            let computed = parts.step()?.probes[0];
            max_top = max_top.max(expected.abs());
            max_difference = max_difference.max((computed - expected).abs());
        }
        assert!(max_difference < 1e-9 * max_top, "{formulation:?}: {max_difference} of {max_top}");
        assert!(parts.run(1, |_| {})?.energy_error < 1e-9);
        let whole_structure: &dyn std::any::Any = simulation_of_the_model.structure();
        let fem_model: &FemModel = whole_structure.downcast_ref().unwrap();
        let parts_structure: &dyn std::any::Any = parts.structure();
        let with_elements: &WithElements = parts_structure.downcast_ref().unwrap();
        let moment = with_elements.beam_sections(0)?[0].moment;
        assert!(moment.abs() > 1e3 && with_elements.solid_points(0)?.is_empty());
        let first_column = fem_model.inelastic_elements().next().unwrap();
        assert_eq!(fem_model.beam_sections(first_column)?.len(), 4);
    }
    Ok(())
}

#[test]
fn elements_that_do_not_belong_on_a_structure_are_errors() -> Result<()> {
    let linear_model = model(BeamFormulation::default(), false)?;
    let row = |node, direction| linear_model.row(node, direction);
    let error_without_elements = WithElements::new(linear_model.clone(), Mesh::new(), row);
    assert!(
        matches!(error_without_elements, Err(Error::Size { .. })),
        "{error_without_elements:?}"
    );
    let mut mesh = Mesh::new();
    let ends = [mesh.add_node(0.0, 0.0)?, mesh.add_node(0.0, 3.0)?];
    let fibres = FiberBeam::new(ends, &section()?, BeamQuadrature::Lobatto(3), 0.0)?;
    let mut with_beam = mesh.clone();
    with_beam.add(Beam::new(ends, 30.0e9, 1.0, 0.1, 0.0)?)?;
    let result = WithElements::new(linear_model.clone(), with_beam, row).unwrap_err().to_string();
    assert!(result.contains("element 0") && result.contains("linear"), "{result}");
    mesh.add(fibres)?;
    let error_of_a_missing_dof =
        WithElements::new(linear_model.clone(), mesh.clone(), |_, _| Ok(999.into()));
    assert!(
        matches!(error_of_a_missing_dof, Err(Error::Index { .. })),
        "{error_of_a_missing_dof:?}"
    );
    let error_of_an_infinite_factor =
        WithElements::new(linear_model.clone(), mesh.clone(), |_, _| Ok((0, f64::NAN).into()));
    assert!(error_of_an_infinite_factor.unwrap_err().to_string().contains("weight"));
    let model_with_spring =
        WithSprings::new(linear_model.clone()).spring(0, Bilinear::new(1e6, 1e4, 0.1)?)?;
    let result = WithElements::new(model_with_spring, mesh, row).unwrap_err().to_string();
    assert!(result.contains("springs may be around"), "{result}");
    Ok(())
}
