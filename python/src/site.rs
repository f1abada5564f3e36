//! Strain curves of soils, and the equivalent-linear response of a site.

use std::sync::Arc;

use basemat::site::{ComplexModulus, EquivalentLinear, EquivalentLinearOptions};
use basemat::soil::StrainCurves;
use pyo3::prelude::*;

use crate::array::{Array, Numbers, Pairs, Rows, whole_numbers};
use crate::error::{OrRaise, input_error};
use crate::list_arguments::ListOf;
use crate::motion::{PyColumn, PyRecord, control_point};
use crate::names::choice;
use crate::profile::PySoilProfile;
use crate::structure::PyIwan;
use crate::ticker::with_progress;

/// Modulus reduction and damping ratio of a soil over shear strain.
///
/// The modulus reduction is G/G_max. A strain of 0.01 is 1 %.
#[pyclass(name = "StrainCurves", module = "basemat", frozen, dict)]
pub(crate) struct PyStrainCurves(StrainCurves);

/// The curves as an object of Python; an error if their parameters are invalid.
fn checked_curves(curves: StrainCurves) -> PyResult<PyStrainCurves> {
    curves.at(0.0).or_raise()?;
    Ok(PyStrainCurves(curves))
}

#[pymethods]
impl PyStrainCurves {
    /// A soil or rock that stays linear, with this ``damping`` ratio.
    #[staticmethod]
    fn linear(damping: f64) -> PyResult<Self> {
        checked_curves(StrainCurves::Linear { damping })
    }

    /// Sand by Seed and Idriss (1970): ``bound`` "mean" (the default), or "upper" for the upper modulus and the lower
    /// damping.
    #[pyo3(signature = (bound="mean"))]
    #[staticmethod]
    fn seed_idriss(bound: &str) -> PyResult<Self> {
        let bounds =
            [("mean", StrainCurves::SeedIdrissMean), ("upper", StrainCurves::SeedIdrissUpper)];
        checked_curves(choice("bound", bound, &bounds)?)
    }

    /// Soil with this ``plasticity_index``, per cent, after Vucetic and Dobry (1991).
    #[staticmethod]
    fn vucetic_dobry(plasticity_index: f64) -> PyResult<Self> {
        checked_curves(StrainCurves::VuceticDobry { plasticity_index })
    }

    /// Sand by the ``depth`` (m) of the middle of its layer, after EPRI (1993).
    #[staticmethod]
    fn epri(depth: f64) -> PyResult<Self> {
        checked_curves(StrainCurves::Epri { depth })
    }

    /// Soil after Darendeli (2001) by its ``plasticity_index`` (per cent), overconsolidation ratio
    /// ``overconsolidation``, effective ``mean_stress`` (Pa), the ``frequency`` (Hz; 1 by default) and the number of
    /// ``cycles`` (10 by default).
    #[pyo3(signature = (plasticity_index, overconsolidation, mean_stress, *, frequency=1.0, cycles=10.0))]
    #[staticmethod]
    fn darendeli(
        plasticity_index: f64,
        overconsolidation: f64,
        mean_stress: f64,
        frequency: f64,
        cycles: f64,
    ) -> PyResult<Self> {
        checked_curves(StrainCurves::Darendeli {
            plasticity_index,
            overconsolidation,
            mean_stress,
            frequency,
            cycles,
        })
    }

    /// A table: arrays of shape (n,) of increasing ``strains``, of their ``modulus_ratios`` G/G_max and of damping
    /// ratios, ``dampings``.
    #[staticmethod]
    fn table(strains: Numbers, modulus_ratios: Numbers, dampings: Numbers) -> PyResult<Self> {
        let lengths = [strains.0.len(), modulus_ratios.0.len(), dampings.0.len()];
        if lengths != [lengths[0]; 3] {
            return Err(input_error(format!(
                "arrays of lengths {lengths:?}, but their lengths must be equal"
            )));
        }
        let rows = strains.0.iter().zip(&modulus_ratios.0).zip(&dampings.0);
        checked_curves(StrainCurves::Table(
            rows.map(|((strain, modulus_ratio), damping)| [*strain, *modulus_ratio, *damping])
                .collect(),
        ))
    }

    /// Soil whose stress–strain loops follow Masing's rules on a backbone: the equivalent-linear approximation of `Iwan`.
    ///
    /// ``points``: array of shape (n, 2) of shear strain (engineering) and shear stress (Pa), such as ``Iwan.points``.
    /// The backbone is straight from the origin and between points, and constant beyond the last one. With the area A
    /// under it up to the strain γ and its stress τ, the damping ratio is ``small_strain_damping`` + (2/π)(2A/(γτ) −
    /// 1). ``small_strain_damping``: damping ratio in addition to that of Masing's loops, often 0.005 to 0.02; 0 by
    /// default.
    #[staticmethod]
    #[pyo3(signature = (points, *, small_strain_damping=0.0))]
    fn masing(points: Pairs, small_strain_damping: f64) -> PyResult<Self> {
        StrainCurves::masing(&points.0, small_strain_damping).or_raise().map(Self)
    }

    /// The `Iwan` soil that yields along these curves up to a ``strength`` (Pa), with the ``shear_modulus`` G_max (Pa);
    /// ``poisson`` and ``density`` (kg/m³) are those of `Iwan`.
    ///
    /// The backbone G_max (G/G_max) γ is straight between the points of the curves, and ends where it reaches the
    /// strength; curves that end below the strength are continued with their last slope. Damping follows from Masing's
    /// rules, not from the curves of damping.
    fn iwan(
        &self,
        shear_modulus: f64,
        strength: f64,
        poisson: f64,
        density: f64,
    ) -> PyResult<PyIwan> {
        let soil = self.0.iwan(shear_modulus, strength, poisson, density);
        soil.or_raise().map(PyIwan::from)
    }

    /// G/G_max and damping ratios at ``strains`` (array of shape (n,)): two arrays of shape (n,).
    fn at(&self, strains: Numbers) -> PyResult<(Array, Array)> {
        let results = strains.0.iter().map(|strain| self.0.at(*strain));
        let values: Vec<[f64; 2]> = results.collect::<Result<_, _>>().or_raise()?;
        let modulus_ratios = values.iter().map(|[modulus_ratio, _]| *modulus_ratio).collect();
        Ok((modulus_ratios, values.iter().map(|[_, damping]| *damping).collect()))
    }
}

/// Conventions of the complex modulus by their names.
const MODULUS_CONVENTIONS: [(&str, ComplexModulus); 2] =
    [("real_part", ComplexModulus::RealPart), ("magnitude", ComplexModulus::Magnitude)];

#[pymethods]
impl PyColumn {
    /// Response with strain-compatible properties, an `EquivalentLinear`, to the ``record`` of the ``control``
    /// point, "outcrop" (the default) or "within"; ``curves``: a list of `StrainCurves`, one per layer.
    ///
    /// ``strain_ratio``: ratio of the effective to the largest strain, often (M − 1)/10 for the magnitude M; 0.65
    /// unless given. ``tolerance``: relative tolerance of moduli and damping ratios; 1e-3 unless given.
    /// ``most_iterations``: largest number of iterations; 50 unless given. ``band``: frequencies (Hz) between which
    /// damping is constant; 0.1 to 30 Hz unless given. ``complex_modulus`` of the layers: "real_part", G(1 + 2iξ) (the
    /// default), or "magnitude", G(1 − 2ξ² + 2iξ√(1 − ξ²)) as in SHAKE91.
    #[pyo3(signature = (record, curves, *, control="outcrop", strain_ratio=None, tolerance=None, most_iterations=None, band=None, complex_modulus="real_part"))]
    fn equivalent_linear(
        &self,
        py: Python<'_>,
        record: &PyRecord,
        curves: ListOf<'_, PyStrainCurves>,
        control: &str,
        strain_ratio: Option<f64>,
        tolerance: Option<f64>,
        #[pyo3(from_py_with = whole_numbers)] most_iterations: Option<usize>,
        band: Option<[f64; 2]>,
        complex_modulus: &str,
    ) -> PyResult<PyEquivalentLinear> {
        let defaults = EquivalentLinearOptions::default();
        let options = EquivalentLinearOptions {
            control: control_point(control)?,
            strain_ratio: strain_ratio.unwrap_or(defaults.strain_ratio),
            tolerance: tolerance.unwrap_or(defaults.tolerance),
            most_iterations: most_iterations.unwrap_or(defaults.most_iterations),
            band: band.unwrap_or(defaults.band),
            complex_modulus: choice("complex_modulus", complex_modulus, &MODULUS_CONVENTIONS)?,
        };
        let curves: Vec<_> = curves.iter().map(|curves| curves.get().0.clone()).collect();
        let response = py.detach(|| {
            with_progress(None, |observer| {
                self.0.equivalent_linear(&record.0, &curves, &options, observer)
            })
        });
        Ok(PyEquivalentLinear(response?))
    }
}

/// Response of a site with strain-compatible properties: arrays have one value per layer from the surface down; arrays
/// of accelerations end with one more value, of the base under the layers. Printed, it is a table.
#[pyclass(name = "EquivalentLinear", module = "basemat", frozen, dict)]
pub(crate) struct PyEquivalentLinear(EquivalentLinear);

#[pymethods]
impl PyEquivalentLinear {
    /// Depth of the tops of the layers: array of shape (layers,), m.
    #[getter]
    fn depth(&self) -> Array {
        self.0.layers.iter().map(|layer| layer.depth).collect()
    }

    /// Strain-compatible shear moduli: array of shape (layers,), Pa.
    #[getter]
    fn shear_modulus(&self) -> Array {
        self.0.layers.iter().map(|layer| layer.shear_modulus).collect()
    }

    /// Ratio of the strain-compatible shear moduli to those at small strain: array of shape (layers,).
    #[getter]
    fn modulus_ratio(&self) -> Array {
        self.0.layers.iter().map(|layer| layer.modulus_ratio).collect()
    }

    /// Strain-compatible damping ratio of each layer: array of shape (layers,).
    #[getter]
    fn damping(&self) -> Array {
        self.0.layers.iter().map(|layer| layer.damping).collect()
    }

    /// Largest shear strains in the middle of the layers, relative to 1: array of shape (layers,).
    #[getter]
    fn largest_strain(&self) -> Array {
        self.0.layers.iter().map(|layer| layer.largest_strain).collect()
    }

    /// Effective shear strains, at which the curves were read, relative to 1: array of shape (layers,).
    #[getter]
    fn effective_strain(&self) -> Array {
        self.0.layers.iter().map(|layer| layer.effective_strain).collect()
    }

    /// Largest absolute accelerations of the layer boundaries: array of shape (layers + 1,), m/s².
    #[getter]
    fn peak_acceleration(&self) -> Array {
        self.0.peak_accelerations.as_slice().into()
    }

    /// Number of linear calculations.
    #[getter]
    fn iterations(&self) -> usize {
        self.0.iterations
    }

    /// Estimate of the largest relative change of a modulus or damping ratio that all further iterations would cause.
    #[getter]
    fn last_change(&self) -> f64 {
        self.0.last_change
    }

    /// Texts of the warnings.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.0.warnings.iter().map(ToString::to_string).collect()
    }

    /// Accelerations at the tops of layers and base: array of shape (layers + 1, samples), m/s².
    #[getter]
    fn accelerations(&self) -> Rows {
        Rows(self.0.accelerations.clone())
    }

    /// Record of the free surface.
    #[getter]
    fn surface(&self) -> PyRecord {
        PyRecord(Arc::new(self.0.surface.clone()))
    }

    /// The site for a ground: strain-compatible moduli at its first frequency, damping constant over the band.
    fn profile(&self) -> PySoilProfile {
        PySoilProfile(self.0.profile.clone())
    }

    fn __str__(&self) -> String {
        self.0.to_string()
    }

    fn __repr__(&self) -> String {
        format!(
            "EquivalentLinear({} layers, {} iterations)",
            self.0.layers.len(),
            self.0.iterations
        )
    }
}
