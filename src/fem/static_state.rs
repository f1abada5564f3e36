//! Elements in the static state of their mesh.

use super::mesh::Mesh;
use super::numbering::Numbering;
use crate::error::Result;

/// Lets every element of `mesh` take the static state; `displacement` (m, rad) in the unknowns of
/// `numbering`, `gravity` in m/s².
///
/// # Errors
/// [`Error::Scene`](crate::Error::Scene) for an element that would then have other nodes or
/// directions.
pub(crate) fn set_static_state(
    mesh: &mut Mesh,
    numbering: &Numbering,
    displacement: &[f64],
    gravity: f64,
) -> Result<()> {
    let mut indices = Vec::new();
    mesh.replace_elements(|element, points| {
        numbering.of_element(element, &mut indices);
        let value = |&index: &usize| displacement.get(index).copied().unwrap_or(0.0);
        let own: Vec<f64> = indices.iter().map(value).collect();
        element.in_static_state(points, &own, gravity)
    })
}
