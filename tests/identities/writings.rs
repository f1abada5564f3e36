//! A scene in modal or reduced coordinates, with parts that a user writes, and with a mesh from a Gmsh file, is the scene
//! in physical coordinates.

use super::compare::{same, usual};
use super::parts::{Choice, Coordinate, Space, covering};
use super::scene::{REDUCED_LIMIT, Writing};
use super::tally::{Tally, scenes};
use super::view::{PLAIN, View};

/// Static states are known to 1e-10.
const LIMIT: f64 = 1e-7;

fn check(space: Space, row: &'static str, count: usize) {
    let mut tally = Tally::new(row);
    for choice in covering(space, 81, count) {
        let other = choice.coordinate;
        let physical = Choice { coordinate: Coordinate::Physical, ..choice };
        let Some(response) = usual(&physical, &mut tally) else { continue };
        tally.pair(&choice.words());
        let by_user = ("parts of a user", &View { by_user: true, ..PLAIN }, Writing::ByUser);
        same(&physical, &response, by_user, LIMIT, &mut tally);
        if physical.body.has_a_gmsh_mesh() {
            tally.pair(&["Gmsh", physical.body.word()]);
            let read = ("mesh from Gmsh", &View { read_from_gmsh: true, ..PLAIN }, Writing::Usual);
            same(&physical, &response, read, LIMIT, &mut tally);
        }
        if other != Coordinate::Physical {
            let limit = if other == Coordinate::Reduced { REDUCED_LIMIT } else { LIMIT };
            let writing = (other.word(), &PLAIN, Writing::In(other));
            same(&physical, &response, writing, limit, &mut tally);
        }
    }
    tally.close(0.75);
}

#[test]
fn coordinates_and_users_parts_in_the_plane() {
    check(Space::Plane, "coordinates and users' parts in the plane", scenes(50, 1000));
}

#[test]
fn coordinates_and_users_parts_in_plan() {
    check(Space::Plan, "coordinates and users' parts in plan", scenes(25, 400));
}

#[test]
fn coordinates_and_users_parts_around_a_trench() {
    check(Space::Trench, "coordinates and users' parts around a trench", scenes(1, 40));
}
