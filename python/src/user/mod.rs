//! Parts that users write in Python.

mod step_start;

pub(crate) use step_start::PyStepStart;
