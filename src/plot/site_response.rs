//! Picture of the equivalent-linear response of a site.

use super::axes::{ChartAxis, chart, draw_curve};
use super::drawing::{Area, CURVE_COLORS, Drawing, Stroke, range_of};
use super::key::{KeySample, PictureKey};
use super::lines::{axes_of_spectra, draw_spectra};
use super::svg::{PictureLayout, Svg};
use crate::error::Result;
use crate::motion::SpectralOrdinate;
use crate::site::{EquivalentLinear, LayerResponse};

/// Function that returns a quantity of a layer from its response and its shear wave speed, m/s.
type LayerValue = fn(&LayerResponse, f64) -> f64;

/// Width of each chart over depth, in tenths of the picture.
const DEPTH_CHART_TENTHS: u32 = 3;

/// Shear wave speeds and strains over depth, and response spectra beside them.
///
/// Depth increases downwards from y = 0. Spectra are, for example, those at the surface and at the rock.
///
/// # Errors
/// As for [`spectra`](crate::plot::spectra()).
pub fn site_response(
    title: &str,
    response: &EquivalentLinear,
    spectra: &[(&str, &[SpectralOrdinate])],
) -> Result<Svg> {
    let speeds: [(&str, LayerValue); 2] = [
        ("speed at small strain", |layer, speed| speed / layer.modulus_ratio.sqrt()),
        ("strain-compatible speed", |_, speed| speed),
    ];
    let strains: [(&str, LayerValue); 2] = [
        ("largest strain", |layer, _| 100.0 * layer.largest_strain),
        ("effective strain", |layer, _| 100.0 * layer.effective_strain),
    ];
    // Spectra use the first colours.
    let strokes =
        [CURVE_COLORS[5], CURVE_COLORS[4], CURVE_COLORS[3], CURVE_COLORS[6]].map(Stroke::plain);
    let axes = axes_of_spectra(spectra)?;
    let mut key = Vec::new();
    for ((name, _), stroke) in speeds.iter().chain(&strains).zip(strokes) {
        key.push((*name, KeySample::Line(stroke)));
    }
    for (k, (name, _)) in spectra.iter().enumerate() {
        key.push((*name, KeySample::Line(Stroke::nth(k))));
    }
    let speed_curves = speeds.map(|(_, value)| steps_over_depth(response, value));
    let strain_curves = strains.map(|(_, value)| steps_over_depth(response, value));
    PictureLayout::new(title, PictureKey::new(key)).picture(|area| {
        let depth_chart_width = area.dim_in_pixel().0 * DEPTH_CHART_TENTHS / 10;
        let (speed_area, remaining_area) = area.split_horizontally(depth_chart_width);
        let (strain_area, spectrum_area) = remaining_area.split_horizontally(depth_chart_width);
        draw_over_depth(&speed_area, "c_S, m/s", &speed_curves, &strokes[..2])?;
        draw_over_depth(&strain_area, "strain, %", &strain_curves, &strokes[2..])?;
        draw_spectra(&spectrum_area, &axes, spectra)
    })
}

/// Curve of a value over y, constant in each layer.
fn steps_over_depth(response: &EquivalentLinear, value: LayerValue) -> Vec<(f64, f64)> {
    let mut points = Vec::new();
    for (layer, soil_layer) in response.layers.iter().zip(response.profile.layers()) {
        let speed = (layer.shear_modulus / soil_layer.soil.density()).sqrt();
        let x = value(layer, speed);
        points.push((x, -layer.depth));
        points.push((x, -layer.depth - soil_layer.thickness));
    }
    points
}

/// Draws curves over depth.
fn draw_over_depth(
    area: &Area<'_>,
    description: &str,
    curves: &[Vec<(f64, f64)>; 2],
    strokes: &[Stroke],
) -> Drawing<()> {
    let points = curves.iter().flatten();
    let x_range = range_of(points.clone().map(|point| point.0).chain([0.0]));
    let y_range = range_of(points.map(|point| point.1).chain([0.0]));
    let x_axis = ChartAxis::linear(x_range, description);
    let y_axis = ChartAxis::linear(y_range, "y, m");
    let mut chart = chart(area, &x_axis, &y_axis, true)?;
    for (points, stroke) in curves.iter().zip(strokes) {
        draw_curve(&mut chart, points, *stroke, 2)?;
    }
    Ok(())
}
