//! Pictures: panels with curves and markers, as SVG.

use std::ops::Range;
use std::path::Path;

use plotters::coord::Shift;
use plotters::coord::ranged1d::ValueFormatter;
use plotters::prelude::*;
use plotters::style::SizeDesc;

use crate::AnyError;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Points of a curve: more than pixels help nobody.
const POINTS: usize = 700;

/// Pixels of the drawing to one of the picture: coordinates in SVG files are whole numbers here.
const SCALE: i32 = 4;
/// Width of a thin line in it.
const WIDTH: u32 = 4;

pub(crate) const BLUE: RGBColor = RGBColor(31, 119, 180);
pub(crate) const RED: RGBColor = RGBColor(214, 39, 40);
pub(crate) const GREEN: RGBColor = RGBColor(44, 160, 44);
pub(crate) const ORANGE: RGBColor = RGBColor(255, 140, 0);
pub(crate) const VIOLET: RGBColor = RGBColor(148, 103, 189);
pub(crate) const GRAY: RGBColor = RGBColor(70, 70, 70);

/// Panels under a title.
pub(crate) struct Figure {
    pub(crate) title: String,
    pub(crate) columns: usize,
    pub(crate) panels: Vec<Panel>,
}

/// Style in which a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Style {
    /// Wide and pale: references, which lie beneath.
    Wide,
    /// Thin: what the crate found.
    Thin,
    Dashed,
    Circles,
    Crosses,
}

struct Series {
    name: String,
    color: RGBColor,
    style: Style,
    points: Vec<(f64, f64)>,
}

/// Axes with series.
pub(crate) struct Panel {
    x: String,
    y: String,
    logarithmic: [bool; 2],
    legend: SeriesLabelPosition,
    categories: Vec<String>,
    /// Part of the height that is kept free for the legend: below, above.
    room: [f64; 2],
    series: Vec<Series>,
}

impl Panel {
    pub(crate) fn new(x: &str, y: &str) -> Self {
        Self {
            x: x.into(),
            y: y.into(),
            logarithmic: [false; 2],
            legend: SeriesLabelPosition::UpperRight,
            categories: Vec::new(),
            room: [0.05; 2],
            series: Vec::new(),
        }
    }

    /// With a logarithmic vertical axis.
    pub(crate) fn logarithmic(mut self) -> Self {
        self.logarithmic[1] = true;
        self
    }

    /// With two logarithmic axes.
    pub(crate) fn double_logarithmic(mut self) -> Self {
        self.logarithmic = [true; 2];
        self
    }

    /// With the legend somewhere else than at the upper right.
    pub(crate) fn legend(mut self, position: SeriesLabelPosition) -> Self {
        self.legend = position;
        self
    }

    /// With free parts of the height below and above the curves.
    pub(crate) fn room(mut self, below: f64, above: f64) -> Self {
        self.room = [below, above];
        self
    }

    /// With names instead of the numbers 0, 1, 2, … along x.
    pub(crate) fn categories(mut self, names: &[&str]) -> Self {
        self.categories = names.iter().map(|&name| name.to_owned()).collect();
        self
    }

    /// A reference curve.
    pub(crate) fn reference(self, name: &str, color: RGBColor, points: Vec<(f64, f64)>) -> Self {
        self.series(name, color, Style::Wide, points)
    }

    /// A curve that was computed.
    pub(crate) fn line(self, name: &str, color: RGBColor, points: Vec<(f64, f64)>) -> Self {
        self.series(name, color, Style::Thin, points)
    }

    /// A curve that is not the point.
    pub(crate) fn dashed(self, name: &str, color: RGBColor, points: Vec<(f64, f64)>) -> Self {
        self.series(name, color, Style::Dashed, points)
    }

    /// Single values.
    pub(crate) fn circles(self, name: &str, color: RGBColor, points: Vec<(f64, f64)>) -> Self {
        self.series(name, color, Style::Circles, points)
    }

    /// Single values of a reference.
    pub(crate) fn crosses(self, name: &str, color: RGBColor, points: Vec<(f64, f64)>) -> Self {
        self.series(name, color, Style::Crosses, points)
    }

    fn series(
        mut self,
        name: &str,
        color: RGBColor,
        style: Style,
        points: Vec<(f64, f64)>,
    ) -> Self {
        let every = points.len().div_ceil(POINTS).max(1);
        let points: Vec<_> = points.into_iter().step_by(every).collect();
        self.series.push(Series { name: name.into(), color, style, points });
        self
    }

    /// Extent of the series along one axis, with room beside them.
    fn range(
        &self,
        [below, above]: [f64; 2],
        logarithmic: bool,
        pick: impl Fn(&(f64, f64)) -> f64,
    ) -> Range<f64> {
        let values = || self.series.iter().flat_map(|series| &series.points).map(&pick);
        let low = values().fold(f64::INFINITY, f64::min);
        let high = values().fold(f64::NEG_INFINITY, f64::max);
        if logarithmic {
            let span = (high / low).ln();
            return low * (-below * span).exp()..high * (above * span).exp();
        }
        let span = (high - low).max(f64::MIN_POSITIVE);
        low - below * span..high + above * span
    }

    fn draw(&self, area: &Area) -> Result<(), AnyError> {
        // Signs reach beyond their place.
        let signs = |s: &Series| matches!(s.style, Style::Circles | Style::Crosses);
        let sides = match (self.series.iter().any(signs), self.categories.is_empty()) {
            // Names as well.
            (_, false) => 0.12,
            (true, true) => 0.06,
            (false, true) => 0.0,
        };
        let [log_x, log_y] = self.logarithmic;
        let x = self.range([sides; 2], log_x, |p| p.0);
        let y = self.range(self.room, log_y, |p| p.1);
        let mut builder = ChartBuilder::on(area);
        builder.margin(SCALE * 12).x_label_area_size(SCALE * 48).y_label_area_size(SCALE * 78);
        let names = |value: &f64| {
            let place = self.categories.iter().enumerate();
            let mut near = place.filter(|(k, _)| (*k as f64 - value).abs() < 0.01);
            near.next().map_or_else(String::new, |(_, name)| name.clone())
        };
        let (plain_x, plain_y) = (plain(&x), plain(&y));
        let format_x: &dyn Fn(&f64) -> String =
            if self.categories.is_empty() { &plain_x } else { &names };
        let power = |value: &f64| format!("{value:.0e}");
        match (log_x, log_y) {
            (true, _) => {
                let chart = builder.build_cartesian_2d(x.log_scale(), y.log_scale())?;
                self.fill(chart, &|value| format!("{value}"), &power)
            }
            (_, true) => {
                let chart = builder.build_cartesian_2d(x, y.log_scale())?;
                self.fill(chart, format_x, &power)
            }
            _ => self.fill(builder.build_cartesian_2d(x, y)?, format_x, &plain_y),
        }
    }

    /// Mesh, series and legend.
    fn fill<'a, 'b: 'a, X, Y>(
        &self,
        mut chart: ChartContext<'a, SVGBackend<'b>, Cartesian2d<X, Y>>,
        format_x: &dyn Fn(&f64) -> String,
        format_y: &dyn Fn(&f64) -> String,
    ) -> Result<(), AnyError>
    where
        X: Ranged<ValueType = f64> + ValueFormatter<f64>,
        Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
    {
        chart
            .configure_mesh()
            .x_desc(&self.x)
            .y_desc(&self.y)
            .x_label_formatter(&|x| format_x(x))
            .y_label_formatter(&|y| format_y(y))
            .label_style(("sans-serif", SCALE * 14))
            .axis_desc_style(("sans-serif", SCALE * 16))
            .x_labels(if self.categories.is_empty() { 11 } else { self.categories.len() })
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.15).stroke_width(WIDTH))
            .axis_style(BLACK.stroke_width(WIDTH))
            .set_all_tick_mark_size(SCALE * 5)
            .draw()?;
        for series in &self.series {
            series.draw(&mut chart)?;
        }
        if self.series.iter().any(|series| !series.name.is_empty()) {
            chart
                .configure_series_labels()
                .position(self.legend.clone())
                .background_style(WHITE.mix(0.85))
                .border_style(BLACK.mix(0.3).stroke_width(WIDTH))
                .margin(SCALE * 8)
                .legend_area_size(SCALE * 30)
                .label_font(("sans-serif", SCALE * 14))
                .draw()?;
        }
        Ok(())
    }
}

impl Series {
    fn draw<'a, 'b: 'a, X, Y>(
        &self,
        chart: &mut ChartContext<'a, SVGBackend<'b>, Cartesian2d<X, Y>>,
    ) -> Result<(), AnyError>
    where
        X: Ranged<ValueType = f64>,
        Y: Ranged<ValueType = f64>,
    {
        let (color, points) = (self.color, self.points.iter().copied());
        let stroke = match self.style {
            Style::Wide => color.mix(0.35).stroke_width(6 * WIDTH),
            Style::Crosses => color.stroke_width(2 * WIDTH),
            Style::Thin | Style::Dashed | Style::Circles => color.stroke_width(WIDTH + WIDTH / 2),
        };
        let (radius, arm) = (SCALE * 4, SCALE * 5);
        let drawn = match self.style {
            Style::Wide | Style::Thin => chart.draw_series(LineSeries::new(points, stroke))?,
            Style::Dashed => {
                let size = |pixels: i32| (SCALE * pixels).in_pixels(&(1, 1));
                chart.draw_series(DashedLineSeries::new(points, size(5), size(4), stroke))?
            }
            Style::Circles => {
                chart.draw_series(points.map(|at| Circle::new(at, radius, stroke)))?
            }
            Style::Crosses => chart.draw_series(points.map(|at| Cross::new(at, arm, stroke)))?,
        };
        if self.name.is_empty() {
            return Ok(());
        }
        let to = |x: i32, pixels: i32| x + SCALE * pixels;
        let drawn = drawn.label(&self.name);
        // Each sign is a type of its own.
        match self.style {
            Style::Wide | Style::Thin => {
                drawn.legend(move |(x, y)| PathElement::new(vec![(x, y), (to(x, 22), y)], stroke))
            }
            Style::Dashed => drawn.legend(move |at| {
                let dash = |from| {
                    PathElement::new(vec![(SCALE * from, 0), (SCALE * (from + 5), 0)], stroke)
                };
                EmptyElement::at(at) + dash(0) + dash(9) + dash(18)
            }),
            Style::Circles => {
                drawn.legend(move |(x, y)| Circle::new((to(x, 11), y), radius, stroke))
            }
            Style::Crosses => drawn.legend(move |(x, y)| Cross::new((to(x, 11), y), arm, stroke)),
        };
        Ok(())
    }
}

impl Figure {
    pub(crate) fn new(title: &str, columns: usize, panels: Vec<Panel>) -> Self {
        Self { title: title.into(), columns, panels }
    }

    /// Writes the SVG.
    pub(crate) fn draw(&self, path: &Path) -> Result<(), AnyError> {
        let rows = self.panels.len().div_ceil(self.columns);
        let (width, height) = (1200, if rows == 1 { 460 } else { 60 + 290 * rows });
        let scale = usize::try_from(SCALE)?;
        let size = (u32::try_from(scale * width)?, u32::try_from(scale * height)?);
        let mut text = String::new();
        {
            let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
            root.fill(&WHITE)?;
            let body =
                root.margin(SCALE * 10, 0, 0, 0).titled(&self.title, ("sans-serif", SCALE * 22))?;
            for (area, panel) in body.split_evenly((rows, self.columns)).iter().zip(&self.panels) {
                panel.draw(area)?;
            }
            root.present()?;
        }
        // The view box keeps the drawing's pixels.
        let large = format!("width=\"{}\" height=\"{}\"", size.0, size.1);
        let small = format!("width=\"{width}\" height=\"{height}\"");
        Ok(std::fs::write(path, text.replacen(&large, &small, 1))?)
    }
}

/// Decimal numbers with as many digits as a tenth of the range needs.
fn plain(range: &Range<f64>) -> impl Fn(&f64) -> String + use<> {
    let step = (range.end - range.start) / 10.0;
    let digits = (-step.log10()).ceil().clamp(0.0, 6.0);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 6")]
    let digits = digits as usize;
    move |value| format!("{:.digits$}", if value.abs() < 1e-12 { 0.0 } else { *value })
}
