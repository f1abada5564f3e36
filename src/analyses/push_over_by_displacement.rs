//! A static push-over by a growing displacement, through the largest load.

use crate::analyses::base_rotations::base_rotations;
use crate::analyses::push_over::{PushOver, PushPoint, sliding_fraction};
use crate::coupled::SimulationBuilder;
use crate::coupled::assembly::static_push::{StaticPush, has_no_equilibrium};
use crate::error::{Result, all_finite, at_least};
use crate::structure::DofCombination;

/// Smallest fraction of an increment, after halving what has no equilibrium.
const MIN_INCREMENT_FRACTION: f64 = 1.0 / 256.0;

/// Pushes a structure on its ground to growing displacements, through its largest load.
///
/// `builder` has the scene; its motion has no effect. The weight acts first, as the
/// [`GravityStage`](crate::coupled::GravityStage) defines, then the loads at t = 0, and both stay constant. Forces `pattern`
/// times a load factor follow: for a force F at a degree of freedom, its row; for a pattern over the height, the sum of the floors'
/// rows with their weights, such as their heights for an inverted triangle. The factor is an unknown. It follows
/// from the displacement of `control`, a degree of freedom or a weighted sum of degrees of freedom, which takes the
/// values `displacements` one after the other, m or rad, relative to the state under weight and loads. They may grow, fall and
/// change their sign.
///
/// Uplift, slip, yielding and P–Δ are those of the scene. The states are a path: each commits the internal variables of the
/// structure and the slip of the foundation, so that unloading and cycles are right. The curve passes the collapse load,
/// where the structure is a mechanism. `force` of a [`PushPoint`] is the load factor. The
/// first point is the state without it. An increment
/// without equilibrium is halved up to eight times. If that does not help, the curve ends, and
/// [`PushOver::cause`] has the error's text; [`PushOver::limit`] is `None`. On a half-plane displacements have no datum: control a
/// drift or a rotation there.
///
/// ```
/// use basemat::analyses::push_over_by_displacement;
/// use basemat::bem::SpringGround;
/// use basemat::interface::Coulomb;
/// use basemat::structure::RigidBlock;
/// use basemat::Simulation;
///
/// // A block 4 m wide and 6 m high on springs, pushed at its top until it stands on its edge.
/// let block = RigidBlock::new(4.0, 6.0, 2000.0)?;
/// let top = block.horizontal_at(6.0);
/// let builder = Simulation::builder(0.01)
///     .ground(SpringGround::under(&block, 16, 4e7, 3e7)?)
///     .structure(block)
///     .interface(Coulomb::new(0.7)?);
/// let curve = push_over_by_displacement(builder, &top, &top, &[0.005, 0.02, 0.08, 0.32])?;
/// assert_eq!(curve.points.len(), 5);
/// let last = &curve.points[4];
/// assert!((last.displacement - 0.32).abs() < 1e-9);
/// // The block overturns at W b/2 over its height.
/// let overturning = 48.0e3 * 9.81 * 2.0 / 6.0;
/// assert!(last.uplifted_fraction > 0.7 && last.force < overturning && last.force > 0.8 * overturning);
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// [`Error::Size`](crate::Error::Size) without displacements, or for a pattern or control without weights;
/// [`Error::NotFinite`](crate::Error::NotFinite) for displacements that are not finite;
/// [`Error::Index`](crate::Error::Index) for a degree of freedom that the structure does not have;
/// [`Error::Scene`](crate::Error::Scene) for a pattern that does not move the control, for walls, for a gravity stage without
/// static state, and in plan for a control that is not the pattern; any error of
/// [`SimulationBuilder::build`] up to the static state.
pub fn push_over_by_displacement(
    builder: SimulationBuilder,
    pattern: &DofCombination,
    control: &DofCombination,
    displacements: &[f64],
) -> Result<PushOver> {
    at_least("displacements of the push-over", displacements.len(), 1)?;
    all_finite("displacements of the push-over", displacements)?;
    let mut push = StaticPush::new(builder, pattern, control)?;
    let datum = Datum {
        displacement: push.controlled_displacement(),
        base_rotations: base_rotations(push.structure(), &push.state.displacement),
    };
    let mut curve = PushOver { points: vec![datum.point(&push)], limit: None, cause: None };
    for &target in displacements {
        if let Err(error) = advance(&mut push, datum.displacement + target) {
            if !has_no_equilibrium(&error) {
                return Err(error);
            }
            curve.cause = Some(error.to_string());
            break;
        }
        curve.points.push(datum.point(&push));
    }
    Ok(curve)
}

/// Displacement of the control and rotations of the base in the state without the load pattern.
struct Datum {
    displacement: f64,
    base_rotations: [f64; 2],
}

impl Datum {
    /// Point of the curve for the present state.
    fn point(&self, push: &StaticPush) -> PushPoint {
        let rotations = base_rotations(push.structure(), &push.state.displacement);
        let resultants = push.resultants();
        PushPoint {
            force: push.state.load_factor,
            displacement: push.controlled_displacement() - self.displacement,
            base_rotation: rotations[0] - self.base_rotations[0],
            rotation_across: rotations[1] - self.base_rotations[1],
            uplifted_fraction: resultants.uplifted_fraction,
            sliding_fraction: sliding_fraction(
                &push.state.modes,
                &push.state.traction,
                push.areas(),
            ),
            base_shear: resultants.base_shear,
            base_moment: resultants.base_moment,
        }
    }
}

/// Advances to a displacement of the control, in equal parts if the whole increment has no equilibrium.
fn advance(push: &mut StaticPush, target: f64) -> Result<()> {
    let start = push.controlled_displacement();
    let mut fraction = 0.0;
    let mut increment_fraction = 1.0;
    while fraction < 1.0 {
        // Fractions are sums of powers of two, without rounding.
        let next_fraction = fraction + increment_fraction;
        let is_last = next_fraction == 1.0;
        let next_displacement =
            if is_last { target } else { start + next_fraction * (target - start) };
        match push.advance(next_displacement) {
            Ok(()) => fraction = next_fraction,
            Err(_) if increment_fraction > MIN_INCREMENT_FRACTION => increment_fraction *= 0.5,
            Err(error) => return Err(error),
        }
    }
    Ok(())
}
