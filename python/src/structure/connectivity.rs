//! Node numbers and properties of many elements at once.

use pyo3::prelude::*;

use crate::array::{Numbers, Points, Table};
use crate::error::refuse;
use crate::several::no_such;

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
    all: &'a [T],
    name: &str,
    index: usize,
    count: usize,
) -> PyResult<&'a T> {
    match all {
        [own] => Ok(own),
        all if all.len() == count => Ok(&all[index]),
        all => {
            let found = all.len();
            let needed = format!("must have one, or {count}: one for each element");
            Err(refuse(format!("{name} has {found} entries, but {needed}")))
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
fn node(value: f64) -> PyResult<usize> {
    if value < 0.0 || value.fract() != 0.0 {
        let needed = "must be a whole number of 0 or more";
        return Err(refuse(format!("node is {value}, but {needed}")));
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
    Ok(value as usize)
}

/// Node numbers of elements: anything that numpy takes for an array of shape (elements, nodes each).
pub(super) struct Connectivity {
    /// Nodes of an element.
    pub(super) each: usize,
    rows: Vec<Vec<usize>>,
}

extracts!(Connectivity, object => {
    // Read as floats: as integers, numpy would truncate fractions.
    let Table { columns, rows } = Table::read(&object, "(elements, nodes of each)")?;
    let rows = rows.into_iter().map(|row| row.into_iter().map(node).collect());
    Ok(Self { each: columns, rows: rows.collect::<PyResult<_>>()? })
});

impl Connectivity {
    pub(super) fn rows<const N: usize>(&self) -> PyResult<Vec<[usize; N]>> {
        let nodes = |row: &Vec<usize>| {
            <[usize; N]>::try_from(row.as_slice()).map_err(|_| {
                refuse(format!("elements have {} nodes, but must have {N}", self.each))
            })
        };
        self.rows.iter().map(nodes).collect()
    }
}

/// Node numbers of elements that may have different numbers of nodes: an array, or a list of lists.
pub(super) struct Cells(pub(super) Vec<Vec<usize>>);

extracts!(Cells, object => {
    if object.hasattr("shape")? {
        return Ok(Self(object.extract::<Connectivity>()?.rows));
    }
    let needed = "a list of lists of node numbers, or an array of shape (elements, nodes of each)";
    let cells = object.try_iter().map_err(|_| no_such(&object, needed))?;
    let cell = |own: PyResult<Bound<'_, PyAny>>| {
        let own = own?;
        if let Ok(nodes) = own.extract::<Vec<usize>>() {
            return Ok(nodes);
        }
        let Numbers(nodes) = own.extract()?;
        nodes.into_iter().map(node).collect()
    };
    cells.map(cell).collect::<PyResult<_>>().map(Self)
});
