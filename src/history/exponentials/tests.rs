//! Tests of fits that several histories share.

use super::*;
use crate::bem::{PatchKernel, Strip};
use crate::soil::Soil;

/// Two threads that make the same fit share the fit that is stored first.
#[test]
fn histories_share_the_fit_that_is_stored_first() {
    let soil = Soil::new(1.0, 0.3, 1.0).unwrap();
    let elements = Strip::uniform(-1.0..1.0, 3).unwrap().elements();
    let kernel = PatchKernel::new(soil, elements, 0.2).unwrap();
    let mut store = vec![];
    let fits = [1e-9, 1e-9, 1e-4].map(|tolerance| {
        let request = FitRequest { lags: 64, horizon: 1000, tolerance };
        Arc::new(TailFit::new(&kernel, &kernel, request).unwrap())
    });
    let stored = fits.map(|fit| store_fit(&mut store, fit));
    assert!(Arc::ptr_eq(&stored[0].fit, &stored[1].fit));
    assert!(!Arc::ptr_eq(&stored[0].fit, &stored[2].fit));
    assert_eq!(store.len(), 2);
}
