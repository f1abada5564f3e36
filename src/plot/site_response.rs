//! Equivalent-linear response of a site.

use super::axes::{Axis, chart, draw_curve, range_of};
use super::drawing::{Area, COLORS, Drawing, Stroke};
use super::key::{Key, Sample};
use super::lines::{axes_of_spectra, draw_spectra};
use super::svg::{Sheet, Svg};
use crate::error::Result;
use crate::motion::SpectralOrdinate;
use crate::site::{EquivalentLinear, LayerResponse};

/// A quantity of a layer, from its response and its shear wave speed.
type Value = fn(&LayerResponse, f64) -> f64;

/// Shear wave speeds and strains over depth, and response spectra beside them.
///
/// Depth goes down from y = 0. Spectra are, for example, those at the surface and at the rock.
///
/// # Errors
/// As for [`spectra`](crate::plot::spectra()).
pub fn site_response(
    title: &str,
    response: &EquivalentLinear,
    spectra: &[(&str, &[SpectralOrdinate])],
) -> Result<Svg> {
    let speeds: [(&str, Value); 2] = [
        ("speed at small strain", |own, speed| speed / own.modulus_ratio.sqrt()),
        ("strain-compatible speed", |_, speed| speed),
    ];
    let strains: [(&str, Value); 2] = [
        ("largest strain", |own, _| 100.0 * own.largest_strain),
        ("effective strain", |own, _| 100.0 * own.effective_strain),
    ];
    // Spectra use the first colours.
    let strokes = [COLORS[5], COLORS[4], COLORS[3], COLORS[6]].map(Stroke::plain);
    let steps = |value: Value| -> Vec<(f64, f64)> {
        let layers = response.layers.iter().zip(response.profile.layers());
        let step = layers.flat_map(|(own, layer)| {
            let x = value(own, (own.shear_modulus / layer.soil.density()).sqrt());
            [(x, -own.depth), (x, -own.depth - layer.thickness)]
        });
        step.collect()
    };
    let panel =
        |area: &Area<'_>, name: &str, values: [Value; 2], strokes: &[Stroke]| -> Drawing<()> {
            let curves = values.map(steps);
            let all = || curves.iter().flatten();
            let x = Axis::linear(range_of(all().map(|point| point.0).chain([0.0])), name);
            let y = Axis::linear(range_of(all().map(|point| point.1).chain([0.0])), "y, m");
            let mut chart = chart(area, &x, &y, true)?;
            for (points, stroke) in curves.iter().zip(strokes) {
                draw_curve(&mut chart, points, *stroke, 2)?;
            }
            Ok(())
        };
    let axes = axes_of_spectra(spectra)?;
    let names = speeds.iter().chain(&strains).zip(strokes);
    let own = names.map(|((name, _), stroke)| (*name, Sample::Line(stroke)));
    let others = spectra.iter().enumerate();
    let others = others.map(|(k, (name, _))| (*name, Sample::Line(Stroke::nth(k))));
    Sheet::new(title, Key::new(own.chain(others))).picture(|area| {
        let width = area.dim_in_pixel().0;
        let (left, rest) = area.split_horizontally(width * 3 / 10);
        let (middle, right) = rest.split_horizontally(width * 3 / 10);
        panel(&left, "c_S, m/s", speeds.map(|(_, value)| value), &strokes[..2])?;
        panel(&middle, "strain, %", strains.map(|(_, value)| value), &strokes[2..])?;
        draw_spectra(&right, &axes, spectra)
    })
}
