//! Node numbers and properties of many elements at once.

use pyo3::prelude::*;

use crate::array::{Numbers, Points, Table};
use crate::error::input_error;
use crate::several::type_error;

/// Number for all elements, or one each.
pub(super) struct PerElement(Vec<f64>);

extracts!(PerElement, object => match object.extract::<f64>() {
    Ok(value) => Ok(Self(vec![value])),
    Err(_) => Ok(Self(object.extract::<Numbers>()?.0)),
});

impl PerElement {
    /// Value for the element `index` out of `count`.
    ///
    /// An error calls the argument by its `name`.
    pub(super) fn at(&self, name: &str, index: usize, count: usize) -> PyResult<f64> {
        Ok(*one_of(&self.0, name, index, count)?)
    }
}

/// Entry of a list for the element `index` out of `count`.
///
/// A list of one entry holds for all elements. An error calls the list by its `name`.
pub(super) fn one_of<'a, T>(
    entries: &'a [T],
    name: &str,
    index: usize,
    count: usize,
) -> PyResult<&'a T> {
    match entries {
        [common] => Ok(common),
        entries if entries.len() == count => Ok(&entries[index]),
        entries => {
            let found = entries.len();
            let needed = format!("must have one, or {count}: one for each element");
            Err(input_error(format!("{name} has {found} entries, but {needed}")))
        }
    }
}

/// A vector for all elements, or one each: an array of shape (3,) or (elements, 3).
pub(super) struct Vectors(pub(super) Vec<[f64; 3]>);

extracts!(Vectors, object => match object.extract::<[f64; 3]>() {
    Ok(vector) => Ok(Self(vec![vector])),
    Err(_) => Ok(Self(object.extract::<Points>()?.in_space()?)),
});

/// Number of a node, which numpy may have as a float.
fn node_number(value: f64) -> PyResult<usize> {
    if value < 0.0 || value.fract() != 0.0 {
        let needed = "must be a whole number of 0 or more";
        return Err(input_error(format!("node is {value}, but {needed}")));
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
    Ok(value as usize)
}

/// Node numbers of elements: anything that numpy takes for an array of shape (elements, nodes each).
pub(super) struct Connectivity {
    /// Number of nodes of an element.
    pub(super) nodes_each: usize,
    rows: Vec<Vec<usize>>,
}

extracts!(Connectivity, object => {
    // Read as floats: as integers, numpy would truncate fractions.
    let Table { columns, rows } = Table::read(&object, "(elements, nodes of each)")?;
    let rows = rows.into_iter().map(|row| row.into_iter().map(node_number).collect());
    Ok(Self { nodes_each: columns, rows: rows.collect::<PyResult<_>>()? })
});

impl Connectivity {
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
    let needed = "a list of lists of node numbers, or an array of shape (elements, nodes of each)";
    let cells = object.try_iter().map_err(|_| type_error(&object, needed))?;
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
