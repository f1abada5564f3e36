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

use super::function::{MakeWave, field};
use super::{PyFreeField, PyRecord, given};
use crate::array::{Array, Numbers, complex};
use crate::error::{OrRaise, refuse};
use crate::names::choice;
use crate::profile::PySoilProfile;
use crate::soil::PySoil;
use crate::ticker::watched;

/// Motion of a ``horizontal`` `Record` (to the right), of a ``vertical`` one (up), or of both, the
/// same everywhere at once; a component is zero unless given.
#[pyfunction]
#[pyo3(signature = (horizontal=None, vertical=None))]
pub(crate) fn vertical_incidence(
    horizontal: Option<Bound<'_, PyRecord>>,
    vertical: Option<Bound<'_, PyRecord>>,
) -> PyResult<PyFreeField> {
    let (incidence, duration) = incidence([horizontal, vertical])?;
    Ok(PyFreeField { duration, ..field(move || Ok(incidence.clone()))? })
}

/// Motion by a horizontal and a vertical record, and the time at which the last of them ends (s).
pub(super) fn incidence(
    given: [Option<Bound<'_, PyRecord>>; 2],
) -> PyResult<(VerticalIncidence, Option<f64>)> {
    let duration = longest(&given);
    let [horizontal, vertical] =
        given.map(|record| record.map(|record| Record::clone(&record.get().0)));
    if duration.is_none() {
        return Err(refuse("give a horizontal record, a vertical one, or both"));
    }
    Ok((VerticalIncidence { horizontal, vertical }, duration))
}

/// Time at which the last of the records ends, s.
fn longest(given: &[Option<Bound<'_, PyRecord>>]) -> Option<f64> {
    given.iter().flatten().map(|record| record.get().0.duration()).reduce(f64::max)
}

/// Records along x, y and up.
fn records(given: [Option<Bound<'_, PyRecord>>; 3]) -> Triaxial {
    let [x, y, up] = given.map(|record| record.map(|record| Record::clone(&record.get().0)));
    Triaxial { x, y, up }
}

/// Motion of records along ``x`` (to the right), ``y`` (away) and ``up`` (each a `Record`), the same everywhere at
/// once, for a ground in plan; what is None rests.
#[pyfunction]
#[pyo3(signature = (x=None, y=None, up=None))]
pub(crate) fn triaxial(
    x: Option<Bound<'_, PyRecord>>,
    y: Option<Bound<'_, PyRecord>>,
    up: Option<Bound<'_, PyRecord>>,
) -> PyResult<PyFreeField> {
    let given = [x, y, up];
    let duration = longest(&given);
    if duration.is_none() {
        return Err(refuse("give a record along x, along y or up"));
    }
    let motion = records(given);
    Ok(PyFreeField { duration, ..field(move || Ok(motion.clone()))? })
}

/// A ``motion`` (`FreeField`) that runs along x with an ``apparent_velocity`` (m/s; to the left if
/// negative), as it is at the ``origin`` (x, m). ``azimuth`` (rad; 0 by default): in plan the direction in which it runs and
/// from which x is counted, counter-clockwise from x as seen from above; the motion turns with it.
#[pyfunction]
#[pyo3(signature = (motion, apparent_velocity, origin, *, azimuth=0.0))]
pub(crate) fn travelling_wave(
    motion: Bound<'_, PyAny>,
    apparent_velocity: f64,
    origin: f64,
    azimuth: f64,
) -> PyResult<PyFreeField> {
    let motion = given(&motion)?.get().make.clone();
    turned(azimuth, move || TravellingWave::new(motion()?, apparent_velocity, origin))
}

/// A wave that runs in the direction of an azimuth.
fn turned(
    azimuth: f64,
    make: impl Fn() -> basemat::Result<TravellingWave> + Send + Sync + 'static,
) -> PyResult<PyFreeField> {
    let wave: Arc<MakeWave> = Arc::new(move || {
        // A wave along x has exact velocities.
        if azimuth == 0.0 { make() } else { make()?.with_azimuth(azimuth) }
    });
    let again = Arc::clone(&wave);
    Ok(PyFreeField { wave: Some(wave), ..field(move || again())? })
}

/// A Ricker pulse of displacement: peak ``amplitude`` (m), width ``sigma`` (s), at ``center`` (s), to the
/// right or, if ``vertical`` (False by default), up.
#[pyfunction]
#[pyo3(signature = (amplitude, sigma, center, *, vertical=false))]
pub(crate) fn ricker(
    amplitude: f64,
    sigma: f64,
    center: f64,
    vertical: bool,
) -> PyResult<PyFreeField> {
    field(move || {
        let pulse = RickerDisplacement::new(amplitude, sigma, center)?;
        Ok(if vertical { pulse.vertical() } else { pulse })
    })
}

/// A plane wave that meets the free surface of a half-plane at an angle, or a Rayleigh wave;
/// `field_from_horizontal` and `field_from_vertical` make it a motion.
#[pyclass(name = "PlaneWave", module = "basemat", frozen, dict)]
pub(crate) struct PyPlaneWave(PlaneWave);

/// Methods of a plane wave that make it a motion: the core's of the same name.
macro_rules! fields_from {
    ($($(#[doc = $doc:tt])+ $name:ident;)+) => {
        #[pymethods]
        impl PyPlaneWave {
            $(
                $(#[doc = $doc])+
                #[pyo3(signature = (record, origin, *, azimuth=0.0))]
                fn $name(
                    &self,
                    record: &PyRecord,
                    origin: f64,
                    azimuth: f64,
                ) -> PyResult<PyFreeField> {
                    let (wave, record) = (self.0, Arc::clone(&record.0));
                    turned(azimuth, move || wave.$name(&record, origin))
                }
            )+
        }
    };
}

fields_from! {
    /// The `FreeField` whose horizontal motion at ``origin`` (x, m) is the ``record``; ``azimuth`` (rad; 0 by default) is as in
    /// `travelling_wave`.
    field_from_horizontal;
    /// The `FreeField` whose vertical motion (up) at ``origin`` (x, m) is the ``record``; ``azimuth`` (rad; 0 by default) is as in
    /// `travelling_wave`.
    field_from_vertical;
    /// The `FreeField` whose motion across its direction at ``origin`` (x, m) is the ``record``, of an SH wave; ``azimuth``
    /// (rad; 0 by default) is as in `travelling_wave`.
    field_from_across;
}

#[pymethods]
impl PyPlaneWave {
    /// SV wave from below in a half-plane of this ``soil`` at ``angle`` (rad) from the vertical, to the
    /// right if positive.
    #[staticmethod]
    fn sv(soil: &PySoil, angle: f64) -> PyResult<Self> {
        PlaneWave::sv(soil.0, angle).or_raise().map(Self)
    }

    /// SH wave from below at ``angle`` (rad) from the vertical in this ``soil``, for a ground in plan: it moves the surface
    /// across its direction only.
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

    /// Apparent velocity along the surface, m/s.
    #[getter]
    fn apparent_velocity(&self) -> f64 {
        self.0.apparent_velocity()
    }

    /// Wave with this motion, running the other way.
    fn reversed(&self) -> Self {
        Self(self.0.reversed())
    }
}

/// A soil ``profile`` (`SoilProfile`) as a column that waves travel up and down; ``wave``: "shear"
/// (the default) or "pressure".
#[pyclass(name = "SoilColumn", module = "basemat", frozen, dict)]
pub(crate) struct PyColumn(pub(crate) SoilColumn);

pub(crate) fn control(name: &str) -> PyResult<ControlPoint> {
    choice("control", name, &[("outcrop", ControlPoint::Outcrop), ("within", ControlPoint::Within)])
}

/// Part of its peak that a motion may lack without a warning: less than response spectra show.
const UNSEEN: f64 = 1e-4;

/// The record of what a column makes of one, with a warning if it lacks what can be seen.
fn through(
    py: Python<'_>,
    record: &PyRecord,
    control: &str,
    column: impl Send
    + FnOnce(ControlPoint, f64, &[f64], &mut Observer<'_>) -> basemat::Result<SiteMotion>,
) -> PyResult<PyRecord> {
    let (control, step) = (self::control(control)?, record.0.time_step());
    let samples = record.0.accelerations();
    let motion =
        py.detach(|| watched(None, |observer| column(control, step, samples, observer)))?;
    let lost = [motion.before, motion.after, motion.rounding].map(|part| part / motion.peak());
    let [before, after, rounding] = lost.map(|part| format!("{:.2} %", 100.0 * part));
    if lost[0].max(lost[1]) > UNSEEN {
        let text = format!(
            "the motion begins before the record or lasts longer, and is cut off: up to {before} of its peak \
             before the first sample, up to {after} after the last; give the record quiet time on both sides (padded)"
        );
        crate::error::warn(py, text)?;
    }
    if lost[2] > UNSEEN {
        let text = format!(
            "rounding is {rounding} of the motion's peak, since layers amplify high frequencies on the way down; \
             remove these from the record before (low_pass)"
        );
        crate::error::warn(py, text)?;
    }
    if let Some(warning) = motion.warning() {
        crate::error::warn(py, warning.to_string())?;
    }
    PyRecord::from_core(Record::new(step, motion.samples))
}

#[pymethods]
impl PyColumn {
    #[new]
    #[pyo3(signature = (profile, wave="shear"))]
    fn new(profile: &PySoilProfile, wave: &str) -> PyResult<Self> {
        let all = [("shear", VerticalWave::Shear), ("pressure", VerticalWave::Pressure)];
        let wave = choice("wave", wave, &all)?;
        Ok(Self(SoilColumn::new(profile.0.clone(), wave).or_raise()?))
    }

    /// Ratio of the motion of the surface to the motion of the ``control`` point for e^(iωt): complex array of
    /// shape (m,) at ``frequencies`` (array of shape (m,), Hz). ``control``: "outcrop" (the default: the
    /// base without layers) or "within" (the base under them).
    #[pyo3(signature = (frequencies, *, control="outcrop"))]
    fn transfer(
        &self,
        py: Python<'_>,
        frequencies: Numbers,
        control: &str,
    ) -> PyResult<Array<Complex64>> {
        let control = self::control(control)?;
        let call =
            |observer: &mut Observer<'_>| self.0.transfers(control, &frequencies.0, observer);
        let values = py.detach(|| watched(None, call))?;
        Ok(values.into_iter().map(complex).collect())
    }

    /// The record of the surface from the ``record`` of the ``control`` point, "outcrop" (the default) or
    /// "within", as long. A `BasematWarning` gives the size, relative to the peak, of what comes before or after
    /// and is cut off, from 0.01 % on: `Record.padded` makes room for it.
    #[pyo3(signature = (record, *, control="outcrop"))]
    fn to_surface(&self, py: Python<'_>, record: &PyRecord, control: &str) -> PyResult<PyRecord> {
        through(py, record, control, |control, step, own, observer| {
            self.0.to_surface(control, step, own, observer)
        })
    }

    /// The record of the ``control`` point, "outcrop" (the default) or "within", from the ``record`` of the
    /// surface (deconvolution); it warns as `to_surface`, and of a motion that is mostly noise which the way down
    /// amplifies more than a hundredfold: `Record.low_pass` removes it before, as a rule at 15 to 25 Hz.
    #[pyo3(signature = (record, *, control="outcrop"))]
    #[allow(clippy::wrong_self_convention, reason = "the core's name")]
    fn from_surface(&self, py: Python<'_>, record: &PyRecord, control: &str) -> PyResult<PyRecord> {
        through(py, record, control, |control, step, own, observer| {
            self.0.from_surface(control, step, own, observer)
        })
    }

    /// Records of the surface, a list of those along x, along y and up, from records of the ``control`` point, "outcrop" (the
    /// default) or "within", of a ``profile`` (`SoilProfile`): ``x`` and ``y`` by shear waves, ``up`` by pressure waves; what
    /// is None stays so.
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
        let (motion, control) = (records([x, y, up]), self::control(control)?);
        let call = |observer: &mut Observer<'_>| {
            SoilColumn::surface_in_plan(&profile.0, control, &motion, observer)
        };
        let found = py.detach(|| watched(None, call))?;
        Ok([found.x, found.y, found.up].map(|own| own.map(|own| PyRecord(Arc::new(own)))))
    }
}

/// A plane wave from the half-plane under a layered profile; `field` makes it a motion.
#[pyclass(name = "InclinedWave", module = "basemat", frozen, dict)]
pub(crate) struct PyInclinedWave(InclinedWave);

#[pymethods]
impl PyInclinedWave {
    /// SV wave at ``angle`` (rad) from the vertical in the base of the ``profile``, to the right if
    /// positive.
    #[staticmethod]
    fn sv(profile: &PySoilProfile, angle: f64) -> PyResult<Self> {
        InclinedWave::sv(profile.0.clone(), angle).or_raise().map(Self)
    }

    /// SH wave as of `sv` (``profile``, ``angle`` in rad), for a ground in plan: its horizontal motion is across its
    /// direction.
    #[staticmethod]
    fn sh(profile: &PySoilProfile, angle: f64) -> PyResult<Self> {
        InclinedWave::sh(profile.0.clone(), angle).or_raise().map(Self)
    }

    /// P wave at ``angle`` (rad) from the vertical in the base of the ``profile``, to the right if
    /// positive.
    #[staticmethod]
    fn p(profile: &PySoilProfile, angle: f64) -> PyResult<Self> {
        InclinedWave::p(profile.0.clone(), angle).or_raise().map(Self)
    }

    /// Apparent velocity along the surface, m/s.
    #[getter]
    fn apparent_velocity(&self) -> f64 {
        self.0.apparent_velocity()
    }

    /// The `FreeField` of the surface whose ``control`` point moves as the ``record`` at ``origin``
    /// (x, m), the point that is reached first. ``control``: "outcrop_horizontal" (the default),
    /// "outcrop_vertical" (motions of the base without layers) or "incident" (the incident wave alone). ``azimuth`` (rad; 0 by
    /// default) is as in `travelling_wave`.
    #[pyo3(signature = (record, origin, *, control="outcrop_horizontal", azimuth=0.0))]
    fn field(
        &self,
        py: Python<'_>,
        record: &PyRecord,
        origin: f64,
        control: &str,
        azimuth: f64,
    ) -> PyResult<PyFreeField> {
        let all = [
            ("outcrop_horizontal", InclinedControl::OutcropHorizontal),
            ("outcrop_vertical", InclinedControl::OutcropVertical),
            ("incident", InclinedControl::Incident),
        ];
        let control = choice("control", control, &all)?;
        let call =
            |observer: &mut Observer<'_>| self.0.surface_records(control, &record.0, observer);
        let surface = py.detach(|| watched(None, call))?;
        let speed = self.0.apparent_velocity();
        turned(azimuth, move || TravellingWave::new(surface.clone(), speed, origin))
    }
}
