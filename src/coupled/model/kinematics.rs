//! Displacement, velocity and acceleration of the structure in stepping coordinates.

use std::sync::{Arc, OnceLock};

use crate::coupled::base::influence::Influence;
use crate::coupled::base::transformation::Transformation;
use crate::coupled::model::Model;
use crate::coupled::scheme::SchemeCoefficients;

/// Mean translation of the free field under a part, `[right, up, along_y]`.
///
/// The last component is zero in the plane.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Translation {
    /// Translation y at the end of the step, m.
    pub(crate) displacement: [f64; 3],
    /// Increment Δy of the step, m.
    pub(crate) increment: [f64; 3],
    /// Velocity at the time of v* of the time scheme, m/s.
    ///
    /// With it, a structure that moves with the ground has no damping force.
    pub(crate) velocity: [f64; 3],
    /// Velocity at the end of the step, m/s.
    pub(crate) new_velocity: [f64; 3],
    /// Acceleration at the end of the step, m/s².
    pub(crate) new_acceleration: [f64; 3],
}

impl Translation {
    /// The translation of the next step, which ends at `displacement`.
    pub(crate) fn next(&self, displacement: [f64; 3], c: &SchemeCoefficients) -> Self {
        let increment: [f64; 3] = std::array::from_fn(|k| displacement[k] - self.displacement[k]);
        let apply_scheme = |coefficients| -> [f64; 3] {
            std::array::from_fn(|k| {
                let velocity = self.new_velocity[k];
                SchemeCoefficients::apply(
                    coefficients,
                    increment[k],
                    velocity,
                    self.new_acceleration[k],
                )
            })
        };
        Self {
            displacement,
            increment,
            velocity: apply_scheme(c.velocity),
            new_velocity: apply_scheme(c.new_velocity),
            new_acceleration: apply_scheme(c.new_acceleration),
        }
    }
}

/// Motion of the structure: relative displacement, total velocity and total acceleration.
///
/// The displacement is relative to the free field's translation. Values in degrees of freedom are computed at their
/// first use and stored.
#[derive(Clone)]
pub(crate) struct Kinematics {
    pub(crate) displacement: Vec<f64>,
    pub(crate) velocity: Vec<f64>,
    pub(crate) acceleration: Vec<f64>,
    /// The free field's translation under each part.
    pub(crate) translations: Vec<Translation>,
    influence: Arc<Influence>,
    transformation: Transformation,
    /// Quantities in degrees of freedom that have been computed, by [`DofResponse`].
    dof_cache: [OnceLock<Vec<f64>>; 4],
}

/// Quantity of [`Kinematics`] in degrees of freedom.
#[derive(Debug, Clone, Copy)]
pub(crate) enum DofResponse {
    Displacement,
    Velocity,
    Acceleration,
    AbsoluteDisplacement,
}

impl Kinematics {
    /// Zero displacement, velocity and acceleration.
    pub(crate) fn new(model: &Model) -> Self {
        Self {
            displacement: vec![0.0; model.coordinate_count],
            velocity: vec![0.0; model.coordinate_count],
            acceleration: vec![0.0; model.coordinate_count],
            translations: vec![Translation::default(); model.influence.parts().len()],
            influence: model.influence.clone(),
            transformation: model.transformation.clone(),
            dof_cache: Default::default(),
        }
    }

    /// Discards the stored degrees of freedom; call it after a change of the coordinates.
    pub(crate) fn clear_dof_cache(&mut self) {
        self.dof_cache.iter_mut().for_each(|values| drop(values.take()));
    }

    /// A quantity in degrees of freedom.
    pub(crate) fn dofs(&self, quantity: DofResponse) -> &[f64] {
        let coordinates = match quantity {
            DofResponse::Displacement | DofResponse::AbsoluteDisplacement => &self.displacement,
            DofResponse::Velocity => &self.velocity,
            DofResponse::Acceleration => &self.acceleration,
        };
        let is_absolute = matches!(quantity, DofResponse::AbsoluteDisplacement);
        if let (Transformation::Identity, false) = (&self.transformation, is_absolute) {
            return coordinates;
        }
        self.dof_cache[quantity as usize].get_or_init(|| {
            let mut values = coordinates.clone();
            if is_absolute {
                let translations = self.translations.iter().map(|y| y.displacement);
                self.influence.translate(1.0, translations, &mut values);
            }
            self.transformation.dofs(values)
        })
    }
}

/// All quantities, with their names for `Debug`.
const RESPONSE_QUANTITIES: [(DofResponse, &str); 4] = [
    (DofResponse::Displacement, "displacement"),
    (DofResponse::Velocity, "velocity"),
    (DofResponse::Acceleration, "acceleration"),
    (DofResponse::AbsoluteDisplacement, "absolute_displacement"),
];

impl PartialEq for Kinematics {
    fn eq(&self, other: &Self) -> bool {
        RESPONSE_QUANTITIES
            .into_iter()
            .all(|(quantity, _)| self.dofs(quantity) == other.dofs(quantity))
    }
}

impl std::fmt::Debug for Kinematics {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut debug_struct = f.debug_struct("Kinematics");
        for (quantity, name) in RESPONSE_QUANTITIES {
            debug_struct.field(name, &self.dofs(quantity));
        }
        debug_struct.finish()
    }
}
