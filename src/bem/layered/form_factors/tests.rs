//! Tests of form factors on wide panels, and of the functions from which they are computed.

use super::*;
use crate::bem::{Grading, Strip};

/// The integral over a wide panel equals the sum over its narrow panels, for near and distant elements.
#[test]
fn wide_panels_are_sums_of_narrow_panels() {
    let strip = Strip::new(-1.0..1.0, 7, Grading::Cosine).unwrap();
    let classes = PairClasses::new(strip.elements()).unwrap();
    let forms = FormFactors::new(&classes);
    for (level, index) in [(1, 2), (1, 9), (3, 5), (6, 2), (6, 3)] {
        let panel = Panel { level, index };
        let mut wide_sums = vec![Sums::default(); forms.block_count()];
        add_panel(&forms, panel, &mut wide_sums);
        let mut narrow_panel_sums = vec![Sums::default(); forms.block_count()];
        for index in index << level..(index + 1) << level {
            add_panel(&forms, Panel { level: 0, index }, &mut narrow_panel_sums);
        }
        let expected = narrow_panel_sums.iter().flatten().flatten();
        let max_sum = expected.clone().fold(0.0_f64, |max, sum| max.max(sum.abs()));
        for (wide, narrow) in wide_sums.iter().flatten().flatten().zip(expected) {
            assert!((wide - narrow).abs() < 1e-11 * max_sum, "{level} {index} {wide} {narrow}");
        }
    }
}

/// Adds the integral of a smooth compliance over a panel.
fn add_panel(forms: &FormFactors, panel: Panel, sums: &mut [Sums]) {
    let [start, width] = forms.start_and_width(panel);
    let coefficients: [[f64; 6]; PANEL_POINTS] = std::array::from_fn(|i| {
        let k = start + 0.5 * width * (1.0 + forms.rule.nodes[i]);
        let c = 0.5 * width * forms.rule.weights[i] / (k + 20.0 * forms.width);
        [c, -2.0 * c, c, c, 3.0 * c, c]
    });
    forms.with_values(panel, |rows| accumulate(rows, &coefficients, sums));
}

/// The functions satisfy closed forms and their recurrence, also at the limits between the three methods.
#[test]
fn spherical_bessel_functions_satisfy_their_recurrence() {
    for t in [1e-12, 1e-3, 0.5, 0.999_999, 1.0, 3.1, 9.0, 15.9, 16.1, 300.0_f64] {
        let computed = spherical_bessel(t);
        let sin = t.sin();
        let cos = t.cos();
        if t > 0.4 {
            let j2 = (3.0 / t.powi(3) - 1.0 / t) * sin - 3.0 * cos / (t * t);
            for (value, expected) in computed.iter().zip([sin / t, (sin / t - cos) / t, j2]) {
                assert!((value - expected).abs() < 1e-14, "{t} {value} {expected}");
            }
        }
        for n in 1..PANEL_POINTS - 1 {
            let sum = computed[n - 1] + computed[n + 1];
            let expected = (2 * n + 1) as f64 / t * computed[n];
            assert!((sum - expected).abs() < 1e-13 * sum.abs().max(1e-3), "{t} {n}");
        }
    }
    assert_eq!(spherical_bessel(0.0)[..2], [1.0, 0.0]);
}
