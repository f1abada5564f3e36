//! Models of finite elements in space in pictures: shells, bricks and beams that hide each other, and values on a plan.

use std::path::{Path, PathBuf};

use basemat::bem::SpringGround;
use basemat::fem::{BeamSection, Hex8, LumpedMass, Material, Mesh, Shell, SpaceBeam};
use basemat::interface::Coulomb;
use basemat::motion::{Triaxial, el_centro_1940};
use basemat::results::{DeformedShape, Recorder, TimeSeries};
use basemat::structure::FemModel;
use basemat::{Error, Simulation, plot};

/// A mat of shells at z = 7, a brick on it at its back, and a column with a mass at its front.
fn model() -> FemModel {
    let concrete = Material::new(30.0e9, 0.2, 2500.0).unwrap();
    let mut mesh = Mesh::in_space();
    let mat = mesh.add_grid(4, 4, |i, j| [2.0 * j as f64, 2.0 * i as f64, 7.0]).unwrap();
    for (_, cell) in mat.cells() {
        mesh.add(Shell::new(cell, concrete, 0.5).unwrap()).unwrap();
    }
    let below = [9, 10, 14, 13];
    let above = below.map(|node| {
        let [x, y, z] = mesh.nodes()[node];
        mesh.add_node_at([x, y, z + 3.0]).unwrap()
    });
    let brick = [below, above].concat().try_into().unwrap();
    mesh.add(Hex8::new(brick, concrete)).unwrap();
    let top = mesh.add_node_at([2.0, 2.0, 11.0]).unwrap();
    let section = BeamSection::new(0.16, [2.1e-3, 2.1e-3], 3.6e-3).unwrap();
    mesh.add(SpaceBeam::new([5, top], concrete, section, [1.0, 0.0, 0.0]).unwrap()).unwrap();
    mesh.add(LumpedMass::in_space(top, 2.0e4, [0.0; 3]).unwrap()).unwrap();
    FemModel::on_base(mesh).unwrap()
}

fn recorded(model: &FemModel) -> TimeSeries {
    let ground = SpringGround::under(model, 3, 4e7, 3e7).unwrap();
    let record = el_centro_1940();
    let motion = Triaxial { x: Some(record.clone()), y: Some(record), up: None };
    let mut simulation = Simulation::builder(0.01)
        .structure(model.clone())
        .ground(ground.with_dashpots(8e5, 6e5).unwrap())
        .interface(Coulomb::new(0.5).unwrap())
        .motion(motion)
        .build()
        .unwrap();
    let mut series = Recorder::new().contact(50).motion(50).start(&simulation).unwrap();
    simulation.run(150, |state| series.record(state)).unwrap();
    series
}

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("model_pictures").join(name)
}

/// Corners of each cell of an animation at its start, pixels.
fn cells(svg: &str) -> Vec<Vec<[f64; 2]>> {
    let group = svg.split("<g fill=\"#fff\"").nth(1).unwrap();
    let paths = group.split("<path d=\"M").skip(1).map(|rest| rest.split('"').next().unwrap());
    let corner = |pair: &str| -> [f64; 2] {
        let numbers: Vec<f64> = pair.split_whitespace().map(|own| own.parse().unwrap()).collect();
        numbers.try_into().unwrap()
    };
    let corners = |path: &str| path.trim_end_matches('Z').split('L').map(corner).collect();
    paths.map(corners).collect()
}

/// Far cells are drawn first, and the base lies on the surface of the soil.
#[test]
fn near_cells_hide_far_ones() {
    let model = model();
    let shape = DeformedShape::of_model(&model);
    assert!(shape.points().iter().all(|point| (0.0..=4.0).contains(&point.position[1])));
    // Nine shells, five sides of the brick beside the shell below it, a line and a point.
    assert_eq!(shape.cells().len(), 9 + 5 + 2);
    let series = recorded(&model);
    let svg = plot::animation("A model", &shape, &series, 20.0, 1.0).unwrap();
    svg.save(file("model.svg")).unwrap();
    let drawn = cells(svg.as_str());
    assert_eq!(drawn.len(), 16);
    // The same cells by hand: places in the isometric view, and distances towards the viewer.
    let frame = series.motion_frames().next().unwrap();
    let moved = shape.displacements(frame.displacement).unwrap();
    let place = |k: usize| {
        let point = &shape.points()[k];
        let [x, z] = [0, 1].map(|a| point.position[a] + 20.0 * moved[k][a]);
        let y = point.away + 20.0 * moved[k][2];
        let (sin, cos) = (std::f64::consts::PI / 6.0).sin_cos();
        [(x + y) * cos, -z - (y - x) * sin]
    };
    let depth = |cell: &Vec<usize>| {
        let sum = |k: &usize| {
            let point = &shape.points()[*k];
            point.position[0] - point.away + point.position[1]
        };
        cell.iter().map(sum).sum::<f64>() / cell.len() as f64
    };
    let mut order: Vec<&Vec<usize>> = shape.cells().iter().collect();
    order.sort_by(|a, b| depth(a).total_cmp(&depth(b)));
    // The front corner of the brick's top is near, the shell in the corner at the back left is far.
    assert_eq!(order[0][..], [8, 9, 13, 12]);
    let (first, scale) = (place(order[0][0]), {
        let [a, b] = [order[0][0], order[0][1]].map(place);
        (drawn[0][1][0] - drawn[0][0][0]) / (b[0] - a[0])
    });
    for (cell, own) in order.iter().zip(&drawn) {
        assert_eq!(cell.len(), own.len());
        for (&corner, found) in cell.iter().zip(own) {
            let exact = place(corner);
            for a in 0..2 {
                let exact = drawn[0][0][a] + scale * (exact[a] - first[a]);
                assert!((found[a] - exact).abs() < 0.3, "{cell:?}: {found:?} {exact}");
            }
        }
    }
    // Elevations: faces of the two instants in both views.
    let svg = plot::deformed_shapes("A model", &shape, &series, &[1.0], 20.0).unwrap();
    svg.save(file("shapes.svg")).unwrap();
    assert_eq!(svg.as_str().matches("<polygon").count(), 2 * 2 * 14);
    let svg = plot::contact_plan("A model", &series, 1.0).unwrap();
    svg.save(file("contact.svg")).unwrap();
    assert_eq!(svg.as_str().matches("<polygon").count(), series.elements().len());
}

/// Colours and middles (pixels) of the polygons of a picture.
fn polygons(svg: &str) -> Vec<(&str, [f64; 2])> {
    let value = |text, name| -> &str {
        let (_, rest) = str::split_once(text, name).unwrap();
        rest.split('"').next().unwrap()
    };
    let middle = |points: &str| {
        let pairs: Vec<[f64; 2]> = points
            .split_whitespace()
            .map(|pair| pair.split_once(',').unwrap())
            .map(|(x, y)| [x.parse().unwrap(), y.parse().unwrap()])
            .collect();
        [0, 1].map(|a| pairs.iter().map(|own| own[a]).sum::<f64>() / pairs.len() as f64)
    };
    let polygons = svg.split("<polygon").skip(1);
    polygons.map(|own| (value(own, "fill=\""), middle(value(own, "points=\"")))).collect()
}

/// Shells have the colours of their values, where they lie, and a key.
#[test]
fn values_of_shells_are_shown_on_a_plan() {
    let mesh = model().mesh().clone();
    // From −400 below zero in front on the left to 400 at the back on the right.
    let values: Vec<(usize, f64)> = (0..9).map(|k| (k, 100.0 * k as f64 - 400.0)).collect();
    let svg = plot::shell_plan("Moments", "m_x, kNm/m", &mesh, &values).unwrap();
    svg.save(file("moments.svg")).unwrap();
    let text = svg.as_str();
    let drawn = polygons(text);
    assert_eq!(drawn.len(), 9);
    assert_eq!([drawn[0].0, drawn[4].0, drawn[8].0], ["#143C8C", "#FAF0DE", "#96141E"]);
    let side = drawn[1].1[0] - drawn[0].1[0];
    for (k, (_, [x, y])) in drawn.iter().enumerate() {
        let (row, column) = ((k / 3) as f64, (k % 3) as f64);
        let exact = [drawn[0].1[0] + side * column, drawn[0].1[1] - side * row];
        assert!((x - exact[0]).abs() < 2.5 && (y - exact[1]).abs() < 2.5, "{k}: {x} {y} {exact:?}");
    }
    for word in ["m_x, kNm/m", "-400 to -300", "-100 to 0", "300 to 400", "x, m", "y, m"] {
        assert!(text.contains(word), "{word}");
    }
    // A value has one colour wherever it stands, and zero is pale beside one sign only.
    let some = |values: &[(usize, f64)]| {
        let svg = plot::shell_plan("M", "m", &mesh, values).unwrap();
        polygons(svg.as_str()).iter().map(|own| own.0.to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(some(&[(0, 0.0), (1, 700.0)]), ["#FAF0DE", "#96141E"]);
    assert_eq!(some(&[(0, -700.0), (1, 0.0)])[0], "#143C8C");
    assert_eq!(some(&[(3, 0.0)]), ["#FAF0DE"]);

    let fault = |mesh: &Mesh, values: &[(usize, f64)]| {
        plot::shell_plan("M", "m", mesh, values).unwrap_err()
    };
    assert!(matches!(fault(&mesh, &[]), Error::Size { .. }));
    assert!(matches!(fault(&mesh, &[(12, 0.0)]), Error::Index { index: 12, bound: 12, .. }));
    // A brick, and a beam.
    for element in [9, 10] {
        assert!(matches!(fault(&mesh, &[(element, 0.0)]), Error::Part { .. }));
    }
    assert!(matches!(fault(&mesh, &[(0, f64::NAN)]), Error::Input { .. }));
    assert!(matches!(fault(&Mesh::new(), &[(0, 1.0)]), Error::Scene { .. }));
}
