//! Structures with hysteretic springs.

use std::sync::Arc;

use basemat::structure::{Hysteresis, Row, WithSprings};
use pyo3::prelude::*;

use super::hysteresis::PyHysteresis;
use super::{PyStructure, recipe};
use crate::error::OrRaise;
use crate::recipe::Recipe;
use crate::row::RowLike;

/// A structure with hysteretic springs: pairs ``(row, law)``, each spring sees the deformation of
/// its row (m).
#[pyclass(name = "WithSprings", module = "basemat", extends = PyStructure, frozen)]
pub(crate) struct PyWithSprings;

#[pymethods]
impl PyWithSprings {
    #[new]
    fn new(
        structure: Bound<'_, PyAny>,
        springs: Vec<(RowLike, Bound<'_, PyHysteresis>)>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let structure = recipe(&structure)?;
        let unknowns = structure().or_raise()?.unknowns();
        let springs: Vec<(Row, Recipe<dyn Hysteresis>)> = springs
            .into_iter()
            .map(|(RowLike(row, order), law)| {
                order.check("the row of a spring", unknowns)?;
                Ok((row, law.get().make.clone()))
            })
            .collect::<PyResult<_>>()?;
        let make = move || {
            let mut own = WithSprings::new(structure()?);
            for (row, law) in &springs {
                own = own.spring(row, law()?)?;
            }
            Ok(Box::new(own) as Box<_>)
        };
        make().or_raise()?;
        Ok(PyClassInitializer::from(PyStructure { make: Arc::new(make) }).add_subclass(Self))
    }
}
