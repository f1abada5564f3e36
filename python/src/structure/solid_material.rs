//! Materials of solids: those that yield, and lists of materials.

use std::sync::Arc;

use basemat::fem::{DruckerPrager, Iwan, Material, SharedMaterial};
use numpy::{PyUntypedArray, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};

use super::connectivity::one_of;
use super::material::PyMaterial;
use crate::array::{Pairs, Rows, Table};
use crate::error::{OrRaise, input_error, raise_user_exceptions};
use crate::list_arguments::type_error;
use crate::user;

/// Undrained clay, a material of solids in plane strain. It yields in shear only, along any concave backbone.
///
/// Elastic–perfectly plastic components act in parallel (Iwan 1967, Besseling 1958), so that the stress in simple shear
/// follows the backbone, and unloads and reloads by Masing's rules. The strength is the stress of the last point; it
/// does not depend on the mean stress, which stays elastic. An initial stress must lie within the strength: with principal
/// stresses σ_v and σ_h its √J₂ is |σ_v − σ_h|/√3 in plane strain with σ_z = σ_h.
///
/// ``points``: array of shape (n, 2) of shear strain γ (engineering, 0.01 is 1 %) and shear stress τ (Pa) in simple
/// shear, without the origin. The backbone is straight between points and constant beyond the last one. ``poisson``: Poisson's
/// ratio ν of small strains; the bulk modulus is 2 G (1 + ν)/(3 (1 − 2ν)) with G = τ/γ of the first point. ``density``:
/// kg/m³; 0 is allowed.
#[pyclass(name = "Iwan", module = "basemat", frozen, dict)]
pub(crate) struct PyIwan(Arc<Iwan>);

impl From<Iwan> for PyIwan {
    fn from(soil: Iwan) -> Self {
        Self(Arc::new(soil))
    }
}

#[pymethods]
impl PyIwan {
    #[new]
    fn new(points: Pairs, poisson: f64, density: f64) -> PyResult<Self> {
        Iwan::new(&points.0, poisson, density).or_raise().map(Self::from)
    }

    /// Soil with a hyperbolic backbone from its ``shear_modulus`` G of small strains (Pa) and its ``strength`` τ_s (Pa), which
    /// it reaches at the shear strain ``limit_strain`` γ_n; 200 τ_s/G is usual. ``poisson`` and ``density`` are as in the class.
    ///
    /// The backbone is τ = G γ/(1 + G γ/τ_m) with 1/τ_m = 1/τ_s − 1/(γ_n G), at 12 strains in a geometric series from
    /// 0.02 τ_s/G to γ_n. Up to the first of them it is straight with the slope G. γ_n must be 5 τ_s/G or more.
    #[staticmethod]
    fn hyperbolic(
        shear_modulus: f64,
        strength: f64,
        limit_strain: f64,
        poisson: f64,
        density: f64,
    ) -> PyResult<Self> {
        let soil = Iwan::hyperbolic(shear_modulus, strength, limit_strain, poisson, density);
        soil.or_raise().map(Self::from)
    }

    /// Points of the backbone: array of shape (n, 2) of shear strain and shear stress (Pa).
    #[getter]
    fn points(&self) -> Rows {
        Rows(self.0.points().iter().map(|point| point.to_vec()).collect())
    }

    /// Shear modulus G of small strains, Pa.
    #[getter]
    fn shear_modulus(&self) -> f64 {
        self.0.shear_modulus()
    }

    /// Bulk modulus, Pa.
    #[getter]
    fn bulk_modulus(&self) -> f64 {
        self.0.bulk_modulus()
    }

    /// Shear strength, Pa: the stress of the last point.
    #[getter]
    fn strength(&self) -> f64 {
        self.0.strength()
    }
}

/// Sand or other drained soil, a material of solids in plane strain. It yields on Drucker–Prager's cone, which matches
/// Mohr–Coulomb's law in plane strain.
///
/// It is elastic–perfectly plastic, with a ``cohesion`` c (Pa), a ``friction_angle`` φ and a ``dilation_angle`` ψ
/// (rad), 0 ≤ ψ ≤ φ < π/2; ``elastic`` is its `Material`. A smaller ψ than φ makes the tangent unsymmetric, and steps
/// take longer. Stress beyond the tip of the cone returns to the tip. With φ = 0 it is von Mises' law with the shear
/// strength c, and with ψ = 0 the plastic strain has no change of volume.
///
/// An initial stress must lie within the cone. Without cohesion the stress at rest with σ_h = (1 − sin φ) σ_v lies
/// outside the cone for φ above about 36°; and without an initial stress a soil without cohesion has no strength.
#[pyclass(name = "DruckerPrager", module = "basemat", frozen, dict)]
pub(crate) struct PyDruckerPrager(Arc<DruckerPrager>);

#[pymethods]
impl PyDruckerPrager {
    #[new]
    fn new(
        elastic: &PyMaterial,
        cohesion: f64,
        friction_angle: f64,
        dilation_angle: f64,
    ) -> PyResult<Self> {
        let soil = DruckerPrager::new(elastic.0, cohesion, friction_angle, dilation_angle);
        Ok(Self(Arc::new(soil.or_raise()?)))
    }

    /// Cohesion c, Pa.
    #[getter]
    fn cohesion(&self) -> f64 {
        self.0.cohesion()
    }

    /// Friction angle φ, rad.
    #[getter]
    fn friction_angle(&self) -> f64 {
        self.0.friction_angle()
    }

    /// Dilation angle ψ, rad.
    #[getter]
    fn dilation_angle(&self) -> f64 {
        self.0.dilation_angle()
    }
}

/// A material of solids: linear elastic, one that yields, or one written in Python.
pub(crate) struct SolidLike(pub(super) SharedMaterial);

extracts!(SolidLike, object => {
    if let Ok(material) = object.cast::<PyMaterial>() {
        return Ok(Self(material.get().0.into()));
    }
    if let Ok(soil) = object.cast::<PyIwan>() {
        return Ok(Self(Arc::clone(&soil.get().0).into()));
    }
    if let Ok(soil) = object.cast::<PyDruckerPrager>() {
        return Ok(Self(Arc::clone(&soil.get().0).into()));
    }
    user::solid_material(&object).map(Self)
});

/// What elements other than quadrilaterals in plane strain need as material.
const ELASTIC_REQUIREMENT: &str =
    "a Material: bricks, shells and beams do not yield, quadrilaterals in the plane do";

/// Material of bricks, shells and beams: linear elastic.
pub(super) struct ElasticMaterial(pub(super) Material);

extracts!(ElasticMaterial, object => match object.cast::<PyMaterial>() {
    Ok(material) => Ok(Self(material.get().0)),
    Err(_) => Err(type_error(&object, ELASTIC_REQUIREMENT)),
});

/// One elastic material for all elements, or a list of one for each.
pub(super) struct ElasticList(pub(super) Vec<Material>);

extracts!(ElasticList, object => {
    if !is_list(&object) {
        return Ok(Self(vec![object.extract::<ElasticMaterial>()?.0]));
    }
    let materials = object.try_iter()?.map(|entry| Ok(entry?.extract::<ElasticMaterial>()?.0));
    materials.collect::<PyResult<_>>().map(Self)
});

/// Whether an object is a list of materials: a list, a tuple or an array.
fn is_list(object: &Bound<'_, PyAny>) -> bool {
    object.is_instance_of::<PyList>()
        || object.is_instance_of::<PyTuple>()
        || object.cast::<PyUntypedArray>().is_ok_and(|array| array.ndim() > 0)
}

/// One material for all elements, or a list of one for each.
pub(super) struct SolidList(pub(super) Vec<SharedMaterial>);

extracts!(SolidList, object => {
    if !is_list(&object) {
        return Ok(Self(vec![object.extract::<SolidLike>()?.0]));
    }
    let mut materials: Vec<SharedMaterial> = Vec::new();
    let mut previous: Option<Bound<'_, PyAny>> = None;
    for entry in object.try_iter()? {
        let entry = entry?;
        // Neighbouring entries that are the same object share its material.
        let material = match (&previous, materials.last()) {
            (Some(previous), Some(material)) if previous.is(&entry) => material.clone(),
            _ => entry.extract::<SolidLike>()?.0,
        };
        materials.push(material);
        previous = Some(entry);
    }
    Ok(Self(materials))
});

impl SolidList {
    /// Material of an `element` out of `element_count`.
    pub(super) fn at(&self, element: usize, element_count: usize) -> PyResult<SharedMaterial> {
        Ok(one_of(&self.0, "material", element, element_count)?.clone())
    }
}

/// Materials of a block: one, or a list of one for each row, whose entries may be lists of one for each column.
pub(super) struct BlockMaterials(Vec<SolidList>);

extracts!(BlockMaterials, object => {
    if !is_list(&object) {
        return Ok(Self(vec![object.extract()?]));
    }
    let mut rows: Vec<SolidList> = Vec::new();
    let mut previous: Option<Bound<'_, PyAny>> = None;
    for entry in object.try_iter()? {
        let entry = entry?;
        let row = match (&previous, rows.last()) {
            (Some(previous), Some(row)) if previous.is(&entry) => SolidList(row.0.clone()),
            _ => entry.extract()?,
        };
        rows.push(row);
        previous = Some(entry);
    }
    Ok(Self(rows))
});

impl BlockMaterials {
    /// Error unless there is one row or as many as the block has, each of one column or as many as the block has.
    pub(super) fn check(&self, column_count: usize, row_count: usize) -> PyResult<()> {
        let found_rows = self.0.len();
        if found_rows != 1 && found_rows != row_count {
            return Err(input_error(format!(
                "material has {found_rows} rows, but must have one, or {row_count} from the bottom"
            )));
        }
        for (row, columns) in self.0.iter().enumerate() {
            let found_columns = columns.0.len();
            if found_columns != 1 && found_columns != column_count {
                return Err(input_error(format!(
                    "row {row} of material has {found_columns} entries, but must have one, or {column_count} from the left"
                )));
            }
        }
        Ok(())
    }

    /// Material of an element of a block that was checked.
    pub(super) fn at(&self, column: usize, row: usize) -> SharedMaterial {
        let columns = &self.0[if self.0.len() == 1 { 0 } else { row }].0;
        columns[if columns.len() == 1 { 0 } else { column }].clone()
    }
}

/// Stresses or strains `[xx, yy, zz, xy]`: one for all, or one for each.
pub(crate) struct PlaneTensors(pub(super) Vec<[f64; 4]>);

extracts!(PlaneTensors, object => {
    if let Ok(components) = object.extract::<[f64; 4]>() {
        return Ok(Self(vec![components]));
    }
    let Table { column_count, rows } = Table::read(&object, "(4,) or (n, 4)")?;
    let components = rows.into_iter().map(<[f64; 4]>::try_from).collect::<Result<_, _>>();
    let requirement = "must be of shape (4,) or (n, 4): xx, yy, zz, xy";
    let text = format!("an array of {column_count} columns, but {requirement}");
    components.map(Self).map_err(|_| input_error(text))
});

impl PlaneTensors {
    /// Initial stress of an `element` out of `element_count`.
    pub(super) fn at(&self, element: usize, element_count: usize) -> PyResult<[f64; 4]> {
        Ok(*one_of(&self.0, "initial_stress", element, element_count)?)
    }
}

/// Stresses at the ``strains`` of a path through a ``material`` of solids, which starts without strain: array of shape
/// (n, 4), Pa.
///
/// ``material``: a `Material`, `Iwan`, `DruckerPrager` or `UserMaterial`. ``strains``: array of shape (n, 4) of xx, yy, zz
/// and xy, with the engineering shear strain; every state is committed. ``initial_stress``: stress at zero strain, xx, yy, zz
/// and xy (four numbers, Pa; tension is positive); none unless given.
#[pyfunction]
#[pyo3(signature = (material, strains, *, initial_stress=None))]
pub(crate) fn stress_path(
    material: SolidLike,
    strains: PlaneTensors,
    initial_stress: Option<[f64; 4]>,
) -> PyResult<Rows> {
    let law = material.0.law();
    raise_user_exceptions(|| {
        let mut variables = vec![0.0; law.variable_count()];
        law.initialize(initial_stress.unwrap_or_default(), &mut variables).or_raise()?;
        let mut stresses = Vec::with_capacity(strains.0.len());
        for strain in strains.0 {
            stresses.push(law.stress(strain, &variables).or_raise()?.to_vec());
            law.commit(strain, &mut variables);
        }
        Ok(Rows(stresses))
    })
}
