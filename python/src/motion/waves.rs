//! Waves, pulses and records in both directions.

use std::sync::Arc;

use basemat::Observer;
use basemat::motion::{
    PlaneWave, Record, RickerDisplacement, TravellingWave, Triaxial, VerticalIncidence,
};
use basemat::site::{
    ControlPoint, InclinedControl, InclinedWave, SiteMotion, SoilColumn, VerticalWave,
};
use numpy::Complex64;
use pyo3::prelude::*;

use super::function::{WaveFactory, new_free_field};
use super::{PyFreeField, PyRecord, free_field_object};
use crate::array::{Array, Numbers, numpy_complex};
use crate::error::{OrRaise, input_error, warn};
use crate::names::choice;
use crate::profile::PySoilProfile;
use crate::soil::PySoil;
use crate::ticker::with_progress;

/// Motion of a ``horizontal`` `Record` (to the right), of a ``vertical`` one (up), or of both, the same everywhere; a
/// component is zero unless given.
#[pyfunction]
#[pyo3(signature = (horizontal=None, vertical=None))]
pub(crate) fn vertical_incidence(
    horizontal: Option<Bound<'_, PyRecord>>,
    vertical: Option<Bound<'_, PyRecord>>,
) -> PyResult<PyFreeField> {
    let motion = vertical_motion(horizontal.as_ref(), vertical.as_ref())?;
    let duration = latest_end([motion.horizontal.as_ref(), motion.vertical.as_ref()]);
    Ok(PyFreeField { duration, ..new_free_field(move || Ok(motion.clone()))? })
}

/// Motion of a horizontal and a vertical record, one of which may be missing.
pub(super) fn vertical_motion(
    horizontal: Option<&Bound<'_, PyRecord>>,
    vertical: Option<&Bound<'_, PyRecord>>,
) -> PyResult<VerticalIncidence> {
    if horizontal.is_none() && vertical.is_none() {
        return Err(input_error("give a horizontal record, a vertical one, or both"));
    }
    Ok(VerticalIncidence {
        horizontal: cloned_record(horizontal),
        vertical: cloned_record(vertical),
    })
}

/// Time at which the last of the records ends, s.
pub(super) fn latest_end<const N: usize>(records: [Option<&Record>; N]) -> Option<f64> {
    records.into_iter().flatten().map(Record::duration).reduce(f64::max)
}

/// A copy of the record, if there is one.
pub(super) fn cloned_record(record: Option<&Bound<'_, PyRecord>>) -> Option<Record> {
    record.map(|record| Record::clone(&record.get().0))
}

/// Motion of records along ``x`` (to the right), ``y`` (away) and ``up`` (each a `Record`), the same everywhere, for a
/// ground in plan; a component is zero unless given.
#[pyfunction]
#[pyo3(signature = (x=None, y=None, up=None))]
pub(crate) fn triaxial(
    x: Option<Bound<'_, PyRecord>>,
    y: Option<Bound<'_, PyRecord>>,
    up: Option<Bound<'_, PyRecord>>,
) -> PyResult<PyFreeField> {
    let motion = Triaxial {
        x: cloned_record(x.as_ref()),
        y: cloned_record(y.as_ref()),
        up: cloned_record(up.as_ref()),
    };
    let duration = latest_end([motion.x.as_ref(), motion.y.as_ref(), motion.up.as_ref()]);
    if duration.is_none() {
        return Err(input_error("give a record along x, along y or up"));
    }
    Ok(PyFreeField { duration, ..new_free_field(move || Ok(motion.clone()))? })
}

/// A ``motion`` (`FreeField`) that travels along x with an ``apparent_velocity`` (m/s; to the left if negative) and
/// acts unchanged at the ``origin`` (x, m). ``azimuth`` (rad; 0 by default): in plan the direction of travel, along
/// which ``origin`` is measured, counter-clockwise from x as seen from above; the components of the motion turn with
/// it.
#[pyfunction]
#[pyo3(signature = (motion, apparent_velocity, origin, *, azimuth=0.0))]
pub(crate) fn travelling_wave(
    motion: Bound<'_, PyAny>,
    apparent_velocity: f64,
    origin: f64,
    azimuth: f64,
) -> PyResult<PyFreeField> {
    let motion = free_field_object(&motion)?.get().make.clone();
    wave_field(azimuth, move || TravellingWave::new(motion()?, apparent_velocity, origin))
}

/// Free field of a wave that travels in the direction of an azimuth.
fn wave_field(
    azimuth: f64,
    make: impl Fn() -> basemat::Result<TravellingWave> + Send + Sync + 'static,
) -> PyResult<PyFreeField> {
    let wave: Arc<WaveFactory> = Arc::new(move || {
        // Without a rotation the velocities of a wave along x stay exact.
        if azimuth == 0.0 { make() } else { make()?.with_azimuth(azimuth) }
    });
    let make_field = Arc::clone(&wave);
    Ok(PyFreeField { wave: Some(wave), ..new_free_field(move || make_field())? })
}

/// Ricker pulse of displacement to the right, or up if ``vertical`` (False by default): ``amplitude`` of the peak (m),
/// width ``sigma`` (s), time ``center`` (s).
#[pyfunction]
#[pyo3(signature = (amplitude, sigma, center, *, vertical=false))]
pub(crate) fn ricker(
    amplitude: f64,
    sigma: f64,
    center: f64,
    vertical: bool,
) -> PyResult<PyFreeField> {
    new_free_field(move || {
        let pulse = RickerDisplacement::new(amplitude, sigma, center)?;
        Ok(if vertical { pulse.vertical() } else { pulse })
    })
}

/// Plane wave below the surface of a half-plane, or Rayleigh wave.
///
/// `field_from_horizontal` and `field_from_vertical` convert it to a motion.
#[pyclass(name = "PlaneWave", module = "basemat", frozen, dict)]
pub(crate) struct PyPlaneWave(PlaneWave);

#[pymethods]
impl PyPlaneWave {
    /// SV wave from below in a half-plane of this ``soil`` at ``angle`` (rad) from the vertical, to the
    /// right if positive.
    #[staticmethod]
    fn sv(soil: &PySoil, angle: f64) -> PyResult<Self> {
        PlaneWave::sv(soil.0, angle).or_raise().map(Self)
    }

    /// SH wave from below at ``angle`` (rad) from the vertical in this ``soil``, for a ground in plan: it moves the
    /// surface only perpendicular to its direction.
    #[staticmethod]
    fn sh(soil: &PySoil, angle: f64) -> PyResult<Self> {
        PlaneWave::sh(soil.0, angle).or_raise().map(Self)
    }

    /// P wave from below in a half-plane of this ``soil`` at ``angle`` (rad) from the vertical, to the
    /// right if positive.
    #[staticmethod]
    fn p(soil: &PySoil, angle: f64) -> PyResult<Self> {
        PlaneWave::p(soil.0, angle).or_raise().map(Self)
    }

    /// Rayleigh wave to the right on a half-plane of this ``soil``.
    #[staticmethod]
    fn rayleigh(soil: &PySoil) -> Self {
        Self(PlaneWave::rayleigh(soil.0))
    }

    /// The `FreeField` whose horizontal motion at ``origin`` (x, m) is the ``record``; ``azimuth`` (rad; 0 by default) is as in
    /// `travelling_wave`.
    #[pyo3(signature = (record, origin, *, azimuth=0.0))]
    fn field_from_horizontal(
        &self,
        record: &PyRecord,
        origin: f64,
        azimuth: f64,
    ) -> PyResult<PyFreeField> {
        let wave = self.0;
        let record = Arc::clone(&record.0);
        wave_field(azimuth, move || wave.field_from_horizontal(&record, origin))
    }

    /// The `FreeField` whose vertical motion (up) at ``origin`` (x, m) is the ``record``; ``azimuth`` (rad; 0 by default) is as in
    /// `travelling_wave`.
    #[pyo3(signature = (record, origin, *, azimuth=0.0))]
    fn field_from_vertical(
        &self,
        record: &PyRecord,
        origin: f64,
        azimuth: f64,
    ) -> PyResult<PyFreeField> {
        let wave = self.0;
        let record = Arc::clone(&record.0);
        wave_field(azimuth, move || wave.field_from_vertical(&record, origin))
    }

    /// The `FreeField` whose motion perpendicular to its direction at ``origin`` (x, m) is the ``record``, of an SH
    /// wave; ``azimuth`` (rad; 0 by default) is as in `travelling_wave`.
    #[pyo3(signature = (record, origin, *, azimuth=0.0))]
    fn field_from_across(
        &self,
        record: &PyRecord,
        origin: f64,
        azimuth: f64,
    ) -> PyResult<PyFreeField> {
        let wave = self.0;
        let record = Arc::clone(&record.0);
        wave_field(azimuth, move || wave.field_from_across(&record, origin))
    }

    /// Apparent velocity along the surface, m/s.
    #[getter]
    fn apparent_velocity(&self) -> f64 {
        self.0.apparent_velocity()
    }

    /// Wave with the same motion in the opposite direction.
    fn reversed(&self) -> Self {
        Self(self.0.reversed())
    }
}

/// A soil ``profile`` (`SoilProfile`) as a column with vertical waves; ``wave``: "shear" (the default) or "pressure".
#[pyclass(name = "SoilColumn", module = "basemat", frozen, dict)]
pub(crate) struct PyColumn(pub(crate) SoilColumn);

/// The control point with this name.
pub(crate) fn control_point(name: &str) -> PyResult<ControlPoint> {
    choice("control", name, &[("outcrop", ControlPoint::Outcrop), ("within", ControlPoint::Within)])
}

/// Largest error without a warning, relative to the peak: smaller errors are invisible in response spectra.
const MAX_SILENT_ERROR: f64 = 1e-4;

/// Record of another point of a soil column by `transform`; warns of errors by cut ends and rounding.
fn through_column(
    py: Python<'_>,
    record: &PyRecord,
    control: &str,
    transform: impl Send
    + FnOnce(ControlPoint, f64, &[f64], &mut Observer<'_>) -> basemat::Result<SiteMotion>,
) -> PyResult<PyRecord> {
    let control = control_point(control)?;
    let time_step = record.0.time_step();
    let samples = record.0.accelerations();
    let motion = py.detach(|| {
        with_progress(None, |observer| transform(control, time_step, samples, observer))
    })?;
    let leading_part = motion.before / motion.peak();
    let trailing_part = motion.after / motion.peak();
    let rounding_error = motion.rounding / motion.peak();
    if leading_part.max(trailing_part) > MAX_SILENT_ERROR {
        let text = format!(
            "the motion begins before the record or lasts longer, and is cut off: up to {:.2} % of its peak \
             before the first sample, up to {:.2} % after the last; give the record quiet time on both sides (padded)",
            100.0 * leading_part,
            100.0 * trailing_part
        );
        warn(py, text)?;
    }
    if rounding_error > MAX_SILENT_ERROR {
        let text = format!(
            "the rounding error is {:.2} % of the motion's peak, since the deconvolution amplifies high frequencies; \
             remove these from the record first (low_pass)",
            100.0 * rounding_error
        );
        warn(py, text)?;
    }
    if let Some(warning) = motion.warning() {
        warn(py, warning.to_string())?;
    }
    PyRecord::from_core(Record::new(time_step, motion.samples))
}

#[pymethods]
impl PyColumn {
    #[new]
    #[pyo3(signature = (profile, wave="shear"))]
    fn new(profile: &PySoilProfile, wave: &str) -> PyResult<Self> {
        let choices = [("shear", VerticalWave::Shear), ("pressure", VerticalWave::Pressure)];
        let wave = choice("wave", wave, &choices)?;
        Ok(Self(SoilColumn::new(profile.0.clone(), wave).or_raise()?))
    }

    /// Ratio of the surface motion to the motion of the ``control`` point for e^(iωt): complex array of shape (m,) at
    /// ``frequencies`` (array of shape (m,), Hz). ``control``: "outcrop" (the default: the base without layers) or
    /// "within" (the base under them).
    #[pyo3(signature = (frequencies, *, control="outcrop"))]
    fn transfer(
        &self,
        py: Python<'_>,
        frequencies: Numbers,
        control: &str,
    ) -> PyResult<Array<Complex64>> {
        let control = control_point(control)?;
        let values = py.detach(|| {
            with_progress(None, |observer| self.0.transfers(control, &frequencies.0, observer))
        })?;
        Ok(values.into_iter().map(numpy_complex).collect())
    }

    /// The record of the surface, as long as the ``record`` of the ``control`` point, "outcrop" (the default) or
    /// "within". If the motion is cut off at the ends of the record, a `BasematWarning` states the cut-off part
    /// relative to the peak, if it is above 0.01 %; `Record.padded` avoids this.
    #[pyo3(signature = (record, *, control="outcrop"))]
    fn to_surface(&self, py: Python<'_>, record: &PyRecord, control: &str) -> PyResult<PyRecord> {
        through_column(py, record, control, |control, time_step, samples, observer| {
            self.0.to_surface(control, time_step, samples, observer)
        })
    }

    /// The record of the ``control`` point, "outcrop" (the default) or "within", from the ``record`` of the surface
    /// (deconvolution); it warns as `to_surface`, and also if most of the motion is noise that the deconvolution
    /// amplifies more than a hundredfold: filter the record with `Record.low_pass` before, typically at 15 to 25 Hz.
    #[pyo3(signature = (record, *, control="outcrop"))]
    #[allow(clippy::wrong_self_convention, reason = "the core's name")]
    fn from_surface(&self, py: Python<'_>, record: &PyRecord, control: &str) -> PyResult<PyRecord> {
        through_column(py, record, control, |control, time_step, samples, observer| {
            self.0.from_surface(control, time_step, samples, observer)
        })
    }

    /// Records of the surface, a list of those along x, along y and up, from records of the ``control`` point,
    /// "outcrop" (the default) or "within", of a ``profile`` (`SoilProfile`): ``x`` and ``y`` by shear waves, ``up`` by
    /// pressure waves; None for a record that is not given.
    #[staticmethod]
    #[pyo3(signature = (profile, x=None, y=None, up=None, *, control="outcrop"))]
    fn surface_in_plan(
        py: Python<'_>,
        profile: &PySoilProfile,
        x: Option<Bound<'_, PyRecord>>,
        y: Option<Bound<'_, PyRecord>>,
        up: Option<Bound<'_, PyRecord>>,
        control: &str,
    ) -> PyResult<[Option<PyRecord>; 3]> {
        let motion = Triaxial {
            x: cloned_record(x.as_ref()),
            y: cloned_record(y.as_ref()),
            up: cloned_record(up.as_ref()),
        };
        let control = control_point(control)?;
        let surface = py.detach(|| {
            with_progress(None, |observer| {
                SoilColumn::surface_in_plan(&profile.0, control, &motion, observer)
            })
        })?;
        let records = [surface.x, surface.y, surface.up];
        Ok(records.map(|component| component.map(|record| PyRecord(Arc::new(record)))))
    }
}

/// A plane wave from the half-plane under a layered profile; `field` converts it to a motion.
#[pyclass(name = "InclinedWave", module = "basemat", frozen, dict)]
pub(crate) struct PyInclinedWave(InclinedWave);

#[pymethods]
impl PyInclinedWave {
    /// SV wave at ``angle`` (rad) from the vertical in the base of the ``profile``, to the right if positive.
    #[staticmethod]
    fn sv(profile: &PySoilProfile, angle: f64) -> PyResult<Self> {
        InclinedWave::sv(profile.0.clone(), angle).or_raise().map(Self)
    }

    /// SH wave with a ``profile`` and an ``angle`` (rad) as for `sv`, for a ground in plan: its motion is horizontal
    /// and perpendicular to its direction.
    #[staticmethod]
    fn sh(profile: &PySoilProfile, angle: f64) -> PyResult<Self> {
        InclinedWave::sh(profile.0.clone(), angle).or_raise().map(Self)
    }

    /// P wave at ``angle`` (rad) from the vertical in the base of the ``profile``, to the right if positive.
    #[staticmethod]
    fn p(profile: &PySoilProfile, angle: f64) -> PyResult<Self> {
        InclinedWave::p(profile.0.clone(), angle).or_raise().map(Self)
    }

    /// Apparent velocity along the surface, m/s.
    #[getter]
    fn apparent_velocity(&self) -> f64 {
        self.0.apparent_velocity()
    }

    /// The `FreeField` of the surface for the ``record`` of the ``control`` point below ``origin`` (x, m), the edge of
    /// the base that the wave reaches first. ``control``: "outcrop_horizontal" (the default), "outcrop_vertical" (base
    /// without layers) or "incident" (incident wave alone). ``azimuth`` (rad; 0 by default) is as in `travelling_wave`.
    #[pyo3(signature = (record, origin, *, control="outcrop_horizontal", azimuth=0.0))]
    fn field(
        &self,
        py: Python<'_>,
        record: &PyRecord,
        origin: f64,
        control: &str,
        azimuth: f64,
    ) -> PyResult<PyFreeField> {
        let choices = [
            ("outcrop_horizontal", InclinedControl::OutcropHorizontal),
            ("outcrop_vertical", InclinedControl::OutcropVertical),
            ("incident", InclinedControl::Incident),
        ];
        let control = choice("control", control, &choices)?;
        let surface = py.detach(|| {
            with_progress(None, |observer| self.0.surface_records(control, &record.0, observer))
        })?;
        let speed = self.0.apparent_velocity();
        wave_field(azimuth, move || TravellingWave::new(surface.clone(), speed, origin))
    }
}
