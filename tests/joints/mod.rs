//! Joints: contact between two lines of nodes of a structure.

mod checkpoint;
mod free_cap;
mod halves;
mod in_ground;
mod moment_capacity;
mod portal;
mod pounding;
mod refused;
mod slab;
mod stacked;

/// Asserts that each response differs by less than a fraction of its peak; returns the peaks.
fn assert_same_responses<const N: usize>(
    expected: &[Vec<f64>; N],
    computed: &[Vec<f64>; N],
    tolerance: f64,
) -> [f64; N] {
    std::array::from_fn(|k| {
        let pairs = expected[k].iter().zip(&computed[k]);
        let peak = expected[k].iter().fold(0.0, |peak: f64, value| peak.max(value.abs()));
        let difference = pairs.fold(0.0, |max: f64, (a, b)| max.max((a - b).abs()));
        println!("peak {peak:e}, difference {:e}", difference / peak);
        assert!(difference < tolerance * peak, "response {k}: {difference:e} of {peak:e}");
        peak
    })
}
