//! GOAL: a flexible mat on too few contact elements is an error or causes a warning, on enough elements neither.
//! SCENE: a mat 20 m wide and 0.25 m thick of 40 beams, two columns, on the half-plane.
//! REFERENCE: the same on 64 elements; twice the elements; numbers of elements.

use basemat::bem::{ElasticGround, Ground, Strip};
use basemat::coupled::CoarseBaseError;
use basemat::coupled::Warning;
use basemat::fem::{Beam, Direction, LumpedMass, Mesh};
use basemat::prelude::*;
use basemat::structure::DofCombination;
use basemat::{Error, Result};

const MAT_WIDTH: f64 = 20.0;
const BEAM_COUNT: usize = 40;
const YOUNG_MODULUS: f64 = 30.0e9;

/// A mat with two columns.
struct Mat {
    model: FemModel,
    /// Settlement of a column relative to the middle.
    settlement: DofCombination,
}

fn mat(thickness: f64, beams: usize) -> Result<Mat> {
    let mut mesh = Mesh::new();
    let mut nodes = Vec::new();
    for k in 0..=beams {
        nodes.push(mesh.add_node(MAT_WIDTH * (k as f64 / beams as f64 - 0.5), 0.0)?);
    }
    for ends in nodes.windows(2) {
        let inertia = thickness.powi(3) / 12.0;
        mesh.add(Beam::new([ends[0], ends[1]], YOUNG_MODULUS, thickness, inertia, 2400.0)?)?;
    }
    let columns = [nodes[beams / 4], nodes[3 * beams / 4]];
    for (foot, x) in columns.into_iter().zip([-0.25 * MAT_WIDTH, 0.25 * MAT_WIDTH]) {
        let top = mesh.add_node(x, 4.0)?;
        mesh.add(Beam::new([foot, top], YOUNG_MODULUS, 0.3, 0.3_f64.powi(3) / 12.0, 2400.0)?)?;
        mesh.add(LumpedMass::new(top, 30.0e3)?)?;
    }
    let model = FemModel::new(mesh, &nodes)?;
    let column = model.row(columns[0], Direction::Y)?;
    let middle = model.row(nodes[beams / 2], Direction::Y)?;
    Ok(Mat { model, settlement: column - middle })
}

fn soil() -> Soil {
    Soil::from_shear_wave_speed(200.0, 0.33, 1900.0).unwrap()
}

/// Statics of a mat on contact elements.
struct StandingMat {
    /// Settlement of a column relative to the middle, m.
    settlement: f64,
    /// Warnings of too few elements.
    warnings: Vec<Warning>,
}

fn stand(thickness: f64, strips: Strip) -> Result<StandingMat> {
    let Mat { model, settlement } = mat(thickness, BEAM_COUNT)?;
    let mut simulation = Simulation::builder(0.005)
        .structure(model)
        .ground(ElasticGround::new(soil(), strips)?)
        .interface(Coulomb::new(0.5)?)
        .build()?;
    let settlement = settlement.value(simulation.static_displacement());
    let mut warnings = simulation.run(1, |_| {})?.warnings;
    warnings.retain(|warning| matches!(warning, Warning::CoarseBase { .. }));
    Ok(StandingMat { settlement, warnings })
}

fn graded_strip(count: usize) -> Strip {
    Strip::graded(-10.0..10.0, count).unwrap()
}

/// Settlement of the columns relative to the middle: 20 times too large on four elements, 2.4 times on eight.
#[test]
fn too_few_elements_under_a_mat_are_an_error_or_a_warning() {
    let StandingMat { settlement: exact, warnings } = stand(0.25, graded_strip(64)).unwrap();
    assert!((exact + 1.669e-3).abs() < 1e-6 && warnings.is_empty(), "{exact} {warnings:?}");
    for count in [4, 8] {
        let error = stand(0.25, graded_strip(count)).err().expect("an error");
        let Error::CoarseBase(CoarseBaseError {
            foundation: 0,
            elements,
            needed,
            difference,
            axis: None,
        }) = error
        else {
            panic!("{error}")
        };
        assert_eq!(elements, count);
        assert!((18..=26).contains(&needed) && difference.unwrap() > 0.3, "{error}");
    }
    let StandingMat { settlement: found, warnings } = stand(0.25, graded_strip(16)).unwrap();
    assert!((found / exact - 1.0).abs() < 0.03, "{found}");
    let [Warning::CoarseBase { foundation: 0, elements: 16, needed, difference, axis: None }] =
        warnings[..]
    else {
        panic!("{warnings:?}")
    };
    assert!((20..=22).contains(&needed) && difference.unwrap() < 0.01, "{warnings:?}");
    let StandingMat { settlement: found, warnings } = stand(0.25, graded_strip(32)).unwrap();
    assert!((found / exact - 1.0).abs() < 0.005 && warnings.is_empty(), "{found} {warnings:?}");
    // A thick mat hardly bends between few elements.
    let warnings = stand(2.0, graded_strip(8)).unwrap().warnings;
    assert!(warnings.is_empty(), "{warnings:?}");
}

/// A mat on elements, each with a law.
fn mat_with_laws(count: usize) -> Result<Simulation> {
    let mut laws: Vec<Box<dyn InterfaceLaw>> = Vec::new();
    for element in 0..count {
        laws.push(Box::new(Coulomb::new(0.4 + 0.01 * element as f64)?));
    }
    Simulation::builder(0.005)
        .structure(mat(0.25, BEAM_COUNT)?.model)
        .ground(ElasticGround::new(soil(), graded_strip(count))?)
        .interfaces(laws)
        .build()
}

/// A law for each element has no effect on the check.
#[test]
fn too_few_elements_with_a_law_for_each_are_an_error() {
    for count in [4, 8] {
        let error = mat_with_laws(count).expect_err("an error");
        assert!(matches!(error, Error::CoarseBase(_)), "{error}");
    }
    assert!(mat_with_laws(32).is_ok());
}

/// `under` makes at least one element for each segment of a flexible base, and the requested number under a rigid base.
#[test]
fn a_flexible_mat_gets_an_element_for_each_segment() {
    let model = mat(0.25, BEAM_COUNT).unwrap().model;
    let rigid_block = basemat::structure::RigidBlock::new(20.0, 4.0, 2400.0).unwrap();
    for (requested, count) in [(8, BEAM_COUNT), (BEAM_COUNT, BEAM_COUNT), (64, 64)] {
        let flexible_ground = ElasticGround::under(soil(), &model, requested).unwrap();
        assert_eq!(flexible_ground.elements().len(), count);
        let rigid_ground = ElasticGround::under(soil(), &rigid_block, requested).unwrap();
        assert_eq!(rigid_ground.elements().len(), requested);
    }
    assert!(ElasticGround::under(soil(), &model, 0).is_err());
}
