//! The printed page of a run, in kN, mm and kPa.

use std::fmt;

use crate::coupled::run::ground_motion::seconds;
use crate::coupled::run::peak::Peak;
use crate::coupled::run::quantity::ShownIn;
use crate::coupled::run::{ElementEnvelope, Extremes, Fallbacks, Quantity, Run, Summary};
use crate::geometry::{axis_name, middle, resultant, span};
use crate::text::readable_number::{number, of_body, printed, thousandths};
use crate::text::table::Table;

/// Number of elements above which the pressure envelope is shortened.
const MOST_ROWS: usize = 12;
/// Lever of the outermost elements, over half the width, above which no advice is printed.
const ENOUGH: f64 = 0.93;
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
        let (all, some) = (self.envelope.len(), shown.rows.len());
        let part = if some < all { format!(", {some} of {all} elements") } else { String::new() };
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
        let row = |name: &str, unit: &str, factor: f64, extremes: &Extremes| {
            let cell = |peak: Peak| [number(factor * peak.value), format!("{:.3}", peak.time)];
            let [low, low_time] = cell(extremes.lowest);
            let [high, high_time] = cell(extremes.highest);
            vec![name.to_owned(), unit.to_owned(), low, low_time, high, high_time]
        };
        let whole = Quantity::shown(ShownIn::Page, self.in_plan).map(|quantity| {
            let (factor, unit) = quantity.printed(self.in_plan);
            row(quantity.name(), unit, factor, &self.whole.extremes(quantity))
        });
        let mut rows: Vec<_> = whole.collect();
        rows.extend(self.probes.iter().map(|probe| {
            let (factor, unit) = printed(&probe.unit);
            row(&probe.name, unit, factor, &probe.extremes)
        }));
        Table { heading: heading.map(str::to_owned).to_vec(), repeated: 1, rows }
    }

    /// Largest magnitudes, one line for each foundation.
    fn each_foundation(&self) -> Table {
        let shown: Vec<_> = Quantity::shown(ShownIn::Foundations, self.in_plan).collect();
        let printed = |quantity: &Quantity| quantity.printed(self.in_plan);
        let heading = |quantity: &Quantity| {
            let unit = if quantity.limit().is_some() { "" } else { printed(quantity).1 };
            format!("{} {unit}", quantity.short_name()).trim_end().to_owned()
        };
        let mut headings = vec!["Foundation, m".to_owned()];
        headings.extend(shown.iter().map(heading));
        headings.extend(["slip events", "sliding distance mm"].map(str::to_owned));
        let row = |own: &Summary| {
            let ends = |[low, high]: [f64; 2]| format!("{low:.2} to {high:.2}");
            let place = self.axes().map(|axis| {
                let name = axis_name(self.in_plan, axis);
                let ends = ends([own.ends, own.depth][axis]);
                name.map_or_else(|| ends.clone(), |name| format!("{name} {ends}"))
            });
            let place = place.collect::<Vec<_>>().join(", ");
            let value = |quantity: &Quantity| match own.peak(*quantity).value {
                safety if quantity.limit().is_some() => factor(safety),
                value => number(printed(quantity).0 * value),
            };
            let mut cells = vec![place];
            cells.extend(shown.iter().map(value));
            cells.extend([own.sliding.events.len().to_string(), number(1e3 * own.sliding.path)]);
            cells
        };
        Table { heading: headings, repeated: 1, rows: self.foundations.iter().map(row).collect() }
    }

    fn safety(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let known = |own: &Quantity| own.limit().is_some() && !self.whole.peak(*own).value.is_nan();
        for quantity in Quantity::recorded(self.in_plan).filter(known) {
            let peak = self.whole.peak(quantity);
            let (name, least) = (quantity.name(), factor(peak.value));
            write!(f, "Least {name}: {least} at {:.3} s", peak.time)?;
            match quantity {
                Quantity::OverturningSafety => writeln!(f, ", over the left or the right edge")?,
                Quantity::OverturningSafetyAcross => {
                    writeln!(f, ", over the front or the back edge")?;
                }
                _ => writeln!(f)?,
            }
        }
        let near = self.axes().map(|axis| self.lever(axis)).fold(1.0, f64::min);
        if near < ENOUGH {
            writeln!(
                f,
                "  pressure acts in the middle of elements, {near:.2} of the half width from the middle of the base at \
                 most:\n  a base on its edge has a factor of {:.2}, not 1 (1.07 or less with 16 elements a side)",
                1.0 / near
            )?;
        }
        Ok(())
    }

    /// Distance from the middle of a foundation to the middles of its outermost elements, over half its
    /// width.
    ///
    /// Along an axis; the smallest of all foundations and both sides.
    fn lever(&self, axis: usize) -> f64 {
        let of = |own: &Summary| {
            let ends = [own.ends, own.depth][axis];
            let elements = self.envelope.get(own.elements.clone()).unwrap_or_default();
            let of_element = |own: &ElementEnvelope| own.element.center()[axis];
            let ([first, last], center) = (span(elements.iter().map(of_element)), middle(ends));
            (center - first).min(last - center) / (0.5 * (ends[1] - ends[0]))
        };
        self.foundations.iter().map(of).fold(f64::INFINITY, f64::min)
    }

    fn uplift_and_sliding(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (uplift, uplifted) = (&self.whole.uplift, self.whole.uplifted_fraction.highest);
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
        let sliding = &self.whole.sliding;
        writeln!(f, "Sliding")?;
        for axis in self.axes() {
            let mean = [&self.whole.mean_slip, &self.whole.mean_slip_across][axis].largest();
            let end = [self.whole.residual_slip, self.whole.residual_slip_across][axis];
            let name = ["mean slip", "mean slip across"][axis];
            let [value, end] = [mean.value, end].map(|slip| number(1e3 * slip));
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

    fn pressures(&self) -> Table {
        let axes: Vec<usize> = self.axes().chain(self.has_walls().then_some(2)).collect();
        let places = axes.iter().map(|&axis| ["x, m", "y, m", "z, m"][axis]);
        let numbers = ["static kPa", "least kPa", "largest kPa", "at s", "open s"];
        let heading: Vec<_> = places.chain(numbers).map(str::to_owned).collect();
        let every = self.envelope.len().div_ceil(MOST_ROWS).max(1);
        let last = self.envelope.len().saturating_sub(1);
        let row = |envelope: &ElementEnvelope| {
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
        };
        // The line with the largest pressure is always printed.
        let place = |k: &usize| self.envelope[*k].pressure.highest.value;
        let largest = (0..self.envelope.len()).max_by(|a, b| place(a).total_cmp(&place(b)));
        let kept = |k: &usize| k.is_multiple_of(every) || *k == last || Some(*k) == largest;
        let shown = self.envelope.iter().enumerate().filter(|(k, _)| kept(k));
        let repeated = heading.len() - 5;
        Table { heading, repeated, rows: shown.map(|(_, envelope)| row(envelope)).collect() }
    }

    fn effort(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (steps, wall) = (self.steps.max(1) as f64, self.wall.as_secs_f64());
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
        if self.energy_balance.is_left_out() {
            return write!(f, "\n{}", self.energy_balance);
        }
        let (input, unit) = (1e-3 * self.energy_balance.input, of_body("kJ/m", self.in_plan));
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
