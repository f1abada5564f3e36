//! GOAL: coordinates, parts that a user writes, and a mesh from a Gmsh file do not change a scene.
//! SCENE: scenes of all parts in the plane, in plan and around a trench.
//! REFERENCE: the scene in physical coordinates.

use super::compare::{NamedVariant, compare_variant, usual_response};
use super::parts::{Choice, CoordinatePart, Space, covering, covering_yielding};
use super::scene::{REDUCED_LIMIT, SceneVariant};
use super::tally::{IdentityTally, scenes};
use super::view::{PLAIN_VIEW, View};

/// Largest relative difference; static states are accurate to 1e-10.
const DIFFERENCE_LIMIT: f64 = 1e-7;

fn check(choices: Vec<Choice>, row: &'static str) {
    let mut tally = IdentityTally::new(row);
    for choice in choices {
        let usual_coordinate = choice.coordinate;
        let physical = Choice { coordinate: CoordinatePart::Physical, ..choice };
        let Some(response) = usual_response(&physical, &mut tally) else { continue };
        tally.pair(&choice.words());
        let named_variant = NamedVariant {
            name: "parts of a user",
            view: &View { by_user: true, ..PLAIN_VIEW },
            variant: SceneVariant::ByUser,
        };
        compare_variant(&physical, &response, &named_variant, DIFFERENCE_LIMIT, &mut tally);
        if physical.body.has_a_gmsh_mesh() {
            tally.pair(&["Gmsh", physical.body.word()]);
            let named_variant = NamedVariant {
                name: "mesh from Gmsh",
                view: &View { read_from_gmsh: true, ..PLAIN_VIEW },
                variant: SceneVariant::Usual,
            };
            compare_variant(&physical, &response, &named_variant, DIFFERENCE_LIMIT, &mut tally);
        }
        if usual_coordinate != CoordinatePart::Physical {
            let limit = if usual_coordinate == CoordinatePart::Reduced {
                REDUCED_LIMIT
            } else {
                DIFFERENCE_LIMIT
            };
            let variant = SceneVariant::InCoordinates(usual_coordinate);
            let named_variant =
                NamedVariant { name: usual_coordinate.word(), view: &PLAIN_VIEW, variant };
            compare_variant(&physical, &response, &named_variant, limit, &mut tally);
        }
    }
    tally.close(0.75);
}

/// GOAL: variants of scenes in the plane.
#[test]
fn coordinates_and_users_parts_in_the_plane() {
    let choices = covering(Space::Plane, 81, scenes(50, 1000));
    check(choices, "coordinates and users' parts in the plane");
}

/// GOAL: variants of scenes in plan.
#[test]
fn coordinates_and_users_parts_in_plan() {
    let choices = covering(Space::Plan, 81, scenes(25, 400));
    check(choices, "coordinates and users' parts in plan");
}

/// GOAL: variants of scenes around a trench.
#[test]
fn coordinates_and_users_parts_around_a_trench() {
    let choices = covering(Space::Trench, 81, scenes(1, 40));
    check(choices, "coordinates and users' parts around a trench");
}

/// GOAL: users' elements and materials, and meshes from Gmsh, of soil that yields.
#[test]
fn users_parts_of_soil_that_yields() {
    check(covering_yielding(82, scenes(20, 300)), "users' parts of soil that yields");
}
