//! Comparison of two writings of a scene.

use super::parts::Choice;
use super::scene::{Response, Writing, kind, run};
use super::tally::Tally;
use super::view::{PLAIN, View};

/// Factor by which two writings may differ more than two scenes that differ by 1e-10.
const AMPLIFICATION: f64 = 30.0;

/// The scene as it is usually written; `None`, and noted, if a builder refuses it.
pub(crate) fn usual(choice: &Choice, tally: &mut Tally) -> Option<Response> {
    super::grounds::next_scene();
    tally.scene(&choice.words());
    match run(choice, &PLAIN, Writing::Usual) {
        Ok(response) => Some(response),
        Err(error) => {
            tally.refuse(format!("{}: {error}", choice.name()));
            None
        }
    }
}

/// Compares a writing in a view with the `usual` response, to a limit relative to each group's largest number.
///
/// Landings and slips amplify rounding: where the limit is exceeded, scenes that differ by 1e-10 show by how much.
pub(crate) fn same(
    choice: &Choice,
    usual: &Response,
    (name, view, writing): (&str, &View, Writing),
    limit: f64,
    tally: &mut Tally,
) {
    let place = format!("{name}: {}", choice.name());
    match run(choice, view, writing) {
        Ok(response) => {
            let (value, group) = usual.apart(&response);
            let limit = if value > limit { limit.max(amplified(choice, usual)) } else { limit };
            tally.within(&format!("{group}, {place}"), value, limit);
        }
        Err(error) => tally.fail(format!("{place}: refused, {}: {error}", kind(&error))),
    }
}

/// How much a scene amplifies differences of 1e-10 in shaking, soil and friction.
fn amplified(choice: &Choice, usual: &Response) -> f64 {
    let ways = [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    ways.into_iter().fold(0.0, |largest, way| {
        let nearly = run(choice, &PLAIN, Writing::Nearly(way));
        nearly.map_or(largest, |nearly| usual.apart(&nearly).0.max(largest))
    }) * AMPLIFICATION
}
