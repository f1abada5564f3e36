//! Structures with hysteretic springs.

use std::sync::Arc;

use basemat::structure::{DofCombination, Hysteresis, WithSprings};
use pyo3::prelude::*;

use super::hysteresis::LawLike;
use super::{PyStructure, recipe};
use crate::dof_names::DofNames;
use crate::error::OrRaise;
use crate::recipe::Recipe;
use crate::row::RowLike;

/// A ``structure`` with hysteretic ``springs``: a list of pairs ``(row, law)``, of a row of degrees of
/// freedom, which is the spring's deformation (m), and a :class:`Hysteresis` or :class:`UserHysteresis`.
#[pyclass(name = "WithSprings", module = "basemat", extends = PyStructure, frozen)]
pub(crate) struct PyWithSprings;

#[pymethods]
impl PyWithSprings {
    #[new]
    fn new(
        structure: Bound<'_, PyAny>,
        springs: Vec<(RowLike, LawLike)>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let (object, structure) = (structure.clone(), recipe(&structure)?);
        let dofs = structure().or_raise()?.dofs();
        let names = DofNames::of(&object, dofs)?;
        let springs: Vec<(DofCombination, Recipe<dyn Hysteresis>)> = springs
            .into_iter()
            .map(|(RowLike(row, order), LawLike(law))| {
                order.check("the row of a spring", dofs)?;
                Ok((row, law))
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
        let base = PyStructure::new(Arc::new(make)).named(names);
        Ok(PyClassInitializer::from(base).add_subclass(Self))
    }
}
