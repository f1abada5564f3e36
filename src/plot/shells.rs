//! Pictures of the values of shells on a plan, such as the bending moments of a mat.

use super::classes::Classes;
use super::key::KeySample;
use super::plan::{PlanCell, plan_picture};
use super::svg::Svg;
use crate::error::{Error, Result, at_least, finite, in_bounds, require_part};
use crate::fem::{Element, Mesh};
use crate::geometry::span;

/// Picture of one value for each shell of a mat, seen from above.
///
/// `values` are pairs of an element of the mesh, by its index, and its value, such as the mean of a bending moment over
/// its corners ([`FemModel::shell_resultants`](crate::structure::FemModel::shell_resultants)). `quantity` is the name
/// and unit of the values, for the key. Every shell has the colour of its value, in classes on both sides of zero; other elements
/// are not drawn.
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
    require_part(
        "plan of shells",
        mesh.has_depth(),
        "must be in a mesh in space, but this one is in the plane",
    )?;
    at_least("values of shells", values.len(), 1)?;
    for &(_, value) in values {
        finite("value of a shell", value)?;
    }
    let classes = Classes::between(span(values.iter().map(|pair| pair.1).chain([0.0])));
    let mut cells = Vec::with_capacity(values.len());
    for &(element_index, value) in values {
        let corners = shell_corners(mesh, element_index)?;
        cells.push(PlanCell { corners, color: classes.color(value), arrow: None });
    }
    let mut key = vec![(quantity.to_owned(), KeySample::Nothing)];
    key.append(&mut classes.key(1.0, ""));
    plan_picture(title, &cells, &key)
}

/// Corners (x, y) of a shell; an error for any other element.
fn shell_corners(mesh: &Mesh, element_index: usize) -> Result<Vec<(f64, f64)>> {
    in_bounds("element of the mesh", element_index, mesh.elements().len())?;
    let faces = mesh.elements().nth(element_index).map_or_else(Vec::new, Element::faces);
    let [shell] = &faces[..] else {
        return Err(Error::part(
            format!("element {element_index}"),
            "it is not a shell".to_owned(),
        ));
    };
    let mut corners = Vec::new();
    for &node in shell.corners() {
        corners.push((mesh.nodes()[node][0], mesh.nodes()[node][1]));
    }
    Ok(corners)
}
