//! Plots that correspond to the paper's Figs. 4, 5 and 6, and a map of contact modes.

use std::path::Path;

use basemat::interface::Mode;
use plotters::prelude::*;

use super::AnyError;
use super::case::{Kind, Outcome};
use super::chart::key::{self, Sample};
use super::chart::{self, SIZE};
use super::report::file_stem;

/// Draws everything into `folder`.
pub(crate) fn draw_all(folder: &Path, results: &[Outcome]) -> Result<(), AnyError> {
    curves(
        &folder.join("roof_horizontal.svg"),
        "Horizontal displacement of A, a roof corner (absolute, right is positive)",
        "displacement, mm",
        results,
        |outcome, k| 1e3 * outcome.histories.roof[k][0],
    )?;
    curves(
        &folder.join("roof_vertical.svg"),
        "Vertical displacement of A, a roof corner (absolute, up is positive)",
        "displacement, mm",
        results,
        |outcome, k| 1e3 * outcome.histories.roof[k][1],
    )?;
    curves(
        &folder.join("base_shear.svg"),
        "Base shear at the foundation–superstructure interface",
        "shear, kN/m",
        results,
        |outcome, k| 1e-3 * outcome.histories.shear[k],
    )?;
    for outcome in results.iter().filter(|outcome| outcome.case.kind != Kind::Bonded) {
        let path = folder.join(format!("modes_{}.svg", file_stem(&outcome.case.name)));
        mode_map(&path, outcome)?;
    }
    Ok(())
}

/// One curve per case.
fn curves(
    path: &Path,
    title: &str,
    unit: &str,
    results: &[Outcome],
    value: impl Fn(&Outcome, usize) -> f64,
) -> Result<(), AnyError> {
    let curve = |outcome: &Outcome| {
        let time = outcome.histories.time.iter().enumerate();
        (outcome.case.name.clone(), time.map(|(k, &t)| (t, value(outcome, k))).collect())
    };
    chart::draw(path, title, unit, results.iter().map(curve).collect())
}

/// What an element does, as drawn; where several share a column the greater shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Shown {
    Stick,
    Open,
    /// Touching without a pressure, between stick and open: the law's modes of slip where friction
    /// is infinite.
    Weightless,
    SlipLeft,
    SlipRight,
}

impl Shown {
    fn of(mode: Mode, kind: Kind) -> Self {
        match mode {
            Mode::Stick => Self::Stick,
            Mode::Open => Self::Open,
            _ if kind == Kind::Coulomb(f64::INFINITY) => Self::Weightless,
            Mode::SlipLeft => Self::SlipLeft,
            // The laws here know no other.
            _ => Self::SlipRight,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Stick => "stick",
            Self::Weightless => "touching without pressure",
            Self::Open => "open",
            Self::SlipLeft => "slip to the left",
            Self::SlipRight => "slip to the right",
        }
    }

    fn color(self) -> RGBColor {
        match self {
            Self::Stick => RGBColor(222, 230, 236),
            Self::Weightless => RGBColor(118, 172, 214),
            Self::Open => RGBColor(22, 72, 120),
            Self::SlipLeft => RGBColor(255, 166, 43),
            Self::SlipRight => RGBColor(214, 39, 40),
        }
    }

    /// What a case can show.
    fn key(kind: Kind) -> Vec<Self> {
        match kind {
            Kind::Coulomb(f64::INFINITY) => vec![Self::Stick, Self::Weightless, Self::Open],
            _ => vec![Self::Stick, Self::SlipLeft, Self::SlipRight, Self::Open],
        }
    }
}

/// Contact modes over base and time; where steps share a column, the rarest mode shows.
fn mode_map(path: &Path, outcome: &Outcome) -> Result<(), AnyError> {
    let kept = &outcome.histories;
    let (Some(first), Some(&end)) = (kept.modes.first(), kept.time.last()) else { return Ok(()) };
    let count = first.len();
    let half = 0.5 * outcome.width;
    let length = outcome.width / count as f64;
    let every = kept.modes.len().div_ceil(1000).max(1);

    let root = SVGBackend::new(path, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let title = format!("Contact modes, {}", outcome.case.name);
    let shown = Shown::key(outcome.case.kind);
    let entries: Vec<_> =
        shown.iter().map(|what| (what.name().to_owned(), Sample::Area(what.color()))).collect();
    let area = key::draw(&root, 64, &entries)?;
    let mut chart = ChartBuilder::on(&area)
        .caption(title, ("sans-serif", 24))
        .margin(16)
        .x_label_area_size(48)
        .y_label_area_size(76)
        .build_cartesian_2d(0.0..end, -half..half)?;
    chart
        .configure_mesh()
        .disable_mesh()
        .x_desc("time, s")
        .y_desc("place along the base, m (right is up)")
        .x_label_formatter(&|x| format!("{x:.0}"))
        .y_label_formatter(&|y| format!("{y:.0}"))
        .label_style(("sans-serif", 16))
        .axis_desc_style(("sans-serif", 18))
        .draw()?;
    for element in 0..count {
        let mut begin = 0.0;
        let row = element as f64 * length - half;
        let columns: Vec<(f64, Shown)> = kept
            .modes
            .chunks(every)
            .zip(kept.time.chunks(every))
            .filter_map(|(modes, time)| {
                let kind = outcome.case.kind;
                let rarest = modes.iter().map(|m| Shown::of(m[element], kind)).max()?;
                Some((*time.last()?, rarest))
            })
            .collect();
        // One rectangle per stretch of equal mode keeps the file small.
        for stretch in columns.chunk_by(|a, b| a.1 == b.1) {
            let (end, what) = stretch[stretch.len() - 1];
            let area = [(begin, row + 0.04 * length), (end, row + 0.96 * length)];
            chart.draw_series([Rectangle::new(area, what.color().filled())])?;
            begin = end;
        }
    }
    root.present()?;
    Ok(())
}
