//! Pictures of finite element models in space: shells, bricks and beams that hide each other, and values on a plan.

use std::path::{Path, PathBuf};

use basemat::bem::SpringGround;
use basemat::fem::{BeamSection, Hex8, LumpedMass, Material, Mesh, Shell, SpaceBeam};
use basemat::interface::Coulomb;
use basemat::motion::{Triaxial, el_centro_1940};
use basemat::results::{DeformedShape, Recorder, TimeSeries};
use basemat::structure::FemModel;
use basemat::{Error, Simulation, plot};

/// Factor on the displacements in the pictures.
const DISPLACEMENT_FACTOR: f64 = 20.0;

/// A mat of shells at z = 7, a brick on it at its back, and a column with a mass at its front.
fn model() -> FemModel {
    let concrete = Material::new(30.0e9, 0.2, 2500.0).unwrap();
    let mut mesh = Mesh::in_space();
    let mat = mesh.add_grid(4, 4, |i, j| [2.0 * j as f64, 2.0 * i as f64, 7.0]).unwrap();
    for (_, cell) in mat.cells() {
        mesh.add(Shell::new(cell, concrete, 0.5).unwrap()).unwrap();
    }
    let lower_nodes = [9, 10, 14, 13];
    let upper_nodes = lower_nodes.map(|node| {
        let [x, y, z] = mesh.nodes()[node];
        mesh.add_node_at([x, y, z + 3.0]).unwrap()
    });
    let brick = [lower_nodes, upper_nodes].concat().try_into().unwrap();
    mesh.add(Hex8::new(brick, concrete)).unwrap();
    let top = mesh.add_node_at([2.0, 2.0, 11.0]).unwrap();
    let section = BeamSection::new(0.16, [2.1e-3, 2.1e-3], 3.6e-3).unwrap();
    mesh.add(SpaceBeam::new([5, top], concrete, section, [1.0, 0.0, 0.0]).unwrap())
        .unwrap();
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

/// Numbers x and y, separated by a space.
fn spaced_pair(text: &str) -> [f64; 2] {
    let numbers: Vec<f64> = text.split_whitespace().map(|number| number.parse().unwrap()).collect();
    numbers.try_into().unwrap()
}

/// Corners of each cell of an animation at its start, pixels.
fn drawn_cells(svg: &str) -> Vec<Vec<[f64; 2]>> {
    let group = svg.split("<g fill=\"#fff\"").nth(1).unwrap();
    group
        .split("<path d=\"M")
        .skip(1)
        .map(|rest| rest.split('"').next().unwrap())
        .map(|path| path.trim_end_matches('Z').split('L').map(spaced_pair).collect())
        .collect()
}

/// Place of a point in the isometric view.
fn isometric([x, y, z]: [f64; 3]) -> [f64; 2] {
    let angle = std::f64::consts::PI / 6.0;
    [(x + y) * angle.cos(), -z - (y - x) * angle.sin()]
}

/// Distance of a cell's middle towards the viewer.
fn depth(shape: &DeformedShape, cell: &[usize]) -> f64 {
    let sum: f64 = cell
        .iter()
        .map(|k| &shape.points()[*k])
        .map(|point| point.position[0] - point.away + point.position[1])
        .sum();
    sum / cell.len() as f64
}

/// Compares the drawn cells with places in the isometric view, up to a common scale and shift.
fn assert_cells_are_drawn(
    cells: &[&Vec<usize>],
    points_in_view: &[[f64; 2]],
    drawn_cells: &[Vec<[f64; 2]>],
) {
    let first = points_in_view[cells[0][0]];
    let second = points_in_view[cells[0][1]];
    let scale = (drawn_cells[0][1][0] - drawn_cells[0][0][0]) / (second[0] - first[0]);
    for (cell, polygon) in cells.iter().zip(drawn_cells) {
        assert_eq!(cell.len(), polygon.len());
        for (&corner, computed) in cell.iter().zip(polygon) {
            for axis in 0..2 {
                let expected =
                    drawn_cells[0][0][axis] + scale * (points_in_view[corner][axis] - first[axis]);
                assert!(
                    (computed[axis] - expected).abs() < 0.3,
                    "{cell:?}: {computed:?} {expected}"
                );
            }
        }
    }
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
    let svg = plot::animation("A model", &shape, &series, DISPLACEMENT_FACTOR, 1.0).unwrap();
    svg.save(file("model.svg")).unwrap();
    let drawn = drawn_cells(svg.as_str());
    assert_eq!(drawn.len(), 16);
    // The same cells by hand: places in the isometric view, and distances towards the viewer.
    let frame = series.motion_frames().next().unwrap();
    let displacements = shape.displacements(frame.displacement).unwrap();
    let points_in_view: Vec<[f64; 2]> = shape
        .points()
        .iter()
        .zip(&displacements)
        .map(|(point, u)| {
            isometric([
                point.position[0] + DISPLACEMENT_FACTOR * u[0],
                point.away + DISPLACEMENT_FACTOR * u[2],
                point.position[1] + DISPLACEMENT_FACTOR * u[1],
            ])
        })
        .collect();
    let mut order: Vec<&Vec<usize>> = shape.cells().iter().collect();
    order.sort_by(|a, b| depth(&shape, a).total_cmp(&depth(&shape, b)));
    // The front corner of the brick's top is near, the shell in the corner at the back left is far.
    assert_eq!(order[0][..], [8, 9, 13, 12]);
    assert_cells_are_drawn(&order, &points_in_view, &drawn);
    // Elevations: faces of the two instants in both views.
    let svg = plot::deformed_shapes("A model", &shape, &series, &[1.0], DISPLACEMENT_FACTOR);
    let svg = svg.unwrap();
    svg.save(file("shapes.svg")).unwrap();
    assert_eq!(svg.as_str().matches("<polygon").count(), 2 * 2 * 14);
    let svg = plot::contact_plan("A model", &series, 1.0).unwrap();
    svg.save(file("contact.svg")).unwrap();
    assert_eq!(svg.as_str().matches("<polygon").count(), series.elements().len());
}

/// A polygon of a picture: its colour, and its middle in pixels.
struct Polygon<'a> {
    color: &'a str,
    middle: [f64; 2],
}

/// Value of an attribute of a tag.
fn attribute<'a>(tag: &'a str, name: &str) -> &'a str {
    let rest = tag.split_once(&format!("{name}=\"")).unwrap().1;
    rest.split('"').next().unwrap()
}

fn polygons(svg: &str) -> Vec<Polygon<'_>> {
    svg.split("<polygon")
        .skip(1)
        .map(|tag| {
            let corners: Vec<[f64; 2]> = attribute(tag, "points")
                .split_whitespace()
                .map(|pair| pair.split_once(',').unwrap())
                .map(|(x, y)| [x.parse().unwrap(), y.parse().unwrap()])
                .collect();
            let middle = [0, 1].map(|axis| {
                corners.iter().map(|corner| corner[axis]).sum::<f64>() / corners.len() as f64
            });
            Polygon { color: attribute(tag, "fill"), middle }
        })
        .collect()
}

/// Colours of shells with these values.
fn colors(mesh: &Mesh, values: &[(usize, f64)]) -> Vec<String> {
    let svg = plot::shell_plan("M", "m", mesh, values).unwrap();
    polygons(svg.as_str()).iter().map(|polygon| polygon.color.to_owned()).collect()
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
    let drawn_polygons = polygons(text);
    assert_eq!(drawn_polygons.len(), 9);
    let colors_shown = [drawn_polygons[0].color, drawn_polygons[4].color, drawn_polygons[8].color];
    assert_eq!(colors_shown, ["#143C8C", "#FAF0DE", "#96141E"]);
    let origin = drawn_polygons[0].middle;
    let side = drawn_polygons[1].middle[0] - origin[0];
    for (k, polygon) in drawn_polygons.iter().enumerate() {
        let row = (k / 3) as f64;
        let column = (k % 3) as f64;
        let expected = [origin[0] + side * column, origin[1] - side * row];
        let error = [0, 1].map(|axis| (polygon.middle[axis] - expected[axis]).abs());
        assert!(error[0] < 2.5 && error[1] < 2.5, "{k}: {:?} {expected:?}", polygon.middle);
    }
    for word in ["m_x, kNm/m", "-400 to -300", "-100 to 0", "300 to 400", "x, m", "y, m"] {
        assert!(text.contains(word), "{word}");
    }
    // A value has one colour at every place, and zero is pale beside values of one sign only.
    assert_eq!(colors(&mesh, &[(0, 0.0), (1, 700.0)]), ["#FAF0DE", "#96141E"]);
    assert_eq!(colors(&mesh, &[(0, -700.0), (1, 0.0)])[0], "#143C8C");
    assert_eq!(colors(&mesh, &[(3, 0.0)]), ["#FAF0DE"]);
}

fn shell_plan_error(mesh: &Mesh, values: &[(usize, f64)]) -> Error {
    plot::shell_plan("M", "m", mesh, values).unwrap_err()
}

#[test]
fn values_without_a_shell_are_errors() {
    let mesh = model().mesh().clone();
    assert!(matches!(shell_plan_error(&mesh, &[]), Error::Size { .. }));
    let error_beyond_the_mesh = shell_plan_error(&mesh, &[(12, 0.0)]);
    assert!(matches!(error_beyond_the_mesh, Error::Index { index: 12, bound: 12, .. }));
    // A brick, and a beam.
    for element in [9, 10] {
        assert!(matches!(shell_plan_error(&mesh, &[(element, 0.0)]), Error::Part { .. }));
    }
    assert!(matches!(shell_plan_error(&mesh, &[(0, f64::NAN)]), Error::Input { .. }));
    assert!(matches!(shell_plan_error(&Mesh::new(), &[(0, 1.0)]), Error::Scene { .. }));
}
