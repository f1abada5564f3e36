//! The linear systems of statuses, by unknown forces and by unknown motions.

use super::problem;
use crate::contact::cone::status::{Normal, Status, Tangential};
use crate::contact::cone::system::System;
use basemat_testkit::random::Random;

/// Both systems meet the conditions of statuses with fewer unknown motions than forces, and a step has the same
/// bits whatever was solved before.
#[test]
fn forces_or_motions_meet_the_conditions_of_statuses() {
    let mut random = Random(3);
    let count = 6;
    let mut turned = 0;
    for case in 0..100 {
        let mut problem = problem(&mut random, count, 0.5);
        problem.anchor.iter_mut().for_each(|force| *force = random.within(-1.0, 1.0));
        let mut status = |e: usize| {
            let bound = [Normal::Open, Normal::Capped, Normal::Hardening(0.7)][case % 3];
            let normal = if e > 3 { bound } else { Normal::Closed };
            let angle: f64 = random.within(0.0, 6.0);
            let turn = random.within(0.0, 1.0);
            let slope = random.pick(&[0.0, 0.4, 3.0, 1e4]);
            let direction = [angle.cos(), angle.sin()];
            let slip = Tangential::Slip { direction, turn, slope };
            let tangential = match (e, case % 4) {
                (0, _) | (4, 2 | 3) => slip,
                (4 | 5, _) => Tangential::Free,
                _ => Tangential::Stick,
            };
            Status { normal, tangential }
        };
        let mut statuses: Vec<Status> = (0..count).map(&mut status).collect();
        if case % 10 == 9 {
            statuses.fill(Status::CLOSED_STICKING);
        }
        for bounds in &mut problem.bounds {
            bounds.interval = [-0.2, 0.7];
            bounds.attraction = 0.3;
        }
        let mut system = System::new(count);
        let mut first = Vec::new();
        let mut other = statuses.clone();
        other[1] = Status::OPEN_FREE;
        for trial in 0..40 {
            let is_constant = trial >= 20;
            if trial % 20 == 0 {
                system.forget(is_constant);
            }
            // Earlier solutions are arbitrary.
            for _ in 0..trial * usize::from(trial % 20 > 0) {
                problem.reset_forces();
                system.solve(&mut problem, [&other, &statuses][trial % 2], trial % 3 == 0);
            }
            system.begin_step();
            problem.reset_forces();
            assert!(system.solve(&mut problem, &statuses, false), "case {case}");
            problem.update_motions();
            if trial % 20 == 0 {
                turned += usize::from(is_constant && first != problem.change);
                first.clone_from(&problem.change);
            }
            assert_eq!(first, problem.change, "case {case}, {trial}");
            for (e, status) in statuses.iter().enumerate() {
                let bounds = &problem.bounds[e];
                let places = problem.places(e);
                let ([p, tx, ty], [gap, x, y]) =
                    (places.map(|i| problem.force(i)), places.map(|i| problem.y[i]));
                let normal = match status.normal {
                    Normal::Open => p - bounds.interval[0],
                    Normal::Closed => gap - bounds.offset,
                    Normal::Capped => p - bounds.interval[1],
                    Normal::Hardening(k) => p - bounds.interval[1] - k * (bounds.offset - gap),
                };
                let shear = match status.tangential {
                    Tangential::Free => [tx, ty],
                    Tangential::Stick => [x, y],
                    Tangential::Slip { direction: [c, s], turn, slope } => [
                        c * tx + s * ty - slope * (p + bounds.attraction) - bounds.strength,
                        (1.0 - turn) * (c * ty - s * tx)
                            + turn * problem.rho[e][1] * (c * y - s * x),
                    ],
                };
                let largest = problem.largest_force();
                for residual in [normal, shear[0], shear[1]] {
                    assert!(residual.abs() < 1e-9 * largest, "{case}, {trial}, {e}: {residual:e}");
                }
            }
        }
    }
    assert!(turned > 80, "{turned}");
}
