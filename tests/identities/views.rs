//! GOAL: a scene translated, turned, mirrored, renumbered and in other units is the same scene.
//! SCENE: scenes of all parts in the plane, in plan and around a trench.
//! REFERENCE: the scene in SI units.

use basemat_problems::random::Random;
use basemat_problems::scenes::{SI_UNITS, UnitFrame};

use super::compare::{NamedVariant, compare_variant, usual_response};
use super::parts::{Choice, CoordinatePart, Space, covering, covering_yielding};
use super::scene::{REDUCED_LIMIT, SceneVariant};
use super::tally::{IdentityTally, scenes};
use super::view::{PLAIN_VIEW, View, random_units};

/// Largest relative difference; static states are accurate to 1e-10.
const DIFFERENCE_LIMIT: f64 = 1e-7;

/// Views that change one thing each.
fn views(choice: &Choice) -> Vec<(&'static str, View)> {
    let mut random = Random(choice.seed ^ 1);
    let in_plan = choice.space == Space::Plan;
    let across = if in_plan { random.within(-50.0, 50.0) } else { 0.0 };
    let shift = [random.within(-50.0, 50.0), across];
    let units = random_units(&mut random);
    let mut views = vec![
        ("translated", View { shift, ..PLAIN_VIEW }),
        ("mirrored", View { frame: UnitFrame { mirrored: true, ..SI_UNITS }, ..PLAIN_VIEW }),
        ("renumbered", View { renumbered: true, ..PLAIN_VIEW }),
        ("in other units", View { frame: units, ..PLAIN_VIEW }),
    ];
    if in_plan {
        let turns = random.pick(&[1, 2, 3]);
        views.push(("turned", View { turns, ..PLAIN_VIEW }));
    }
    views
}

fn check(choices: &[Choice], row: &'static str) {
    let mut tally = IdentityTally::new(row);
    for (number, choice) in choices.iter().enumerate() {
        let Some(response) = usual_response(choice, &mut tally) else { continue };
        let views = views(choice);
        let is_reduced = choice.coordinate == CoordinatePart::Reduced;
        let limit = if is_reduced { REDUCED_LIMIT } else { DIFFERENCE_LIMIT };
        // Some views of each scene, in rotation; all of them at night.
        let few_views = if choice.space == Space::Trench { 1 } else { 2 };
        let view_count = if basemat_problems::heavy() { views.len() } else { few_views };
        for k in 0..view_count {
            let (name, view) = &views[(number + 2 * k) % views.len()];
            let named_variant = NamedVariant { name, view, variant: SceneVariant::Usual };
            compare_variant(choice, &response, &named_variant, limit, &mut tally);
        }
    }
    tally.close(0.75);
}

/// GOAL: views of scenes in the plane.
#[test]
fn scenes_in_the_plane_are_the_same_from_everywhere() {
    check(&covering(Space::Plane, 61, scenes(70, 1500)), "views in the plane");
}

/// GOAL: views of scenes in plan.
#[test]
fn scenes_in_plan_are_the_same_from_everywhere() {
    check(&covering(Space::Plan, 61, scenes(40, 600)), "views in plan");
}

/// GOAL: views of scenes around a trench.
#[test]
fn scenes_around_a_trench_are_the_same_from_everywhere() {
    check(&covering(Space::Trench, 61, scenes(1, 40)), "views around a trench");
}

/// GOAL: views of scenes with soil that yields.
#[test]
fn soil_that_yields_is_the_same_from_everywhere() {
    check(&covering_yielding(62, scenes(30, 400)), "views of soil that yields");
}
