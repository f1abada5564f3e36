//! Motion of the structure in stepping coordinates.

use std::sync::{Arc, OnceLock};

use crate::coupled::base::influence::Influence;
use crate::coupled::base::transformation::Transformation;
use crate::coupled::model::Model;
use crate::coupled::scheme::SchemeCoefficients;

/// Mean translation of the free field under a part, `[right, up, away]`; away is zero in the plane.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Translation {
    /// y at the end of the step, m.
    pub(crate) displacement: [f64; 3],
    /// Δy, m.
    pub(crate) increment: [f64; 3],
    /// Velocity at v* of the time scheme, so that a structure moving with the ground has no damping force.
    pub(crate) velocity: [f64; 3],
    /// Velocity and acceleration of the translation at the end of the step.
    pub(crate) new_velocity: [f64; 3],
    pub(crate) new_acceleration: [f64; 3],
}

impl Translation {
    /// The next translation, which ends at `displacement`.
    pub(crate) fn next(&self, displacement: [f64; 3], c: &SchemeCoefficients) -> Self {
        let increment: [f64; 3] = std::array::from_fn(|k| displacement[k] - self.displacement[k]);
        let stepped = |coefficients| -> [f64; 3] {
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
            velocity: stepped(c.velocity),
            new_velocity: stepped(c.new_velocity),
            new_acceleration: stepped(c.new_acceleration),
        }
    }
}

/// Displacement relative to the free field's translation, total velocity and total acceleration.
///
/// It stores the degrees of freedom after their first use.
#[derive(Clone)]
pub(crate) struct Kinematics {
    pub(crate) displacement: Vec<f64>,
    pub(crate) velocity: Vec<f64>,
    pub(crate) acceleration: Vec<f64>,
    /// The free field's translation under each part.
    pub(crate) translations: Vec<Translation>,
    influence: Arc<Influence>,
    transformation: Transformation,
    dofs: [OnceLock<Vec<f64>>; 4],
}

/// Quantities of [`Kinematics`].
#[derive(Debug, Clone, Copy)]
pub(crate) enum DofResponse {
    Displacement,
    Velocity,
    Acceleration,
    AbsoluteDisplacement,
}

impl Kinematics {
    /// Motion at rest.
    pub(crate) fn new(model: &Model) -> Self {
        Self {
            displacement: vec![0.0; model.coordinates],
            velocity: vec![0.0; model.coordinates],
            acceleration: vec![0.0; model.coordinates],
            translations: vec![Translation::default(); model.influence.parts().len()],
            influence: model.influence.clone(),
            transformation: model.transformation.clone(),
            dofs: Default::default(),
        }
    }

    /// Discards the stored degrees of freedom; call it when coordinates have changed.
    pub(crate) fn changed(&mut self) {
        self.dofs.iter_mut().for_each(|seen| drop(seen.take()));
    }

    /// The degrees of freedom.
    pub(crate) fn dofs(&self, quantity: DofResponse) -> &[f64] {
        let coordinates = match quantity {
            DofResponse::Displacement | DofResponse::AbsoluteDisplacement => &self.displacement,
            DofResponse::Velocity => &self.velocity,
            DofResponse::Acceleration => &self.acceleration,
        };
        let absolute = matches!(quantity, DofResponse::AbsoluteDisplacement);
        if let (Transformation::Identity, false) = (&self.transformation, absolute) {
            return coordinates;
        }
        self.dofs[quantity as usize].get_or_init(|| {
            let mut values = coordinates.clone();
            if absolute {
                let translations = self.translations.iter().map(|y| y.displacement);
                self.influence.translate(1.0, translations, &mut values);
            }
            self.transformation.dofs(values)
        })
    }
}

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
            .all(|(which, _)| self.dofs(which) == other.dofs(which))
    }
}

impl std::fmt::Debug for Kinematics {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut shown = f.debug_struct("Kinematics");
        for (which, name) in RESPONSE_QUANTITIES {
            shown.field(name, &self.dofs(which));
        }
        shown.finish()
    }
}
