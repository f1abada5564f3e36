//! The printed page of a run, in kN, mm and kPa.

use std::fmt;

use crate::coupled::run::ground_motion::seconds;
use crate::coupled::run::quantity_row::ShownIn;
use crate::coupled::run::{ElementEnvelope, Extremes, Fallbacks, Quantity, Run, Summary};
use crate::geometry::{axis_name, middle, resultant, span};
use crate::text::readable_number::{PrintedUnit, number, of_body, printed, thousandths};
use crate::text::table::Table;

/// Number of elements above which the pressure envelope is shortened.
const MAX_PRESSURE_ROWS: usize = 12;
/// Lever of the outermost elements, over half the width, above which no advice is printed.
const ACCURATE_LEVER: f64 = 0.93;
/// Fraction of open base above which small changes of a scene may change its peaks.
const MOSTLY_OPEN: f64 = 0.5;

impl fmt::Display for Run {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { steps, start, end, .. } = self;
        let step = seconds(self.time_step);
        writeln!(f, "Run of {steps} steps of {step} s from t = {start:.3} s to {end:.3} s")?;
        writeln!(f, "{}", self.ground_motion)?;
        let weight = self.whole.static_normal_force;
        if weight > 0.0 {
            writeln!(
                f,
                "Weight on the base: {:.1} {}",
                1e-3 * weight,
                of_body("kN/m", self.in_plan)
            )?;
        }
        writeln!(f, "\n{}", self.peaks().text())?;
        if self.foundations.len() > 1 {
            writeln!(f, "{}", self.each_foundation().text())?;
        }
        if let Some(coefficient) = self.shear_coefficient() {
            writeln!(f, "Largest horizontal force: {coefficient:.3} of the weight")?;
        }
        self.safety(f)?;
        if let Some(met) = self.is_serviceable() {
            writeln!(f, "\nServiceability: {}", if met { "met" } else { "not met" })?;
            for check in &self.serviceability {
                writeln!(f, "  {check}")?;
            }
        }
        self.uplift_and_sliding(f)?;
        let shown = self.pressures();
        let all = self.envelope.len();
        let printed = shown.rows.len();
        let part =
            if printed < all { format!(", {printed} of {all} elements") } else { String::new() };
        let faces = if self.has_walls() { "on base and walls" } else { "under the base" };
        writeln!(f, "\nPressure {faces}{part}\n{}", shown.text())?;
        self.energies(f)?;
        self.effort(f)?;
        for warning in &self.warnings {
            write!(f, "\nwarning: {warning}")?;
        }
        Ok(())
    }
}

impl Run {
    fn peaks(&self) -> Table {
        let heading = ["Peaks", "unit", "smallest", "at s", "largest", "at s"];
        let mut rows = Vec::new();
        for quantity in Quantity::shown(ShownIn::Page, self.in_plan) {
            let extremes = self.whole.extremes(quantity);
            rows.push(peak_row(quantity.name(), quantity.printed(self.in_plan), &extremes));
        }
        for probe in &self.probes {
            rows.push(peak_row(&probe.name, printed(&probe.unit), &probe.extremes));
        }
        Table { heading: heading.map(str::to_owned).to_vec(), repeated: 1, rows }
    }

    /// Largest magnitudes, one line for each foundation.
    fn each_foundation(&self) -> Table {
        let shown: Vec<_> = Quantity::shown(ShownIn::Foundations, self.in_plan).collect();
        let mut headings = vec!["Foundation, m".to_owned()];
        for quantity in &shown {
            let has_limit = quantity.limit().is_some();
            let unit = if has_limit { "" } else { quantity.printed(self.in_plan).symbol };
            headings.push(format!("{} {unit}", quantity.short_name()).trim_end().to_owned());
        }
        headings.extend(["slip events", "sliding distance mm"].map(str::to_owned));
        let rows = self.foundations.iter().map(|summary| self.foundation_row(summary, &shown));
        Table { heading: headings, repeated: 1, rows: rows.collect() }
    }

    /// Place of a foundation, its largest magnitudes, and its sliding.
    fn foundation_row(&self, summary: &Summary, shown: &[Quantity]) -> Vec<String> {
        let mut places = Vec::new();
        for axis in self.axes() {
            let ends = [summary.ends, summary.depth][axis];
            let interval = format!("{:.2} to {:.2}", ends[0], ends[1]);
            places.push(match axis_name(self.in_plan, axis) {
                Some(name) => format!("{name} {interval}"),
                None => interval,
            });
        }
        let mut cells = vec![places.join(", ")];
        for quantity in shown {
            let value = summary.peak(*quantity).value;
            cells.push(if quantity.limit().is_some() {
                factor(value)
            } else {
                number(quantity.printed(self.in_plan).factor * value)
            });
        }
        cells.push(summary.sliding.events.len().to_string());
        cells.push(number(1e3 * summary.sliding.path));
        cells
    }

    fn safety(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for quantity in Quantity::recorded(self.in_plan) {
            let peak = self.whole.peak(quantity);
            if quantity.limit().is_none() || peak.value.is_nan() {
                continue;
            }
            let name = quantity.name();
            let smallest = factor(peak.value);
            write!(f, "Least {name}: {smallest} at {:.3} s", peak.time)?;
            match quantity {
                Quantity::OverturningSafety => writeln!(f, ", over the left or the right edge")?,
                Quantity::OverturningSafetyAcross => {
                    writeln!(f, ", over the front or the back edge")?;
                }
                _ => writeln!(f)?,
            }
        }
        let lever = self.axes().map(|axis| self.lever(axis)).fold(1.0, f64::min);
        if lever < ACCURATE_LEVER {
            writeln!(
                f,
                "  pressure acts in the middle of elements, {lever:.2} of the half width from the middle of the base at \
                 most:\n  a base on its edge has a factor of {:.2}, not 1 (1.07 or less with 16 elements a side)",
                1.0 / lever
            )?;
        }
        Ok(())
    }

    /// Distance from the middle of a foundation to the middles of its outermost elements, over half its
    /// width.
    ///
    /// Along an axis; the smallest of all foundations and both sides.
    fn lever(&self, axis: usize) -> f64 {
        let mut smallest = f64::INFINITY;
        for summary in &self.foundations {
            let ends = [summary.ends, summary.depth][axis];
            let elements = self.envelope.get(summary.elements.clone()).unwrap_or_default();
            let centers = span(elements.iter().map(|element| element.element.center()[axis]));
            let middle = middle(ends);
            let lever =
                (middle - centers[0]).min(centers[1] - middle) / (0.5 * (ends[1] - ends[0]));
            smallest = smallest.min(lever);
        }
        smallest
    }

    fn uplift_and_sliding(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
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
        if uplifted.value > MOSTLY_OPEN {
            writeln!(
                f,
                "  most of the base opens: not every digit of a peak may hold (`sensitivity` counts them)"
            )?;
        }
        self.settlement(f)?;
        let sliding = &self.whole.sliding;
        writeln!(f, "Sliding")?;
        for axis in self.axes() {
            let mean = [&self.whole.mean_slip, &self.whole.mean_slip_across][axis].largest();
            let end = [self.whole.residual_slip, self.whole.residual_slip_across][axis];
            let name = ["mean slip", "mean slip across"][axis];
            let value = number(1e3 * mean.value);
            let end = number(1e3 * end);
            write!(f, "  {name} up to {value} mm at {:.3} s, {end} mm at the end", mean.time)?;
            if axis == 0 {
                let largest = self.whole.largest_slip.highest.value;
                write!(f, "; any element {} mm", number(1e3 * largest))?;
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

    fn settlement(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let settlement = self.whole.settlement.highest;
        writeln!(
            f,
            "Settlement\n  up to {} mm at {:.3} s, {} mm at the end",
            number(1e3 * settlement.value),
            settlement.time,
            number(1e3 * self.whole.residual_settlement)
        )
    }

    fn pressures(&self) -> Table {
        let axes: Vec<usize> = self.axes().chain(self.has_walls().then_some(2)).collect();
        let places = axes.iter().map(|&axis| ["x, m", "y, m", "z, m"][axis]);
        let numbers = ["static kPa", "least kPa", "largest kPa", "at s", "open s"];
        let heading: Vec<_> = places.chain(numbers).map(str::to_owned).collect();
        let every = self.envelope.len().div_ceil(MAX_PRESSURE_ROWS).max(1);
        let last = self.envelope.len().saturating_sub(1);
        // The line with the largest pressure is always printed.
        let pressures = self.envelope.iter().map(|envelope| envelope.pressure.highest.value);
        let largest = pressures.enumerate().max_by(|(_, a), (_, b)| a.total_cmp(b));
        let largest = largest.map(|(k, _)| k);
        let mut rows = Vec::new();
        for (k, envelope) in self.envelope.iter().enumerate() {
            if k.is_multiple_of(every) || k == last || Some(k) == largest {
                rows.push(pressure_row(envelope, &axes));
            }
        }
        let repeated = heading.len() - 5;
        Table { heading, repeated, rows }
    }

    fn effort(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let steps = self.steps.max(1) as f64;
        let wall = self.wall.as_secs_f64();
        let Fallbacks { gauss_seidel, path, newton, proximal } = self.fallbacks;
        write!(
            f,
            "\n\nTime taken: {wall:.2} s, {:.1} µs and {:.2} linear solves per step",
            wall / steps * 1e6,
            self.trials as f64 / steps,
        )?;
        // In plan nearly every step uses sweeps.
        let shown = if self.in_plan {
            [(newton, "Newton's method"), (proximal, "proximal steps")]
        } else {
            [(gauss_seidel, "Gauss–Seidel"), (path, "path following")]
        };
        let shown = shown.into_iter().filter(|(steps, _)| *steps > 0);
        for (k, (steps, method)) in shown.enumerate() {
            let begin = if k == 0 { "\nFallbacks of the search for contact modes:" } else { "," };
            write!(f, "{begin} {steps} steps by {method}")?;
        }
        Ok(())
    }

    fn energies(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.energy_balance.is_omitted() {
            return write!(f, "\n{}", self.energy_balance);
        }
        let input = 1e-3 * self.energy_balance.input;
        let unit = of_body("kJ/m", self.in_plan);
        let fractions = self.energy_balance.fractions();
        let ending = if fractions.is_some() { ", of which" } else { "" };
        writeln!(f, "\nEnergy: input {input:.4} {unit}{ending}")?;
        for (name, fraction) in fractions.into_iter().flatten() {
            // Omits terms that would print as zero.
            if fraction.abs() >= 5e-5 {
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
            let bound = number(1e-3 * bound);
            write!(f, "\n  soil within {bound} {unit} (approximate history)")?;
        }
        Ok(())
    }
}

/// Name, unit, and extremes with their times.
fn peak_row(name: &str, unit: PrintedUnit<'_>, extremes: &Extremes) -> Vec<String> {
    let mut cells = vec![name.to_owned(), unit.symbol.to_owned()];
    for peak in [extremes.lowest, extremes.highest] {
        cells.push(number(unit.factor * peak.value));
        cells.push(format!("{:.3}", peak.time));
    }
    cells
}

/// Place of an element along these axes, its pressures, and the time open.
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

/// A factor of safety.
pub(crate) fn factor(value: f64) -> String {
    if value.is_nan() {
        "–".to_owned()
    } else if value < 1e4 {
        format!("{value:.3}")
    } else {
        "unlimited".to_owned()
    }
}
