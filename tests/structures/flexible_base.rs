//! GOAL: a flexible mat on too few contact elements is an error or warns; on enough it does not.
//! SCENE: a mat 20 m wide and 0.25 m thick of 40 beams, two columns, on the half-plane.
//! REFERENCE: the same on 64 elements; twice the elements; numbers of elements.

use basemat::bem::{ElasticGround, Ground, Strip};
use basemat::coupled::CoarseBaseError;
use basemat::coupled::Warning;
use basemat::fem::{Beam, Direction, LumpedMass, Mesh};
use basemat::prelude::*;
use basemat::structure::DofCombination;
use basemat::{Error, Result};

const WIDTH: f64 = 20.0;
const BEAMS: usize = 40;
const YOUNG_MODULUS: f64 = 30.0e9;

/// The mat and the settlement of a column against the middle.
fn mat(thickness: f64, beams: usize) -> Result<(FemModel, DofCombination)> {
    let mut mesh = Mesh::new();
    let place = |k: usize| WIDTH * (k as f64 / beams as f64 - 0.5);
    let nodes: Vec<_> = (0..=beams).map(|k| mesh.add_node(place(k), 0.0)).collect::<Result<_>>()?;
    for ends in nodes.windows(2) {
        let inertia = thickness.powi(3) / 12.0;
        mesh.add(Beam::new([ends[0], ends[1]], YOUNG_MODULUS, thickness, inertia, 2400.0)?)?;
    }
    let columns = [nodes[beams / 4], nodes[3 * beams / 4]];
    for (foot, x) in columns.into_iter().zip([-0.25 * WIDTH, 0.25 * WIDTH]) {
        let top = mesh.add_node(x, 4.0)?;
        mesh.add(Beam::new([foot, top], YOUNG_MODULUS, 0.3, 0.3_f64.powi(3) / 12.0, 2400.0)?)?;
        mesh.add(LumpedMass::new(top, 30.0e3)?)?;
    }
    let model = FemModel::new(mesh, &nodes)?;
    let [column, middle] = [columns[0], nodes[beams / 2]].map(|node| model.row(node, Direction::Y));
    Ok((model, column? - middle?))
}

fn soil() -> Soil {
    Soil::from_shear_wave_speed(200.0, 0.33, 1900.0).unwrap()
}

/// A mat on these strips: settlement of a column against the middle (m), and warnings of too few elements.
fn stand(thickness: f64, strips: Strip) -> Result<(f64, Vec<Warning>)> {
    let (model, row) = mat(thickness, BEAMS)?;
    let mut simulation = Simulation::builder(0.005)
        .structure(model)
        .ground(ElasticGround::new(soil(), strips)?)
        .interface(Coulomb::new(0.5)?)
        .build()?;
    let settlement = row.value(simulation.static_displacement());
    let mut warnings = simulation.run(1, |_| {})?.warnings;
    warnings.retain(|warning| matches!(warning, Warning::CoarseBase { .. }));
    Ok((settlement, warnings))
}

/// Settlement of the columns against the middle: 20 times too large on four elements, 2.4 times on eight.
#[test]
fn too_few_elements_under_a_mat_are_told() {
    let on = |count: usize| stand(0.25, Strip::graded(-10.0..10.0, count).unwrap());
    let (exact, warnings) = on(64).unwrap();
    assert!((exact + 1.669e-3).abs() < 1e-6 && warnings.is_empty(), "{exact} {warnings:?}");
    for count in [4, 8] {
        let error = on(count).expect_err("an error");
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
    let (found, warnings) = on(16).unwrap();
    assert!((found / exact - 1.0).abs() < 0.03, "{found}");
    let [Warning::CoarseBase { foundation: 0, elements: 16, needed, difference, axis: None }] =
        warnings[..]
    else {
        panic!("{warnings:?}")
    };
    assert!((20..=22).contains(&needed) && difference.unwrap() < 0.01, "{warnings:?}");
    let (found, warnings) = on(32).unwrap();
    assert!((found / exact - 1.0).abs() < 0.005 && warnings.is_empty(), "{found} {warnings:?}");
    // A thick mat is stiffer than the soil between few elements.
    let (_, warnings) = stand(2.0, Strip::graded(-10.0..10.0, 8).unwrap()).unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
}

/// A law for each element makes no difference to the check.
#[test]
fn too_few_elements_are_told_with_a_law_for_each() {
    let on = |count: usize| -> Result<Simulation> {
        let (model, _) = mat(0.25, BEAMS)?;
        let laws = (0..count).map(|e| -> Result<Box<dyn InterfaceLaw>> {
            Ok(Box::new(Coulomb::new(0.4 + 0.01 * e as f64)?))
        });
        Simulation::builder(0.005)
            .structure(model)
            .ground(ElasticGround::new(soil(), Strip::graded(-10.0..10.0, count)?)?)
            .interfaces(laws.collect::<Result<_>>()?)
            .build()
    };
    for count in [4, 8] {
        let error = on(count).expect_err("an error");
        assert!(matches!(error, Error::CoarseBase(_)), "{error}");
    }
    assert!(on(32).is_ok());
}

/// `under` takes an element for each segment at least; a rigid base as many as wanted.
#[test]
fn a_flexible_mat_gets_an_element_for_each_segment() {
    let (model, _) = mat(0.25, BEAMS).unwrap();
    let rigid = basemat::structure::RigidBlock::new(20.0, 4.0, 2400.0).unwrap();
    for (wanted, count) in [(8, BEAMS), (BEAMS, BEAMS), (64, 64)] {
        assert_eq!(ElasticGround::under(soil(), &model, wanted).unwrap().elements().len(), count);
        assert_eq!(ElasticGround::under(soil(), &rigid, wanted).unwrap().elements().len(), wanted);
    }
    assert!(ElasticGround::under(soil(), &model, 0).is_err());
}
