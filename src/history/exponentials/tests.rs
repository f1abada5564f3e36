//! Fits shared by several histories.

use super::*;
use crate::bem::{PatchKernel, Strip};
use crate::soil::Soil;

/// Two threads that make the same fit share the fit that is stored first.
#[test]
fn the_first_fit_is_everybodys() {
    let soil = Soil::new(1.0, 0.3, 1.0).unwrap();
    let elements = Strip::uniform(-1.0..1.0, 3).unwrap().elements();
    let kernel = PatchKernel::new(soil, elements, 0.2).unwrap();
    let mut store = vec![];
    let fit = |tolerance| {
        let request = Request { lags: 64, horizon: 1000, tolerance };
        Arc::new(Fit::new(&kernel, &kernel, request).unwrap())
    };
    let [one, two, coarse] = [fit(1e-9), fit(1e-9), fit(1e-4)];
    let made = [one, two, coarse].map(|fit| keep(&mut store, fit));
    assert!(Arc::ptr_eq(&made[0].fit, &made[1].fit));
    assert!(!Arc::ptr_eq(&made[0].fit, &made[2].fit));
    assert_eq!(store.len(), 2);
}
