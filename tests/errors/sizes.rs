//! GOAL: sizes that are too large are errors before memory is allocated; the error names the memory they would need.
//! SCENE: blocks, strips, boundaries, records, sweeps and matrices far too large; huge expected numbers of steps.
//! REFERENCE: the smallest size of their matrices and lists, counted by hand; the peak memory of the process.

use basemat::bem::full_plane::Boundary;
use basemat::bem::{ElasticGround, Ground, SpringGround, Strip};
use basemat::fem::{Layer, Material, Mesh};
use basemat::history::{HistoryMethod, HistoryOptions};
use basemat::motion::{Record, el_centro_1940};
use basemat::structure::{MatrixModel, Triplets};
use basemat::sweep::{Parameter, Sweep};
use basemat::{Error, Result, Soil, memory_limit, unobserved};

/// Peak memory of this process, bytes; `None` where the system does not report it.
fn peak_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM"))?;
    Some(1024.0 * line.split_whitespace().nth(1)?.parse::<f64>().ok()?)
}

/// Checks that this number is a memory error that names at least `min_bytes`.
#[track_caller]
fn assert_too_large<T>(result: Result<T>, quantity: &str, number: f64, min_bytes: f64) {
    let Err(Error::Memory(error)) = result.map(drop) else {
        panic!("{quantity} is no error")
    };
    assert_eq!((error.quantity, error.asked), (quantity, number));
    assert!(error.needed >= min_bytes && error.needed < 100.0 * min_bytes, "{error}");
    assert!(error.limit == memory_limit() as f64 && error.needed > error.limit, "{error}");
    assert!(error.to_string().contains("GB of memory, but at most 8.6 GB are allowed"), "{error}");
}

/// Checks that the peak memory has grown by less than `limit` bytes.
#[track_caller]
fn assert_memory_growth(previous_peak: Option<f64>, limit: f64) {
    if let (Some(before), Some(after)) = (previous_peak, peak_memory()) {
        assert!(after - before < limit, "{before:e}, then {after:e} bytes");
    }
}

/// A layer of `rows` rows.
fn concrete_layer(rows: usize) -> [Layer; 1] {
    [Layer::new(1.0, rows, Material::new(30e9, 0.2, 2400.0).unwrap())]
}

/// Checks that a block is an error: an element stores at least four node numbers of eight bytes.
#[track_caller]
fn assert_block_is_too_large(result: Result<Mesh>, columns: f64, rows: f64) {
    let quantity = "columns times rows of the block";
    assert_too_large(result, quantity, columns * (rows + 1.0), 32.0 * columns * rows);
}

#[test]
fn large_meshes_are_errors_before_memory_is_allocated() {
    let previous_peak = peak_memory();
    let layers = concrete_layer(100_000);
    assert_block_is_too_large(Mesh::layered_block(0.0..1.0, 100_000, &layers), 1e5, 1e5);
    let lines: Vec<f64> = (0..=100_000).map(f64::from).collect();
    assert_block_is_too_large(Mesh::graded_block(&lines, &layers), 1e5, 1e5);
    let many_columns = Mesh::layered_block(0.0..1.0, 1_000_000_000_000_000, &concrete_layer(1));
    assert_block_is_too_large(many_columns, 1e15, 1.0);
    let two_layers = [concrete_layer(usize::MAX)[0]; 2];
    let many_rows = Mesh::layered_block(0.0..1.0, 1, &two_layers);
    assert!(matches!(many_rows, Err(Error::Memory(_))));
    assert_memory_growth(previous_peak, 5e8);
}

/// Checks that a number of elements is an error: a matrix of two components has 4 Q² numbers.
#[track_caller]
fn assert_too_many_elements<T>(result: Result<T>, quantity: &str, count: f64) {
    assert_too_large(result, quantity, count, 32.0 * count * count);
}

#[test]
fn large_grounds_are_errors_before_memory_is_allocated() {
    let previous_peak = peak_memory();
    let quantity = "contact elements";
    assert_too_many_elements(Strip::graded(-5.0..5.0, 10_000), quantity, 1e4);
    assert_too_many_elements(SpringGround::new(0.0..1.0, 5_000, 1.0, 1.0), quantity, 5e3);
    let soil = Soil::new(80e6, 0.33, 1900.0).unwrap();
    let strips = [0.0, 20.0].map(|x| Strip::uniform(x..x + 9.0, 3_000).unwrap());
    assert_too_many_elements(ElasticGround::new(soil, &strips), quantity, 6e3);
    let strip = [Strip::uniform(0.0..1.0, 2).unwrap()];
    assert_too_many_elements(Boundary::flat(&strip, 1_000_000), "boundary elements", 1e6);
    assert_memory_growth(previous_peak, 5e8);
}

#[test]
fn large_matrices_are_errors_before_memory_is_allocated() {
    let previous_peak = peak_memory();
    // The matrix stores where each row begins.
    let matrix = Triplets::new(100_000_000);
    let model = MatrixModel::new(matrix.clone(), matrix, Vec::new());
    assert_too_large(model, "rows of a matrix", 1e8, 8e8);
    assert_memory_growth(previous_peak, 5e8);
}

#[test]
fn long_records_and_sweeps_are_errors_before_memory_is_allocated() {
    let previous_peak = peak_memory();
    let quantity = "samples of the record";
    let by_function = Record::from_fn(1e-9, 1e3, |_| unreachable!("no sample is taken"));
    assert_too_large(by_function, quantity, 1e12, 8e12);
    let record = el_centro_1940();
    let resampled_count = (record.duration() / 1e-9 - 1e-9).ceil();
    assert_too_large(record.resampled(1e-9), quantity, resampled_count, 8.0 * resampled_count);
    let padded_count = record.len() as f64 + 2e8 + 1.95e8;
    assert_too_large(record.padded(4e6, 3.9e6), quantity, padded_count, 8.0 * padded_count);
    assert!(matches!(record.padded(f64::MAX, 0.0), Err(Error::Memory(_))));

    let [first, second] =
        ["a", "b"].map(|name| Parameter::numbers(name, (0..20_000).map(f64::from)));
    assert_too_large(Sweep::grid([first, second]), "cases of the sweep", 4e8, 8.0 * 4e8);
    assert_memory_growth(previous_peak, 5e8);
}

/// Huge numbers of steps are errors before anything is allocated, unless the history does not grow.
#[test]
fn huge_numbers_of_steps_take_no_memory() {
    let soil = Soil::new(80e6, 0.33, 1900.0).unwrap();
    let mut displacement = [0.0; 32];
    for (kind, steps) in [
        (HistoryMethod::Auto, 1 << 40),
        (HistoryMethod::RelaxedFft, 1 << 39),
        (HistoryMethod::RelaxedFft, usize::MAX),
        (HistoryMethod::Direct, usize::MAX),
    ] {
        let previous_peak = peak_memory();
        let ground = ElasticGround::new(soil, Strip::graded(-5.0..5.0, 16).unwrap()).unwrap();
        let mut ground =
            ground.with_history(HistoryOptions { memory: 1 << 24, ..kind.into() }).unwrap();
        let preparation = ground.prepare(0.002, Some(steps), &mut unobserved);
        if kind == HistoryMethod::Auto {
            ground.history(&mut displacement).unwrap();
        } else {
            let Err(Error::Memory(error)) = preparation else {
                panic!("{kind}: {preparation:?}")
            };
            assert!(error.asked == steps as f64 && error.limit == f64::from(1 << 24), "{error}");
        }
        assert_memory_growth(previous_peak, 3e8);
    }
}
