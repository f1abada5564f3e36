//! Interface laws against the scene that they are to act in.

use super::Scene;
use crate::contact::ContactSearch;
use crate::error::{Error, LawError, Result};
use crate::interface::{ContactScene, InterfaceLaw, Mode, StepStarts};

/// Whether the laws fit the ground's `count` elements, and laws and contact search the scene.
pub(crate) fn check(
    laws: &[Box<dyn InterfaceLaw>],
    search: ContactSearch,
    scene: &ContactScene,
    count: usize,
) -> Result<()> {
    let refuse = |quantity, needed| Err(Error::Scene { quantity, needed });
    if laws.is_empty() {
        return refuse("interface law", "give one to the builder with `interface`");
    }
    if laws.len() != 1 && laws.len() != count {
        let quantity = "list of interface laws";
        return Err(Error::Size { quantity, found: laws.len(), needed: count });
    }
    if laws.iter().any(|law| law.modes().is_empty()) {
        return refuse("interface law", "`modes` must name at least one mode");
    }
    if search == (ContactSearch::FlowChart { iterations: 0 }) {
        return refuse("contact search", "the flow chart needs one iteration or more");
    }
    laws.iter().try_for_each(|law| law.check(scene))
}

/// Coefficients for the factor of safety against sliding: the `given` ones or those of the laws; one
/// for all elements, one each, or none unless all laws have one.
pub(crate) fn safety_friction(
    laws: &[Box<dyn InterfaceLaw>],
    given: Vec<f64>,
    count: usize,
) -> Result<Vec<f64>> {
    let coefficients = if given.is_empty() {
        let each: Option<_> = laws.iter().map(InterfaceLaw::friction_coefficient).collect();
        each.unwrap_or_default()
    } else {
        given
    };
    if coefficients.len() > 1 && coefficients.len() != count {
        let quantity = "list of friction coefficients";
        return Err(Error::Size { quantity, found: coefficients.len(), needed: count });
    }
    // Infinity is a coefficient.
    match coefficients.iter().find(|value| value.is_nan() || **value < 0.0) {
        Some(&value) => {
            let (quantity, needed) = ("friction coefficient", "zero or more");
            Err(Error::Input { quantity, value, needed })
        }
        None => Ok(coefficients),
    }
}

impl Scene {
    /// Whether any law stores energy in its elements, or may do so once it has something to
    /// remember.
    pub(crate) fn is_compliant(&self, start: &StepStarts) -> Result<bool> {
        let mut compliant = false;
        for element in 0..self.count() {
            for &mode in self.law(element).modes() {
                compliant |= self.compliance(element, mode, start)? != [0.0; 2];
            }
        }
        Ok(compliant || !start.memory().is_empty())
    }

    /// Compliance of an element whose step ends in `mode`.
    pub(crate) fn compliance(
        &self,
        element: usize,
        mode: Mode,
        start: &StepStarts,
    ) -> std::result::Result<[f64; 2], LawError> {
        let compliance = self.law(element).compliance(mode, &start.of(element));
        let named = [("normal compliance", compliance[0]), ("shear compliance", compliance[1])];
        match named.into_iter().find(|(_, value)| !value.is_finite()) {
            None => Ok(compliance),
            Some((quantity, value)) => {
                Err(LawError::NotFinite { element, mode: mode.word(), quantity, value })
            }
        }
    }
}
