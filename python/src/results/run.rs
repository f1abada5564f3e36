//! A run: its summary and its time series.

use basemat::coupled::EnergyTerm;
use basemat::results::{ElementEnvelope, Quantity, Run, TimeSeries};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::base::{events, known, preformatted};
use super::{PyEnergyBalance, PyExtremes, PyFoundationSummary, PyPeak, PyServiceCheck, series};
use crate::array::Numbers;
use crate::error::{OrRaise, in_python, refuse};
use crate::motion::{PyRecord, PySpectrum};
use crate::saved::{Reduced, reduced};

type Array<'py> = Bound<'py, PyArray1<f64>>;
type Column = fn(&ElementEnvelope) -> f64;

/// A run: peaks with their times, envelopes, uplift, slip, energies, warnings, and its time series.
///
/// ``run["base_shear"]`` is the time series of a scalar or a probe at ``run.time``; printed, a run is
/// a page for a report.
#[pyclass(name = "Run", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyRun {
    pub(super) run: Run,
    histories: Option<TimeSeries>,
    names: Option<Vec<String>>,
}

impl PyRun {
    pub(crate) fn new(run: Run, histories: Option<TimeSeries>, names: Option<Vec<String>>) -> Self {
        Self { run, histories, names }
    }

    fn kept(&self) -> PyResult<&TimeSeries> {
        self.histories
            .as_ref()
            .ok_or_else(|| refuse("the run kept no time series (`series=False`)"))
    }
}

#[pymethods]
impl PyRun {
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced(slf)
    }

    /// Number of steps made.
    #[getter]
    fn steps(&self) -> usize {
        self.run.steps
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

    /// Times of the kept steps: array of shape (steps + 1,), s; the first is that of the start.
    #[getter]
    fn time<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        Ok(PyArray1::from_slice(py, self.kept()?.times()))
    }

    /// Time series of the scalar or the probe ``name``: array of shape (steps + 1,).
    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Array<'py>> {
        series::named(py, self.kept()?, name)
    }

    /// All time series: dict of arrays of shape (steps + 1,), "time" first.
    #[getter]
    fn series<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        series::all(py, self.kept()?)
    }

    /// Terms of the energy balance over time: dict of arrays of shape (steps + 1,), J/m.
    #[getter]
    fn energy_balances<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        series::energy_balances(py, self.kept()?)
    }

    /// Snapshots of the base: dict of "time" (frames,), s, and "gap", "slip" (m), "pressure", "shear"
    /// (Pa), "mode" (numbers into :data:`basemat.MODES`), each of shape (frames, elements).
    #[getter]
    fn contact<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        series::contact(py, self.kept()?)
    }

    /// Snapshots of the structure: dict of "time" (frames,), s, "displacement" and "velocity" (frames, n),
    /// m and m/s, and "free_field" (frames, 2), m to the right and up.
    #[getter]
    fn motion<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        series::motion(py, self.kept()?)
    }

    /// Names of the structure's degrees of freedom: list of n texts; None without names.
    #[getter]
    fn dof_names(&self) -> Option<Vec<String>> {
        self.names.clone()
    }

    fn _repr_html_(&self) -> String {
        preformatted(&self.run.to_string())
    }

    /// The :class:`Record` of the acceleration probe called ``probe``.
    fn acceleration_record(&self, py: Python<'_>, probe: &str) -> PyResult<Py<PyRecord>> {
        PyRecord::create(py, self.kept()?.acceleration_record(probe))
    }

    /// Floor (in-structure) response :class:`Spectrum` of the acceleration probe called ``probe`` at
    /// ``periods`` (array of shape (m,), s) with the damping ratio ``damping`` (0.05 by default).
    #[pyo3(signature = (probe, periods, damping=0.05))]
    fn floor_spectrum(
        &self,
        py: Python<'_>,
        probe: &str,
        periods: Numbers,
        damping: f64,
    ) -> PyResult<PySpectrum> {
        let histories = self.kept()?;
        let spectrum = py.detach(|| histories.floor_spectrum(probe, &periods.0, damping));
        Ok(PySpectrum(spectrum.or_raise()?))
    }

    /// Smallest and largest value of each probe: dict of :class:`Extremes` by its name, in its unit.
    #[getter]
    fn probes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let probes = PyDict::new(py);
        for probe in &self.run.probes {
            probes.set_item(&probe.name, Py::new(py, PyExtremes(probe.extremes))?)?;
        }
        Ok(probes)
    }

    /// Total pressure at the start, N/m.
    #[getter]
    fn static_normal_force(&self) -> f64 {
        self.run.whole.static_normal_force
    }

    /// Horizontal force on the soil, positive to the right, N/m: its :class:`Extremes`.
    #[getter]
    fn base_shear(&self) -> PyExtremes {
        PyExtremes(self.run.whole.base_shear)
    }

    /// Moment on the soil, counter-clockwise, N·m/m: its :class:`Extremes`.
    #[getter]
    fn base_moment(&self) -> PyExtremes {
        PyExtremes(self.run.whole.base_moment)
    }

    /// Total pressure on the soil, N/m: its :class:`Extremes`.
    #[getter]
    fn normal_force(&self) -> PyExtremes {
        PyExtremes(self.run.whole.normal_force)
    }

    /// Rotation of the base, counter-clockwise, rad: its :class:`Extremes`.
    #[getter]
    fn base_rotation(&self) -> PyExtremes {
        PyExtremes(self.run.whole.base_rotation)
    }

    /// Largest ratio of the open length to that of the base: its :class:`Peak`.
    #[getter]
    fn uplifted_fraction(&self) -> PyPeak {
        PyPeak(self.run.whole.uplifted_fraction.highest)
    }

    /// Time with uplift, s.
    #[getter]
    fn uplift_duration(&self) -> f64 {
        self.run.whole.uplift.duration
    }

    /// Slip averaged over the base, m: its :class:`Extremes`.
    #[getter]
    fn mean_slip(&self) -> PyExtremes {
        PyExtremes(self.run.whole.mean_slip)
    }

    /// Slip averaged over the base at the end, m.
    #[getter]
    fn residual_slip(&self) -> f64 {
        self.run.whole.residual_slip
    }

    /// Largest slip of any element, m: its :class:`Peak`.
    #[getter]
    fn largest_slip(&self) -> PyPeak {
        PyPeak(self.run.whole.largest_slip.highest)
    }

    /// Largest gap of any element, m: its :class:`Peak`.
    #[getter]
    fn largest_gap(&self) -> PyPeak {
        PyPeak(self.run.largest_gap())
    }

    /// Largest pressure of any element, Pa, a :class:`Peak`; None without elements.
    #[getter]
    fn largest_pressure(&self) -> Option<PyPeak> {
        self.run.largest_pressure().map(|(_, peak)| PyPeak(peak))
    }

    /// Ratio of the largest base shear to the weight; None without weight.
    #[getter]
    fn shear_coefficient(&self) -> Option<f64> {
        self.run.shear_coefficient()
    }

    /// Slip events of the whole base: list of tuples (start in s, end in s, slip in m).
    #[getter]
    fn slip_events(&self) -> Vec<(f64, f64, f64)> {
        events(&self.run.whole.sliding.events)
    }

    /// Sliding distance: |slip| of the base summed over time, m.
    #[getter]
    fn slip_path(&self) -> f64 {
        self.run.whole.sliding.path
    }

    /// Least factor of safety against sliding, a :class:`Peak`; None without a friction coefficient.
    #[getter]
    fn least_sliding_safety(&self) -> Option<PyPeak> {
        known(self.run.whole.sliding_safety)
    }

    /// Least factor of safety against overturning, a :class:`Peak`.
    #[getter]
    fn least_overturning_safety(&self) -> PyPeak {
        PyPeak(self.run.whole.overturning_safety.lowest)
    }

    /// Each foundation by itself: list of :class:`FoundationSummary`, from left to right.
    #[getter]
    fn foundations(&self) -> Vec<PyFoundationSummary> {
        self.run.foundations.iter().cloned().map(PyFoundationSummary).collect()
    }

    /// A check of each limit of service that the simulation was given: list of :class:`ServiceCheck`.
    #[getter]
    fn serviceability(&self) -> Vec<PyServiceCheck> {
        self.run.serviceability.iter().copied().map(PyServiceCheck).collect()
    }

    /// Whether all limits of service were kept; None without limits.
    #[getter]
    fn is_serviceable(&self) -> Option<bool> {
        self.run.is_serviceable()
    }

    /// SI units of the time series, and J/m of the energies: dict of texts by their names, "" for ratios.
    #[getter]
    fn units<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let units = PyDict::new(py);
        units.set_item("time", "s")?;
        for quantity in Quantity::ALL {
            units.set_item(quantity.to_string(), quantity.unit())?;
        }
        for probe in &self.run.probes {
            units.set_item(&probe.name, &probe.unit)?;
        }
        for term in EnergyTerm::ALL {
            units.set_item(term.to_string(), "J/m")?;
        }
        Ok(units)
    }

    /// Envelopes of the elements: dict of arrays of shape (elements,): "left", "right", "gap",
    /// "slip" (m), "static_pressure", "lowest_pressure", "highest_pressure", "shear" (Pa),
    /// "open" (s).
    #[getter]
    fn envelope<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let columns: [(&str, Column); 9] = [
            ("left", |own| own.element.left),
            ("right", |own| own.element.right),
            ("static_pressure", |own| own.static_pressure),
            ("lowest_pressure", |own| own.pressure.lowest.value),
            ("highest_pressure", |own| own.pressure.highest.value),
            ("shear", |own| own.shear.value),
            ("gap", |own| own.gap.value),
            ("slip", |own| own.slip.value),
            ("open", |own| own.open),
        ];
        let envelope = PyDict::new(py);
        for (name, value) in columns {
            envelope
                .set_item(name, PyArray1::from_iter(py, self.run.envelope.iter().map(value)))?;
        }
        Ok(envelope)
    }

    /// Number of changes of contact mode.
    #[getter]
    fn mode_changes(&self) -> usize {
        self.run.mode_changes
    }

    /// The :class:`EnergyBalance` at the end.
    #[getter]
    fn energy_balance(&self) -> PyEnergyBalance {
        PyEnergyBalance(self.run.energy_balance)
    }

    /// Largest residual of the energy balance, relative to the largest energy; NaN if none is kept.
    #[getter]
    fn energy_error(&self) -> f64 {
        self.run.energy_error
    }

    /// Fractions of the energy input at the end: dict of numbers by the terms' names; None if the input
    /// is not positive.
    #[getter]
    fn energy_shares<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let Some(energy) = self.run.energy_balance.shares() else { return Ok(None) };
        let shares = PyDict::new(py);
        for (name, share) in energy {
            shares.set_item(name, share)?;
        }
        Ok(Some(shares))
    }

    /// Number of linear solves of the search for contact modes.
    #[getter]
    fn trials(&self) -> usize {
        self.run.trials
    }

    /// Number of steps that the first search did not solve.
    #[getter]
    fn fallbacks(&self) -> usize {
        self.run.fallbacks.total()
    }

    /// List of the texts of warnings: strained assumptions, and steps and elements too coarse for it.
    #[getter]
    pub(crate) fn warnings(&self) -> Vec<String> {
        self.run.warnings.iter().map(|own| in_python(own.to_string())).collect()
    }

    /// Wall time, s.
    #[getter]
    fn wall(&self) -> f64 {
        self.run.wall.as_secs_f64()
    }

    /// Numbers of the run for a table: dict in SI units; peaks with their signs, probes as "peak NAME".
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let Self { run, .. } = self;
        let numbers = PyDict::new(py);
        for quantity in Quantity::ALL {
            let value = run.whole.peak(quantity).value;
            numbers.set_item(quantity.to_string(), (!value.is_nan()).then_some(value))?;
        }
        for (name, value) in [
            ("end", Some(run.end)),
            ("shear_coefficient", run.shear_coefficient()),
            ("uplift_duration", Some(run.whole.uplift.duration)),
            ("largest_gap", Some(run.largest_gap().value)),
            ("largest_pressure", run.largest_pressure().map(|(_, peak)| peak.value)),
            ("residual_slip", Some(run.whole.residual_slip)),
            ("energy_input", Some(run.energy_balance.input)),
            ("energy_error", Some(run.energy_error)),
        ] {
            numbers.set_item(name, value)?;
        }
        for probe in &run.probes {
            numbers.set_item(format!("peak {}", probe.name), probe.extremes.largest().value)?;
        }
        Ok(numbers)
    }

    fn __str__(&self) -> String {
        self.run.to_string()
    }

    fn __repr__(&self) -> String {
        format!("Run({} steps, {} s to {} s)", self.run.steps, self.run.start, self.run.end)
    }
}
