//! A scene: all data that stay constant during a run.

use std::sync::Arc;

use crate::coupled::base::PlacedBase;
use crate::coupled::base::influence::{ConnectedPart, UPWARD_DIRECTION};
use crate::coupled::base::transformation::{Transformation, Weights};
use crate::coupled::model::Model;
use crate::coupled::model::kinematics::Kinematics;
use crate::coupled::model::load::SteppedLoad;
use crate::coupled::parts::Parts;
use crate::coupled::scheme::SchemeCoefficients;
use crate::coupled::serviceability::Serviceability;
use crate::coupled::state::Context;
use crate::coupled::statics::static_state::StaticState;
use crate::error::LawError;
use crate::geometry::{ContactLayout, Footing};
use crate::interface::{InterfaceLaw, Mode, PreviousContacts, law_of};
use crate::linalg::matrix::spread;
use crate::linalg::{CompressedMatrix, mixing_sum};
use crate::structure::Probe;

/// Structure, base, laws and static state for steps; read-only once built.
///
/// Structure, ground and motion change during a run and are separate.
pub(crate) struct Scene {
    pub(crate) time_step: f64,
    pub(crate) coefficients: SchemeCoefficients,
    /// Whether the scheme conserves energy.
    pub(crate) conserves_energy: bool,
    pub(crate) model: Model,
    pub(crate) base: PlacedBase,
    pub(crate) laws: Vec<Box<dyn InterfaceLaw>>,
    /// Limits of serviceability, against which runs are checked.
    pub(crate) serviceability: Serviceability,
    pub(crate) static_state: StaticState,
    /// External loads in addition to the load of the structure.
    pub(crate) loads: Vec<SteppedLoad>,
    /// Weight as a load, in stepping coordinates, if the run begins without a static state; otherwise empty.
    pub(crate) weight: Vec<f64>,
    /// Parts that the nonlinear force joins with others.
    pub(crate) joined: Vec<bool>,
    /// Step compliance of the ground, 2Q × 2Q.
    pub(crate) soil: Arc<CompressedMatrix>,
    /// Free field at t = 0, which is subtracted from it later, 2Q.
    pub(crate) start_motion: Vec<f64>,
    /// Displacement, velocity and acceleration of each probe.
    pub(crate) probe_rows: Vec<ProbeRows>,
    /// Number of the gravity stage, and sums over the initial displacement and velocity, for comparison with a
    /// checkpoint.
    pub(crate) start: [f64; 3],
    /// The builder's label, for comparison with a checkpoint.
    pub(crate) label: String,
    /// Shared data for results of the scene's states.
    pub(crate) context: Arc<Context>,
}

/// A probe in stepping coordinates.
pub(crate) struct ProbeRows {
    pub(crate) rows: [Weights; 3],
    /// Displacement of an absolute probe by a translation of 1 m of each part `[right, up, away]`.
    pub(crate) carried: Vec<[f64; 3]>,
}

impl ProbeRows {
    pub(crate) fn new(probe: &Probe, model: &Model) -> Self {
        let rows = probe.rows().map(|row| model.transformation.row(row));
        let parts = model.influence.parts().iter().filter(|_| probe.absolute);
        let carried = parts
            .map(|part| part.vectors.each_ref().map(|r| rows[0].of(&spread(r, model.coordinates))));
        Self { carried: carried.collect(), rows }
    }
}

impl Scene {
    /// Collects the data that steps need from the parts.
    pub(crate) fn new(
        parts: &mut Parts,
        model: Model,
        base: PlacedBase,
        static_state: StaticState,
        joined: Vec<bool>,
    ) -> Self {
        let Parts { builder, coefficients, .. } = parts;
        let time_step = builder.time_step;
        let coefficients = *coefficients;
        let is_static = builder.is_static();
        let loads = std::mem::take(&mut builder.loads).into_iter();
        let loads = loads.map(|load| SteppedLoad::new(load, &model.transformation, is_static));
        let mut weight = Vec::new();
        if builder.falls() {
            weight.resize(model.coordinates, 0.0);
            let up = model.influence.of(UPWARD_DIRECTION, model.coordinates);
            model.mass.multiply_add(-builder.gravity, &up, &mut weight);
        }
        let elements = &parts.elements;
        let origin = parts.moment_center;
        let shapes = base.foundations().zip(base.outlines());
        let footings =
            shapes.map(|((_, range), outline)| Footing::new(elements, range, outline, origin));
        let probe_rows = builder.probes.iter().map(|probe| ProbeRows::new(probe, &model)).collect();
        let context = Context {
            probes: std::mem::take(&mut builder.probes),
            elements: elements.clone(),
            pressure_depths: std::mem::take(&mut parts.description.depth_of_pressure_at_rest),
            friction: std::mem::take(&mut builder.safety_friction),
            footings: footings.collect(),
        };
        Self {
            time_step,
            coefficients,
            conserves_energy: coefficients.conserves_energy(time_step),
            laws: std::mem::take(&mut builder.laws),
            serviceability: builder.serviceability,
            static_state,
            loads: loads.collect(),
            weight,
            joined,
            soil: parts.soil.clone(),
            start_motion: std::mem::take(&mut parts.start_motion),
            probe_rows,
            start: [
                builder.gravity_stage as usize as f64,
                mixing_sum(&builder.displacement),
                mixing_sum(&builder.velocity),
            ],
            label: std::mem::take(&mut builder.label),
            context: Arc::new(context),
            model,
            base,
        }
    }

    /// Number of contact elements Q.
    pub(crate) fn count(&self) -> usize {
        self.base.elements().len()
    }

    /// Order of the numbers of a contact vector.
    pub(crate) fn layout(&self) -> ContactLayout {
        self.base.layout()
    }

    /// The law of an element.
    pub(crate) fn law(&self, element: usize) -> &dyn InterfaceLaw {
        law_of(&self.laws, element)
    }

    /// Subtracts the mean translation of each part's base from a displacement, before K acts on it.
    ///
    /// A translation strains nothing. In degrees of freedom, K would give zero only by cancellation, with an error
    /// that grows with stiffness times displacement. In modes it has no stiffness.
    pub(crate) fn subtract_base(&self, displacement: &mut [f64], means: &mut [f64]) {
        if let Transformation::Identity = self.model.transformation {
            self.base.means(displacement, means);
            let influence = &self.model.influence;
            let parts = influence.parts().iter().map(|part| part.mean(&self.base, means));
            influence.translate(-1.0, parts, displacement);
        }
    }

    /// Subtracts from each part's displacement the mean translation of its base; nonlinear forces receive the
    /// result.
    ///
    /// The result stays small. From all parts that the force joins, the mean translation of the first of them is
    /// subtracted, so that the distances between them stay. The static displacement is added. `translations`: of
    /// the parts' free fields.
    pub(crate) fn to_force_displacement(
        &self,
        displacement: &mut [f64],
        means: &mut [f64],
        translations: impl Iterator<Item = [f64; 3]> + Clone,
    ) {
        self.base.means(displacement, means);
        let influence = &self.model.influence;
        let mean = |part: &ConnectedPart| part.mean(&self.base, means);
        let parts = || influence.parts().iter().zip(&self.joined);
        let first = parts().zip(translations.clone()).find(|((_, joined), _)| **joined);
        let first = first.map(|((part, _), y)| (mean(part), y));
        let shifts = parts().zip(translations).map(|((part, joined), y)| match first {
            Some((mean, reference)) if *joined => {
                [0, 1, 2].map(|k| (y[k] - reference[k]) - mean[k])
            }
            _ => mean(part).map(|component| -component),
        });
        influence.translate(1.0, shifts, displacement);
        for (entry, at_rest) in displacement.iter_mut().zip(&self.static_state.displacement) {
            *entry += at_rest;
        }
    }

    /// Displacement of a motion as the nonlinear force receives it.
    pub(crate) fn force_displacement_of(&self, motion: &Kinematics) -> Vec<f64> {
        let mut displacement = motion.displacement.clone();
        let translations = motion.translations.iter().map(|y| y.displacement);
        self.to_force_displacement(
            &mut displacement,
            &mut vec![0.0; self.layout().len()],
            translations,
        );
        displacement
    }

    /// Whether [`Scene::add_loads`] adds anything.
    pub(crate) fn has_loads(&self) -> bool {
        !(self.weight.is_empty() && self.loads.is_empty())
    }

    /// Adds the weight and the external loads at `time`, minus the loads of the static state, to `force`.
    ///
    /// Stops at a load that is not finite, and returns its number and value.
    pub(crate) fn add_loads(&self, time: f64, force: &mut [f64]) -> Option<(usize, f64)> {
        force.iter_mut().zip(&self.weight).for_each(|(force, weight)| *force += weight);
        let mut added = self.loads.iter().map(|load| load.add(time, force)).enumerate();
        added.find(|(_, value)| !value.is_finite())
    }

    /// Whether any law stores energy in its elements, or may do so with other state variables.
    pub(crate) fn is_compliant(&self, start: &PreviousContacts) -> Result<bool, LawError> {
        let mut compliant = false;
        for element in 0..self.count() {
            for &mode in self.law(element).modes() {
                compliant |= self.compliance(element, mode, start)? != [0.0; 2];
            }
        }
        Ok(compliant || !start.state_variables().is_empty())
    }

    /// Compliance of an element whose step ends in `mode`.
    pub(crate) fn compliance(
        &self,
        element: usize,
        mode: Mode,
        start: &PreviousContacts,
    ) -> Result<[f64; 2], LawError> {
        let compliance = self.law(element).compliance(mode, &start.element(element));
        let named = [("normal compliance", compliance[0]), ("shear compliance", compliance[1])];
        match named.into_iter().find(|(_, value)| !value.is_finite()) {
            None => Ok(compliance),
            Some((quantity, value)) => {
                Err(LawError::not_finite(element, mode.word(), quantity, value))
            }
        }
    }
}
