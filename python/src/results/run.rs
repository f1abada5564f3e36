//! A run: its summary and its time series.

use std::path::PathBuf;

use basemat::io::paraview;
use basemat::results::{Quantity, Run, Summary, TimeSeries};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};

use super::shape::shape;
use super::{PyEnergyBalance, PyExtremes, PyPeak, PyServiceCheck, PySummary, series};
use crate::array::{Array, Numbers, OrderedDict, Rows};
use crate::error::{OrRaise, in_python_words, input_error, warn};
use crate::motion::{PyRecord, PySpectrum, coarse_period_warnings};
use crate::names::preformatted;
use crate::ticker::with_progress;

/// Results of a run: `Summary` of the whole base, energies and time series.
///
/// It also has envelopes and warnings.
///
/// ``run["base_shear"]`` is the time series of a scalar or a probe at ``run.time``, ``list(run.series)`` has all names;
/// printed, a run is a page for a report.
#[pyclass(name = "Run", module = "basemat", frozen, extends = PySummary)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyRun {
    pub(super) run: Run,
    time_series: Option<TimeSeries>,
    dof_names: Option<Vec<String>>,
}

extends!(PyRun, run => PySummary(run.run.whole.clone()));

impl PyRun {
    pub(crate) fn new(
        run: Run,
        time_series: Option<TimeSeries>,
        dof_names: Option<Vec<String>>,
    ) -> Self {
        Self { run, time_series, dof_names }
    }

    /// The time series; an error if the run recorded none.
    pub(super) fn recorded(&self) -> PyResult<&TimeSeries> {
        self.time_series
            .as_ref()
            .ok_or_else(|| input_error("the run recorded no time series (`series=False`)"))
    }

    /// Peaks of all scalars of the base or of a foundation; `None` for a scalar without values.
    fn peaks(&self, summary: &Summary) -> impl Iterator<Item = (String, Option<f64>)> {
        Quantity::recorded(self.run.in_plan).map(|quantity| {
            let value = summary.peak(quantity).value;
            (quantity.to_string(), (!value.is_nan()).then_some(value))
        })
    }

    /// The time series; an error unless the `probe` is one of them.
    fn series_with_probe(&self, probe: &str) -> PyResult<&TimeSeries> {
        let time_series = self.recorded()?;
        let probe_names = series::probe_names(time_series);
        if probe_names.iter().any(|name| name == probe) {
            return Ok(time_series);
        }
        let name_list = if probe_names.is_empty() { "none".into() } else { probe_names.join(", ") };
        Err(input_error(format!("there is no probe '{probe}', only {name_list}")))
    }
}

#[pymethods]
impl PyRun {
    /// Number of steps made.
    #[getter]
    fn steps(&self) -> usize {
        self.run.steps
    }

    /// Whether the ground was in plan: forces are then those of the whole body, in N instead of N/m.
    #[getter]
    fn in_plan(&self) -> bool {
        self.run.in_plan
    }

    /// Time at the beginning, s.
    #[getter]
    fn start(&self) -> f64 {
        self.run.start
    }

    /// Time at the end, s.
    #[getter]
    fn end(&self) -> f64 {
        self.run.end
    }

    /// Time step, s.
    #[getter]
    fn time_step(&self) -> f64 {
        self.run.time_step
    }

    /// The ground motion: dict of "peak" (largest component of the acceleration, m/s²), "duration" and "time_step" of
    /// its record (s; None without one) and "passed", the fraction of the intensity of the record up to the end of the
    /// run.
    #[getter]
    fn ground_motion(&self) -> OrderedDict<&'static str, Option<f64>> {
        let motion = self.run.ground_motion;
        OrderedDict(vec![
            ("peak", Some(motion.peak)),
            ("duration", motion.duration),
            ("time_step", motion.time_step),
            ("passed", motion.passed),
        ])
    }

    /// Whether the run ended because a base turned beyond the ``rotation_limit`` of the `Simulation`.
    #[getter]
    fn is_overturned(&self) -> bool {
        self.run.is_overturned
    }

    /// The ground motion as a text, as in the report of the run.
    #[getter]
    fn _ground_motion(&self) -> String {
        self.run.ground_motion.to_string()
    }

    /// Times of the recorded steps: array of shape (steps + 1,), s; the first is the start.
    #[getter]
    fn time(&self) -> PyResult<Array> {
        Ok(Array::from(self.recorded()?.times()))
    }

    /// Names of the structure's degrees of freedom: list of n texts; None without names.
    #[getter]
    fn dof_names(&self) -> Option<Vec<String>> {
        self.dof_names.clone()
    }

    /// Largest gap of any element, m, a `Peak`.
    #[getter]
    fn largest_gap(&self) -> PyPeak {
        PyPeak(self.run.largest_gap())
    }

    /// Largest pressure of any element, Pa, a `Peak`; None without elements.
    #[getter]
    fn largest_pressure(&self) -> Option<PyPeak> {
        self.run.largest_pressure().map(|(_, peak)| PyPeak(peak))
    }

    /// Each foundation separately: list of `Summary`, from left to right.
    #[getter]
    fn foundations(&self) -> Vec<PySummary> {
        self.run.foundations.iter().cloned().map(PySummary).collect()
    }

    /// A check of each limit of service of the simulation: list of `ServiceCheck`.
    #[getter]
    fn serviceability(&self) -> Vec<PyServiceCheck> {
        self.run.serviceability.iter().copied().map(PyServiceCheck).collect()
    }

    /// Whether the run stays within all limits of service; None without limits.
    #[getter]
    fn is_serviceable(&self) -> Option<bool> {
        self.run.is_serviceable()
    }

    /// Number of changes of contact mode.
    #[getter]
    fn mode_changes(&self) -> usize {
        self.run.mode_changes
    }

    /// The `EnergyBalance` at the end.
    #[getter]
    fn energy_balance(&self) -> PyEnergyBalance {
        PyEnergyBalance(self.run.energy_balance)
    }

    /// Largest residual of the energy balance, relative to the largest energy; NaN without an energy balance.
    #[getter]
    fn energy_error(&self) -> f64 {
        self.run.energy_error
    }

    /// Number of trials of the search for contact modes: linear solutions, sweeps and iterations of Newton's method.
    #[getter]
    fn trials(&self) -> usize {
        self.run.trials
    }

    /// Number of steps that the first search method did not solve.
    #[getter]
    fn fallbacks(&self) -> usize {
        self.run.fallbacks.total()
    }

    /// List of the texts of warnings: violated assumptions, and steps and elements that are too coarse.
    #[getter]
    pub(crate) fn warnings(&self) -> Vec<String> {
        let warnings = self.run.warnings.iter();
        warnings.map(|warning| in_python_words(warning.to_string())).collect()
    }

    /// All time series: dict of arrays of shape (steps + 1,), "time" first.
    #[getter]
    fn series(&self) -> PyResult<OrderedDict<String, Array>> {
        series::all_series(self.recorded()?)
    }

    /// Terms of the energy balance over time: dict of arrays of shape (steps + 1,), J, in the plane J/m.
    #[getter]
    fn energy_balances(&self) -> PyResult<OrderedDict<String, Array>> {
        Ok(series::energy_balances(self.recorded()?))
    }

    /// Smallest and largest value of each probe: dict of `Extremes` by its name, in its unit.
    #[getter]
    fn probes(&self) -> OrderedDict<String, PyExtremes> {
        let probes = self.run.probes.iter();
        probes.map(|probe| (probe.name.clone(), PyExtremes(probe.extremes))).collect()
    }

    /// SI units of the time series and of the energies: dict of texts by their names, "" for ratios.
    #[getter]
    fn units(&self) -> OrderedDict<String, &str> {
        series::units(&self.run)
    }

    /// Lower and upper end of each element: array of shape (elements, 2), m above the surface; zero on it.
    #[getter]
    fn heights(&self) -> Rows {
        let envelopes = self.run.envelope.iter();
        Rows(envelopes.map(|envelope| envelope.element.heights().to_vec()).collect())
    }

    /// `FaceForces` over time, at the snapshots of ``contact_every`` of `Simulation.run`: dict of "left_wall", "base"
    /// and "right_wall"; without walls it has "base" only. Each is a dict of arrays of shape (frames,): "time" (s),
    /// "thrust", "shear" (N/m), "place" (m), "open_fraction" (a ratio).
    #[getter]
    fn faces(&self) -> PyResult<OrderedDict<&'static str, OrderedDict<&'static str, Array>>> {
        series::faces(self.recorded()?)
    }

    /// Envelopes of the elements: dict of arrays of shape (elements,): "left", "right", "gap",
    /// "slip" (m), "static_pressure", "lowest_pressure", "highest_pressure", "shear" (Pa),
    /// "open" (s); in plan also "front", "back", "slip_across" (m) and "shear_across" (Pa), along y;
    /// "gap_time", "lowest_pressure_time" and so on are the times of extremes (s).
    #[getter]
    fn envelope(&self) -> OrderedDict<&'static str, Array> {
        series::envelope(&self.run)
    }

    /// Fractions of the energy input at the end: dict of numbers by the terms' names; None if the input
    /// is not positive.
    #[getter]
    fn energy_fractions(&self) -> Option<OrderedDict<&'static str, f64>> {
        self.run.energy_balance.fractions().map(|fractions| fractions.into_iter().collect())
    }

    /// Peaks of all scalar quantities of each foundation.
    #[getter]
    fn _foundation_peaks(&self) -> Vec<OrderedDict<String, Option<f64>>> {
        let foundations = self.run.foundations.iter();
        foundations.map(|foundation| self.peaks(foundation).collect()).collect()
    }

    /// Wall time, s.
    #[getter]
    fn wall(&self) -> f64 {
        self.run.wall.as_secs_f64()
    }

    /// Time series of the scalar or the probe ``name``: array of shape (steps + 1,).
    fn __getitem__(&self, name: &str) -> PyResult<Array> {
        series::series_named(self.recorded()?, name)
    }

    /// Snapshots of the base: dict of "time" (frames,), s, and "gap", "slip" (m), "pressure", "shear" (Pa), "mode"
    /// (numbers into `basemat.MODES`), each of shape (frames, elements); in plan also "slip_across" (m) and
    /// "shear_across" (Pa), along y.
    #[getter]
    fn contact<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        series::contact(py, self.recorded()?)
    }

    /// Snapshots of the structure: dict of "time" (frames,), s, "displacement" and "velocity" (frames, n),
    /// m and m/s, and "free_field" (frames, 2), m to the right and up; in plan also "free_field_across" (frames,), m along y.
    #[getter]
    fn motion<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        series::motion(py, self.recorded()?)
    }

    /// Static displacement of the degrees of freedom, under weight and loads at the start: array of shape (n,), m and rad. It
    /// is recorded with the motion: give ``motion_every`` to `Simulation.run`.
    #[getter]
    fn static_displacement(&self) -> PyResult<Array> {
        let time_series = self.recorded()?;
        if time_series.motion_frames().next().is_none() {
            return Err(input_error("no motion was recorded: give `motion_every` to `run`"));
        }
        Ok(Array::from(time_series.static_displacement()))
    }

    fn _repr_html_(&self) -> String {
        preformatted(&self.run.to_string())
    }

    /// The `Record` of the acceleration probe called ``probe``.
    fn acceleration_record(&self, probe: &str) -> PyResult<PyRecord> {
        PyRecord::from_core(self.series_with_probe(probe)?.acceleration_record(probe))
    }

    /// Floor (in-structure) response `Spectrum` of the acceleration probe called ``probe`` at ``periods`` (array of
    /// shape (m,), s) with the damping ratio ``damping`` (0.05 by default). Peaks of the free vibration within one
    /// period after the end of the run are included: run until the floor is at rest. A `BasematWarning` names periods
    /// shorter than ten time steps, for which the spectrum needs a run with a shorter step.
    #[pyo3(signature = (probe, periods, damping=0.05))]
    fn floor_spectrum(
        &self,
        py: Python<'_>,
        probe: &str,
        periods: Numbers,
        damping: f64,
    ) -> PyResult<PySpectrum> {
        let record = self.series_with_probe(probe)?.acceleration_record(probe).or_raise()?;
        let spectrum = py.detach(|| {
            with_progress(None, |observer| record.response_spectrum(&periods.0, damping, observer))
        })?;
        let warnings = coarse_period_warnings(&record, &periods.0);
        for warning in &warnings {
            warn(py, warning.clone())?;
        }
        Ok(PySpectrum(spectrum, warnings))
    }

    /// Numbers of the run for a table: dict in SI units; peaks with their signs, probes as "peak NAME", and with limits of
    /// service "is_serviceable".
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let Self { run, .. } = self;
        let scalars = series::scalar_results(run).map(|(name, value)| (name.to_owned(), value));
        let numbers = self.peaks(&run.whole).chain(scalars).into_py_dict(py)?;
        if let Some(is_serviceable) = run.is_serviceable() {
            numbers.set_item("is_serviceable", is_serviceable)?;
        }
        for probe in &run.probes {
            numbers.set_item(format!("peak {}", probe.name), probe.extremes.largest().value)?;
        }
        Ok(numbers)
    }

    /// Writes all time series and snapshots as arrays of numpy to the file at ``path``: ``numpy.load(path)`` returns
    /// them by names with units, such as "base_shear_n_per_m", in any version and without this package.
    fn save_npz(&self, path: PathBuf) -> PyResult<()> {
        self.recorded()?.save_npz(path).or_raise()
    }

    /// Writes the snapshots for ParaView into a ``folder``: ``name.pvd``, and a grid of the base for each snapshot of the
    /// contact. Returns the number of grids.
    ///
    /// With the ``structure`` of the simulation, or its `DeformedShape`, it also writes a grid of the structure for
    /// each snapshot of the motion; none unless given. ``height`` (m): height of the box that represents a rigid block
    /// or body, as for `DeformedShape`; None for structures with a shape.
    #[pyo3(signature = (folder, name, structure=None, *, height=None))]
    fn save_paraview(
        &self,
        folder: PathBuf,
        name: &str,
        structure: Option<Bound<'_, PyAny>>,
        height: Option<f64>,
    ) -> PyResult<usize> {
        let time_series = self.recorded()?;
        match structure {
            Some(structure) => {
                let shape = shape(&structure, height)?;
                paraview::write_series(folder, name, &shape, time_series).or_raise()
            }
            None => paraview::write_base(folder, name, time_series).or_raise(),
        }
    }

    fn __str__(&self) -> String {
        self.run.to_string()
    }

    fn __repr__(&self) -> String {
        format!("Run({} steps, {} s to {} s)", self.run.steps, self.run.start, self.run.end)
    }
}
