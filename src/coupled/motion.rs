//! Motion of the structure in the coordinates that are stepped.

use std::sync::{Arc, OnceLock};

use super::scene::influence::Influence;
use super::scene::modal_basis::ModalBasis;
use super::translation::Translation;

/// Displacement relative to the free field's translation, total velocity and acceleration, and the
/// unknowns once they have been asked for.
#[derive(Clone)]
pub(crate) struct Motion {
    pub(crate) displacement: Vec<f64>,
    pub(crate) velocity: Vec<f64>,
    pub(crate) acceleration: Vec<f64>,
    /// The free field's translation under each part.
    pub(crate) translations: Vec<Translation>,
    influence: Arc<Influence>,
    modes: Option<Arc<ModalBasis>>,
    unknowns: [OnceLock<Vec<f64>>; 4],
}

/// Quantities of [`Motion`].
#[derive(Debug, Clone, Copy)]
pub(crate) enum Quantity {
    Displacement,
    Velocity,
    Acceleration,
    AbsoluteDisplacement,
}

impl Motion {
    /// At rest.
    pub(crate) fn new(
        coordinates: usize,
        influence: Arc<Influence>,
        modes: Option<Arc<ModalBasis>>,
    ) -> Self {
        let zero = || vec![0.0; coordinates];
        Self {
            displacement: zero(),
            velocity: zero(),
            acceleration: zero(),
            translations: vec![Translation::default(); influence.parts().len()],
            influence,
            modes,
            unknowns: Default::default(),
        }
    }

    /// To be called when coordinates have changed.
    pub(crate) fn changed(&mut self) {
        self.unknowns.iter_mut().for_each(|seen| drop(seen.take()));
    }

    /// The unknowns.
    pub(crate) fn unknowns(&self, quantity: Quantity) -> &[f64] {
        let coordinates = match quantity {
            Quantity::Displacement | Quantity::AbsoluteDisplacement => &self.displacement,
            Quantity::Velocity => &self.velocity,
            Quantity::Acceleration => &self.acceleration,
        };
        let absolute = matches!(quantity, Quantity::AbsoluteDisplacement);
        if !absolute && self.modes.is_none() {
            return coordinates;
        }
        self.unknowns[quantity as usize].get_or_init(|| {
            let mut values = coordinates.clone();
            if absolute {
                let translations = self.translations.iter().map(|y| y.displacement);
                self.influence.translate(1.0, translations, &mut values);
            }
            match &self.modes {
                Some(modes) => modes.unknowns(&values),
                None => values,
            }
        })
    }
}

const ALL: [Quantity; 4] = [
    Quantity::Displacement,
    Quantity::Velocity,
    Quantity::Acceleration,
    Quantity::AbsoluteDisplacement,
];

impl PartialEq for Motion {
    fn eq(&self, other: &Self) -> bool {
        ALL.into_iter().all(|which| self.unknowns(which) == other.unknowns(which))
    }
}

impl std::fmt::Debug for Motion {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut shown = f.debug_struct("Motion");
        for (which, name) in ALL.into_iter().zip([
            "displacement",
            "velocity",
            "acceleration",
            "absolute_displacement",
        ]) {
            shown.field(name, &self.unknowns(which));
        }
        shown.finish()
    }
}
