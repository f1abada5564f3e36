//! Structures on a spring bed, against an event-driven integration and closed forms.

mod support;

use basemat::Simulation;
use basemat::bem::SpringGround;
use basemat::interface::Coulomb;
use basemat::motion::FreeFieldFn;
use basemat::structure::RigidBlock;

/// Ground displacement and velocity of a ground acceleration 5·Ricker(σ = 0.3 s, t₀ = 1.5 s) m/s².
fn ricker_ground() -> FreeFieldFn {
    let sigma = 0.3_f64;
    let a = move |t: f64| (t - 1.5) / sigma;
    FreeFieldFn::new(
        move |_, t| [-2.5 * sigma * sigma * (-a(t) * a(t)).exp(), 0.0],
        move |_, t| [5.0 * sigma * a(t) * (-a(t) * a(t)).exp(), 0.0],
    )
}

fn winkler_error(elements: usize, time_step: f64) -> f64 {
    let table = support::table("winkler_block_ricker.csv");
    let bed = SpringGround::new(-2.0..2.0, elements, 2.0e7, 2.0e13)
        .unwrap()
        .with_dashpots(4.0e5, 0.0)
        .unwrap();
    let block = RigidBlock::new(4.0, 8.0, 500.0).unwrap().with_p_delta(9.81).unwrap();
    let mut sim = Simulation::builder(time_step)
        .structure(block)
        .ground(bed)
        .interface(Coulomb::uplift_only())
        .motion(ricker_ground())
        .gravity(9.81)
        .build()
        .unwrap();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive")]
    let every = (0.01 / time_step).round() as usize;
    let theta = table.column("theta");
    let (mut error, mut norm) = (0.0, 0.0);
    let run = sim
        .run(every * (theta.len() - 1), |state| {
            if state.step % every == 0 {
                // Down-positive rotation of the table is clockwise.
                let expected = -theta[state.step / every];
                error += (state.displacement[2] - expected).powi(2);
                norm += expected * expected;
            }
        })
        .unwrap();
    println!("{run}");
    (error / norm).sqrt()
}

#[test]
fn rocking_block_on_a_no_tension_bed() {
    for (n, dt) in [(20, 0.005), (40, 0.0025), (80, 0.00125)] {
        println!("{n} {dt} {:e}", winkler_error(n, dt));
    }
}
