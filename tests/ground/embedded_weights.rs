//! GOAL: weights around a trench are right in time, give no work, and can be saved.
//! SCENE: a block welded to the faces of a trench, under waves and forces; tractions that take out work.
//! REFERENCE: Fourier synthesis with twice as many elements; the sign of the waves' shear on a wall, turned over.

use basemat::bem::Ground;
use basemat::bem::embedded::{Trench, TrenchGround};
use basemat::history::HistoryMethod;
use basemat::{Error, Soil, unobserved};

use basemat_problems::passivity::least_work;
use basemat_problems::profiles::{gmb, p3};
use basemat_problems::welded_block::{Cause, errors, march};

use super::layered_files::{self, Temporary};

fn ground() -> TrenchGround {
    let elements = Trench::new(-1.0..1.0, 1.0).unwrap().elements(4, 3).unwrap();
    TrenchGround::new(Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap(), elements).unwrap()
}

/// One ground, because its weights take seconds.
#[test]
fn a_ground_with_a_trench_steps_as_by_fourier_synthesis_and_gives_no_work() {
    const STEP: f64 = 0.2;
    let mut ground = ground();
    for (cause, name) in [(Cause::Waves(1.0), "SV_h1f_dt02"), (Cause::Force, "force_h1f_dt02")] {
        let found = errors(&march(&mut ground, STEP, 128, cause), name);
        println!("{cause:?}: {found:?}");
        assert!(found.iter().all(|error| *error < 2.5e-2), "{cause:?}: {found:?}");
    }
    let wrong = errors(&march(&mut ground, STEP, 128, Cause::Waves(-1.0)), "SV_h1f_dt02");
    assert!(wrong.iter().all(|error| *error > 0.1), "{wrong:?}");
    ground.prepare(STEP, Some(100), &mut unobserved).unwrap();
    let least = least_work(&mut ground, 100, 45);
    println!("{least}");
    assert!(least > 0.5, "{least}");
    // Save, go on, and restore into a ground that is prepared again.
    let saved = ground.save().unwrap();
    let mut histories = [(); 2].map(|()| vec![0.0; 20]);
    ground.history(&mut histories[0]).unwrap();
    ground.commit(&[1.0; 20]);
    ground.prepare(STEP, Some(110), &mut unobserved).unwrap();
    ground.restore(100, &saved).unwrap();
    ground.history(&mut histories[1]).unwrap();
    assert_eq!(histories[0], histories[1]);
    assert!(ground.restore(99, &saved).is_err());
    let description = ground.description();
    let history = description.history.unwrap();
    assert_eq!((history.kind, history.stages), (HistoryMethod::RelaxedFft, Some(2)));
    assert_eq!(description.soils.len(), 1);
    let many = ground.prepare(STEP, Some(usize::MAX / 64), &mut unobserved);
    assert!(matches!(many, Err(Error::Memory(_))), "{many:?}");
}

/// Weights in a file are those that were computed, to the last bit; another trench replaces them.
#[test]
fn weights_are_taken_from_a_file() {
    let file = Temporary::new("trench");
    let ground = |depth: f64| {
        let elements = Trench::new(-1.0..1.0, depth).unwrap().elements(2, 2).unwrap();
        TrenchGround::new(p3(gmb(5)), elements).unwrap()
    };
    let run = |mut ground: TrenchGround| layered_files::march(&mut ground, 0.4, 64);
    let wanted = run(ground(1.0)).unwrap();
    assert!(run(ground(1.0).with_kernel_file(&file.0)).unwrap() == wanted);
    let written = std::fs::read(&file.0).unwrap();
    assert!(run(ground(0.8).with_kernel_file(&file.0)).unwrap() != wanted);
    assert!(std::fs::read(&file.0).unwrap() != written);
    assert!(run(ground(1.0).with_kernel_file(&file.0)).unwrap() == wanted);
    assert!(std::fs::read(&file.0).unwrap() == written);
    // The file is read: one wrong bit in it is found.
    let mut damaged = written.clone();
    damaged[written.len() / 2] ^= 1;
    std::fs::write(&file.0, damaged).unwrap();
    let refused = run(ground(1.0).with_kernel_file(&file.0));
    assert!(matches!(refused, Err(Error::File(_))), "{:?}", refused.err());
}
