//! Static push-over of the scene of a simulation.

use basemat::analyses::push_over_by_displacement;
use basemat::structure::Base;
use pyo3::prelude::*;

use super::PySimulation;
use super::run_reporter::step_result;
use crate::array::Numbers;
use crate::error::take_exception;
use crate::results::PyPushOver;
use crate::row::RowLike;

#[pymethods]
impl PySimulation {
    /// The `PushOver` of this scene from its start: static states with growing displacements, through the largest load.
    ///
    /// Weight and the loads at t = 0 act first and stay constant; the motion has no effect. Forces ``pattern`` times a load
    /// factor follow, which the displacement of ``control`` determines. Uplift, slip, yielding and P–Δ are those of the scene.
    /// The states are a path, so that unloading and cycles are right. An increment without equilibrium is halved up to eight
    /// times; then the curve ends, and `PushOver.cause` says why. The state of this simulation is unchanged.
    ///
    /// Args:
    ///     pattern: forces at a load factor of 1, a `DofCombination` or its ``terms``: a degree of freedom, or for a pattern
    ///         over the height the sum of the floors' rows times their weights.
    ///     control: the displacement that is prescribed, a `DofCombination` or its ``terms``. A half-plane has no datum for
    ///         displacements: control a drift or a rotation there. In plan it must be the pattern.
    ///     displacements: values of the control relative to the state under weight and loads, array of shape (n,), m or rad.
    ///         They may grow, fall and change their sign.
    fn push_over_by_displacement(
        &self,
        py: Python<'_>,
        pattern: RowLike,
        control: RowLike,
        displacements: Numbers,
    ) -> PyResult<PyPushOver> {
        let in_plan = {
            let simulation = self.lock()?;
            let dof_count = simulation.structure().dofs();
            pattern.1.check("the pattern", dof_count)?;
            control.1.check("the control", dof_count)?;
            matches!(simulation.structure().base(), Base::Faces(_))
        };
        take_exception();
        let curve = py.detach(|| {
            let parts = Python::attach(|py| self.parts.builder_parts(py))?;
            let builder = parts.builder;
            step_result(push_over_by_displacement(
                builder,
                &pattern.0,
                &control.0,
                &displacements.0,
            ))
        })?;
        Ok(PyPushOver::new(curve, in_plan))
    }
}
