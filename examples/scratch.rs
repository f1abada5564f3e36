use basemat::bem::HalfPlaneGround;
use basemat::coupled::Placement;
use basemat::interface::Coulomb;
use basemat::motion::STANDARD_GRAVITY;
use basemat::reference::RockingBlock;
use basemat::structure::RigidBlock;
use basemat::{Simulation, Soil};
fn main() -> basemat::Result<()> {
    let (b, h) = (0.5, 2.0);
    let reference = RockingBlock::new(b, h, STANDARD_GRAVITY)?;
    let alpha = reference.slenderness_angle();
    let t0 = 0.3 * alpha;
    let quarter = 0.25 * reference.period_slender(t0)?;
    println!(
        "quarter {quarter}  next {} slender {}",
        reference.next_peak(t0)? / t0,
        reference.next_peak_slender(t0)? / t0
    );
    for speed in [200.0, 400.0, 800.0, 1600.0, 3200.0] {
        for (elements, dt) in [(16, 1e-3), (16, 5e-4), (32, 5e-4), (32, 2.5e-4)] {
            let block =
                RigidBlock::new(2.0 * b, 2.0 * h, 2500.0)?.with_p_delta(STANDARD_GRAVITY)?;
            let soil = Soil::from_shear_wave_speed(speed, 0.3, 2000.0)?;
            let mut s = Simulation::builder(dt)
                .ground(HalfPlaneGround::under(soil, &block, elements)?)
                .structure(block)
                .interface(Coulomb::new(2.0)?)
                .placement(Placement::Unloaded)
                .initial_displacement([-0.0, b * t0, t0])
                .build()?;
            let mut crossing = 0.0;
            let mut before = t0;
            let mut low = 0.0_f64;
            let steps = (2.2 * quarter / dt * 1.2) as usize;
            let run = s.run(steps, |state| {
                let now = state.base_rotation;
                if crossing == 0.0 && now <= 0.0 {
                    crossing = state.time - dt * (0.0 - now) / (before - now);
                }
                low = low.min(now);
                before = now;
            })?;
            println!(
                "{speed} {elements} {dt}: quarter {:.4}  next {:.4}  ledger {:.1e}",
                crossing / quarter,
                -low / t0,
                run.ledger_residual
            );
        }
    }
    Ok(())
}
