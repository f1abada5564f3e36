//! GOAL: weights around a trench are correct in time, return no energy, and can be saved.
//! SCENE: a block welded to the faces of a trench, under waves and forces; tractions that extract work.
//! REFERENCE: Fourier synthesis with twice as many elements; the waves' shear on a wall with the wrong sign.

use basemat::bem::Ground;
use basemat::bem::embedded::{Trench, TrenchGround};
use basemat::history::HistoryMethod;
use basemat::{Error, Result, Soil, unobserved};

use basemat_problems::passivity::min_work_ratio;
use basemat_problems::profiles::{gmb, p3};
use basemat_problems::welded_block::{Cause, errors, march};

use super::layered_files::{self, TemporaryFile};

fn ground() -> TrenchGround {
    let elements = Trench::new(-1.0..1.0, 1.0).unwrap().elements(4, 3).unwrap();
    TrenchGround::new(Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap(), elements).unwrap()
}

/// GOAL: the march of a block around a trench, the smallest work, and a saved state.
///
/// One test of one ground, as its weights take seconds.
#[test]
fn a_ground_with_a_trench_steps_as_by_fourier_synthesis_and_gives_no_work() {
    const TIME_STEP: f64 = 0.2;
    let mut ground = ground();
    for (cause, name) in [(Cause::Waves(1.0), "SV_h1f_dt02"), (Cause::Force, "force_h1f_dt02")] {
        let errors = errors(&march(&mut ground, TIME_STEP, 128, cause), name);
        println!("{cause:?}: {errors:?}");
        assert!(errors.iter().all(|error| *error < 2.5e-2), "{cause:?}: {errors:?}");
    }
    let wrong_sign = march(&mut ground, TIME_STEP, 128, Cause::Waves(-1.0));
    let wrong_errors = errors(&wrong_sign, "SV_h1f_dt02");
    assert!(wrong_errors.iter().all(|error| *error > 0.1), "{wrong_errors:?}");
    ground.prepare(TIME_STEP, Some(100), &mut unobserved).unwrap();
    let smallest_work = min_work_ratio(&mut ground, 100, 45);
    println!("{smallest_work}");
    assert!(smallest_work > 0.5, "{smallest_work}");
    // The state is saved, the march continues, and the state is restored into the ground prepared again.
    let saved_variables = ground.save().unwrap();
    let mut expected = vec![0.0; 20];
    ground.history(&mut expected).unwrap();
    ground.commit(&[1.0; 20]);
    ground.prepare(TIME_STEP, Some(110), &mut unobserved).unwrap();
    ground.restore(100, &saved_variables).unwrap();
    let mut displacement_after_restoring = vec![0.0; 20];
    ground.history(&mut displacement_after_restoring).unwrap();
    assert_eq!(expected, displacement_after_restoring);
    assert!(ground.restore(99, &saved_variables).is_err());
    let description = ground.description();
    let history = description.history.unwrap();
    assert_eq!((history.kind, history.stages), (HistoryMethod::RelaxedFft, Some(2)));
    assert_eq!(description.soils.len(), 1);
    let too_long = ground.prepare(TIME_STEP, Some(usize::MAX / 64), &mut unobserved);
    assert!(matches!(too_long, Err(Error::Memory(_))), "{too_long:?}");
}

/// A trench of this depth in a damped layer on rigid bedrock.
fn trench_in_layer(depth: f64) -> TrenchGround {
    let elements = Trench::new(-1.0..1.0, depth).unwrap().elements(2, 2).unwrap();
    TrenchGround::new(p3(gmb(5)), elements).unwrap()
}

/// Bits of the displacements of a march with the trench's weights in a file.
fn march_with_file(depth: f64, file: &TemporaryFile) -> Result<Vec<u64>> {
    layered_files::march(&mut trench_in_layer(depth).with_kernel_file(&file.path), 0.4, 64)
}

/// GOAL: weights in a file are the computed ones, to the last bit; those of another trench replace them.
#[test]
fn weights_are_taken_from_a_file() {
    let file = TemporaryFile::new("trench");
    let expected = layered_files::march(&mut trench_in_layer(1.0), 0.4, 64).unwrap();
    assert!(march_with_file(1.0, &file).unwrap() == expected);
    let written = std::fs::read(&file.path).unwrap();
    assert!(march_with_file(0.8, &file).unwrap() != expected);
    assert!(std::fs::read(&file.path).unwrap() != written);
    assert!(march_with_file(1.0, &file).unwrap() == expected);
    assert!(std::fs::read(&file.path).unwrap() == written);
    // The file is read: one wrong bit in it is found.
    let mut damaged_bytes = written.clone();
    damaged_bytes[written.len() / 2] ^= 1;
    std::fs::write(&file.path, damaged_bytes).unwrap();
    let result = march_with_file(1.0, &file);
    assert!(matches!(result, Err(Error::File(_))), "{:?}", result.err());
}
