//! Static settlement of rigid bodies whose outline is oblique to the cells.

use basemat::bem::ElasticGround;
use basemat::interface::Coulomb;
use basemat::structure::RigidBody;
use basemat::{Simulation, Soil};

use basemat_problems::heavy;

const POISSON_RATIO: f64 = 0.3;
const SHEAR_MODULUS: f64 = 80e6;
const BODY_MASS: f64 = 1e5;
const STANDARD_GRAVITY: f64 = 9.80665;
/// K (1 − ν)/G of a square with sides of 2.
const SQUARE_STIFFNESS: f64 = 4.6092;

/// Corners of a regular polygon; the first at an angle of `turn` degrees.
fn polygon(corners: usize, radius: f64, turn: f64) -> Vec<[f64; 2]> {
    (0..corners)
        .map(|k| std::f64::consts::TAU * k as f64 / corners as f64 + turn.to_radians())
        .map(|angle| [radius * angle.cos(), radius * angle.sin()])
        .collect()
}

/// Stiffness K (1 − ν)/G of a body under its weight, m.
fn stiffness(body: &RigidBody, cells: usize) -> f64 {
    let soil = Soil::new(SHEAR_MODULUS, POISSON_RATIO, 1900.0).unwrap();
    let ground = ElasticGround::under(soil, body, cells).unwrap();
    let simulation = Simulation::builder(0.01).structure(body.clone()).ground(ground);
    let simulation = simulation.interface(Coulomb::new(0.5).unwrap()).build().unwrap();
    let u = simulation.static_displacement();
    let weight = body.total_mass() * STANDARD_GRAVITY;
    assert!(u[3].abs().max(u[4].abs()) < 1e-3 * u[2].abs(), "{u:?}");
    -weight / u[2] * (1.0 - POISSON_RATIO) / SHEAR_MODULUS
}

fn body(outline: Vec<[f64; 2]>) -> RigidBody {
    let inertia = [[BODY_MASS, 0.0, 0.0], [0.0, BODY_MASS, 0.0], [0.0, 0.0, BODY_MASS]];
    RigidBody::from_mass(outline, BODY_MASS, inertia, [0.0, 0.0, 1.0]).unwrap()
}

/// A square with sides of 2, turned by `degrees`.
fn turned_square(degrees: f64) -> RigidBody {
    body(polygon(4, f64::sqrt(2.0), 45.0 + degrees))
}

/// K (1 − ν)/G of the disc with the area of a regular polygon of radius 1.
fn equal_disc_stiffness(corners: usize) -> f64 {
    let angle = std::f64::consts::TAU / corners as f64;
    4.0 * f64::sqrt(0.5 * corners as f64 * angle.sin() / std::f64::consts::PI)
}

/// Bounds of a regular polygon's stiffness: not below the disc's, and closer to it than the square's.
fn polygon_bounds(corners: usize) -> [f64; 2] {
    [1.0, 1.0 + 0.0212 * 16.0 / (corners * corners) as f64]
        .map(|ratio| ratio * equal_disc_stiffness(corners))
}

/// A body, bounds of K (1 − ν)/G, and the tolerance above the upper one.
struct OutlineCase {
    name: &'static str,
    body: RigidBody,
    bounds: [f64; 2],
    tolerance: f64,
}

impl OutlineCase {
    fn new(name: &'static str, body: RigidBody, bounds: [f64; 2], tolerance: f64) -> Self {
        Self { name, body, bounds, tolerance }
    }
}

/// A disc: 4 G R/(1 − ν). A square with sides of 2: 4.6092 G/(1 − ν), however it is turned. A regular polygon: at least
/// the disc of its area (Pólya and Szegő), and closer to it than the square's stiffness.
#[test]
fn stiffnesses_fall_steadily_to_their_closed_form() {
    let cylinder = RigidBody::cylinder(1.0, 2.0, 1000.0).unwrap();
    let cases = [
        OutlineCase::new("cylinder", cylinder, [4.0; 2], 0.004),
        OutlineCase::new("square, 10 degrees", turned_square(10.0), [SQUARE_STIFFNESS; 2], 0.005),
        OutlineCase::new("square, 27 degrees", turned_square(27.0), [SQUARE_STIFFNESS; 2], 0.005),
        OutlineCase::new("square, 45 degrees", turned_square(45.0), [SQUARE_STIFFNESS; 2], 0.005),
        OutlineCase::new("hexagon", body(polygon(6, 1.0, 0.0)), polygon_bounds(6), 0.005),
        OutlineCase::new("octagon", body(polygon(8, 1.0, 0.0)), polygon_bounds(8), 0.005),
    ];
    for case in cases.into_iter().step_by(if heavy() { 1 } else { 2 }) {
        let OutlineCase { name, body, bounds: [low, high], tolerance } = case;
        let computed = [4, 6, 8, 12, 16].map(|cells| stiffness(&body, cells));
        println!("{name}: {:.4?}", computed.map(|k| k / low - 1.0));
        assert!(computed.is_sorted_by(|coarse, fine| fine < coarse), "{name} {computed:?}");
        let finest_stiffness = computed[4];
        assert!(
            finest_stiffness > low && finest_stiffness < high * (1.0 + tolerance),
            "{name} {finest_stiffness} {low} {high}"
        );
    }
}
