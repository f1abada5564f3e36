//! Ground of the full-plane boundary element method of Patel & Spyrakos.

use std::cell::Cell;

use super::ground_state::PreparedBoundary;
use super::stability_symbol::BoundarySymbol;
use super::static_limit::static_compliance;
use super::{
    Boundary, BoundaryCondition, BoundaryKernel, IncidentField, Segment, Stability, TimeKernel,
};
use crate::bem::{ContactElement, Ground, GroundDescription, NOT_PREPARED, StaticKernel, Strip};
use crate::error::{Error, GroundError, Observer, Result, same_length};
use crate::geometry::{COMPONENTS_IN_PLANE, ContactLayout};
use crate::motion::FreeField;
use crate::soil::Soil;

/// Length L₀ of the static solution over the contact length; the static full plane does not determine this length.
const REFERENCE_LENGTH_RATIO: f64 = 10.0;

/// Largest growth per step with which a run may begin: e-fold growth then takes 10 000 steps.
const MAX_GROWTH_PER_STEP: f64 = 1e-4;

/// Function that computes the kernel for a boundary and a time step.
type MakeKernel = dyn Fn(&[Segment], Soil, f64) -> Result<Box<dyn BoundaryKernel>> + Send;

/// Ground of the full-plane boundary element method of Patel & Spyrakos.
///
/// The free surface on both sides of the base is discretised. In every step the displacements of the
/// traction-free elements are eliminated from H⁰ u = G⁰ t + history (eqs. 17–18, 21); the contact elements
/// remain. The step compliance is not symmetric. [`ElasticGround`](crate::bem::ElasticGround) needs no free
/// surface and is always stable. This ground serves for comparison with the paper and for boundaries that are
/// not flat.
///
/// Displacements refer to the midpoints of the contact elements. Runs on this ground cannot be saved as a
/// [`Checkpoint`](crate::coupled::Checkpoint).
///
/// # Stability
///
/// The scheme is not stable for every step: see [the module](super). The builder of a simulation calls
/// [`Ground::prepare`], which assesses the discrete operator for this boundary, step and kernel, with the
/// base uplifted and with the base bonded. It returns [`GroundError::Unstable`](crate::bem::GroundError::Unstable) if
/// perturbations grow by more than 1e-4 per step. [`FullPlaneGround::assess`] returns the growth. The assessment takes
/// the time of a thousand factorisations of complex matrices of order 2E, and ten times that time if modes grow. After
/// [`FullPlaneGround::allow_growth`] there is no assessment.
///
/// ```
/// use basemat::{Soil, bem::{Ground, full_plane::FullPlaneGround}};
/// let soil = Soil::new(80.0e6, 0.25, 2000.0)?;
/// // Ten elements of 1 m and five free ones on either side, as in the paper. With this short step perturbations grow.
/// let mut ground = FullPlaneGround::strip(soil, -5.0..5.0, 10, 5)?.allow_growth();
/// ground.prepare(1.0e-3, None, &mut basemat::unobserved)?;
/// assert!(ground.assess(1.0e-3, 1e-4)?.iter().any(|stability| !stability.is_bounded()));
/// let mut matrix = vec![0.0; 20 * 20];
/// ground.step_compliance(&mut matrix)?;
/// // Waves have not reached the edges of the element: p·t/(ρ c₁).
/// let plane_wave = 1.0e-3 / (2000.0 * soil.pressure_wave_speed());
/// assert!((matrix[0] / plane_wave - 1.0).abs() < 1e-12);
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct FullPlaneGround {
    soil: Soil,
    boundary: Boundary,
    make_kernel: Box<MakeKernel>,
    incident: Option<Box<dyn IncidentField>>,
    /// Whether a run may begin although perturbations grow.
    may_grow: bool,
    /// Last time step at which no perturbation grows.
    stable_time_step: Option<f64>,
    /// Whether there are both a motion of the scene and an incident field.
    has_two_motions: Cell<bool>,
    prepared_boundary: Option<PreparedBoundary>,
}

short_debug! {
    FullPlaneGround;
    self;
    soil: self.soil,
    segments: self.boundary.segments().len(),
    elements: self.boundary.contact().len(),
    prepared: self.prepared_boundary.is_some(),
}

impl FullPlaneGround {
    /// Ground of one strip of equal elements on a flat surface.
    ///
    /// The strip has `count` elements over `range` (m), and `free_count` traction-free elements of the same length
    /// on either side (the paper has 5).
    ///
    /// # Errors
    /// As for [`Strip::new`] and [`Boundary::flat`].
    pub fn strip(
        soil: Soil,
        range: std::ops::Range<f64>,
        count: usize,
        free_count: usize,
    ) -> Result<Self> {
        let boundary = Boundary::flat(&[Strip::uniform(range, count)?], free_count)?;
        Ok(Self::new(soil, boundary))
    }

    /// Ground with any boundary.
    ///
    /// A boundary that is not flat scatters the ground motion, and needs
    /// [`FullPlaneGround::with_incident_field`] before the ground is prepared.
    pub fn new(soil: Soil, boundary: Boundary) -> Self {
        let make_kernel = Box::new(|segments: &[Segment], soil, time_step| {
            Ok(Box::new(TimeKernel::new(soil, segments, time_step)?) as Box<dyn BoundaryKernel>)
        });
        Self {
            soil,
            boundary,
            make_kernel,
            incident: None,
            may_grow: false,
            stable_time_step: None,
            has_two_motions: Cell::new(false),
            prepared_boundary: None,
        }
    }

    /// Replaces the coefficients of [`TimeKernel`].
    ///
    /// `make` is called with the elements, the soil and the time step when the step is known. The soil is
    /// homogeneous, so coefficients may depend only on the relative position of two elements. They are
    /// computed for one pair of each kind.
    #[must_use]
    pub fn with_kernel(
        mut self,
        make: impl Fn(&[Segment], Soil, f64) -> Result<Box<dyn BoundaryKernel>> + Send + 'static,
    ) -> Self {
        self.make_kernel = Box::new(make);
        self.stable_time_step = None;
        self
    }

    /// Permits runs in which perturbations grow, and skips the assessment.
    #[must_use]
    pub fn allow_growth(mut self) -> Self {
        self.may_grow = true;
        self
    }

    /// Growth for steps of `time_step` seconds: with the base uplifted, and with the base bonded.
    ///
    /// All elements are free of traction under an uplifted base; contact elements have prescribed displacements under a
    /// bonded base. A partly open base, and the structure on it, are not assessed. A structure stabilises the elements in
    /// contact with it. `smallest_growth`: as for [`Stability::assess`].
    ///
    /// ```
    /// use basemat::{Error, Soil, bem::{Ground, GroundError, full_plane::FullPlaneGround}, unobserved};
    /// let soil = Soil::new(80.0e6, 1.0 / 3.0, 2000.0)?;
    /// let step = |beta: f64| beta / soil.pressure_wave_speed();
    /// let mut ground = FullPlaneGround::strip(soil, -3.0..3.0, 6, 5)?;
    /// // The step of the paper, β = 1/2.
    /// let [uplifted, _] = ground.assess(step(0.5), 1e-4)?;
    /// assert!(uplifted.growth_per_step > 0.05 && !uplifted.is_bounded());
    /// let error = ground.prepare(step(0.5), None, &mut unobserved).unwrap_err();
    /// assert!(matches!(error, Error::Ground(GroundError::Unstable { .. })));
    /// ground.allow_growth().prepare(step(0.5), None, &mut unobserved)?;
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// The errors of [`Stability::assess`] and of the kernel.
    pub fn assess(&self, time_step: f64, smallest_growth: f64) -> Result<[Stability; 2]> {
        let kernel = (self.make_kernel)(self.boundary.segments(), self.soil, time_step)?;
        self.assess_kernel(kernel.as_ref(), smallest_growth)
    }

    /// Growth with this kernel: with the base uplifted, and with the base bonded.
    fn assess_kernel(
        &self,
        kernel: &dyn BoundaryKernel,
        smallest_growth: f64,
    ) -> Result<[Stability; 2]> {
        let mut conditions = vec![BoundaryCondition::TractionFree; self.boundary.segments().len()];
        let mut symbol = BoundarySymbol::new(kernel, &conditions)?;
        let uplifted = Stability::from_symbol(&symbol, smallest_growth)?;
        for &element in self.boundary.contact() {
            conditions[element] = BoundaryCondition::PrescribedDisplacement;
        }
        symbol.prescribe(&conditions)?;
        Ok([uplifted, Stability::from_symbol(&symbol, smallest_growth)?])
    }

    /// Error if perturbations grow.
    fn check_growth(&mut self, kernel: &dyn BoundaryKernel, time_step: f64) -> Result<()> {
        if self.may_grow || self.stable_time_step == Some(time_step) {
            return Ok(());
        }
        let [uplifted, bonded] = self.assess_kernel(kernel, MAX_GROWTH_PER_STEP)?;
        let bonded_is_faster = bonded.growth_per_step > uplifted.growth_per_step;
        let faster_growth = if bonded_is_faster { bonded } else { uplifted };
        if !faster_growth.is_bounded() {
            let Stability { growth_per_step, growing_modes } = faster_growth;
            return Err(GroundError::Unstable { growth_per_step, growing_modes }.into());
        }
        self.stable_time_step = Some(time_step);
        Ok(())
    }

    /// Adds waves from below, which the boundary scatters (eq. 21).
    ///
    /// They replace the ground motion of the scene, which must be at rest.
    #[must_use]
    pub fn with_incident_field(mut self, field: impl IncidentField + 'static) -> Self {
        self.incident = Some(Box::new(field));
        self
    }

    /// Soil of the ground.
    pub fn soil(&self) -> Soil {
        self.soil
    }

    /// Boundary of the soil.
    pub fn boundary(&self) -> &Boundary {
        &self.boundary
    }

    /// Displacements of all elements at the end of the last step (2E, m; x first, then z down).
    ///
    /// They are relative to the incident field, and empty before [`Ground::prepare`].
    pub fn displacement(&self) -> &[f64] {
        self.prepared_boundary
            .as_ref()
            .map_or(&[], |prepared_boundary| &prepared_boundary.displacement)
    }
}

impl Ground for FullPlaneGround {
    fn elements(&self) -> &[ContactElement] {
        self.boundary.contact_elements()
    }

    /// Assesses stability first, see [`FullPlaneGround`]; a ground with growth is not prepared.
    fn prepare(
        &mut self,
        time_step: f64,
        steps: Option<usize>,
        _observer: &mut Observer<'_>,
    ) -> Result<()> {
        if self.incident.is_none() && !self.boundary.is_flat() {
            return Err(Error::Scene {
                quantity: "full-plane ground",
                needed: "a boundary that is not flat scatters the ground motion and needs \
                         `with_incident_field`",
            });
        }
        let kernel = (self.make_kernel)(self.boundary.segments(), self.soil, time_step)?;
        self.check_growth(kernel.as_ref(), time_step)?;
        let has_incident_field = self.incident.is_some();
        let mut prepared_boundary =
            PreparedBoundary::new(&self.boundary, kernel, time_step, has_incident_field)?;
        prepared_boundary.history.prepare(steps.unwrap_or(0))?;
        self.prepared_boundary = Some(prepared_boundary);
        self.has_two_motions.set(false);
        Ok(())
    }

    fn description(&self) -> GroundDescription {
        let shear_wave_speed = Some(self.soil.shear_wave_speed());
        GroundDescription { shear_wave_speed, soils: vec![self.soil], ..Default::default() }
    }

    /// Overwrites `matrix` with the step compliance, which is not symmetric.
    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        let Some(prepared_boundary) = &self.prepared_boundary else {
            return Err(NOT_PREPARED);
        };
        let contact_layout = ContactLayout::new(COMPONENTS_IN_PLANE, self.boundary.contact().len());
        same_length("step compliance", matrix.len(), contact_layout.matrix_len())?;
        self.boundary.compliance(&prepared_boundary.contact_compliance.columns, matrix);
        Ok(())
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        let Some(prepared_boundary) = &mut self.prepared_boundary else {
            return Err(NOT_PREPARED);
        };
        if self.has_two_motions.get() {
            return Err(TWO_GROUND_MOTIONS);
        }
        let contact_rows = self.boundary.contact_rows();
        same_length(
            "displacement of the history",
            displacement.len(),
            contact_rows.clone().count(),
        )?;
        prepared_boundary.update_history_displacement(&self.boundary, self.incident.as_deref())?;
        for (value, row) in displacement.iter_mut().zip(contact_rows) {
            *value = prepared_boundary.history_displacement[row];
        }
        Ok(())
    }

    fn commit(&mut self, traction: &[f64]) {
        if let Some(prepared_boundary) = &mut self.prepared_boundary {
            // If this fails, the next history fails in the same way.
            if prepared_boundary
                .update_history_displacement(&self.boundary, self.incident.as_deref())
                .is_ok()
            {
                prepared_boundary.commit(&self.boundary, traction);
            }
        }
    }

    /// Overwrites `matrix` with the static compliance.
    ///
    /// A flat boundary has the compliance of the half-plane, whose free surface is infinite. Another boundary
    /// has the static limit of the same boundary equation (not symmetric).
    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        let elements = self.elements();
        let contact_layout = ContactLayout::new(COMPONENTS_IN_PLANE, elements.len());
        same_length("static compliance", matrix.len(), contact_layout.matrix_len())?;
        if self.boundary.is_flat() {
            return StaticKernel::under(self.soil, elements)?.compliance(elements, matrix);
        }
        let contact_length = elements[elements.len() - 1].right() - elements[0].left();
        let reference_length = REFERENCE_LENGTH_RATIO * contact_length;
        static_compliance(self.soil, &self.boundary, reference_length, matrix)
    }

    /// Overwrites `displacement` with the incident field at the midpoints, or with the motion of the scene.
    ///
    /// If there are both, the values are not finite, and the next history returns an error.
    fn free_field(&self, motion: &dyn FreeField, time: f64, displacement: &mut [f64]) {
        let contact = self.boundary.contact();
        let segments = self.boundary.segments();
        let [down, tangential] =
            ContactLayout::new(COMPONENTS_IN_PLANE, contact.len()).split_mut(displacement);
        for ((&index, down), tangential) in contact.iter().zip(down).zip(tangential) {
            let center = segments[index].center();
            let scene_motion = motion.displacement(center[0], time);
            let Some(field) = &self.incident else {
                // The record is positive up, the contact component down.
                *tangential = scene_motion[0];
                *down = -scene_motion[1];
                continue;
            };
            if scene_motion == [0.0; 2] {
                [*tangential, *down] = field.displacement(center, time);
            } else {
                self.has_two_motions.set(true);
                [*tangential, *down] = [f64::NAN; 2];
            }
        }
    }
}

/// Error for a ground motion of the scene together with an incident field.
const TWO_GROUND_MOTIONS: Error = Error::Scene {
    quantity: "ground motion",
    needed: "none in the scene: the full-plane ground has an incident field",
};
