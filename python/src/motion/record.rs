//! Records of ground acceleration, their files, and response spectra.

use std::path::PathBuf;
use std::sync::Arc;

use basemat::motion::{Baseline, Record};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::PyFreeField;
use super::record_file::{FileOptions, unit_of};
use super::spectrum::{PySpectrum, coarse_period_warnings};
use crate::array::{Array, Numbers, whole_numbers};
use crate::error::{OrRaise, input_error};
use crate::ticker::with_progress;

/// Ground acceleration at equal time steps, linear between samples; velocity and displacement are
/// its exact integrals from rest.
///
/// ``time_step`` in s, ``acceleration`` an array of shape (samples,), at least two, in ``unit``: "m/s²" (the default),
/// "mm/s²", "g", "gal", "ft/s²" or "in/s²". As the motion of a simulation it is horizontal and the same everywhere.
#[pyclass(name = "Record", module = "basemat", extends = PyFreeField, frozen)]
pub(crate) struct PyRecord(pub(crate) Arc<Record>);

extends!(PyRecord, record => {
    let shared_record = Arc::clone(&record.0);
    PyFreeField {
        duration: Some(shared_record.duration()),
        make: Arc::new(move || Ok(Box::new(Record::clone(&shared_record)))),
        wave: None,
    }
});

impl PyRecord {
    /// The object of Python for a record of the core.
    pub(crate) fn from_core(record: basemat::Result<Record>) -> PyResult<Self> {
        Ok(Self(Arc::new(record.or_raise()?)))
    }
}

/// The `Record` of El Centro 1940, north–south.
///
/// Peknold's version with a peak of 0.319 g: 31.18 s with a time step of 0.02 s.
#[pyfunction]
pub(crate) fn el_centro_1940() -> PyResult<PyRecord> {
    PyRecord::from_core(Ok(basemat::motion::el_centro_1940()))
}

#[pymethods]
impl PyRecord {
    // Python's reader of signatures accepts ASCII only.
    #[pyo3(
        signature = (time_step, acceleration, *, unit="m/s²"),
        text_signature = r#"(time_step, acceleration, *, unit="m/s\xb2")"#
    )]
    #[new]
    fn new(
        time_step: f64,
        acceleration: Numbers,
        unit: &str,
    ) -> PyResult<PyClassInitializer<Self>> {
        let sample_count = acceleration.0.len();
        if sample_count < 2 {
            return Err(input_error(format!(
                "acceleration has {sample_count} samples, but must have 2 or more"
            )));
        }
        let unit_factor = unit_of(unit)?.in_metres_per_second_squared();
        let samples = acceleration.0.into_iter().map(|value| value * unit_factor).collect();
        Self::from_core(Record::new(time_step, samples))?.initializer()
    }

    /// Time step, s.
    #[getter]
    fn time_step(&self) -> f64 {
        self.0.time_step()
    }

    /// Time of the last sample, s.
    #[getter]
    fn duration(&self) -> f64 {
        self.0.duration()
    }

    /// Times of the samples: array of shape (samples,), s.
    #[getter]
    fn times(&self) -> Array {
        (0..self.0.len()).map(|sample| sample as f64 * self.0.time_step()).collect()
    }

    /// Acceleration at the samples: array of shape (samples,), m/s².
    #[getter]
    fn accelerations(&self) -> Array {
        self.0.accelerations().into()
    }

    /// Velocity at the samples: array of shape (samples,), m/s.
    #[getter]
    fn velocities(&self) -> Array {
        self.0.velocities().into()
    }

    /// Displacement at the samples: array of shape (samples,), m.
    #[getter]
    fn displacements(&self) -> Array {
        self.0.displacements().into()
    }

    /// Largest |acceleration|, m/s².
    #[getter]
    fn peak_acceleration(&self) -> f64 {
        self.0.peaks().acceleration
    }

    /// Largest |velocity|, m/s.
    #[getter]
    fn peak_velocity(&self) -> f64 {
        self.0.peaks().velocity
    }

    /// Largest |displacement|, m.
    #[getter]
    fn peak_displacement(&self) -> f64 {
        self.0.peaks().displacement
    }

    /// Arias intensity, m/s.
    #[getter]
    fn arias_intensity(&self) -> f64 {
        self.0.arias_intensity()
    }

    /// Reads a file at ``path``.
    ///
    /// ``format``: "columns" (the default: columns of text with the time, in s or as a time of day, and the
    /// acceleration), "along_lines" (several values on a line: SHAKE, OpenSees), "peer" (.AT2), "cosmos" (.V2, COSMOS
    /// and CSMIP), "k_net" (K-NET and KiK-net), "k_net_csv", "esm" (ESM and ITACA), "afad", "slist" (ObsPy), "smc" or
    /// "geonet". ``unit``: unit of the acceleration, as for the class. It is needed for "columns" and "along_lines",
    /// and for files of "cosmos" and "slist" that do not name it; files of other formats have a fixed unit.
    ///
    /// For "columns", ``columns`` are the numbers of the columns of time and acceleration, counted from 1, (1, 2)
    /// unless given. If ``time_step`` (s) is given, the times are ignored, and the file must have one column unless
    /// ``columns`` is given. "along_lines" needs the ``time_step``; ``layout`` is the Fortran format of the lines, such
    /// as "8F9.6", none unless given. For both formats ``header_lines`` at the beginning are skipped, and it is an
    /// error if the number of samples is not ``samples``, if given.
    ///
    /// ``channel`` is the number of the component from 1, for formats with several components in a file ("cosmos",
    /// "k_net_csv", "afad", "geonet", "slist").
    #[staticmethod]
    #[pyo3(signature = (
        path, *, format="columns", unit=None, time_step=None, columns=None, channel=None, header_lines=None,
        samples=None, layout=None
    ))]
    fn read(
        path: PathBuf,
        format: &str,
        unit: Option<&str>,
        time_step: Option<f64>,
        #[pyo3(from_py_with = whole_numbers)] columns: Option<[usize; 2]>,
        #[pyo3(from_py_with = whole_numbers)] channel: Option<usize>,
        #[pyo3(from_py_with = whole_numbers)] header_lines: Option<usize>,
        #[pyo3(from_py_with = whole_numbers)] samples: Option<usize>,
        layout: Option<&str>,
    ) -> PyResult<Self> {
        let options =
            FileOptions { unit, time_step, columns, channel, header_lines, samples, layout };
        Self::from_core(Record::read(path, options.reader(format)?.as_ref()))
    }

    /// Reads all components of the file at ``path``, such as the three directions of a station: a
    /// dict from the name of each to its `Record`, in the order of the file.
    ///
    /// ``format``, ``unit``, ``time_step`` and ``header_lines`` are as for `read`, none unless given. Of a file of
    /// columns, all columns except the column of times are read.
    #[staticmethod]
    #[pyo3(signature = (path, *, format="columns", unit=None, time_step=None, header_lines=None))]
    fn read_all<'py>(
        py: Python<'py>,
        path: PathBuf,
        format: &str,
        unit: Option<&str>,
        time_step: Option<f64>,
        #[pyo3(from_py_with = whole_numbers)] header_lines: Option<usize>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let options = FileOptions { unit, time_step, header_lines, ..FileOptions::default() };
        let components = Record::read_all(path, options.reader(format)?.as_ref()).or_raise()?;
        let records = PyDict::new(py);
        for (name, record) in components {
            records.set_item(name, Self::from_core(Ok(record))?)?;
        }
        Ok(records)
    }

    /// The two times (s) at which the fractions ``start`` and ``end`` of the Arias intensity are reached,
    /// by default 0.05 and 0.95: between them is the significant duration.
    #[pyo3(signature = (start=0.05, end=0.95))]
    fn significant_times(&self, start: f64, end: f64) -> PyResult<[f64; 2]> {
        self.0.significant_times(start, end).or_raise()
    }

    /// Record with all samples multiplied by a ``factor``.
    fn scaled(&self, factor: f64) -> PyResult<Self> {
        Self::from_core(self.0.scaled(factor))
    }

    /// Record scaled to a ``peak`` acceleration (m/s²); signs stay the same.
    fn scaled_to_peak(&self, peak: f64) -> PyResult<Self> {
        Self::from_core(self.0.scaled_to_peak(peak))
    }

    /// Record with samples every ``time_step`` (s), interpolated linearly between the present samples.
    fn resampled(&self, time_step: f64) -> PyResult<Self> {
        Self::from_core(self.0.resampled(time_step))
    }

    /// Record with a corrected baseline. ``treatment``: "remove_mean", "newmark_parabola", "velocity_polynomial",
    /// "displacement_polynomial" or "rest_to_rest"; polynomials have the ``degree``, 4 by default.
    #[pyo3(signature = (treatment, *, degree=4))]
    fn with_baseline(
        &self,
        treatment: &str,
        #[pyo3(from_py_with = whole_numbers)] degree: usize,
    ) -> PyResult<Self> {
        Self::from_core(self.0.with_baseline(baseline(treatment, degree)?))
    }

    /// Record filtered at a ``corner`` frequency (Hz): a high-pass Butterworth filter of ``order`` (1 to 8; 4 by
    /// default), applied forwards and backwards, so that phases do not shift.
    ///
    /// Rest of 1.5 ``order / corner`` s is added before and after the record, 30 s each for a corner of 0.2 Hz, since
    /// the filter changes the motion there. Do not remove this rest: without it velocity and displacement do not return
    /// to zero.
    #[pyo3(signature = (corner, *, order=4))]
    fn high_pass(
        &self,
        corner: f64,
        #[pyo3(from_py_with = whole_numbers)] order: u32,
    ) -> PyResult<Self> {
        Self::from_core(self.0.high_pass(corner, order))
    }

    /// Record filtered at a ``corner`` frequency (Hz): a low-pass Butterworth filter of ``order`` (1 to 8; 4 by
    /// default), applied forwards and backwards, so that phases do not shift; rest is added as by `high_pass`. Use it
    /// before a deconvolution (`SoilColumn.from_surface`).
    #[pyo3(signature = (corner, *, order=4))]
    fn low_pass(
        &self,
        corner: f64,
        #[pyo3(from_py_with = whole_numbers)] order: u32,
    ) -> PyResult<Self> {
        Self::from_core(self.0.low_pass(corner, order))
    }

    /// Record tapered over the durations ``beginning`` and ``end`` (s) at its two ends.
    fn tapered(&self, beginning: f64, end: f64) -> PyResult<Self> {
        Self::from_core(self.0.tapered(beginning, end))
    }

    /// Record with rest of ``before`` and ``after`` (s) at its two ends.
    fn padded(&self, before: f64, after: f64) -> PyResult<Self> {
        Self::from_core(self.0.padded(before, after))
    }

    /// Elastic response `Spectrum` at ``periods`` (array of shape (m,), s) with the damping ratio
    /// ``damping`` (0.05 by default).
    #[pyo3(signature = (periods, damping=0.05))]
    fn response_spectrum(
        &self,
        py: Python<'_>,
        periods: Numbers,
        damping: f64,
    ) -> PyResult<PySpectrum> {
        let record = &self.0;
        let spectrum = py.detach(|| {
            with_progress(None, |observer| record.response_spectrum(&periods.0, damping, observer))
        });
        Ok(PySpectrum(spectrum?, coarse_period_warnings(record, &periods.0)))
    }

    fn __len__(&self) -> usize {
        self.0.len()
    }

    fn __repr__(&self) -> String {
        format!(
            "Record({} samples of {:?} s, peak {:.3} m/s²)",
            self.0.len(),
            self.0.time_step(),
            self.0.peaks().acceleration
        )
    }

    fn __getnewargs__(&self) -> (f64, Array) {
        (self.time_step(), self.accelerations())
    }
}

/// The treatment of the baseline with this name; for a polynomial the `degree` is appended to the name.
fn baseline(name: &str, degree: usize) -> PyResult<Baseline> {
    let without_degree = name.parse::<Baseline>();
    without_degree
        .or_else(|error| format!("{name}({degree})").parse().map_err(|_| error))
        .or_raise()
}
