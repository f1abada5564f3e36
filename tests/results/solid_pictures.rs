//! GOAL: pictures of solids have units and a key, show values where they belong, and return errors for others.
//! SCENE: loops of two points; a block of two layers with a bar, a mass and an eight-node quadrilateral.
//! REFERENCE: the tags and texts of the SVG, laid out here.

use basemat::fem::{Beam, Layer, LumpedMass, Material, Mesh, Quad8};
use basemat::plot::{self, Svg};
use basemat::{Error, Result};

use super::plot::shows;

/// Colours of the smallest and of the largest class of values above zero.
const CLASS_COLORS: [&str; 2] = ["#FAF0DE", "#96141E"];
/// Colour of elements without a value.
const OUTLINE_COLOR: &str = "#B9B9B9";

/// A loop from rest between ± 0.4 % and ± 30 kPa.
const SAND_LOOP: [[f64; 2]; 5] =
    [[0.0, 0.0], [4e-3, 30e3], [2e-3, -5e3], [-4e-3, -30e3], [-2e-3, 5e3]];

fn attribute<'t>(tag: &'t str, name: &str) -> &'t str {
    tag.split(&format!(" {name}=\"")).nth(1).unwrap().split('"').next().unwrap()
}

/// Pairs of numbers of a tag, pixels.
fn points(tag: &str) -> Vec<[f64; 2]> {
    let mut points = Vec::new();
    for pair in attribute(tag, "points").split_whitespace() {
        let (x, y) = pair.split_once(',').unwrap();
        points.push([x.parse().unwrap(), y.parse().unwrap()]);
    }
    points
}

/// Tags with this name, such as `<polygon`.
fn tags<'t>(svg: &'t Svg, name: &str) -> Vec<&'t str> {
    svg.as_str()
        .split(name)
        .skip(1)
        .map(|rest| rest.split('>').next().unwrap())
        .collect()
}

/// x or y (0 or 1) of the text of a mark, pixels.
fn mark_place(svg: &Svg, axis: usize, mark: &str) -> f64 {
    let texts = svg.as_str().split("<text").skip(1).filter_map(|text| {
        let (tag, rest) = text.split_once('>')?;
        let places: [f64; 2] = ["x", "y"].map(|name| attribute(tag, name).parse().unwrap());
        // Marks of x stand below the chart, those of y at its left.
        let is_of_axis = if axis == 0 { places[1] > 490.0 } else { places[0] < 104.0 };
        (is_of_axis && rest.split('<').next()?.trim() == mark).then(|| places[axis])
    });
    texts.last().unwrap_or_else(|| panic!("no mark {mark}"))
}

#[test]
fn loops_pass_their_strains_and_stresses() {
    let small_loop = SAND_LOOP.map(|state| state.map(|value| 0.1 * value));
    let paths = [("3 m deep", &SAND_LOOP[..]), ("10 m deep", &small_loop[..])];
    let picture = plot::stress_strain("Sand < 5 m", &paths).unwrap();
    let needed = ["Sand &lt; 5 m", "shear strain, %", "shear stress, kPa", "3 m deep", "10 m deep"];
    shows(&picture, &needed);
    let lines = tags(&picture, "<polyline");
    let drawn_loop = lines.iter().map(|tag| points(tag)).find(|line| line.len() == 5).unwrap();
    let zero = [mark_place(&picture, 0, "0"), mark_place(&picture, 1, "0")];
    let pixels_per_percent = (mark_place(&picture, 0, "0.4") - zero[0]) / 0.4;
    let pixels_per_kilopascal = (mark_place(&picture, 1, "30") - zero[1]) / 30.0;
    // Texts stand beside the marks, at an offset that all marks share.
    let [rest_x, rest_y] = drawn_loop[0];
    for ([x, y], [strain, stress]) in drawn_loop.iter().zip(SAND_LOOP) {
        assert!((x - rest_x - pixels_per_percent * 100.0 * strain).abs() < 2.0, "{x} {strain}");
        assert!((y - rest_y - pixels_per_kilopascal * 1e-3 * stress).abs() < 2.0, "{y} {stress}");
    }
    assert!((rest_x - zero[0]).abs() < 2.0 && pixels_per_kilopascal < 0.0);
    // Strains below 0.1 % are in thousandths.
    let small_strains = plot::stress_strain("T", &[("rest", &small_loop)]).unwrap();
    shows(&small_strains, &["shear strain, 10⁻³", "0.4", "-0.4", "shear stress, kPa"]);
}

#[test]
fn loops_with_a_fault_are_errors() {
    assert!(matches!(plot::stress_strain("T", &[]), Err(Error::Size { found: 0, .. })));
    let fault = |path: &[[f64; 2]]| {
        let paths = [("sound", &SAND_LOOP[..]), ("3 m deep", path)];
        match plot::stress_strain("T", &paths).unwrap_err() {
            Error::Item { item, source } => {
                assert!(item.contains("3 m deep"), "{item}");
                *source
            }
            error => panic!("{error}"),
        }
    };
    assert!(matches!(fault(&[]), Error::Size { found: 0, needed: 1, .. }));
    for value in [f64::NAN, f64::INFINITY, -1e60] {
        let error = fault(&[[0.0, 0.0], [value, 1.0]]);
        assert!(matches!(error, Error::Input { quantity: "shear strain", .. }), "{error}");
        let error = fault(&[[0.0, value]]);
        assert!(matches!(error, Error::Input { quantity: "shear stress", .. }), "{error}");
    }
}

fn soil() -> Material {
    Material::new(60e6, 0.3, 1800.0).unwrap()
}

/// Six quadrilaterals of 4 m by 2 m (0 to 5), a bar (6) with a mass (7), and an eight-node quadrilateral (8) of 2 m by 2 m.
fn section() -> Mesh {
    let mut mesh = Mesh::layered_block(-6.0..6.0, 3, &[Layer::new(4.0, 2, soil())]).unwrap();
    let foot = mesh.node_at(-2.0, 4.0).unwrap();
    let top = mesh.add_node(-2.0, 7.0).unwrap();
    mesh.add(Beam::new([foot, top], 3e10, 0.4, 0.01, 2400.0).unwrap()).unwrap();
    mesh.add(LumpedMass::new(top, 5000.0).unwrap()).unwrap();
    let places = [
        [6.0, 4.0],
        [8.0, 4.0],
        [8.0, 6.0],
        [6.0, 6.0],
        [7.0, 4.0],
        [8.0, 5.0],
        [7.0, 6.0],
        [6.0, 5.0],
    ];
    let nodes = places.map(|[x, y]| mesh.add_node(x, y).unwrap());
    mesh.add(Quad8::new(nodes, soil())).unwrap();
    mesh
}

fn middle(corners: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|axis| corners.iter().map(|corner| corner[axis]).sum::<f64>() / corners.len() as f64)
}

#[test]
fn solids_have_the_colours_of_their_values() {
    let mesh = section();
    // The lower row has no values; the eight-node quadrilateral has the largest value.
    let values = [(3, 0.0), (4, 0.31), (5, 0.7), (8, 1.0 + f64::EPSILON)];
    let picture = plot::solid_section("Sand", "mobilised strength", &mesh, &values).unwrap();
    let classes = ["0 to 0.1", "0.1 to 0.2", "0.3 to 0.4", "0.9 to 1.0"];
    shows(&picture, &["Sand", "mobilised strength", "x, m", "y, m", "without a value"]);
    shows(&picture, &classes);
    let areas = tags(&picture, "<polygon");
    let colors: Vec<&str> = areas.iter().map(|tag| attribute(tag, "fill")).collect();
    assert_eq!((colors.len(), colors[0], colors[3]), (4, CLASS_COLORS[0], CLASS_COLORS[1]));
    assert!(colors[1] != colors[0] && colors[1] != colors[2] && colors[2] != colors[3]);
    assert!(!picture.as_str().contains("1.0 to 1.1"));
    // Middles in pixels, at one scale in both directions; y points up.
    let middles: Vec<[f64; 2]> = areas.iter().map(|tag| middle(&points(tag))).collect();
    let pixels_per_metre = (middles[1][0] - middles[0][0]) / 4.0;
    for (middle, place) in middles.iter().zip([[-4.0, 3.0], [0.0, 3.0], [4.0, 3.0], [7.0, 5.0]]) {
        let expected = [
            middles[0][0] + pixels_per_metre * (place[0] + 4.0),
            middles[0][1] - pixels_per_metre * (place[1] - 3.0),
        ];
        let distance = (middle[0] - expected[0]).hypot(middle[1] - expected[1]);
        assert!(distance < 2.5, "{middle:?} {expected:?}");
    }
    // Three outlines; the bar is darker, and the mass is not drawn.
    let outlines = tags(&picture, "<polyline")
        .iter()
        .filter(|tag| attribute(tag, "stroke") == OUTLINE_COLOR)
        .count();
    assert_eq!(outlines, 3);
    let bars = tags(&picture, "<polyline")
        .iter()
        .filter(|tag| attribute(tag, "stroke") == "#464646")
        .count();
    assert_eq!(bars, 1);
    // The class of the smallest values is below zero if these values are.
    let signed = plot::solid_section("T", "stress, kPa", &mesh, &[(0, -30.0), (1, 12.0)]).unwrap();
    shows(&signed, &["-30 to -25", "10 to 15"]);
    let all_values: Vec<(usize, f64)> =
        [0, 1, 2, 3, 4, 5, 8].map(|element| (element, 2e-4)).to_vec();
    let complete_picture = plot::solid_section("T", "strain", &mesh, &all_values).unwrap();
    assert!(!complete_picture.as_str().contains("without a value"));
    shows(&complete_picture, &["1.8e-4 to 2.0e-4"]);
}

fn section_error(mesh: &Mesh, values: &[(usize, f64)]) -> Error {
    let picture: Result<Svg> = plot::solid_section("T", "strain", mesh, values);
    picture.unwrap_err()
}

#[test]
fn values_without_a_solid_are_errors() {
    let mesh = section();
    assert!(matches!(section_error(&mesh, &[]), Error::Size { found: 0, needed: 1, .. }));
    let error_of_a_missing_element = section_error(&mesh, &[(0, 1.0), (9, 1.0)]);
    assert!(matches!(error_of_a_missing_element, Error::Index { index: 9, bound: 9, .. }));
    // A bar, a mass, and an element with two values.
    for values in [[(6, 1.0)], [(7, 1.0)]] {
        assert!(section_error(&mesh, &values).to_string().contains("not a solid"));
    }
    let error_of_a_second_value = section_error(&mesh, &[(2, 1.0), (3, 1.0), (2, 1.0)]);
    assert!(
        matches!(&error_of_a_second_value, Error::Part { part, .. } if part == "element 2"),
        "{error_of_a_second_value}"
    );
    for value in [f64::NAN, f64::NEG_INFINITY, 1e70] {
        let error = section_error(&mesh, &[(0, value)]);
        assert!(matches!(error, Error::Input { quantity: "value of an element", .. }), "{error}");
    }
    let in_space = section_error(&Mesh::in_space(), &[(0, 1.0)]);
    assert!(matches!(in_space, Error::Scene { quantity: "section of solids", .. }));
}
