//! Node numbers and properties of many elements at once.

use pyo3::prelude::*;

use crate::array::{Numbers, Points, Table};
use crate::error::input_error;
use crate::list_arguments::type_error;

/// One number for all elements, or one for each.
pub(super) struct PerElement(Vec<f64>);

extracts!(PerElement, object => match object.extract::<f64>() {
    Ok(value) => Ok(Self(vec![value])),
    Err(_) => Ok(Self(object.extract::<Numbers>()?.0)),
});

impl PerElement {
    /// Value for an `element` out of `element_count`.
    ///
    /// An error calls the argument by its `name`.
    pub(super) fn at(&self, name: &str, element: usize, element_count: usize) -> PyResult<f64> {
        Ok(*one_of(&self.0, name, element, element_count)?)
    }
}

/// Entry of a list for an `element` out of `element_count`.
///
/// The only entry of a list is the one for all elements. An error calls the list by its `name`.
pub(super) fn one_of<'a, T>(
    entries: &'a [T],
    name: &str,
    element: usize,
    element_count: usize,
) -> PyResult<&'a T> {
    match entries {
        [common_entry] => Ok(common_entry),
        entries if entries.len() == element_count => Ok(&entries[element]),
        entries => {
            let entry_count = entries.len();
            let requirement = format!("must have one, or {element_count}: one for each element");
            Err(input_error(format!("{name} has {entry_count} entries, but {requirement}")))
        }
    }
}

/// One vector for all elements, or one for each: an array of shape (3,) or (elements, 3).
pub(super) struct Vectors(pub(super) Vec<[f64; 3]>);

extracts!(Vectors, object => match object.extract::<[f64; 3]>() {
    Ok(vector) => Ok(Self(vec![vector])),
    Err(_) => Ok(Self(object.extract::<Points>()?.in_space()?)),
});

/// Number of a node that numpy may return as a float.
fn node_number(value: f64) -> PyResult<usize> {
    if value < 0.0 || value.fract() != 0.0 {
        let requirement = "must be a whole number of 0 or more";
        return Err(input_error(format!("node is {value}, but {requirement}")));
    }
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a whole number of 0 or more"
    )]
    Ok(value as usize)
}

/// Node numbers of elements: anything that numpy converts to an array of shape (elements, nodes each).
pub(super) struct Connectivity {
    /// Number of nodes of an element.
    pub(super) nodes_each: usize,
    rows: Vec<Vec<usize>>,
}

extracts!(Connectivity, object => {
    // Read as floats: as integers, numpy would truncate fractions.
    let Table { column_count, rows: number_rows } = Table::read(&object, "(elements, nodes of each)")?;
    let rows = number_rows.into_iter().map(|row| row.into_iter().map(node_number).collect());
    Ok(Self { nodes_each: column_count, rows: rows.collect::<PyResult<_>>()? })
});

impl Connectivity {
    /// Node numbers of each element; an error unless elements have `N` nodes.
    pub(super) fn rows<const N: usize>(&self) -> PyResult<Vec<[usize; N]>> {
        let nodes = self.rows.iter().map(|row| <[usize; N]>::try_from(row.as_slice()));
        nodes.collect::<Result<_, _>>().map_err(|_| {
            input_error(format!("elements have {} nodes, but must have {N}", self.nodes_each))
        })
    }
}

/// Node numbers of elements that may have different numbers of nodes: an array, or a list of lists.
pub(super) struct Cells(pub(super) Vec<Vec<usize>>);

extracts!(Cells, object => {
    if object.hasattr("shape")? {
        return Ok(Self(object.extract::<Connectivity>()?.rows));
    }
    let requirement = "a list of lists of node numbers, or an array of shape (elements, nodes of each)";
    let cells = object.try_iter().map_err(|_| type_error(&object, requirement))?;
    cells.map(|cell| cell_nodes(&cell?)).collect::<PyResult<_>>().map(Self)
});

/// Node numbers of one element.
fn cell_nodes(cell: &Bound<'_, PyAny>) -> PyResult<Vec<usize>> {
    if let Ok(nodes) = cell.extract::<Vec<usize>>() {
        return Ok(nodes);
    }
    let Numbers(nodes) = cell.extract()?;
    nodes.into_iter().map(node_number).collect()
}
