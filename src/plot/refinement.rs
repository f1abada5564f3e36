//! Picture of the error of a refinement against run time.

use std::ops::Range;

use super::axes::{ChartAxis, chart, draw_curve};
use super::drawing::Stroke;
use super::key::PictureKey;
use super::svg::{PictureLayout, Svg};
use crate::analyses::{Refinement, Setting};
use crate::error::{Error, Result};

/// Margin of an axis, in decades, so that no point lies on the frame.
const DECADE_MARGIN: f64 = 0.1;

/// Estimated error of each setting over its run time, both on logarithmic axes.
///
/// The curves are smaller steps, more elements, and both. A setting without an error or a run time is omitted.
///
/// # Errors
/// [`Error::Size`] if no setting has both an error and a run time.
pub fn refinement(title: &str, refinement: &Refinement) -> Result<Svg> {
    let Some(coarsest) = refinement.settings.first() else {
        return Err(Error::Size { quantity: "settings of a refinement", found: 0, needed: 1 });
    };
    let mut smaller_steps = Vec::new();
    let mut more_elements = Vec::new();
    let mut finer_in_both = Vec::new();
    for setting in &refinement.settings {
        let has_smaller_step = setting.time_step < coarsest.time_step;
        let has_more_elements = setting.elements > coarsest.elements;
        // The coarsest setting is the first point of every curve.
        if let Some(point) = logarithmic_point(setting) {
            if !has_more_elements {
                smaller_steps.push(point);
            }
            if !has_smaller_step {
                more_elements.push(point);
            }
            if has_more_elements == has_smaller_step {
                finer_in_both.push(point);
            }
        }
    }
    let curves = [
        ("smaller steps", smaller_steps),
        ("more elements", more_elements),
        ("both", finer_in_both),
    ];
    let points = curves.iter().flat_map(|(_, points)| points);
    let run_times = padded_range(points.clone().map(|point| point.0));
    let errors = padded_range(points.map(|point| point.1));
    let (Some(run_times), Some(errors)) = (run_times, errors) else {
        let quantity = "settings with an error and a run time";
        return Err(Error::Size { quantity, found: 0, needed: 1 });
    };
    let key = PictureKey::of_curves(curves.iter().map(|(name, _)| *name));
    PictureLayout::new(title, key).picture(|area| {
        let x = ChartAxis::logarithmic(run_times, "run time, s");
        let y = ChartAxis::logarithmic(errors, "estimated error, relative");
        let mut chart = chart(area, &x, &y, true)?;
        for (k, (_, points)) in curves.iter().enumerate() {
            draw_curve(&mut chart, points, Stroke::nth(k), 2)?;
        }
        Ok(())
    })
}

/// Logarithms of run time (s) and error of a setting; `None` unless both are positive.
fn logarithmic_point(setting: &Setting) -> Option<(f64, f64)> {
    let log_run_time = setting.wall.as_secs_f64().log10();
    let log_error = setting.error.log10();
    (log_run_time.is_finite() && log_error.is_finite()).then_some((log_run_time, log_error))
}

/// Range of values whose logarithms these are, with a margin; `None` without values.
fn padded_range(logarithms: impl Iterator<Item = f64>) -> Option<Range<f64>> {
    let mut low = f64::INFINITY;
    let mut high = f64::NEG_INFINITY;
    for logarithm in logarithms {
        low = low.min(logarithm);
        high = high.max(logarithm);
    }
    (low <= high).then(|| 10.0_f64.powf(low - DECADE_MARGIN)..10.0_f64.powf(high + DECADE_MARGIN))
}
