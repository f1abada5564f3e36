//! GOAL: sizes given as numbers are refused before memory is taken for them, by one error that says
//! what they would take.
//! SCENE: blocks, strips, boundaries, records, sweeps, structures and matrices far too large; hints
//! of steps without end.
//! REFERENCE: the least that their matrices and lists take, counted by hand; the memory that the
//! process had at most.

use basemat::bem::full_plane::Boundary;
use basemat::bem::{ElasticGround, Ground, SpringGround, Strip};
use basemat::fem::{Layer, Material, Mesh};
use basemat::history::{HistoryMethod, HistoryOptions};
use basemat::motion::{Record, el_centro_1940};
use basemat::structure::{MatrixModel, Triplets};
use basemat::sweep::{Parameter, Sweep};
use basemat::{Error, Result, Soil, memory_limit, unobserved};

/// The most memory that this process has had, bytes; none where the system does not tell.
fn peak() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM"))?;
    Some(1024.0 * line.split_whitespace().nth(1)?.parse::<f64>().ok()?)
}

/// Refused for memory, of which it would take at least as much as this.
#[track_caller]
fn too_large<T>(result: Result<T>, quantity: &str, asked: f64, least: f64) {
    let Err(Error::Memory(error)) = result.map(drop) else { panic!("{quantity} is not refused") };
    assert_eq!((error.quantity, error.asked), (quantity, asked));
    assert!(error.needed >= least && error.needed < 100.0 * least, "{error}");
    assert!(error.limit == memory_limit() as f64 && error.needed > error.limit, "{error}");
    assert!(error.to_string().contains("GB of memory, but at most 8.6 GB are allowed"), "{error}");
}

#[test]
fn sizes_are_refused_before_memory_is_taken() {
    let before = peak();
    let concrete = Material::new(30e9, 0.2, 2400.0).unwrap();
    let rows = |rows: usize| [Layer::new(1.0, rows, concrete)];
    let block = "columns times rows of the block";
    // An element has four nodes of eight bytes, at least.
    let of = |columns: f64, rows: f64| (columns * (rows + 1.0), 32.0 * columns * rows);
    let (asked, least) = of(1e5, 1e5);
    too_large(Mesh::layered_block(0.0..1.0, 100_000, &rows(100_000)), block, asked, least);
    let grid: Vec<f64> = (0..=100_000).map(f64::from).collect();
    too_large(Mesh::graded_block(&grid, &rows(100_000)), block, asked, least);
    let (asked, least) = of(1e15, 1.0);
    too_large(Mesh::layered_block(0.0..1.0, 1_000_000_000_000_000, &rows(1)), block, asked, least);
    let two = [rows(usize::MAX)[0]; 2];
    assert!(matches!(Mesh::layered_block(0.0..1.0, 1, &two), Err(Error::Memory(_))));

    // One matrix of two components has 4 Q² numbers.
    let elements = "contact elements";
    let pairs = |count: f64| 32.0 * count * count;
    too_large(Strip::graded(-5.0..5.0, 10_000), elements, 1e4, pairs(1e4));
    too_large(SpringGround::new(0.0..1.0, 5_000, 1.0, 1.0), elements, 5e3, pairs(5e3));
    let soil = Soil::new(80e6, 0.33, 1900.0).unwrap();
    let strips = [0.0, 20.0].map(|x| Strip::uniform(x..x + 9.0, 3_000).unwrap());
    too_large(ElasticGround::new(soil, &strips), elements, 6e3, pairs(6e3));
    let strip = [Strip::uniform(0.0..1.0, 2).unwrap()];
    too_large(Boundary::flat(&strip, 1_000_000), "boundary elements", 1e6, pairs(1e6));

    // Rows by where they begin.
    let matrix = || Triplets::new(100_000_000);
    let model = MatrixModel::new(matrix(), matrix(), Vec::new());
    too_large(model, "rows of a matrix", 1e8, 8e8);

    let samples = "samples of the record";
    let endless = Record::from_fn(1e-9, 1e3, |_| unreachable!("no sample is taken"));
    too_large(endless, samples, 1e12, 8e12);
    let record = el_centro_1940();
    let last = (record.duration() / 1e-9 - 1e-9).ceil();
    too_large(record.resampled(1e-9), samples, last, 8.0 * last);
    let padded = record.padded(4e6, 3.9e6);
    let count = record.len() as f64 + 2e8 + 1.95e8;
    too_large(padded, samples, count, 8.0 * count);
    assert!(matches!(record.padded(f64::MAX, 0.0), Err(Error::Memory(_))));

    let values = |name: &str| Parameter::numbers(name, (0..20_000).map(f64::from));
    too_large(Sweep::grid([values("a"), values("b")]), "cases of the sweep", 4e8, 8.0 * 4e8);
    if let (Some(before), Some(after)) = (before, peak()) {
        assert!(after - before < 5e8, "{before:e}, then {after:e} bytes");
    }
}

/// More steps than any run has are refused before anything is allocated, unless the history does not grow.
#[test]
fn steps_without_end_take_no_memory() {
    let soil = Soil::new(80e6, 0.33, 1900.0).unwrap();
    let mut displacement = [0.0; 32];
    for (kind, steps) in [
        (HistoryMethod::Auto, 1 << 40),
        (HistoryMethod::RelaxedFft, 1 << 39),
        (HistoryMethod::RelaxedFft, usize::MAX),
        (HistoryMethod::Direct, usize::MAX),
    ] {
        let before = peak();
        let ground = ElasticGround::new(soil, Strip::graded(-5.0..5.0, 16).unwrap()).unwrap();
        let mut ground =
            ground.with_history(HistoryOptions { memory: 1 << 24, ..kind.into() }).unwrap();
        let found = ground.prepare(0.002, Some(steps), &mut unobserved);
        if kind == HistoryMethod::Auto {
            ground.history(&mut displacement).unwrap();
        } else {
            let Err(Error::Memory(error)) = found else { panic!("{kind}: {found:?}") };
            assert!(error.asked == steps as f64 && error.limit == f64::from(1 << 24), "{error}");
        }
        if let (Some(before), Some(after)) = (before, peak()) {
            assert!(after - before < 3e8, "{kind:?}: {before:e}, then {after:e} bytes");
        }
    }
}
