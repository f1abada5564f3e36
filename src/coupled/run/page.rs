//! The printed page of a run, in kN, mm and kPa.

use std::fmt;

use crate::coupled::run::ground_motion::seconds;
use crate::coupled::run::quantity_row::ShownIn;
use crate::coupled::run::{ElementEnvelope, Extremes, Fallbacks, Quantity, Run, Summary};
use crate::geometry::{axis_name, middle, resultant, span};
use crate::text::readable_number::{
    PrintedUnit, number, printed_unit, thousandths, whole_body_unit,
};
use crate::text::table::Table;

/// Approximate number of rows above which the pressure envelope omits elements.
const MAX_PRESSURE_ROWS: usize = 12;
/// Ratio of the outermost elements' lever to half the width that counts as accurate.
///
/// Above it the page omits the hint on the error of factors of safety.
const ACCURATE_LEVER_RATIO: f64 = 0.93;
/// Fraction of open base above which small changes of a scene may change its peaks.
const MOSTLY_OPEN_FRACTION: f64 = 0.5;
/// Fraction of the input energy below which a term would be printed as 0.00 %.
const MIN_PRINTED_FRACTION: f64 = 5e-5;
/// Factor of safety from which it is printed as unlimited: larger factors have no practical meaning.
const UNLIMITED_SAFETY: f64 = 1e4;

impl fmt::Display for Run {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { steps, start, end, .. } = self;
        let time_step = seconds(self.time_step);
        writeln!(f, "Run of {steps} steps of {time_step} s from t = {start:.3} s to {end:.3} s")?;
        writeln!(f, "{}", self.ground_motion)?;
        self.write_weight(f)?;
        writeln!(f, "\n{}", self.peak_table().text())?;
        if self.foundations.len() > 1 {
            writeln!(f, "{}", self.foundation_table().text())?;
        }
        if let Some(coefficient) = self.shear_coefficient() {
            writeln!(f, "Largest horizontal force: {coefficient:.3} of the weight")?;
        }
        self.write_safety(f)?;
        if let Some(is_serviceable) = self.is_serviceable() {
            writeln!(f, "\nServiceability: {}", if is_serviceable { "met" } else { "not met" })?;
            for check in &self.serviceability {
                writeln!(f, "  {check}")?;
            }
        }
        self.write_uplift(f)?;
        self.write_settlement(f)?;
        self.write_sliding(f)?;
        let pressures = self.pressure_table();
        let element_count = self.envelope.len();
        let row_count = pressures.rows.len();
        let selection = if row_count < element_count {
            format!(", {row_count} of {element_count} elements")
        } else {
            String::new()
        };
        let faces = if self.has_walls() { "on base and walls" } else { "under the base" };
        writeln!(f, "\nPressure {faces}{selection}\n{}", pressures.text())?;
        if !self.joint_envelopes.is_empty() {
            writeln!(f, "\n{}", self.joint_table().text())?;
        }
        self.write_energies(f)?;
        self.write_effort(f)?;
        for warning in &self.warnings {
            write!(f, "\nwarning: {warning}")?;
        }
        Ok(())
    }
}

impl Run {
    fn peak_table(&self) -> Table {
        let heading = ["Peaks", "unit", "smallest", "at s", "largest", "at s"];
        let mut rows = Vec::new();
        for quantity in Quantity::shown(ShownIn::Page, self.in_plan) {
            let extremes = self.whole.extremes(quantity);
            rows.push(peak_row(quantity.name(), quantity.printed_unit(self.in_plan), &extremes));
        }
        for probe in &self.probes {
            rows.push(peak_row(&probe.name, printed_unit(&probe.unit), &probe.extremes));
        }
        Table { heading: heading.map(str::to_owned).to_vec(), repeated_column_count: 1, rows }
    }

    /// Largest magnitudes, one line for each foundation.
    fn foundation_table(&self) -> Table {
        let quantities: Vec<_> = Quantity::shown(ShownIn::Foundations, self.in_plan).collect();
        let mut headings = vec!["Foundation, m".to_owned()];
        for quantity in &quantities {
            let is_factor_of_safety = quantity.limit_label().is_some();
            let unit =
                if is_factor_of_safety { "" } else { quantity.printed_unit(self.in_plan).symbol };
            headings.push(format!("{} {unit}", quantity.short_name()).trim_end().to_owned());
        }
        headings.extend(["slip events", "sliding distance mm"].map(str::to_owned));
        let rows = self.foundations.iter().map(|summary| self.foundation_row(summary, &quantities));
        Table { heading: headings, repeated_column_count: 1, rows: rows.collect() }
    }

    /// Row of a foundation: its extent, largest magnitudes and sliding.
    fn foundation_row(&self, summary: &Summary, quantities: &[Quantity]) -> Vec<String> {
        let mut intervals = Vec::new();
        for axis in self.axes() {
            let ends = [summary.ends, summary.depth][axis];
            let interval = format!("{:.2} to {:.2}", ends[0], ends[1]);
            intervals.push(match axis_name(self.in_plan, axis) {
                Some(name) => format!("{name} {interval}"),
                None => interval,
            });
        }
        let mut cells = vec![intervals.join(", ")];
        for quantity in quantities {
            let value = summary.peak(*quantity).value;
            cells.push(if quantity.limit_label().is_some() {
                safety_text(value)
            } else {
                number(quantity.printed_unit(self.in_plan).factor * value)
            });
        }
        cells.push(summary.sliding.events.len().to_string());
        cells.push(number(1e3 * summary.sliding.path));
        cells
    }

    fn write_safety(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for quantity in Quantity::recorded(self.in_plan) {
            let peak = self.whole.peak(quantity);
            if quantity.limit_label().is_none() || peak.value.is_nan() {
                continue;
            }
            let name = quantity.name();
            let smallest_text = safety_text(peak.value);
            write!(f, "Least {name}: {smallest_text} at {:.3} s", peak.time)?;
            match quantity {
                Quantity::OverturningSafety => writeln!(f, ", over the left or the right edge")?,
                Quantity::OverturningSafetyAcross => {
                    writeln!(f, ", over the front or the back edge")?;
                }
                _ => writeln!(f)?,
            }
        }
        let lever_ratio = self.axes().map(|axis| self.lever_ratio(axis)).fold(1.0, f64::min);
        if lever_ratio < ACCURATE_LEVER_RATIO {
            writeln!(
                f,
                "  pressure acts in the middle of elements, {lever_ratio:.2} of the half width from the middle of the base at \
                 most:\n  a base on its edge has a factor of {:.2}, not 1 (1.07 or less with 16 elements a side)",
                1.0 / lever_ratio
            )?;
        }
        Ok(())
    }

    /// Smallest lever of the outermost elements along an axis, over half the width of their foundation.
    ///
    /// The lever is the distance from the middle of the foundation to the middle of an outermost element.
    fn lever_ratio(&self, axis: usize) -> f64 {
        let mut smallest_ratio = f64::INFINITY;
        for summary in &self.foundations {
            let ends = [summary.ends, summary.depth][axis];
            let elements = self.envelope.get(summary.elements.clone()).unwrap_or_default();
            let centers = span(elements.iter().map(|element| element.element.center()[axis]));
            let middle = middle(ends);
            let ratio =
                (middle - centers[0]).min(centers[1] - middle) / (0.5 * (ends[1] - ends[0]));
            smallest_ratio = smallest_ratio.min(ratio);
        }
        smallest_ratio
    }

    fn write_uplift(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let uplift = &self.whole.uplift;
        let uplifted = self.whole.uplifted_fraction.highest;
        writeln!(f, "\nUplift")?;
        writeln!(
            f,
            "  up to {:.1} % of the base, at {:.3} s; largest gap {} mm",
            100.0 * uplifted.value,
            uplifted.time,
            number(1e3 * self.largest_gap().value)
        )?;
        writeln!(
            f,
            "  {:.3} s in {} intervals, the longest {:.3} s; {:.3} s without contact",
            uplift.duration, uplift.count, uplift.longest, uplift.flight
        )?;
        if uplifted.value > MOSTLY_OPEN_FRACTION {
            writeln!(
                f,
                "  most of the base opens: rounding errors may change digits of a peak (`sensitivity` finds how many)"
            )?;
        }
        Ok(())
    }

    fn write_sliding(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sliding = &self.whole.sliding;
        writeln!(f, "Sliding")?;
        for axis in self.axes() {
            let peak = [&self.whole.mean_slip, &self.whole.mean_slip_across][axis].largest();
            let residual_slip = [self.whole.residual_slip, self.whole.residual_slip_across][axis];
            let name = ["mean slip", "mean slip across"][axis];
            let peak_mm = number(1e3 * peak.value);
            let residual_mm = number(1e3 * residual_slip);
            write!(
                f,
                "  {name} up to {peak_mm} mm at {:.3} s, {residual_mm} mm at the end",
                peak.time
            )?;
            if axis == 0 {
                let largest_slip = self.whole.largest_slip.highest.value;
                write!(f, "; any element {} mm", number(1e3 * largest_slip))?;
            }
            writeln!(f)?;
        }
        let base =
            if self.foundations.len() > 1 { "all foundations as one" } else { "the whole base" };
        write!(
            f,
            "  slip events of {base}: {}, in all {:.3} s and {:.3} mm of sliding",
            sliding.events.len(),
            sliding.duration,
            1e3 * sliding.path
        )?;
        if let Some(event) = sliding.largest_event() {
            let slip = thousandths(1e3 * resultant(event.slip, event.slip_across));
            write!(f, "\n  largest event {slip} mm, {:.3} s to {:.3} s", event.start, event.end)?;
        }
        writeln!(
            f,
            "\nChanges of contact mode: {} ({} debondings, {} rebondings)",
            self.mode_changes, self.debondings, self.rebondings
        )
    }

    fn write_settlement(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let settlement = self.whole.settlement.highest;
        writeln!(
            f,
            "Settlement\n  up to {} mm at {:.3} s, {} mm at the end",
            number(1e3 * settlement.value),
            settlement.time,
            number(1e3 * self.whole.residual_settlement)
        )
    }

    fn pressure_table(&self) -> Table {
        let axes: Vec<usize> = self.axes().chain(self.has_walls().then_some(2)).collect();
        let coordinates = axes.iter().map(|&axis| ["x, m", "y, m", "z, m"][axis]);
        let values = ["static kPa", "least kPa", "largest kPa", "at s", "open s"];
        let heading: Vec<_> = coordinates.chain(values).map(str::to_owned).collect();
        let row_interval = self.envelope.len().div_ceil(MAX_PRESSURE_ROWS).max(1);
        let last_index = self.envelope.len().saturating_sub(1);
        // The element with the largest pressure always has a row.
        let pressures = self.envelope.iter().map(|envelope| envelope.pressure.highest.value);
        let largest_pressure = pressures.enumerate().max_by(|(_, a), (_, b)| a.total_cmp(b));
        let largest_index = largest_pressure.map(|(k, _)| k);
        let mut rows = Vec::new();
        for (k, envelope) in self.envelope.iter().enumerate() {
            if k.is_multiple_of(row_interval) || k == last_index || Some(k) == largest_index {
                rows.push(pressure_row(envelope, &axes));
            }
        }
        let repeated_column_count = axes.len();
        Table { heading, repeated_column_count, rows }
    }

    /// Extremes of each joint over all its elements.
    fn joint_table(&self) -> Table {
        let heading = ["Joint", "gap mm", "slip mm", "largest kPa", "open s", "of s"];
        let mut rows = Vec::with_capacity(self.joint_envelopes.len());
        for (joint, envelopes) in self.joint_envelopes.iter().enumerate() {
            let largest_value = |value: fn(&ElementEnvelope) -> f64| {
                envelopes.iter().map(value).fold(f64::NEG_INFINITY, f64::max)
            };
            rows.push(vec![
                joint.to_string(),
                number(1e3 * largest_value(|element| element.gap.value)),
                number(1e3 * largest_value(|element| element.slip.value.abs())),
                number(1e-3 * largest_value(|element| element.pressure.highest.value)),
                format!("{:.3}", largest_value(|element| element.open)),
                format!("{:.3}", self.end - self.start),
            ]);
        }
        Table { heading: heading.map(str::to_owned).to_vec(), repeated_column_count: 1, rows }
    }

    fn write_effort(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let step_count = self.steps.max(1) as f64;
        let wall = self.wall.as_secs_f64();
        let Fallbacks { gauss_seidel, path, newton, proximal } = self.fallbacks;
        write!(
            f,
            "\n\nTime taken: {wall:.2} s, {:.1} µs and {:.2} linear solves per step",
            wall / step_count * 1e6,
            self.trials as f64 / step_count,
        )?;
        // Gauss–Seidel is the usual method in plan, not a fallback.
        let fallbacks = if self.in_plan {
            [(newton, "Newton's method"), (proximal, "proximal steps")]
        } else {
            [(gauss_seidel, "Gauss–Seidel"), (path, "path following")]
        };
        let used_fallbacks = fallbacks.into_iter().filter(|(steps, _)| *steps > 0);
        for (k, (steps, method)) in used_fallbacks.enumerate() {
            let separator =
                if k == 0 { "\nFallbacks of the search for contact modes:" } else { "," };
            write!(f, "{separator} {steps} steps by {method}")?;
        }
        Ok(())
    }

    fn write_energies(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.energy_balance.is_omitted() {
            return write!(f, "\n{}", self.energy_balance);
        }
        let input_kj = 1e-3 * self.energy_balance.input;
        let unit = whole_body_unit("kJ/m", self.in_plan);
        let fractions = self.energy_balance.fractions();
        let ending = if fractions.is_some() { ", of which" } else { "" };
        writeln!(f, "\nEnergy: input {input_kj:.4} {unit}{ending}")?;
        for (name, fraction) in fractions.into_iter().flatten() {
            if fraction.abs() >= MIN_PRINTED_FRACTION {
                writeln!(f, "  {name:<24}{:>8.2} %", 100.0 * fraction)?;
            }
        }
        write!(
            f,
            "  energy balance open by at most {:.1e} of the largest energy",
            self.energy_error
        )?;
        let bound = self.energy_balance.soil_error_bound;
        if bound > 0.0 {
            let bound_kj = number(1e-3 * bound);
            write!(f, "\n  soil within {bound_kj} {unit} (approximate history)")?;
        }
        Ok(())
    }
}

/// Row of a quantity: name, unit, and extremes with their times.
fn peak_row(name: &str, unit: PrintedUnit<'_>, extremes: &Extremes) -> Vec<String> {
    let mut cells = vec![name.to_owned(), unit.symbol.to_owned()];
    for peak in [extremes.lowest, extremes.highest] {
        cells.push(number(unit.factor * peak.value));
        cells.push(format!("{:.3}", peak.time));
    }
    cells
}

/// Row of an element: coordinates along these axes, pressures, and the time open.
fn pressure_row(envelope: &ElementEnvelope, axes: &[usize]) -> Vec<String> {
    let center = envelope.element.center();
    let mut cells: Vec<_> = axes.iter().map(|&axis| thousandths(center[axis])).collect();
    cells.extend([
        number(1e-3 * envelope.static_pressure),
        number(1e-3 * envelope.pressure.lowest.value),
        number(1e-3 * envelope.pressure.highest.value),
        format!("{:.3}", envelope.pressure.highest.time),
        format!("{:.3}", envelope.open),
    ]);
    cells
}

/// Text of a factor of safety.
pub(crate) fn safety_text(value: f64) -> String {
    if value.is_nan() {
        "–".to_owned()
    } else if value < UNLIMITED_SAFETY {
        format!("{value:.3}")
    } else {
        "unlimited".to_owned()
    }
}
