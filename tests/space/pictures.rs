//! Bodies and towers in plan as they move: in pictures, for ParaView and in archives, against sums by hand.

use std::path::{Path, PathBuf};

use basemat::bem::SpringGround;
use basemat::coupled::{Probe, State};
use basemat::interface::Coulomb;
use basemat::io::paraview;
use basemat::motion::{FreeField, STANDARD_GRAVITY, Triaxial, el_centro_1940};
use basemat::results::{Comparison, DeformedShape, Recorder, TimeSeries, log_spaced};
use basemat::structure::{
    DofCombination, PlanStorey, RigidBlock, RigidBody, StoreyBuilding, Structure, StructureGroup,
};
use basemat::{Error, Simulation, plot};

use basemat_problems::scenes;

const HEIGHT: f64 = 10.0;

fn tower() -> StoreyBuilding {
    let mat = RigidBody::cuboid([10.0, 10.0, 1.0], 2400.0).unwrap();
    let mat = mat.centered_at([3.0, -2.0]).unwrap();
    let storey = PlanStorey::new(4.0, 1.2e5, [10.0; 2], [1.5e8, 1.5e8, 4.0e9]);
    StoreyBuilding::new(mat, &[storey; 3]).unwrap()
}

fn body() -> RigidBody {
    let body = RigidBody::cuboid([8.0, 6.0, HEIGHT], 2000.0).unwrap();
    body.centered_at([1.0, 2.0]).unwrap()
}

/// El Centro along x and, later and stronger, along y.
struct Shake;

impl FreeField for Shake {
    fn displacement(&self, _: f64, _: f64) -> [f64; 2] {
        unreachable!("a ground in plan asks for three directions")
    }
    fn displacement_at(&self, place: [f64; 2], time: f64) -> [f64; 3] {
        super::cells::Waves { quarters: 0 }.displacement_at(place, time).map(|u| 15.0 * u)
    }
}

/// A structure on springs.
fn on_springs(
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

/// Two seconds of a structure that is shaken, the last one in frames.
fn recorded(structure: impl Structure + 'static) -> (TimeSeries, Vec<State>) {
    let mut simulation = on_springs(structure, Shake, Vec::new());
    simulation.run(200, |_| {}).unwrap();
    let recorder = Recorder::new().contact(5).motion(5);
    let (time_series, _, states) = scenes::recorded(&mut simulation, recorder, 200);
    (time_series, states)
}

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("plan_pictures").join(name)
}

/// Points of a path, `M` and `L` alike.
fn points(path: &str) -> Vec<[f64; 2]> {
    let pairs = path.split(['M', 'L', 'Z']).filter(|pair| !pair.is_empty());
    let numbers = |pair: &str| -> Vec<f64> {
        pair.split_whitespace().map(|number| number.parse().unwrap()).collect()
    };
    pairs.map(|pair| numbers(pair).try_into().unwrap()).collect()
}

#[test]
fn a_body_moves_above_its_elements() {
    let (time_series, _) = recorded(body());
    let shape = DeformedShape::of_block(&body(), HEIGHT).unwrap();
    let svg = plot::animation("A block that rocks", &shape, &time_series, 30.0, 2.0).unwrap();
    svg.save(folder("body.svg")).unwrap();
    let text = svg.as_str();
    assert!(text.contains(">stick<") && text.contains(">slip<") && text.contains(">open<"));
    assert!(!text.contains("to the left") && text.contains("contact from above"));
    // Each element below the body and at the side; open ones are dark.
    let count = time_series.elements().len();
    assert_eq!(text.matches("stroke-width=\"0.6\"").count(), 2 * count);
    assert!(text.contains("#164878"));
    // Edges along x, y and up of the body at the first frame: 30 degrees, one scale.
    let path = text.split(" d=\"").find(|d| d.contains("attributeName=\"d\"")).unwrap();
    let places = points(path.split('"').next().unwrap());
    let frame = time_series.motion_frames().next().unwrap();
    let moved = |[x, y, z]: [f64; 3]| {
        let u = frame.displacement;
        let [dx, dy] = [x - 1.0, y - 2.0];
        let shift = [
            u[0] + z * u[4] - dy * u[5],
            u[1] + dx * u[5] - z * u[3],
            u[2] + dy * u[3] - dx * u[4],
        ];
        let [x, y, z] = [x + 30.0 * shift[0], y + 30.0 * shift[1], z + 30.0 * shift[2]];
        let (sin, cos) = (std::f64::consts::PI / 6.0).sin_cos();
        [(x + y) * cos, -z - (y - x) * sin]
    };
    let corners = [[-3.0, -1.0], [5.0, -1.0], [5.0, 5.0], [-3.0, 5.0]];
    let exact: Vec<[f64; 2]> =
        [0.0, HEIGHT].iter().flat_map(|z| corners.map(|[x, y]| moved([x, y, *z]))).collect();
    let along = |a: [f64; 2], b: [f64; 2]| [b[0] - a[0], b[1] - a[1]];
    let scale = along(places[0], places[6])[1] / along(exact[0], exact[6])[1];
    assert!(scale > 5.0);
    for k in 1..8 {
        let (found, wanted) = (along(places[0], places[k]), along(exact[0], exact[k]));
        for axis in 0..2 {
            assert!((found[axis] - scale * wanted[axis]).abs() < 0.2, "{k}: {found:?} {wanted:?}");
        }
    }
    // A shape of the plane.
    let block = RigidBlock::new(8.0, HEIGHT, 2000.0).unwrap();
    let flat = DeformedShape::of_block(&block, HEIGHT).unwrap();
    for error in [
        plot::animation("A", &flat, &time_series, 1.0, 1.0).err(),
        plot::deformed_shapes("A", &flat, &time_series, &[1.0], 1.0).err(),
    ] {
        assert!(
            matches!(error, Some(Error::Scene { quantity: "deformed shape", .. })),
            "{error:?}"
        );
    }
}

#[test]
fn towers_are_seen_from_two_sides() {
    let own = tower();
    let shape = DeformedShape::of_storeys(&own).unwrap();
    // Four corners of the mat and of each floor; outlines and columns.
    assert_eq!((shape.points().len(), shape.cells().len()), (16, 4 + 12));
    let (time_series, _) = recorded(own);
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
    let other = RigidBody::cylinder(3.0, 6.0, 2000.0).unwrap().centered_at([12.0, 2.0]).unwrap();
    let group = group.with(other, 0.0).unwrap();
    let shape = DeformedShape::of_block(&group, 6.0).unwrap();
    assert_eq!(shape.points().len(), 2 * (4 + 32));
    let (time_series, _) = recorded(group);
    let svg = plot::animation("Two bodies", &shape, &time_series, 20.0, 2.0).unwrap();
    svg.save(folder("two.svg")).unwrap();
    #[cfg(feature = "png")]
    for (name, picture) in [("two.png", &svg), ("tower.png", &picture)] {
        picture.save_png(folder(name), 1.0).unwrap();
    }
}

/// Numbers of an array in a file of VTK.
fn array(text: &str, name: &str) -> Vec<f64> {
    let rest = text.split(&format!("Name=\"{name}\"")).nth(1).unwrap();
    let inner = rest.split_once(">\n").unwrap().1.split("</DataArray>").next().unwrap();
    inner.split_whitespace().map(|cell| cell.parse().unwrap()).collect()
}

#[test]
fn paraview_gets_towers_in_space() {
    let (time_series, states) = recorded(tower());
    let shape = DeformedShape::of_storeys(&tower()).unwrap();
    let folder = folder("paraview");
    assert_eq!(paraview::write_series(&folder, "tower", &shape, &time_series), Ok(2 * 41));
    let text = std::fs::read_to_string(folder.join("tower_0007.vtu")).unwrap();
    let state = &states[35];
    let (u, v) = (state.displacement(), state.velocity());
    let [places, displacement, velocity] =
        ["points", "displacement", "velocity"].map(|name| array(&text, name));
    for point in 0..16 {
        let (level, corner) = (point / 4, point % 4);
        let [dx, dy] = [[-5.0, -5.0], [5.0, -5.0], [5.0, 5.0], [-5.0, 5.0]][corner];
        let own = &places[3 * point..3 * point + 3];
        assert_eq!(own, [3.0 + dx, -2.0 + dy, 4.0 * level as f64]);
        for (found, dofs) in [(&displacement, u), (&velocity, v)] {
            let [x, y, turn] = match level.checked_sub(1) {
                None => [dofs[0], dofs[1], dofs[5]],
                Some(k) => [dofs[6 + 3 * k], dofs[7 + 3 * k], dofs[8 + 3 * k]],
            };
            let exact = [x - dy * turn, y + dx * turn, dofs[2] + dy * dofs[3] - dx * dofs[4]];
            for (found, exact) in found[3 * point..].iter().zip(exact) {
                assert!((found - exact).abs() < 1e-14, "{point}: {found} {exact}");
            }
        }
    }
    let lines = array(&text, "types");
    assert_eq!(lines.iter().filter(|kind| **kind == 3.0).count(), 12);
}

/// Rigid motions of the base at any place, and what is left of a floor's.
#[test]
fn motions_relative_to_the_base_are_known_along_both_axes() {
    let own = tower();
    let dofs: Vec<f64> = (0..15).map(|k| (1.0 + 1.7 * f64::from(k)).sin()).collect();
    for place in [[0.0, 0.0, 0.0], [3.0, -4.0, 8.0], [-1.0, 2.5, 12.0]] {
        let [x, y, z] = place;
        let u = &dofs;
        let exact =
            [u[0] + z * u[4] - y * u[5], u[1] + x * u[5] - z * u[3], u[2] + y * u[3] - x * u[4]];
        let found = DofCombination::of_base(&own, place).unwrap();
        for (row, exact) in found.iter().zip(exact) {
            assert!((row.value(&dofs) - exact).abs() < 1e-13, "{place:?}");
        }
    }
    for storey in 0..3 {
        let height = 4.0 * (storey + 1) as f64;
        let carried = DofCombination::of_base(&own, [3.0, -4.0, height]).unwrap();
        let floor = own.floor(storey, [3.0, -4.0]).unwrap();
        let drift = own.total_drift(storey, [3.0, -4.0]).unwrap();
        for k in 0..2 {
            let found = (floor[k].clone() - carried[k].clone()).value(&dofs);
            assert!((found - drift[k].value(&dofs)).abs() < 1e-13);
        }
        let [along, _, _] = own.floor(storey, [0.0; 2]).unwrap();
        // It may be along y as well.
        for refused in [along.total_drift(&own, height), along.relative_to_base(&own)] {
            assert!(matches!(refused, Err(Error::Scene { .. })), "{refused:?}");
        }
    }
    assert!(matches!(
        DofCombination::of_base(&own, [0.0, f64::NAN, 1.0]),
        Err(Error::Input { .. })
    ));
    let line = vec![[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]];
    let tensor = [[1e4, 0.0, 0.0], [0.0, 1e4, 0.0], [0.0, 0.0, 1e4]];
    let flat = RigidBody::from_mass(line, 1e4, tensor, [0.0; 3]).unwrap();
    assert!(matches!(DofCombination::of_base(&flat, [0.0; 3]), Err(Error::Input { .. })));
    // In the plane: to the right and up.
    let block = RigidBlock::new(4.0, 6.0, 2000.0).unwrap();
    let rows = DofCombination::of_base(&block, [1.5, 7.0, 3.0]).unwrap();
    let found = rows.map(|row| row.value(&[0.1, 0.2, 0.01]));
    for (found, exact) in found.into_iter().zip([0.1 - 0.03, 0.0, 0.2 + 0.015]) {
        assert!((found - exact).abs() < 1e-15);
    }
}

/// A square tower that is shaken along y has the floor spectra, drifts and peaks along y of one that is shaken along x.
#[test]
fn floors_along_y_are_those_along_x() {
    let record = el_centro_1940().scaled(0.4).unwrap();
    let run = |axis: usize| {
        let own = tower();
        let floor = own.floor(2, [0.0; 2]).unwrap();
        let drift = own.drift(0).unwrap();
        let shear = own.shear(0).unwrap();
        let probes = vec![
            Probe::acceleration("roof", floor[axis].clone()),
            Probe::displacement("drift", drift[axis].clone()),
            Probe::section("shear", &shear[axis]),
            Probe::acceleration("other", floor[1 - axis].clone()),
        ];
        let mut motion = Triaxial::default();
        *[&mut motion.x, &mut motion.y][axis] = Some(record.clone());
        let mut simulation = on_springs(own, motion, probes);
        let mut time_series = Recorder::new().start(&simulation).unwrap();
        let run = simulation.run(600, |state| time_series.record(state)).unwrap();
        (time_series, run)
    };
    let [(x, of_x), (y, of_y)] = [run(0), run(1)];
    let periods = log_spaced(0.1, 2.0, 15).unwrap();
    let [one, other] = [&x, &y].map(|own| own.floor_spectrum("roof", &periods, 0.05).unwrap());
    for (one, other) in one.iter().zip(&other) {
        assert!(one.acceleration > 0.02 * STANDARD_GRAVITY);
        assert!((one.acceleration / other.acceleration - 1.0).abs() < 1e-6);
    }
    for name in ["drift", "shear"] {
        let [one, other] = [&of_x, &of_y].map(|own| own.probe(name).unwrap().magnitude());
        assert!(one > 0.0 && (one / other - 1.0).abs() < 1e-6, "{name} {one} {other}");
    }
    assert!(of_y.probe("other").unwrap().magnitude() < 1e-6);
    let both = Comparison::from_iter([("x", of_x), ("y", of_y)]).csv().to_string();
    let mut lines = both.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let (heading, x, y) = (lines.next().unwrap(), lines.next().unwrap(), lines.next().unwrap());
    let at = |row: &[&str], name: &str| -> f64 {
        let place = heading.iter().position(|own| *own == name).expect(name);
        row[place].parse::<f64>().unwrap().abs()
    };
    for (one, other) in [
        ("base_shear_n", "shear_across_n"),
        ("base_moment_n_m", "moment_across_n_m"),
        ("mean_slip_m", "mean_slip_across_m"),
        ("base_rotation_rad", "rotation_across_rad"),
        ("overturning_safety", "overturning_safety_across"),
        ("residual_slip_m", "residual_slip_across_m"),
    ] {
        let [a, b] = [at(&x, one), at(&y, other)];
        assert!(a > 0.0 && (a / b - 1.0).abs() < 1e-6, "{one}: {a} {b}");
    }
}

/// The array of an archive without compression.
#[cfg(feature = "npz")]
fn npz(archive: &[u8], name: &str) -> Vec<f64> {
    let find = |bytes: &[u8], text: &[u8]| bytes.windows(text.len()).position(|own| own == text);
    let rest = &archive[find(archive, format!("{name}.npy").as_bytes()).expect(name)..];
    let rest = &rest[find(rest, b"\x93NUMPY").unwrap()..];
    let header = usize::from(u16::from_le_bytes([rest[8], rest[9]]));
    let text = String::from_utf8(rest[10..10 + header].to_vec()).unwrap();
    let shape = text.split('(').nth(1).unwrap().split(')').next().unwrap();
    let count: usize =
        shape.split(',').filter_map(|part| part.trim().parse::<usize>().ok()).product();
    let numbers = rest[10 + header..].chunks_exact(8).take(count);
    numbers.map(|bytes| f64::from_le_bytes(bytes.try_into().unwrap())).collect()
}

#[test]
fn frames_have_the_motion_of_the_ground_along_y() {
    let (time_series, states) = recorded(body());
    let shown: Vec<&State> = states.iter().step_by(5).collect();
    let across: Vec<f64> = shown.iter().map(|state| state.free_field_across).collect();
    assert!(across.iter().any(|u| u.abs() > 1e-3));
    let frames: Vec<f64> =
        time_series.motion_frames().map(|frame| frame.free_field_across).collect();
    assert_eq!(frames, across);
    let again: TimeSeries =
        serde_json::from_str(&serde_json::to_string(&time_series).unwrap()).unwrap();
    assert!(again.motion_frames().eq(time_series.motion_frames()));
}

#[cfg(feature = "npz")]
#[test]
fn archives_have_what_moves_along_y() {
    let (time_series, states) = recorded(body());
    let shown: Vec<&State> = states.iter().step_by(5).collect();
    let across: Vec<f64> = shown.iter().map(|state| state.free_field_across).collect();
    let mut archive = Vec::new();
    time_series.write_npz(&mut archive).unwrap();
    assert_eq!(npz(&archive, "motion_free_field_across_m"), across);
    let flat: Vec<f64> = shown.iter().flat_map(|state| state.free_field).collect();
    assert_eq!(npz(&archive, "motion_free_field_m"), flat);
    assert_eq!(npz(&archive, "torque_n_m"), time_series.series(basemat::results::Quantity::Torque));
    let slips: Vec<f64> =
        shown.iter().flat_map(|state| state.contact.iter().map(|own| own.slip_across)).collect();
    assert_eq!(npz(&archive, "contact_slip_across_m"), slips);
    let moved: Vec<f64> = shown.iter().flat_map(|state| state.displacement().to_vec()).collect();
    assert_eq!(npz(&archive, "motion_displacement"), moved);
}
