//! Static settlement of rigid bodies whose outline is oblique to the cells.

use basemat::bem::ElasticGround;
use basemat::interface::Coulomb;
use basemat::structure::RigidBody;
use basemat::{Simulation, Soil};

use basemat_problems::heavy;

const POISSON: f64 = 0.3;
const SHEAR_MODULUS: f64 = 80e6;
const MASS: f64 = 1e5;
const GRAVITY: f64 = 9.80665;

/// Corners of a regular polygon; the first at an angle of `turn` degrees.
fn polygon(corners: usize, reach: f64, turn: f64) -> Vec<[f64; 2]> {
    let angle = |k: usize| std::f64::consts::TAU * k as f64 / corners as f64 + turn.to_radians();
    (0..corners).map(|k| [reach * angle(k).cos(), reach * angle(k).sin()]).collect()
}

/// Stiffness K (1 − ν)/G of a body under its weight, m.
fn stiffness(body: &RigidBody, cells: usize) -> f64 {
    let soil = Soil::new(SHEAR_MODULUS, POISSON, 1900.0).unwrap();
    let ground = ElasticGround::under(soil, body, cells).unwrap();
    let simulation = Simulation::builder(0.01).structure(body.clone()).ground(ground);
    let simulation = simulation.interface(Coulomb::new(0.5).unwrap()).build().unwrap();
    let u = simulation.static_displacement();
    let weight = body.total_mass() * GRAVITY;
    assert!(u[3].abs().max(u[4].abs()) < 1e-3 * u[2].abs(), "{u:?}");
    -weight / u[2] * (1.0 - POISSON) / SHEAR_MODULUS
}

fn body(outline: Vec<[f64; 2]>) -> RigidBody {
    let inertia = [[MASS, 0.0, 0.0], [0.0, MASS, 0.0], [0.0, 0.0, MASS]];
    RigidBody::from_mass(outline, MASS, inertia, [0.0, 0.0, 1.0]).unwrap()
}

/// A disc: 4 G R/(1 − ν). A square with sides of 2: 4.6092 G/(1 − ν), however it is turned. A regular polygon: at least
/// the disc of its area (Pólya and Szegő), and less above it than the square is.
#[test]
fn settlements_fall_steadily_to_their_closed_form() {
    let square = |turn: f64| body(polygon(4, f64::sqrt(2.0), 45.0 + turn));
    let disc_of = |corners: usize| {
        let angle = std::f64::consts::TAU / corners as f64;
        4.0 * f64::sqrt(0.5 * corners as f64 * angle.sin() / std::f64::consts::PI)
    };
    let rounder = |corners: usize| [1.0, 1.0 + 0.0212 * 16.0 / (corners * corners) as f64];
    let exact = |value: f64| [value, value];
    let cylinder = RigidBody::cylinder(1.0, 2.0, 1000.0).unwrap();
    let shapes = [
        ("cylinder", cylinder, exact(4.0), 0.004),
        ("square, 10 degrees", square(10.0), exact(4.6092), 0.005),
        ("square, 27 degrees", square(27.0), exact(4.6092), 0.005),
        ("square, 45 degrees", square(45.0), exact(4.6092), 0.005),
        ("hexagon", body(polygon(6, 1.0, 0.0)), rounder(6).map(|x| x * disc_of(6)), 0.005),
        ("octagon", body(polygon(8, 1.0, 0.0)), rounder(8).map(|x| x * disc_of(8)), 0.005),
    ];
    for (name, body, [low, high], gate) in shapes.into_iter().step_by(if heavy() { 1 } else { 2 }) {
        let found = [4, 6, 8, 12, 16].map(|cells| stiffness(&body, cells));
        println!("{name}: {:.4?}", found.map(|k| k / low - 1.0));
        assert!(found.is_sorted_by(|coarse, fine| fine < coarse), "{name} {found:?}");
        let [.., last] = found;
        assert!(last > low && last < high * (1.0 + gate), "{name} {last} {low} {high}");
    }
}
