//! Comparison of two variants of a scene.

use basemat::Result;

use super::parts::Choice;
use super::scene::{RESPONSE_GROUPS, SceneResponse, SceneVariant, error_kind, run};
use super::tally::IdentityTally;
use super::view::{PLAIN_VIEW, View};

/// Factor by which two variants may differ more than two scenes that differ by 1e-10.
const AMPLIFICATION_FACTOR: f64 = 30.0;

/// A scene written another way, with a name for the report.
pub(crate) struct NamedVariant<'a> {
    pub(crate) name: &'a str,
    pub(crate) view: &'a View,
    pub(crate) variant: SceneVariant,
}

/// Response of the usual variant; `None`, and counted, if building it is an error.
pub(crate) fn usual_response(choice: &Choice, tally: &mut IdentityTally) -> Option<SceneResponse> {
    super::grounds::clear_shared_kernels();
    tally.scene(&choice.words());
    match run(choice, &PLAIN_VIEW, SceneVariant::Usual) {
        Ok(response) => Some(response),
        Err(error) => {
            tally.add_error(format!("{}: {error}", choice.name()));
            None
        }
    }
}

/// Compares a variant with the usual response; the limit is relative to each group's largest number.
///
/// Landing and slip amplify rounding: where the limit is exceeded, perturbed scenes measure the amplification.
pub(crate) fn compare_variant(
    choice: &Choice,
    usual_response: &SceneResponse,
    named_variant: &NamedVariant,
    limit: f64,
    tally: &mut IdentityTally,
) {
    let place = format!("{}: {}", named_variant.name, choice.name());
    let response = run(choice, named_variant.view, named_variant.variant);
    compare_response(choice, usual_response, &ComparedGroups::all(&place), response, limit, tally);
}

/// Groups of numbers to compare, and the place for the report.
pub(crate) struct ComparedGroups<'a> {
    pub(crate) place: &'a str,
    pub(crate) groups: &'a [&'a str],
}

impl<'a> ComparedGroups<'a> {
    pub(crate) fn all(place: &'a str) -> Self {
        Self { place, groups: &RESPONSE_GROUPS }
    }
}

/// As [`compare_variant`], of a response that was computed.
pub(crate) fn compare_response(
    choice: &Choice,
    usual_response: &SceneResponse,
    groups_to_compare: &ComparedGroups,
    response: Result<SceneResponse>,
    limit: f64,
    tally: &mut IdentityTally,
) {
    let ComparedGroups { place, groups } = groups_to_compare;
    match response {
        Ok(response) => {
            let difference = usual_response.difference_in(&response, groups);
            let limit = if difference.value > limit {
                limit.max(amplified_perturbation(choice, usual_response, groups))
            } else {
                limit
            };
            tally.within(&format!("{}, {place}", difference.group), difference.value, limit);
        }
        Err(error) => tally.fail(format!("{place}: error, {}: {error}", error_kind(&error))),
    }
}

/// Largest difference of scenes that differ by 1e-10 in shaking, soil and friction, amplified.
fn amplified_perturbation(choice: &Choice, usual_response: &SceneResponse, groups: &[&str]) -> f64 {
    let mut max_difference = 0.0_f64;
    for factors in [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
        if let Ok(perturbed) = run(choice, &PLAIN_VIEW, SceneVariant::Perturbed(factors)) {
            max_difference =
                usual_response.difference_in(&perturbed, groups).value.max(max_difference);
        }
    }
    max_difference * AMPLIFICATION_FACTOR
}

/// Largest difference of two lists.
pub(crate) fn largest_difference(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).fold(0.0, |largest: f64, (a, b)| largest.max((a - b).abs()))
}

/// Largest difference, relative to the largest expected number; NaN if the last one is.
pub(crate) fn relative_difference(expected: &[f64], computed: &[f64]) -> f64 {
    let scale = expected.iter().fold(0.0, |scale: f64, value| scale.max(value.abs()));
    let pairs = expected.iter().zip(computed);
    pairs.fold(0.0, |largest: f64, (a, b)| {
        let difference = (a - b).abs() / scale;
        if difference.is_nan() { f64::NAN } else { largest.max(difference) }
    })
}
