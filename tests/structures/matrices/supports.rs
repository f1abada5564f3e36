//! GOAL: elastic supports are errors and rounding is not: a structure must keep its rigid-body
//! modes.
//! SCENE: a slender wall by its matrices, with weak springs and with few digits.
//! REFERENCE: the force against a rigid translation.

use super::model::{on_soil, tower};
use basemat::Error;
use basemat::bem::{ElasticGround, Strip};
use basemat::fem::{Direction, Layer, Material, Mesh};
use basemat::interface::Coulomb;
use basemat::motion::el_centro_1940;
use basemat::structure::StructureError;
use basemat::structure::{BaseNode, CraigBampton, FemModel, MatrixModel, Structure, Triplets};
use basemat::{Result, Simulation, Soil};

/// The model by its matrices: every entry of K after `change`, and a spring to a fixed point, with its
/// ratio to the largest stiffness.
fn by_matrices(
    model: &FemModel,
    change: impl Fn(f64) -> f64,
    support: Option<(usize, f64)>,
) -> MatrixModel {
    let n = model.dofs();
    let mut mass = Triplets::new(n);
    let mut entries = Triplets::new(n);
    let mut stiffness = Triplets::new(n);
    model.mass(&mut mass).unwrap();
    model.stiffness(&mut entries).unwrap();
    let mut sums = std::collections::BTreeMap::new();
    for &(row, column, value) in entries.entries() {
        *sums.entry((row, column)).or_insert(0.0) += value;
    }
    let max_magnitude = sums.values().fold(0.0_f64, |a, value| a.max(value.abs()));
    for (&(row, column), &value) in sums.iter().filter(|((row, column), _)| row >= column) {
        stiffness.add(row, column, change(value));
        if row > column {
            stiffness.add(column, row, change(value));
        }
    }
    if let Some((dof, ratio)) = support {
        stiffness.add(dof, dof, ratio * max_magnitude);
    }
    MatrixModel::new(mass, stiffness, model.base()).unwrap()
}

/// A value as in a file of `count` significant digits.
fn digits(count: usize) -> impl Fn(f64) -> f64 {
    move |value| format!("{value:.*e}", count - 1).parse().unwrap()
}

/// A wall 0.5 m wide and 50 m high.
fn wall() -> FemModel {
    let material = Material::new(2.0e9, 0.2, 2000.0).unwrap();
    let mesh = Mesh::layered_block(-0.25..0.25, 2, &[Layer::new(50.0, 100, material)]).unwrap();
    FemModel::on_base(mesh).unwrap()
}

fn wall_on_soil(structure: impl Structure + 'static) -> Result<Simulation> {
    let soil = Soil::new(60.0e6, 0.33, 1900.0).unwrap();
    Simulation::builder(0.01)
        .structure(structure)
        .ground(ElasticGround::new(soil, Strip::uniform(-0.25..0.25, 4).unwrap()).unwrap())
        .interface(Coulomb::new(0.4).unwrap())
        .build()
}

/// Springs from 1e-9 of the largest stiffness on, on a block and on a soft wall: the error has their
/// place and stiffness.
#[test]
fn weak_supports_are_errors_and_named() {
    let block = tower(6, 20);
    for (place, direction, name) in
        [([0.0, 15.0], Direction::X, "to the right"), ([-1.0, 7.5], Direction::Y, "upwards")]
    {
        let dof =
            block.dof(block.mesh().nearest_node(place[0], place[1]).unwrap(), direction).unwrap();
        let unsupported_model = by_matrices(&block, |value| value, None);
        let mut entries = Triplets::new(block.dofs());
        unsupported_model.stiffness(&mut entries).unwrap();
        let max_magnitude = entries.entries().iter().fold(0.0_f64, |a, entry| a.max(entry.2));
        for ratio in [1e-9, 1e-7, 1e-5] {
            let supported_model = by_matrices(&block, |value| value, Some((dof, ratio)));
            match on_soil(supported_model).build().err() {
                Some(Error::Structure(StructureError::Restrained {
                    direction,
                    force,
                    dof: found,
                    ratio: found_ratio,
                })) => {
                    assert_eq!((direction, found), (name, dof), "{ratio:e}");
                    assert!(
                        (force / (ratio * max_magnitude) - 1.0).abs() < 1e-3,
                        "{ratio:e}: {force}"
                    );
                    assert!(
                        found_ratio > 0.2 * ratio && found_ratio < 5.0 * ratio,
                        "{ratio:e}: {found_ratio:e}"
                    );
                }
                other => panic!("{ratio:e}: {other:?}"),
            }
        }
    }
    let top = wall().dof(wall().mesh().nearest_node(0.0, 50.0).unwrap(), Direction::X).unwrap();
    for ratio in [1e-9, 1e-6, 1e-3, 1.0, 1e3] {
        let supported_wall = by_matrices(&wall(), |value| value, Some((top, ratio)));
        let reduced_structure = CraigBampton::new(5).reduce(supported_wall.clone()).unwrap();
        for result in [wall_on_soil(supported_wall), wall_on_soil(reduced_structure)] {
            assert!(
                matches!(result, Err(Error::Structure(StructureError::Restrained { .. }))),
                "{ratio:e}: {:?}",
                result.err()
            );
        }
    }
}

/// The value after two operations that round.
fn rounded(value: f64) -> f64 {
    (value * 1.1) / 1.1
}

#[track_caller]
fn assert_stands(built: Result<Simulation>) {
    assert!(built.is_ok(), "{:?}", built.err());
}

/// Rounding of sums, of entries with twelve digits, and of a reduction, is not a support.
#[test]
fn rounding_is_not_a_support() {
    assert_stands(on_soil(by_matrices(&tower(6, 20), rounded, None)).build());
    assert_stands(on_soil(by_matrices(&tower(6, 20), digits(12), None)).build());
    assert_stands(wall_on_soil(by_matrices(&wall(), rounded, None)));
    assert_stands(wall_on_soil(by_matrices(&wall(), digits(12), None)));
    assert_stands(wall_on_soil(wall()));
    let top = wall().dof(wall().mesh().nearest_node(0.0, 50.0).unwrap(), Direction::X).unwrap();
    let reduced_structure = CraigBampton::new(10).keep(&[top]).reduce(wall()).unwrap();
    assert_stands(wall_on_soil(reduced_structure));
}

/// Six to eight digits leave forces under a rigid motion: an error with their size.
#[test]
fn matrices_of_few_digits_are_errors() {
    for (count, size) in [(6, 1e-5), (7, 1e-6), (8, 1e-7)] {
        match on_soil(by_matrices(&tower(6, 20), digits(count), None)).build().err() {
            Some(Error::Structure(StructureError::Restrained { ratio, .. })) => {
                assert!(ratio < size && ratio > 1e-3 * size, "{count}: {ratio:e}");
            }
            other => panic!("{count}: {other:?}"),
        }
    }
}

/// A tower on a rigid mat after Craig and Bampton: x, y, rotation and one mode in a `unit`, with
/// `interface` stiffness, which is exactly zero but for rounding.
fn craig_bampton(unit: f64, interface: [[f64; 2]; 2]) -> MatrixModel {
    let weight = 4.0e5;
    let participation = 2.0e2;
    let height = 40.0;
    let circular = 2.4 * std::f64::consts::PI;
    let mass = [
        [weight, 0.0, -5.0 * weight, participation],
        [0.0, weight, 0.0, 0.0],
        [-5.0 * weight, 0.0, 300.0 * weight, -participation * height],
        [participation, 0.0, -participation * height, 1.0],
    ];
    let units = [1.0, 1.0, 1.0, unit];
    let mut scaled_mass = Triplets::new(4);
    for (i, row) in mass.iter().enumerate() {
        for (j, value) in row.iter().enumerate().filter(|(_, value)| **value != 0.0) {
            scaled_mass.add(i, j, units[i] * units[j] * value);
        }
    }
    let mut stiffness = Triplets::new(4);
    stiffness.add(3, 3, (circular * unit).powi(2));
    for (i, row) in interface.iter().enumerate() {
        row.iter().enumerate().for_each(|(j, value)| stiffness.add(i, j, *value));
    }
    let contact = BaseNode::rigid_base(-7.0, 7.0, [0, 1, 2]);
    MatrixModel::new(scaled_mass, stiffness, contact).unwrap()
}

fn on_stiff_soil(structure: MatrixModel) -> Result<Simulation> {
    let soil = Soil::from_shear_wave_speed(250.0, 0.33, 1900.0).unwrap();
    Simulation::builder(0.005)
        .ground(ElasticGround::under(soil, &structure, 8).unwrap())
        .structure(structure)
        .interface(Coulomb::new(0.6).unwrap())
        .motion(el_centro_1940())
        .build()
}

/// Largest base shear of two seconds of the tower.
fn largest_shear(unit: f64, interface: [[f64; 2]; 2]) -> f64 {
    let mut simulation = on_stiff_soil(craig_bampton(unit, interface)).unwrap();
    simulation.run(400, |_| {}).unwrap().whole.base_shear.magnitude()
}

/// Rounding of the interface stiffness, a period of days with the tower's mass, has no effect, in any unit of the mode.
#[test]
fn rounding_beside_a_rigid_base_is_not_a_support() {
    let expected = largest_shear(1.0, [[0.0; 2]; 2]);
    for unit in [1.0, 1e2, 1e4] {
        for interface in
            [[[1e-6, 0.0], [0.0; 2]], [[1e-3, 3e-4], [2e-4, -1e-3]], [[-1e-3, 0.0], [0.0, 1e-3]]]
        {
            let computed = largest_shear(unit, interface);
            assert!(
                (computed / expected - 1.0).abs() < 1e-6,
                "{unit:e} {interface:?}: {computed} {expected}"
            );
        }
    }
    // 1 N/m is a support.
    let result = on_stiff_soil(craig_bampton(1.0, [[1.0, 0.0], [0.0; 2]]));
    assert!(
        matches!(result, Err(Error::Structure(StructureError::Restrained { .. }))),
        "{:?}",
        result.err()
    );
}

/// Stiffness in one half of a matrix only is an error that names its place, in any unit, unless it is active.
#[test]
fn unsymmetric_stiffness_is_an_error_unless_active() {
    for unit in [1.0, 1e2, 1e4] {
        let mut stiffness = Triplets::new(4);
        craig_bampton(unit, [[0.0; 2]; 2]).stiffness(&mut stiffness).unwrap();
        // A moment on the base in proportion to the mode, without a reaction.
        stiffness.add(2, 3, 1e2 * unit);
        let mut mass = Triplets::new(4);
        let symmetric_model = craig_bampton(unit, [[0.0; 2]; 2]);
        symmetric_model.mass(&mut mass).unwrap();
        let model = MatrixModel::new(mass, stiffness, symmetric_model.base()).unwrap();
        match on_stiff_soil(model.clone()).err() {
            Some(Error::Unsymmetric { matrix: "stiffness matrix", row: 2, column: 3, entries }) => {
                assert_eq!(entries, [1e2 * unit, 0.0]);
            }
            other => panic!("{other:?}"),
        }
        let active = model.with_active_stiffness();
        assert!(active.has_active_stiffness() && on_stiff_soil(active).is_ok());
    }
}
