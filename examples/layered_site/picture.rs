//! The profile with the building on it, and the floor spectra beside it.

use std::path::Path;

use basemat::motion::STANDARD_GRAVITY;
use basemat::soil::SoilProfile;
use plotters::prelude::*;

use super::{Case, STOREYS};

#[path = "../common/key.rs"]
mod key;
use key::{Area, Sample};

type AnyError = Box<dyn std::error::Error + Send + Sync>;

const SIZE: (u32, u32) = (1280, 640);
const SECTION: u32 = 330;
const COLORS: [RGBColor; 4] =
    [RGBColor(40, 40, 40), RGBColor(31, 119, 180), RGBColor(255, 140, 0), RGBColor(214, 39, 40)];

/// Draws both.
pub(crate) fn draw(path: &Path, profile: &SoilProfile, cases: &[Case]) -> Result<(), AnyError> {
    let root = SVGBackend::new(path, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let (left, right) = root.split_horizontally(SECTION);
    section(&left, profile)?;
    spectra(&right, cases)?;
    root.present()?;
    Ok(())
}

/// Layers to scale, the building above.
fn section(area: &Area, profile: &SoilProfile) -> Result<(), AnyError> {
    // Storeys of 3 m on a base of 8 m; pixels per metre.
    let scale = 14.0;
    let (ground, middle) = (250, 165);
    #[allow(clippy::cast_possible_truncation, reason = "a few hundred pixels")]
    let pixels = |length: f64| (scale * length).round() as i32;
    let write = |text: String, at: (i32, i32)| area.draw(&Text::new(text, at, ("sans-serif", 14)));
    for storey in 0..STOREYS {
        let [below, above] = [storey, storey + 1].map(|k| ground - 6 - pixels(3.0 * k as f64));
        let frame = [(middle - pixels(4.0), above), (middle + pixels(4.0), below)];
        area.draw(&Rectangle::new(frame, BLACK.stroke_width(2)))?;
    }
    let base = [(middle - pixels(4.0), ground - 6), (middle + pixels(4.0), ground)];
    area.draw(&Rectangle::new(base, BLACK.filled()))?;
    let (from, to) = (16, 314);
    let mut top = ground;
    let shade = |speed: f64| {
        // Darker, the stiffer: from 100 to 1000 m/s.
        let share = ((speed / 100.0).log10()).clamp(0.0, 1.0);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "150..=240")]
        let grey = (240.0 - 90.0 * share) as u8;
        RGBColor(grey, grey.saturating_sub(8), grey.saturating_sub(28))
    };
    for layer in profile.layers() {
        let (speed, bottom) = (layer.soil.shear_wave_speed(), top + pixels(layer.thickness));
        area.draw(&Rectangle::new([(from, top), (to, bottom)], shade(speed).filled()))?;
        area.draw(&Rectangle::new([(from, top), (to, bottom)], BLACK))?;
        let place = top + pixels(0.5 * layer.thickness) - 18;
        write(
            format!("{} m, {speed:.0} m/s, {:.0} kg/m³", layer.thickness, layer.soil.density()),
            (from + 10, place),
        )?;
        write(layer.damping.describe(), (from + 10, place + 18))?;
        top = bottom;
    }
    if let basemat::soil::Base::HalfPlane { soil, damping } = profile.base() {
        let speed = soil.shear_wave_speed();
        area.draw(&Rectangle::new([(from, top), (to, top + 96)], shade(speed).filled()))?;
        write(format!("rock, {speed:.0} m/s, {:.0} kg/m³", soil.density()), (from + 10, top + 30))?;
        write(damping.describe(), (from + 10, top + 48))?;
    }
    Ok(())
}

/// Spectra of roofs, full lines, and of the surface on rock and on soil, thin.
fn spectra(area: &Area, cases: &[Case]) -> Result<(), AnyError> {
    let mut curves = Vec::new();
    for (case, color) in cases.iter().zip(COLORS) {
        curves.push((format!("roof: {}", case.name), color.stroke_width(2), &case.spectra[1]));
    }
    let [green, violet] = [RGBColor(44, 160, 44), RGBColor(148, 103, 189)];
    curves.push(("outcrop of the rock".into(), green.stroke_width(1), &cases[0].spectra[0]));
    curves.push(("free surface of the soil".into(), violet.stroke_width(1), &cases[3].spectra[0]));
    let entries: Vec<_> = curves
        .iter()
        .map(|(name, style, _)| {
            let (red, green, blue) = style.color.rgb();
            (name.clone(), Sample::Line(RGBColor(red, green, blue)))
        })
        .collect();
    let area = key::draw(area, 64, &entries)?;
    let in_g = |a: f64| a / STANDARD_GRAVITY;
    let ordinates = || curves.iter().flat_map(|curve| curve.2);
    let top = ordinates().fold(0.0_f64, |m, o| m.max(in_g(o.pseudo_acceleration)));
    let (first, last) = ordinates()
        .fold((f64::INFINITY, 0.0_f64), |(low, high), o| (low.min(o.period), high.max(o.period)));
    let mut chart = ChartBuilder::on(&area)
        .caption("Response spectra, 5 % damping", ("sans-serif", 22))
        .margin(16)
        .x_label_area_size(48)
        .y_label_area_size(64)
        .build_cartesian_2d((first..last).log_scale(), 0.0..1.05 * top)?;
    chart
        .configure_mesh()
        .x_desc("period, s")
        .y_desc("pseudo-acceleration, g")
        // Of the marks between powers of ten two: the others would touch.
        .x_label_formatter(&|x| {
            let marked = [0.05, 0.1, 0.2, 0.5, 1.0, 2.0].iter().any(|m| (x / m - 1.0).abs() < 1e-6);
            if marked { format!("{}", (100.0 * x).round() / 100.0) } else { String::new() }
        })
        .label_style(("sans-serif", 15))
        .axis_desc_style(("sans-serif", 17))
        .light_line_style(WHITE)
        .draw()?;
    for (_, style, spectrum) in &curves {
        let points = spectrum.iter().map(|o| (o.period, in_g(o.pseudo_acceleration)));
        chart.draw_series(LineSeries::new(points, *style))?;
    }
    Ok(())
}
