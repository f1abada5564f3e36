//! Pictures of one value for each element: shells of a mat in plan, solids of a section in elevation.

use super::cells::{OUTLINE_COLOR, PictureCell, cell_picture};
use super::classes::Classes;
use super::drawing::is_drawable;
use super::key::KeySample;
use super::svg::Svg;
use crate::error::{Error, Result, at_least, in_bounds, require};
use crate::fem::{Element, Mesh};
use crate::geometry::span;

/// Approximate number of classes of the values of a section, which has steep gradients.
const SECTION_CLASSES: f64 = 10.0;

/// Picture of one value for each shell of a mat, seen from above.
///
/// `values` are pairs of an element of the mesh, by its index, and its value, such as the mean of a bending moment over
/// its corners ([`FemModel::shell_resultants`](crate::structure::FemModel::shell_resultants)). `quantity` is the name
/// and unit of the values, for the key. Every shell has the colour of its value, in classes on both sides of zero.
/// Other elements are not drawn.
///
/// ```
/// use basemat::fem::{Material, Mesh, Shell};
///
/// let concrete = Material::new(30.0e9, 0.2, 2500.0)?;
/// let mut mesh = Mesh::in_space();
/// let mat = mesh.add_grid(3, 4, |row, column| [2.0 * column as f64, 2.0 * row as f64, 0.0])?;
/// let mut moments = Vec::new();
/// for (k, (_, cell)) in mat.cells().enumerate() {
///     moments.push((mesh.add(Shell::new(cell, concrete, 0.6)?)?, 25.0 * k as f64 - 50.0));
/// }
/// let picture = basemat::plot::shell_plan("Mat", "m_x, kNm/m", &mesh, &moments)?;
/// assert!(picture.as_str().contains("m_x, kNm/m") && picture.as_str().contains("-40 to -20"));
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// [`Error::Scene`] for a mesh in the plane; [`Error::Size`] without values; [`Error::Index`] for an element that does
/// not exist; [`Error::Part`] for an element that is not a shell; [`Error::Input`] for a value that is not finite.
pub fn shell_plan(
    title: &str,
    quantity: &str,
    mesh: &Mesh,
    values: &[(usize, f64)],
) -> Result<Svg> {
    mesh.require_space("plan of shells")?;
    let classes = Classes::between(value_ends(values)?);
    let cells = value_cells(mesh, values, &classes, "shell")?;
    cell_picture(title, &cells, &value_key(quantity, &classes))
}

/// Picture of one value for each solid in the plane.
///
/// `values` are pairs of an element of the mesh, by its index, and its value, such as a plastic strain, the mobilised
/// strength or a stress: the mean over the element or its largest, as the caller chooses. `quantity` is the name and unit
/// of the values, for the key. Every element has the colour of its value, in classes on both sides of zero. Elements
/// without a value are drawn as their outlines, bars as lines.
///
/// ```
/// use basemat::fem::{Layer, Material, Mesh};
///
/// let sand = Layer::new(4.0, 2, Material::new(60.0e6, 0.3, 1800.0)?);
/// let mesh = Mesh::layered_block(-6.0..6.0, 3, &[sand])?;
/// // The upper of the two rows of elements, from the left to the right.
/// let strains = [(3, 0.02), (4, 0.11), (5, 0.04)];
/// let picture = basemat::plot::solid_section("Sand", "plastic strain, %", &mesh, &strains)?;
/// assert_eq!(picture.as_str().matches("<polygon").count(), 3);
/// assert!(picture.as_str().contains("plastic strain, %"));
/// assert!(picture.as_str().contains("0.10 to 0.12"));
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// [`Error::Scene`] for a mesh in space; [`Error::Size`] without values; [`Error::Index`] for an element that does not
/// exist; [`Error::Part`] for an element that is not a solid, or that has two values; [`Error::Input`] for a value that
/// is not finite.
pub fn solid_section(
    title: &str,
    quantity: &str,
    mesh: &Mesh,
    values: &[(usize, f64)],
) -> Result<Svg> {
    mesh.require_plane("section of solids")?;
    let classes = Classes::with_count(value_ends(values)?, SECTION_CLASSES);
    let mut cells = value_cells(mesh, values, &classes, "solid")?;
    let mut has_value = vec![false; mesh.elements().len()];
    for &(element_index, _) in values {
        if has_value[element_index] {
            return Err(Error::part(format!("element {element_index}"), "it has two values"));
        }
        has_value[element_index] = true;
    }
    for (element_index, element) in mesh.elements().enumerate() {
        let corners = outline_nodes(element);
        if !has_value[element_index] && corners.len() > 1 {
            cells.push(PictureCell {
                corners: node_coordinates(mesh, &corners),
                color: None,
                arrow: None,
            });
        }
    }
    let mut key = value_key(quantity, &classes);
    if cells[values.len()..].iter().any(|cell| !cell.is_bar()) {
        key.push(("without a value".to_owned(), KeySample::Outline(OUTLINE_COLOR)));
    }
    cell_picture(title, &cells, &key)
}

/// Smallest and largest of the values of elements and zero.
///
/// It is an error if there are no values, or if a value is not finite.
fn value_ends(values: &[(usize, f64)]) -> Result<[f64; 2]> {
    at_least("values of elements", values.len(), 1)?;
    for &(_, value) in values {
        let needed = "finite, and below 1e60 in magnitude";
        require("value of an element", value, is_drawable(value), needed)?;
    }
    Ok(span(values.iter().map(|pair| pair.1).chain([0.0])))
}

/// Elements in the colours of their values.
///
/// It is an error if an element does not exist, or is not of this `kind`.
fn value_cells(
    mesh: &Mesh,
    values: &[(usize, f64)],
    classes: &Classes,
    kind: &str,
) -> Result<Vec<PictureCell>> {
    let elements: Vec<&dyn Element> = mesh.elements().collect();
    let mut cells = Vec::with_capacity(values.len());
    for &(element_index, value) in values {
        in_bounds("element of the mesh", element_index, elements.len())?;
        let [face] = &elements[element_index].faces()[..] else {
            let reason = format!("it is not a {kind}");
            return Err(Error::part(format!("element {element_index}"), reason));
        };
        let corners = node_coordinates(mesh, face.corners());
        cells.push(PictureCell { corners, color: Some(classes.color(value)), arrow: None });
    }
    Ok(cells)
}

/// Key of the values: the quantity, then the classes.
fn value_key(quantity: &str, classes: &Classes) -> Vec<(String, KeySample)> {
    let mut key = vec![(quantity.to_owned(), KeySample::Nothing)];
    key.append(&mut classes.key(1.0, ""));
    key
}

/// Nodes around an element of the plane: the corners of its face, or the nodes of a bar.
fn outline_nodes(element: &dyn Element) -> Vec<usize> {
    match &element.faces()[..] {
        [face] => face.corners().to_vec(),
        _ => element.nodes().to_vec(),
    }
}

/// Coordinates (x, y) of nodes, m.
fn node_coordinates(mesh: &Mesh, nodes: &[usize]) -> Vec<(f64, f64)> {
    nodes.iter().map(|&node| (mesh.nodes()[node][0], mesh.nodes()[node][1])).collect()
}
