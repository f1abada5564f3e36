//! Motion of bodies and towers in space: in pictures, in files for ParaView and in archives, against sums by hand.

use std::path::{Path, PathBuf};

use basemat::bem::SpringGround;
use basemat::coupled::{Probe, State};
use basemat::interface::Coulomb;
use basemat::io::paraview;
use basemat::motion::FreeField;
use basemat::results::{DeformedShape, Recorder, TimeSeries};
use basemat::structure::{
    DofCombination, PlanStorey, RigidBlock, RigidBody, StoreyBuilding, Structure, StructureGroup,
};
use basemat::{Error, Simulation, plot};

use basemat_problems::scenes;

use super::cells::CrossingPulses;

/// Sides of a rigid body and the middle of its base, m.
const BODY_SIDES: [f64; 3] = [8.0, 6.0, 10.0];
const BODY_CENTER: [f64; 2] = [1.0, 2.0];
/// Dimensions of a tower, m.
const TOWER_CENTER: [f64; 2] = [3.0, -2.0];
const STOREY_HEIGHT: f64 = 4.0;

pub(super) fn tower() -> StoreyBuilding {
    let mat = RigidBody::cuboid([10.0, 10.0, 1.0], 2400.0).unwrap();
    let mat = mat.centered_at(TOWER_CENTER).unwrap();
    let storey = PlanStorey::new(STOREY_HEIGHT, 1.2e5, [10.0; 2], [1.5e8, 1.5e8, 4.0e9]);
    StoreyBuilding::new(mat, &[storey; 3]).unwrap()
}

fn body() -> RigidBody {
    RigidBody::cuboid(BODY_SIDES, 2000.0).unwrap().centered_at(BODY_CENTER).unwrap()
}

/// [`CrossingPulses`] with fifteen times the amplitude.
struct AmplifiedPulses;

impl FreeField for AmplifiedPulses {
    fn displacement(&self, _: f64, _: f64) -> [f64; 2] {
        unreachable!("a ground in space needs three directions")
    }
    fn displacement_at(&self, place: [f64; 2], time: f64) -> [f64; 3] {
        CrossingPulses { quarter_turns: 0 }.displacement_at(place, time).map(|u| 15.0 * u)
    }
}

/// A structure on springs.
pub(super) fn on_springs(
    structure: impl Structure + 'static,
    motion: impl FreeField + 'static,
    probes: Vec<Probe>,
) -> Simulation {
    let ground = SpringGround::under(&structure, 6, 4e7, 3e7).unwrap();
    Simulation::builder(5e-3)
        .structure(structure)
        .ground(ground.with_dashpots(8e5, 4e5).unwrap())
        .interface(Coulomb::new(0.35).unwrap())
        .motion(motion)
        .probes(probes)
        .build()
        .unwrap()
}

/// The last second of a shaken structure: every fifth step in frames, and all states.
struct RecordedMotion {
    time_series: TimeSeries,
    states: Vec<State>,
}

impl RecordedMotion {
    fn of(structure: impl Structure + 'static) -> Self {
        let mut simulation = on_springs(structure, AmplifiedPulses, Vec::new());
        simulation.run(200, |_| {}).unwrap();
        let recorder = Recorder::new().contact(5).motion(5);
        let recorded_motion = scenes::record_run(&mut simulation, recorder, 200);
        Self { time_series: recorded_motion.time_series, states: recorded_motion.states }
    }

    /// States of the frames.
    fn shown_states(&self) -> impl Iterator<Item = &State> {
        self.states.iter().step_by(5)
    }

    fn ground_motion_across(&self) -> Vec<f64> {
        self.shown_states().map(|state| state.free_field_across).collect()
    }
}

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("plan_pictures").join(name)
}

/// Points of a path, of the commands `M` and `L`.
fn path_points(path: &str) -> Vec<[f64; 2]> {
    path.split(['M', 'L', 'Z'])
        .filter(|pair| !pair.is_empty())
        .map(|pair| {
            let numbers: Vec<f64> =
                pair.split_whitespace().map(|number| number.parse().unwrap()).collect();
            numbers.try_into().unwrap()
        })
        .collect()
}

/// Displacement by the rigid motion `u` at a point from the middle of the base.
fn rigid_displacement(u: &[f64], [x, y, z]: [f64; 3]) -> [f64; 3] {
    [u[0] + z * u[4] - y * u[5], u[1] + x * u[5] - z * u[3], u[2] + y * u[3] - x * u[4]]
}

/// Place of a point in the isometric view.
fn isometric([x, y, z]: [f64; 3]) -> [f64; 2] {
    let angle = std::f64::consts::PI / 6.0;
    [(x + y) * angle.cos(), -z - (y - x) * angle.sin()]
}

/// Corners of the body in the isometric view, the base first, for displacements enlarged by 30.
fn isometric_corners(u: &[f64]) -> Vec<[f64; 2]> {
    let mut corners = Vec::new();
    for z in [0.0, BODY_SIDES[2]] {
        for [x, y] in [[-3.0, -1.0], [5.0, -1.0], [5.0, 5.0], [-3.0, 5.0]] {
            let displacement = rigid_displacement(u, [x - BODY_CENTER[0], y - BODY_CENTER[1], z]);
            corners.push(isometric([
                x + 30.0 * displacement[0],
                y + 30.0 * displacement[1],
                z + 30.0 * displacement[2],
            ]));
        }
    }
    corners
}

fn difference(start: [f64; 2], end: [f64; 2]) -> [f64; 2] {
    [end[0] - start[0], end[1] - start[1]]
}

#[test]
fn a_body_moves_above_its_elements() {
    let time_series = RecordedMotion::of(body()).time_series;
    let shape = DeformedShape::of_block(&body(), BODY_SIDES[2]).unwrap();
    let svg = plot::animation("A block that rocks", &shape, &time_series, 30.0, 2.0).unwrap();
    svg.save(folder("body.svg")).unwrap();
    let text = svg.as_str();
    assert!(text.contains(">stick<") && text.contains(">slip<") && text.contains(">open<"));
    assert!(!text.contains("to the left") && text.contains("contact from above"));
    // The picture has each element below the body and at the side; open elements are dark.
    let count = time_series.elements().len();
    assert_eq!(text.matches("stroke-width=\"0.6\"").count(), 2 * count);
    assert!(text.contains("#164878"));
    // Edges along x, y and up of the body at the first frame: 30 degrees, one scale.
    let path = text.split(" d=\"").find(|d| d.contains("attributeName=\"d\"")).unwrap();
    let computed = path_points(path.split('"').next().unwrap());
    let expected = isometric_corners(time_series.motion_frames().next().unwrap().displacement);
    let scale = difference(computed[0], computed[6])[1] / difference(expected[0], expected[6])[1];
    assert!(scale > 5.0);
    for k in 1..8 {
        let computed_edge = difference(computed[0], computed[k]);
        let expected_edge = difference(expected[0], expected[k]);
        for axis in 0..2 {
            assert!(
                (computed_edge[axis] - scale * expected_edge[axis]).abs() < 0.2,
                "{k}: {computed_edge:?} {expected_edge:?}"
            );
        }
    }
    // A shape of a structure in the plane.
    let block = RigidBlock::new(8.0, BODY_SIDES[2], 2000.0).unwrap();
    let plane_shape = DeformedShape::of_block(&block, BODY_SIDES[2]).unwrap();
    for error in [
        plot::animation("A", &plane_shape, &time_series, 1.0, 1.0).err(),
        plot::deformed_shapes("A", &plane_shape, &time_series, &[1.0], 1.0).err(),
    ] {
        assert!(
            matches!(error, Some(Error::Scene { quantity: "deformed shape", .. })),
            "{error:?}"
        );
    }
}

#[test]
fn towers_are_drawn_from_two_sides() {
    let shape = DeformedShape::of_storeys(&tower()).unwrap();
    // Four corners of the mat and of each floor; outlines and columns.
    assert_eq!(shape.points().len(), 16);
    assert_eq!(shape.cells().len(), 4 + 12);
    let time_series = RecordedMotion::of(tower()).time_series;
    let picture =
        plot::deformed_shapes("A tower", &shape, &time_series, &[1.3, 1.8], 20.0).unwrap();
    picture.save(folder("tower.svg")).unwrap();
    for text in ["x, m", "y, m", "z, m", "t = 1.30 s", "t = 1.80 s"] {
        assert!(picture.as_str().contains(text), "{text}");
    }
    assert_eq!(picture.as_str().matches("z, m").count(), 2);
    let svg = plot::animation("A tower", &shape, &time_series, 20.0, 2.0).unwrap();
    svg.save(folder("tower_moves.svg")).unwrap();
    let group = StructureGroup::new().with(body(), 0.0).unwrap();
    let cylinder = RigidBody::cylinder(3.0, 6.0, 2000.0).unwrap();
    let group = group.with(cylinder.centered_at([12.0, 2.0]).unwrap(), 0.0).unwrap();
    let shape = DeformedShape::of_block(&group, 6.0).unwrap();
    assert_eq!(shape.points().len(), 2 * (4 + 32));
    let time_series = RecordedMotion::of(group).time_series;
    let svg = plot::animation("Two bodies", &shape, &time_series, 20.0, 2.0).unwrap();
    svg.save(folder("two.svg")).unwrap();
    #[cfg(feature = "png")]
    for (name, picture) in [("two.png", &svg), ("tower.png", &picture)] {
        picture.save_png(folder(name), 1.0).unwrap();
    }
}

/// Numbers of an array in a file of VTK.
fn vtk_array(text: &str, name: &str) -> Vec<f64> {
    let rest = text.split(&format!("Name=\"{name}\"")).nth(1).unwrap();
    let numbers = rest.split_once(">\n").unwrap().1.split("</DataArray>").next().unwrap();
    numbers.split_whitespace().map(|cell| cell.parse().unwrap()).collect()
}

/// Motion of a corner of the tower's level from its middle: the level follows the mat up and down.
fn level_motion(dofs: &[f64], level: usize, [dx, dy]: [f64; 2]) -> [f64; 3] {
    let level_dofs = match level {
        0 => [0, 1, 5],
        _ => [3 + 3 * level, 4 + 3 * level, 5 + 3 * level],
    };
    let motion = level_dofs.map(|dof| dofs[dof]);
    [
        motion[0] - dy * motion[2],
        motion[1] + dx * motion[2],
        dofs[2] + dy * dofs[3] - dx * dofs[4],
    ]
}

#[test]
fn paraview_files_have_towers_in_space() {
    let recorded_motion = RecordedMotion::of(tower());
    let shape = DeformedShape::of_storeys(&tower()).unwrap();
    let folder = folder("paraview");
    let written = paraview::write_series(&folder, "tower", &shape, &recorded_motion.time_series);
    assert_eq!(written, Ok(2 * 41));
    let text = std::fs::read_to_string(folder.join("tower_0007.vtu")).unwrap();
    let state = &recorded_motion.states[35];
    let places = vtk_array(&text, "points");
    let displacement = vtk_array(&text, "displacement");
    let velocity = vtk_array(&text, "velocity");
    for point in 0..16 {
        let level = point / 4;
        let corner = [[-5.0, -5.0], [5.0, -5.0], [5.0, 5.0], [-5.0, 5.0]][point % 4];
        let place = [
            TOWER_CENTER[0] + corner[0],
            TOWER_CENTER[1] + corner[1],
            STOREY_HEIGHT * level as f64,
        ];
        assert_eq!(places[3 * point..3 * point + 3], place);
        for (computed, dofs) in
            [(&displacement, state.displacement()), (&velocity, state.velocity())]
        {
            let expected = level_motion(dofs, level, corner);
            for (computed, expected) in computed[3 * point..].iter().zip(expected) {
                assert!((computed - expected).abs() < 1e-14, "{point}: {computed} {expected}");
            }
        }
    }
    let line_count = vtk_array(&text, "types").iter().filter(|kind| **kind == 3.0).count();
    assert_eq!(line_count, 12);
}

/// Rigid motions of the base at any place, and the motion of a floor relative to them.
#[test]
fn motions_relative_to_the_base_have_rows_along_both_axes() {
    let tower = tower();
    let dofs: Vec<f64> = (0..15).map(|k| (1.0 + 1.7 * f64::from(k)).sin()).collect();
    for place in [[0.0, 0.0, 0.0], [3.0, -4.0, 8.0], [-1.0, 2.5, 12.0]] {
        let rows = DofCombination::of_base(&tower, place).unwrap();
        for (row, expected) in rows.iter().zip(rigid_displacement(&dofs, place)) {
            assert!((row.value(&dofs) - expected).abs() < 1e-13, "{place:?}");
        }
    }
    for storey in 0..3 {
        let height = STOREY_HEIGHT * (storey + 1) as f64;
        let base_motion = DofCombination::of_base(&tower, [3.0, -4.0, height]).unwrap();
        let floor = tower.floor(storey, [3.0, -4.0]).unwrap();
        let drift = tower.total_drift(storey, [3.0, -4.0]).unwrap();
        for k in 0..2 {
            let relative_motion = (floor[k].clone() - base_motion[k].clone()).value(&dofs);
            assert!((relative_motion - drift[k].value(&dofs)).abs() < 1e-13);
        }
        let along = tower.floor(storey, [0.0; 2]).unwrap()[0].clone();
        // The motion may be along y as well.
        for result in [along.total_drift(&tower, height), along.relative_to_base(&tower)] {
            assert!(matches!(result, Err(Error::Scene { .. })), "{result:?}");
        }
    }
    let at_nan = DofCombination::of_base(&tower, [0.0, f64::NAN, 1.0]);
    assert!(matches!(at_nan, Err(Error::Input { .. })));
    let line = vec![[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]];
    let inertia = [[1e4, 0.0, 0.0], [0.0, 1e4, 0.0], [0.0, 0.0, 1e4]];
    let body_without_area = RigidBody::from_mass(line, 1e4, inertia, [0.0; 3]).unwrap();
    assert!(matches!(
        DofCombination::of_base(&body_without_area, [0.0; 3]),
        Err(Error::Input { .. })
    ));
    // In the plane: to the right and up.
    let block = RigidBlock::new(4.0, 6.0, 2000.0).unwrap();
    let rows = DofCombination::of_base(&block, [1.5, 7.0, 3.0]).unwrap();
    let computed = rows.map(|row| row.value(&[0.1, 0.2, 0.01]));
    for (computed, expected) in computed.into_iter().zip([0.1 - 0.03, 0.0, 0.2 + 0.015]) {
        assert!((computed - expected).abs() < 1e-15);
    }
}

#[test]
fn frames_have_the_motion_of_the_ground_along_y() {
    let recorded_motion = RecordedMotion::of(body());
    let expected = recorded_motion.ground_motion_across();
    assert!(expected.iter().any(|u| u.abs() > 1e-3));
    let time_series = &recorded_motion.time_series;
    let frames = time_series.motion_frames();
    let computed: Vec<f64> = frames.map(|frame| frame.free_field_across).collect();
    assert_eq!(computed, expected);
    let json = serde_json::to_string(time_series).unwrap();
    let read_back: TimeSeries = serde_json::from_str(&json).unwrap();
    assert!(read_back.motion_frames().eq(time_series.motion_frames()));
}

/// Archives of time series without compression.
#[cfg(feature = "npz")]
mod archives {
    use super::{RecordedMotion, body};

    fn position(bytes: &[u8], text: &[u8]) -> Option<usize> {
        bytes.windows(text.len()).position(|window| window == text)
    }

    /// The array of an archive without compression.
    fn npz_array(archive: &[u8], name: &str) -> Vec<f64> {
        let start = position(archive, format!("{name}.npy").as_bytes()).expect(name);
        let entry = &archive[start..];
        let array = &entry[position(entry, b"\x93NUMPY").unwrap()..];
        let header = usize::from(u16::from_le_bytes([array[8], array[9]]));
        let text = String::from_utf8(array[10..10 + header].to_vec()).unwrap();
        let shape = text.split('(').nth(1).unwrap().split(')').next().unwrap();
        let count: usize =
            shape.split(',').filter_map(|part| part.trim().parse::<usize>().ok()).product();
        let numbers = array[10 + header..].chunks_exact(8).take(count);
        numbers.map(|bytes| f64::from_le_bytes(bytes.try_into().unwrap())).collect()
    }

    #[test]
    fn archives_have_the_motion_along_y() {
        let recorded_motion = RecordedMotion::of(body());
        let mut archive = Vec::new();
        recorded_motion.time_series.write_npz(&mut archive).unwrap();
        let across = npz_array(&archive, "motion_free_field_across_m");
        assert_eq!(across, recorded_motion.ground_motion_across());
        let ground_motion: Vec<f64> =
            recorded_motion.shown_states().flat_map(|state| state.free_field).collect();
        assert_eq!(npz_array(&archive, "motion_free_field_m"), ground_motion);
        let torque = recorded_motion.time_series.series(basemat::results::Quantity::Torque);
        assert_eq!(npz_array(&archive, "torque_n_m"), torque);
        let slips: Vec<f64> = recorded_motion
            .shown_states()
            .flat_map(|state| state.contact.iter().map(|contact| contact.slip_across))
            .collect();
        assert_eq!(npz_array(&archive, "contact_slip_across_m"), slips);
        let displacements: Vec<f64> = recorded_motion
            .shown_states()
            .flat_map(|state| state.displacement().to_vec())
            .collect();
        assert_eq!(npz_array(&archive, "motion_displacement"), displacements);
    }
}
