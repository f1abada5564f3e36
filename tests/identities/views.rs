//! A scene translated, turned, mirrored, renumbered and in other units is the same scene.

use basemat_problems::random::Random;
use basemat_problems::scenes::{Frame, SI};

use super::compare::{same, usual};
use super::parts::{Choice, Coordinate, Space, covering};
use super::scene::{REDUCED_LIMIT, Writing};
use super::tally::{Tally, scenes};
use super::view::{PLAIN, View};

/// Static states are known to 1e-10.
const LIMIT: f64 = 1e-7;

/// Views that change one thing each.
fn views(choice: &Choice) -> Vec<(&'static str, View)> {
    let mut random = Random(choice.seed ^ 1);
    let in_plan = choice.space == Space::Plan;
    let across = if in_plan { random.within(-50.0, 50.0) } else { 0.0 };
    let shift = [random.within(-50.0, 50.0), across];
    let mut unit = || 10.0_f64.powf(random.within(-3.0, 3.0));
    let units = Frame { length: unit(), time: unit(), mass: unit(), mirrored: false };
    let mut views = vec![
        ("translated", View { shift, ..PLAIN }),
        ("mirrored", View { frame: Frame { mirrored: true, ..SI }, ..PLAIN }),
        ("renumbered", View { renumbered: true, ..PLAIN }),
        ("in other units", View { frame: units, ..PLAIN }),
    ];
    if in_plan {
        let turns = random.pick(&[1, 2, 3]);
        views.push(("turned", View { turns, ..PLAIN }));
    }
    views
}

fn check(space: Space, row: &'static str, count: usize) {
    let mut tally = Tally::new(row);
    for (number, choice) in covering(space, 61, count).iter().enumerate() {
        let Some(response) = usual(choice, &mut tally) else { continue };
        let views = views(choice);
        let is_reduced = choice.coordinate == Coordinate::Reduced;
        let limit = if is_reduced { REDUCED_LIMIT } else { LIMIT };
        // Some views of each scene, by turns; all of them at night.
        let short = if space == Space::Trench { 1 } else { 2 };
        let chosen = if basemat_problems::heavy() { views.len() } else { short };
        for k in 0..chosen {
            let (name, view) = &views[(number + 2 * k) % views.len()];
            same(choice, &response, (name, view, Writing::Usual), limit, &mut tally);
        }
    }
    tally.close(0.75);
}

#[test]
fn scenes_in_the_plane_are_the_same_from_everywhere() {
    check(Space::Plane, "views in the plane", scenes(70, 1500));
}

#[test]
fn scenes_in_plan_are_the_same_from_everywhere() {
    check(Space::Plan, "views in plan", scenes(40, 600));
}

#[test]
fn scenes_around_a_trench_are_the_same_from_everywhere() {
    check(Space::Trench, "views around a trench", scenes(1, 40));
}
