//! Models in space as cells of ParaView: bricks, shells, beams, masses, and a tetrahedron.

use std::collections::BTreeMap;
use std::path::Path;

use basemat::bem::SpringGround;
use basemat::fem::{
    BeamSection, Direction, Element, ElementFace, Hex8, Iwan, LumpedMass, MassKind, Material, Mesh,
    SharedMaterial, Shell, SolidPoint, SpaceBeam,
};
use basemat::interface::Bonded;
use basemat::io::paraview;
use basemat::motion::{Triaxial, el_centro_1940};
use basemat::results::{DeformedShape, Recorder};
use basemat::structure::{FemModel, Structure};
use basemat::{Error, Simulation};

use super::vtk::arrays;

/// A weightless tetrahedron without stiffness.
struct Tetrahedron([usize; 4]);

impl Element for Tetrahedron {
    fn nodes(&self) -> &[usize] {
        &self.0
    }
    fn directions(&self) -> &[Direction] {
        &[Direction::X, Direction::Y, Direction::Z]
    }
    fn stiffness(&self, _: &[[f64; 3]], _: &mut [f64]) {}
    fn mass(&self, _: &[[f64; 3]], _: MassKind, _: &mut [f64]) {}
    fn faces(&self) -> Vec<ElementFace> {
        let [a, b, c, d] = self.0;
        [[a, c, b], [a, b, d], [b, c, d], [c, a, d]]
            .map(|side| ElementFace::side(&side))
            .to_vec()
    }
}

/// Vector from point `a` to point `b`.
fn between(points: &[[f64; 3]], a: usize, b: usize) -> [f64; 3] {
    [0, 1, 2].map(|k| points[b][k] - points[a][k])
}

fn grid_of(folder: &Path, name: &str) -> BTreeMap<String, Vec<f64>> {
    arrays(&std::fs::read_to_string(folder.join(name)).unwrap())
}

/// Two bricks on the ground at z = 5, the second one lying on its side; on them a slab, a wall, a column with a rigid
/// arm, and a tetrahedron. Nodes: bottom 0 to 5, top 6 to 11, wall 12 and 13, head 14, arm 15, tip 16.
fn model() -> FemModel {
    let concrete = Material::new(30.0e9, 0.2, 2400.0).unwrap();
    let mut mesh = Mesh::in_space();
    let grid = mesh.add_grid(2, 3, |i, j| [2.0 * j as f64, 3.0 * i as f64, 5.0]).unwrap();
    let bricks = grid.extrude(&mut mesh, &[1.0]).unwrap();
    let second = bricks[1];
    mesh.add(Hex8::new(bricks[0], concrete)).unwrap();
    mesh.add(Hex8::new([0, 3, 7, 4, 1, 2, 6, 5].map(|corner| second[corner]), concrete))
        .unwrap();
    mesh.add(Shell::new(vec![6, 7, 10, 9], concrete, 0.4).unwrap()).unwrap();
    for x in [0.0, 2.0] {
        mesh.add_node_at([x, 0.0, 9.0]).unwrap();
    }
    mesh.add(Shell::new(vec![6, 7, 13, 12], concrete, 0.4).unwrap()).unwrap();
    mesh.add(Shell::new(vec![7, 8, 13], concrete, 0.4).unwrap()).unwrap();
    let head = mesh.add_node_at([0.0, 3.0, 10.0]).unwrap();
    let arm = mesh.add_node_at([1.0, 2.0, 10.5]).unwrap();
    let section = BeamSection::new(0.16, [2.1e-3, 2.1e-3], 3.6e-3).unwrap();
    mesh.add(SpaceBeam::new([9, head], concrete, section, [1.0, 0.0, 0.0]).unwrap())
        .unwrap();
    mesh.add(LumpedMass::in_space(arm, 2.0e4, [1.0e4; 3]).unwrap()).unwrap();
    let tip = mesh.add_node_at([0.5, 0.5, 7.0]).unwrap();
    mesh.add(Tetrahedron([6, 7, 9, tip])).unwrap();
    let foot = SpaceBeam::new([6, tip], concrete, section, [1.0, 0.0, 0.0]).unwrap();
    mesh.add(foot).unwrap();
    FemModel::on_base(mesh).unwrap().with_rigid_link(head, &[arm]).unwrap()
}

/// Two blocks of clay beside a mat of concrete, sheared by 1 % and compressed.
#[test]
fn states_of_yielding_solids_are_cell_data() {
    let clay = SharedMaterial::from(Iwan::hyperbolic(20.0e6, 40.0e3, 0.4, 0.49, 1900.0).unwrap());
    let concrete = SharedMaterial::from(Material::new(30.0e9, 0.2, 2400.0).unwrap());
    let mesh = Mesh::quad8_block(&[0.0, 1.0, 2.0, 3.0], &[0.0, 1.0], |column, _| {
        if column == 1 { concrete.clone() } else { clay.clone() }
    });
    let mut model = FemModel::on_base(mesh.unwrap()).unwrap();
    let mut dofs = vec![0.0; model.dofs()];
    for (node, &[_, y, _]) in model.mesh().nodes().iter().enumerate() {
        dofs[model.dof(node, Direction::X).unwrap()] = 0.01 * y;
        dofs[model.dof(node, Direction::Y).unwrap()] = -1e-4 * y;
    }
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("vtk_yielding.vtu");
    model.nonlinear_mut().unwrap().commit(&dofs);
    paraview::write_solid_state(&path, &model, &dofs).unwrap();
    let arrays = arrays(&std::fs::read_to_string(&path).unwrap());
    assert_eq!(arrays["types"].len(), 2);
    // All points have the same strain. The bulk modulus is 2 G (1 + ν)/(3 (1 − 2ν)).
    let bulk_modulus = 2.0 * 20.0e6 * 1.49 / (3.0 * 0.02);
    for mean_stress in &arrays["mean_stress"] {
        assert!((mean_stress / (-1e-4 * bulk_modulus) - 1.0).abs() < 1e-9, "{mean_stress}");
    }
    let state = model.solid_points(2).unwrap()[1].state;
    for cell in 0..2 {
        assert!((arrays["plastic_strain"][cell] / state.plastic_strain - 1.0).abs() < 1e-12);
        assert!(
            (arrays["mobilised_strength"][cell] / state.mobilised_strength - 1.0).abs() < 1e-12
        );
    }
    assert!((5e-3..1e-2).contains(&state.plastic_strain), "{state:?}");
    assert!((0.5..1.0).contains(&state.mobilised_strength), "{state:?}");
    assert_eq!(arrays["displacement"].len(), 3 * model.mesh().nodes().len());
    let linear_model = FemModel::on_base(
        Mesh::quad8_block(&[0.0, 1.0], &[0.0, 1.0], |_, _| concrete.clone()).unwrap(),
    );
    let error = paraview::write_solid_state(&path, &linear_model.unwrap(), &dofs).unwrap_err();
    assert!(matches!(error, Error::Scene { .. }), "{error}");
}

/// Expected values of a grid.
struct ExpectedGrid {
    time: f64,
    /// Plastic strain and mobilised strength of each cell.
    strains: [f64; 4],
    strengths: [f64; 4],
    largest_displacement: f64,
}

/// Largest absolute value.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |max: f64, value| max.max(value.abs()))
}

/// Block of clay beside a column of concrete, whose states a series contains at several times.
fn grids_of_a_run(folder: &Path) -> Vec<ExpectedGrid> {
    let clay = SharedMaterial::from(Iwan::hyperbolic(20.0e6, 25.0e3, 0.4, 0.45, 1900.0).unwrap());
    let concrete = SharedMaterial::from(Material::new(30.0e9, 0.2, 2400.0).unwrap());
    let mesh = Mesh::quad8_block(&[-1.5, -0.5, 0.5, 1.5], &[0.0, 1.0, 2.0], |column, _| {
        if column == 1 { concrete.clone() } else { clay.clone() }
    });
    let model = FemModel::on_base(mesh.unwrap()).unwrap();
    let mut simulation = Simulation::builder(0.01)
        .ground(SpringGround::under(&model, 6, 4e7, 3e7).unwrap())
        .structure(model)
        .interface(Bonded)
        .motion(el_centro_1940())
        .build()
        .unwrap();
    let mut series = paraview::SolidSeries::new(folder, "clay").unwrap();
    let mut expected = Vec::new();
    for step in 1..=300 {
        simulation.step().unwrap();
        if step % 100 != 0 {
            continue;
        }
        let structure: &dyn std::any::Any = simulation.structure();
        let model: &FemModel = structure.downcast_ref().unwrap();
        let state = simulation.state();
        series.write(state.time, model, state.displacement()).unwrap();
        // Elements are rectangles with points of equal areas.
        let mean = |element: usize, value: fn(&SolidPoint) -> f64| {
            model.solid_points(element).unwrap().iter().map(value).sum::<f64>() / 4.0
        };
        let elements = [0, 2, 3, 5];
        expected.push(ExpectedGrid {
            time: state.time,
            strains: elements.map(|element| mean(element, |point| point.state.plastic_strain)),
            strengths: elements
                .map(|element| mean(element, |point| point.state.mobilised_strength)),
            largest_displacement: largest(state.displacement()),
        });
        // A time must come after the last one, and nothing is written otherwise.
        let error = series.write(state.time, model, state.displacement()).unwrap_err();
        assert!(matches!(error, Error::Input { .. }), "{error}");
    }
    assert_eq!(series.grid_count(), 3);
    expected
}

/// GOAL: the grids of a run contain the state of every time, and the collection lists them.
#[test]
fn states_of_soil_that_yields_are_a_series() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("vtk_solid_series");
    let _ = std::fs::remove_dir_all(&folder);
    let expected = grids_of_a_run(&folder);
    let collection = std::fs::read_to_string(folder.join("clay.pvd")).unwrap();
    assert_eq!(collection.matches("<DataSet").count(), 3);
    let mut last_strain = 0.0;
    for (index, grid_of_time) in expected.iter().enumerate() {
        let ExpectedGrid { time, strains, strengths, largest_displacement } = grid_of_time;
        let name = format!("clay_{index:04}.vtu");
        assert!(
            collection
                .contains(&format!("timestep=\"{time}\" group=\"\" part=\"0\" file=\"{name}\""))
        );
        let grid = grid_of(&folder, &name);
        assert_eq!(grid["types"].len(), 4);
        for (cell, (strain, strength)) in strains.iter().zip(strengths).enumerate() {
            assert!((grid["plastic_strain"][cell] / strain - 1.0).abs() < 1e-9, "{name} {cell}");
            assert!((grid["mobilised_strength"][cell] / strength - 1.0).abs() < 1e-9, "{name}");
        }
        let written = largest(&grid["displacement"]);
        assert!((written / largest_displacement - 1.0).abs() < 1e-12, "{written}");
        assert!(strains[0] != last_strain && strains[0] > 1e-5, "{strains:?}");
        last_strain = strains[0];
    }
    let error = paraview::SolidSeries::new(&folder, "a/b").unwrap_err();
    assert!(matches!(error, Error::Scene { .. }), "{error}");
}

/// Volume of a brick of VTK; positive if the normal of its first face points to the second face.
fn volume(points: &[[f64; 3]]) -> f64 {
    let [[a, b, c], [d, e, f], [g, h, i]] = [1, 3, 4].map(|corner| between(points, 0, corner));
    a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
}

/// Places and cells of the elements in their order, by vtkCellType.h.
fn assert_cells(grid: &BTreeMap<String, Vec<f64>>, model: &FemModel) {
    assert_eq!(grid["types"], [12.0, 12.0, 9.0, 9.0, 5.0, 3.0, 1.0, 41.0, 3.0]);
    assert_eq!(grid["offsets"], [8.0, 16.0, 20.0, 24.0, 27.0, 29.0, 30.0, 34.0, 36.0]);
    let points: Vec<[f64; 3]> =
        grid["points"].chunks(3).map(|point| point.try_into().unwrap()).collect();
    let nodes = model.mesh().nodes();
    assert!(points.iter().zip(nodes).all(|(point, [x, y, z])| *point == [*x, *y, z - 5.0]));
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "indices")]
    let cells: Vec<usize> = grid["connectivity"].iter().map(|node| *node as usize).collect();
    assert_eq!(cells[..8], [0, 1, 4, 3, 6, 7, 10, 9]);
    for brick in [&cells[..8], &cells[8..16]] {
        let corners: Vec<[f64; 3]> = brick.iter().map(|&corner| points[corner]).collect();
        assert!((volume(&corners) - 2.0 * 3.0).abs() < 1e-12, "{brick:?}");
        // Both faces have the same order of corners.
        for k in 0..4 {
            assert_eq!(between(&corners, k, k + 4), between(&corners, 0, 4));
        }
    }
    let other_cells = [6, 7, 10, 9, 6, 7, 13, 12, 7, 8, 13, 9, 14, 15, 6, 7, 9, 16, 6, 16];
    assert_eq!(cells[16..], other_cells);
}

#[test]
fn models_in_space_are_written_as_cells() {
    let model = model();
    let shape = DeformedShape::of_model(&model);
    let ground = SpringGround::under(&model, 2, 4e7, 3e7).unwrap();
    let motion = Triaxial { x: Some(el_centro_1940()), ..Triaxial::default() };
    let mut simulation = Simulation::builder(0.01)
        .structure(model.clone())
        .ground(ground)
        .interface(Bonded)
        .motion(motion)
        .build()
        .unwrap();
    let rest = simulation.static_displacement().to_vec();
    let mut series = Recorder::new().motion(20).start(&simulation).unwrap();
    simulation.run(20, |state| series.record(state)).unwrap();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("vtk_model");
    assert_eq!(paraview::write_series(&folder, "model", &shape, &series), Ok(2));
    let grid = grid_of(&folder, "model_0001.vtu");
    assert_cells(&grid, &model);

    // Nodes move by their degrees of freedom; the arm by u + θ × d with its head.
    let frame = series.motion_frames().nth(1).unwrap();
    for (name, values) in [
        ("displacement", frame.displacement),
        ("velocity", frame.velocity),
        ("static_displacement", &rest[..]),
    ] {
        assert!(values.iter().any(|value| value.abs() > 1e-6), "{name}");
        let component = |node, direction| values[model.dof(node, direction).unwrap()];
        for node in (0..17).filter(|node| *node != 15) {
            let displacements = [Direction::X, Direction::Y, Direction::Z]
                .map(|direction| component(node, direction));
            assert_eq!(grid[name][3 * node..3 * node + 3], displacements, "{name} {node}");
        }
        let u = component(14, Direction::X);
        let v = component(14, Direction::Y);
        let w = component(14, Direction::Z);
        let a = component(14, Direction::RotationX);
        let b = component(14, Direction::RotationY);
        let c = component(14, Direction::RotationZ);
        let dx = 1.0;
        let dy = -1.0;
        let dz = 0.5;
        let arm = [u + b * dz - c * dy, v + c * dx - a * dz, w + a * dy - b * dx];
        for (found, exact) in grid[name][45..48].iter().zip(arm) {
            assert!((found - exact).abs() < 1e-15, "{name}");
        }
    }

    // One state alone.
    paraview::write_state(folder.join("rest.vtu"), &shape, &rest).unwrap();
    let single_grid = grid_of(&folder, "rest.vtu");
    assert_eq!(single_grid["displacement"], grid["static_displacement"]);
    assert_eq!(single_grid["connectivity"], grid["connectivity"]);
    let result = paraview::write_state(folder.join("no.vtu"), &shape, &rest[..10]);
    assert!(matches!(result, Err(Error::Index { .. })), "{result:?}");
}
