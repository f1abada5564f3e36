//! Error against run time.

use super::axes::{Axis, chart, draw_curve};
use super::drawing::Stroke;
use super::key::Key;
use super::svg::{Sheet, Svg};
use crate::coupled::{Refinement, Setting};
use crate::error::{Error, Result};

/// Estimated error of each setting over its run time, both on logarithmic axes.
///
/// Curves are smaller steps, more elements, and both. A setting without an error or a run time is left out.
///
/// # Errors
/// [`Error::Size`] if no setting has both an error and a run time.
pub fn refinement(title: &str, refinement: &Refinement) -> Result<Svg> {
    let Some(first) = refinement.settings.first() else {
        return Err(Error::Size { quantity: "settings of a refinement", found: 0, needed: 1 });
    };
    let finer = |setting: &Setting| setting.time_step < first.time_step;
    let more = |setting: &Setting| setting.elements > first.elements;
    let curve = |keep: &dyn Fn(&Setting) -> bool| -> Vec<(f64, f64)> {
        let kept = refinement.settings.iter().filter(|setting| keep(setting));
        let points =
            kept.map(|setting| (setting.wall.as_secs_f64().log10(), setting.error.log10()));
        points.filter(|(wall, error)| wall.is_finite() && error.is_finite()).collect()
    };
    let curves = [
        ("smaller steps", curve(&|setting| !more(setting))),
        ("more elements", curve(&|setting| !finer(setting))),
        ("both", curve(&|setting| more(setting) == finer(setting))),
    ];
    let range = |of: fn(&(f64, f64)) -> f64| {
        let all = || curves.iter().flat_map(|(_, points)| points).map(of);
        // A margin of a tenth of a decade, so that no point lies on the frame.
        let (low, high) =
            (all().fold(f64::INFINITY, f64::min), all().fold(-f64::INFINITY, f64::max));
        (low <= high).then(|| 10.0_f64.powf(low - 0.1)..10.0_f64.powf(high + 0.1))
    };
    let (Some(walls), Some(errors)) = (range(|point| point.0), range(|point| point.1)) else {
        let quantity = "settings with an error and a run time";
        return Err(Error::Size { quantity, found: 0, needed: 1 });
    };
    Sheet::new(title, Key::of_curves(curves.iter().map(|(name, _)| *name))).picture(|area| {
        let x = Axis::logarithmic(walls, "run time, s");
        let y = Axis::logarithmic(errors, "estimated error, relative");
        let mut chart = chart(area, &x, &y, true)?;
        for (k, (_, points)) in curves.iter().enumerate() {
            draw_curve(&mut chart, points, Stroke::nth(k), 2)?;
        }
        Ok(())
    })
}
