//! GOAL: files for ParaView contain the states they were written from.
//! SCENE: a moving tower and deformed shapes, written as series.
//! REFERENCE: the XML, parsed here, and the recorded states.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use basemat::Error;
use basemat::coupled::State;
use basemat::fem::{Beam, Direction, Mesh};
use basemat::interface::Mode;
use basemat::io::paraview;
use basemat::results::{DeformedShape, Recorder, ShapePoint, TimeSeries};
use basemat::structure::{FemModel, RigidBlock, ShearBuilding, Storey};
use basemat_problems::faults::is_unwritable;

use basemat_problems::scenes::{self, SI_UNITS, block, friction, scene, tower};

/// An empty folder for each test.
fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("vtk_{name}"));
    let _ = std::fs::remove_dir_all(&path);
    path
}

/// Checks that tags are nested and closed; returns the arrays by name.
pub(super) fn arrays(xml: &str) -> BTreeMap<String, Vec<f64>> {
    let mut open_tags: Vec<String> = Vec::new();
    let mut found = BTreeMap::new();
    for piece in xml.trim_start_matches("<?xml version=\"1.0\"?>").split('<').skip(1) {
        let (tag, text) = piece.split_once('>').expect("every < has its >");
        if let Some(closed) = tag.strip_prefix('/') {
            assert_eq!(open_tags.pop().as_deref(), Some(closed));
        } else if !tag.ends_with('/') {
            open_tags.push(tag.split_whitespace().next().unwrap().to_owned());
        }
        if tag.starts_with("DataArray") {
            let name = tag.split("Name=\"").nth(1).unwrap().split('"').next().unwrap();
            let numbers = text.split_whitespace().map(|word| word.parse().unwrap());
            found.insert(name.to_owned(), numbers.collect());
        } else {
            assert!(text.trim().is_empty(), "text in {tag}");
        }
    }
    assert!(open_tags.is_empty() && !found.is_empty());
    found
}

/// States, recorded time series and deformed shape of a run of the tower.
struct RecordedTower {
    states: Vec<State>,
    time_series: TimeSeries,
    shape: DeformedShape,
}

fn recorded_tower() -> RecordedTower {
    let tower = tower(SI_UNITS, None);
    let shape = DeformedShape::of_model(&tower);
    let mut simulation =
        scene(SI_UNITS, 0.6).structure(tower).interface(friction(0.35)).build().unwrap();
    let recorder = Recorder::new().contact(40).motion(40);
    let (time_series, _, states) = scenes::recorded(&mut simulation, recorder, 200);
    RecordedTower { states, time_series, shape }
}

fn read(folder: &Path, name: &str) -> String {
    std::fs::read_to_string(folder.join(name)).unwrap()
}

/// Value of `key` in a line of XML.
fn attribute<'a>(line: &'a str, key: &str) -> &'a str {
    let after_key = line.split(&format!("{key}=\"")).nth(1).unwrap();
    after_key.split('"').next().unwrap()
}

#[test]
fn a_series_has_the_recorded_states() {
    let RecordedTower { states, time_series, shape } = recorded_tower();
    let folder = folder("series");
    assert_eq!(paraview::write_series(&folder, "tower", &shape, &time_series), Ok(12));

    let collection = read(&folder, "tower.pvd");
    let entries: Vec<&str> = collection.lines().filter(|l| l.contains("<DataSet")).collect();
    assert_eq!(entries.len(), 12);
    for (k, entry) in entries.iter().enumerate() {
        assert_eq!(attribute(entry, "timestep").parse(), Ok(states[40 * (k / 2)].time));
        assert_eq!(attribute(entry, "part").parse(), Ok(k % 2));
        assert!(folder.join(attribute(entry, "file")).exists());
    }

    for frame in 0..6 {
        let state = &states[40 * frame];
        let grid = arrays(&read(&folder, &format!("tower_{frame:04}.vtu")));
        let points = shape.points().len();
        let cells = shape.cells().len();
        assert_eq!((points, cells), (49, 36));
        assert_eq!(grid["points"].len(), 3 * points);
        assert_eq!(grid["offsets"], (1..=cells).map(|k| 4.0 * k as f64).collect::<Vec<_>>());
        assert_eq!(grid["types"], vec![9.0; cells]);
        assert!(grid["connectivity"].iter().all(|&k| k < points as f64));
        for (name, values) in
            [("displacement", state.displacement()), ("velocity", state.velocity())]
        {
            for (found, expected) in grid[name].chunks(3).zip(values.chunks(2)) {
                assert_eq!(found, [expected[0], expected[1], 0.0]);
            }
        }
        let base = arrays(&read(&folder, &format!("tower_base_{frame:04}.vtu")));
        let pressure: Vec<f64> = state.contact.iter().map(|c| c.pressure).collect();
        assert_eq!(base["pressure"], pressure);
        let gap: Vec<f64> = state.contact.iter().map(|c| c.gap).collect();
        assert_eq!(base["gap"], gap);
        let is_open: Vec<bool> = base["mode"].iter().map(|&mode| mode == 3.0).collect();
        let expected: Vec<bool> = state.modes.iter().map(|&mode| mode == Mode::Open).collect();
        assert_eq!(is_open, expected);
        assert_eq!(base["types"], vec![3.0; state.modes.len()]);
    }
}

#[test]
fn deformed_shapes_move_as_their_structures() {
    // A building rotates about the middle of its base; its floors drift relative to the base.
    let storeys = [Storey::new(3.0, 1e4, 1e7), Storey::new(4.0, 1e4, 1e7)];
    let building = ShearBuilding::new(10.0, 1e4, 1e5, &storeys).unwrap();
    let building = building.centered_at(7.0).unwrap();
    let shape = DeformedShape::of_building(&building).unwrap();
    assert_eq!(shape.points()[5].position, [12.0, 7.0]);
    assert_eq!(shape.cells().len(), 3 + 4);
    let displacements = shape.displacements(&[0.1, 0.2, 0.01, 0.3, 0.4]).unwrap();
    for (found, expected) in displacements[5].iter().zip([0.4, 0.2 + 0.05]) {
        assert!((found - expected).abs() < 1e-15);
    }
    assert_eq!(displacements[0][0], 0.1);
    assert_eq!(displacements[2][0], 0.3);

    // Beams are lines, and a node without degrees of freedom does not move.
    let mut mesh = Mesh::new();
    let nodes = [0.0, 1.0, 2.0].map(|x| mesh.add_node(x, 0.0).unwrap());
    mesh.add_node(5.0, 5.0).unwrap();
    for k in 0..2 {
        mesh.add(Beam::new([nodes[k], nodes[k + 1]], 1e6, 1e6, 1.0, 1.0).unwrap()).unwrap();
    }
    let model = FemModel::new(mesh, &nodes).unwrap();
    let shape = DeformedShape::of_model(&model);
    assert_eq!(shape.cells(), [[0, 1], [1, 2]]);
    let mut dofs = vec![0.0; 9];
    dofs[model.dof(1, Direction::Y).unwrap()] = 0.25;
    let displacements = shape.displacements(&dofs).unwrap();
    assert_eq!(displacements, [[0.0; 3], [0.0, 0.25, 0.0], [0.0; 3], [0.0; 3]]);

    // Followers of a rigid link move with its node.
    let mut mesh = Mesh::new();
    let places = [[0.0, 0.0], [0.0, 3.0], [-2.0, 0.0], [2.0, 0.0]];
    let nodes = places.map(|[x, y]| mesh.add_node(x, y).unwrap());
    let foot = nodes[0];
    let edges = [nodes[2], nodes[3]];
    mesh.add(Beam::new([foot, nodes[1]], 1e6, 1e6, 1.0, 1.0).unwrap()).unwrap();
    for node in edges {
        mesh.add(Beam::new([foot, node], 1e6, 1e6, 1.0, 1.0).unwrap()).unwrap();
    }
    let model = FemModel::new(mesh, &edges).unwrap();
    let model = model.with_rigid_link(foot, &edges).unwrap();
    let shift = model.rigid_motion(Direction::X, [0.0; 3]);
    let displacements = DeformedShape::of_model(&model).displacements(&shift).unwrap();
    assert_eq!(displacements, [[1.0, 0.0, 0.0]; 4]);

    // A rigid rotation of a block keeps all distances, to second order.
    let shape = DeformedShape::of_block(&RigidBlock::new(4.0, 6.0, 1e3).unwrap(), 6.0).unwrap();
    let displacements = shape.displacements(&[0.0, 0.0, 1e-5]).unwrap();
    let moved_point =
        |k: usize| [0, 1].map(|d| shape.points()[k].position[d] + displacements[k][d]);
    let distance =
        (moved_point(0)[0] - moved_point(2)[0]).hypot(moved_point(0)[1] - moved_point(2)[1]);
    assert!((distance - 52.0_f64.sqrt()).abs() < 1e-9);
}

#[test]
fn invalid_requests_are_errors() {
    let RecordedTower { time_series, shape, .. } = recorded_tower();
    let folder = folder("errors");
    for name in ["", "a/b", "..", "a b", "\"x\""] {
        let error = paraview::write_series(&folder, name, &shape, &time_series).unwrap_err();
        assert!(matches!(error, Error::Scene { .. }));
    }
    // More degrees of freedom than the run has.
    let point = ShapePoint { position: [0.0; 2], horizontal: 98.into(), ..ShapePoint::default() };
    let other_shape = DeformedShape::new(vec![point.clone()], vec![vec![0]]).unwrap();
    let error = paraview::write_series(&folder, "a", &other_shape, &time_series).unwrap_err();
    assert!(matches!(error, Error::Index { index: 98, bound: 98, .. }));
    let simulation = scene(SI_UNITS, 0.6)
        .structure(block(SI_UNITS))
        .interface(friction(0.3))
        .build()
        .unwrap();
    let series_without_frames = Recorder::new().start(&simulation).unwrap();
    let error = paraview::write_series(&folder, "a", &shape, &series_without_frames).unwrap_err();
    assert!(matches!(error, Error::Scene { .. }));
    // A folder that cannot be created.
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("file"), "").unwrap();
    let fault = paraview::write_series(folder.join("file/deeper"), "a", &shape, &time_series);
    assert!(is_unwritable(&fault));

    assert!(DeformedShape::new(vec![], vec![]).is_err());
    assert!(DeformedShape::new(vec![point.clone()], vec![vec![]]).is_err());
    assert!(DeformedShape::new(vec![point.clone()], vec![vec![0, 1]]).is_err());
    let nan = ShapePoint { position: [f64::NAN, 0.0], ..point.clone() };
    assert!(DeformedShape::new(vec![nan], vec![]).is_err());
    let infinite_point = ShapePoint { vertical: (0, f64::INFINITY).into(), ..point };
    assert!(DeformedShape::new(vec![infinite_point], vec![]).is_err());
    assert!(DeformedShape::of_block(&block(SI_UNITS), 0.0).is_err());
}
