//! Time series, envelopes and spectra as CSV.

use std::fmt::Write;

use super::columns::{ContactNumber, contact_numbers};
use super::{ContactFrame, ElementEnvelope, Run, TimeSeries};
use crate::coupled::EnergyTerm;
use crate::motion::SpectralOrdinate;
use crate::text::column::{NumberCell, cell_line, column};
use crate::text::csv::Csv;

/// Joins a heading and lines; each line has a text, followed by numbers.
pub(super) fn csv_lines<N: IntoIterator<Item = f64>>(
    heading: &str,
    rows: impl IntoIterator<Item = (String, N)>,
) -> Csv {
    let mut text = format!("{heading}\n");
    for (line_start, numbers) in rows {
        text += &line_start;
        text += &cell_line(numbers.into_iter().map(NumberCell));
    }
    Csv(text)
}

impl TimeSeries {
    /// Times, scalars, probes and the energy balance's input as CSV.
    ///
    /// The text has a heading and a line for every kept step, by [the rule](super#columns-and-numbers-in-files).
    pub fn csv(&self) -> Csv {
        let mut columns = self.columns();
        columns.push(EnergyTerm::Input.column(self.in_plan()));
        let rows = self.energy_balances().iter().enumerate().map(|(k, energy_balance)| {
            let values = self.column_values().map(move |values| values[k]);
            (String::new(), values.chain([energy_balance.input]))
        });
        csv_lines(&columns.join(","), rows)
    }

    /// [Contact frames](TimeSeries::contact_frames) as CSV in long form.
    ///
    /// The text has a heading and a line for every frame and element. Elements count from 0, and each line has the ends
    /// of its element.
    ///
    /// ```
    /// # use basemat::bem::SpringGround;
    /// # use basemat::interface::Coulomb;
    /// # use basemat::results::Recorder;
    /// # use basemat::structure::RigidBlock;
    /// # let mut simulation = basemat::Simulation::builder(0.01)
    /// #     .structure(RigidBlock::new(4.0, 6.0, 2000.0)?)
    /// #     .ground(SpringGround::new(-2.0..2.0, 2, 2e7, 1e7)?)
    /// #     .interface(Coulomb::new(0.4)?)
    /// #     .motion(basemat::motion::AtRest)
    /// #     .build()?;
    /// let mut time_series = Recorder::new().contact(5).start(&simulation)?;
    /// simulation.run(10, |state| time_series.record(state))?;
    /// let text = time_series.contact_csv();
    /// let lines: Vec<_> = text.lines().collect();
    /// assert_eq!(lines[0], "time_s,element,left_m,right_m,mode,gap_m,slip_m,pressure_pa,shear_pa");
    /// // Three frames of two elements.
    /// assert_eq!(lines.len(), 1 + 3 * 2);
    /// assert!(lines[2].starts_with("0.0,1,0.0,2.0,stick,"));
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// In plan the line continues with front and back ends, and ends with slip and shear along y. With walls it
    /// continues with the heights of both ends, `bottom_m` and `top_m`.
    pub fn contact_csv(&self) -> Csv {
        let numbers = contact_numbers(self.in_plan());
        contact_csv(&self.base_ends(), &numbers, self.contact_frames())
    }
}

/// Frames of elements with these ends as CSV in long form, with these numbers of each element.
pub(super) fn contact_csv<'a>(
    ends: &[(&'static str, Vec<f64>)],
    numbers: &[(String, ContactNumber)],
    frames: impl Iterator<Item = ContactFrame<'a>>,
) -> Csv {
    let mut heading = vec!["time_s", "element"];
    heading.extend(ends.iter().map(|(name, _)| *name));
    heading.push("mode");
    heading.extend(numbers.iter().map(|(name, _)| name.as_str()));
    let mut text = format!("{}\n", heading.join(","));
    for frame in frames {
        for (element, (state, mode)) in frame.states.iter().zip(frame.modes).enumerate() {
            let end_cells: Vec<_> = ends
                .iter()
                .map(|(_, coordinates)| NumberCell(coordinates[element]).to_string())
                .collect();
            let time = NumberCell(frame.time);
            let _ = write!(text, "{time},{element},{},{mode},", end_cells.join(","));
            text += &cell_line(numbers.iter().map(|(_, value)| NumberCell(value(state))));
        }
    }
    Csv(text)
}

/// Column of an envelope.
type EnvelopeColumn = (&'static str, &'static str, fn(&Run) -> bool, fn(&ElementEnvelope) -> f64);

/// Condition of a column that all runs have.
const IN_ALL_RUNS: fn(&Run) -> bool = |_| true;
/// Condition of a column that runs in plan have.
const IN_PLAN_RUNS: fn(&Run) -> bool = |run| run.in_plan;
/// Condition of a column that runs of a base with walls have.
const IN_RUNS_WITH_WALLS: fn(&Run) -> bool = Run::has_walls;

impl Run {
    /// Columns of an [envelope](Run::envelope): word, SI unit, whether a run has it, value.
    pub const ENVELOPE_COLUMNS: [EnvelopeColumn; 22] = [
        ("left", "m", IN_ALL_RUNS, |element| element.element.left()),
        ("right", "m", IN_ALL_RUNS, |element| element.element.right()),
        ("front", "m", IN_PLAN_RUNS, |element| element.element.depth()[0]),
        ("back", "m", IN_PLAN_RUNS, |element| element.element.depth()[1]),
        ("bottom", "m", IN_RUNS_WITH_WALLS, |element| element.element.heights()[0]),
        ("top", "m", IN_RUNS_WITH_WALLS, |element| element.element.heights()[1]),
        ("static_pressure", "Pa", IN_ALL_RUNS, |element| element.static_pressure),
        ("lowest_pressure", "Pa", IN_ALL_RUNS, |element| element.pressure.lowest.value),
        ("lowest_pressure_time", "s", IN_ALL_RUNS, |element| element.pressure.lowest.time),
        ("highest_pressure", "Pa", IN_ALL_RUNS, |element| element.pressure.highest.value),
        ("highest_pressure_time", "s", IN_ALL_RUNS, |element| element.pressure.highest.time),
        ("shear", "Pa", IN_ALL_RUNS, |element| element.shear.value),
        ("shear_time", "s", IN_ALL_RUNS, |element| element.shear.time),
        ("gap", "m", IN_ALL_RUNS, |element| element.gap.value),
        ("gap_time", "s", IN_ALL_RUNS, |element| element.gap.time),
        ("slip", "m", IN_ALL_RUNS, |element| element.slip.value),
        ("slip_time", "s", IN_ALL_RUNS, |element| element.slip.time),
        ("open", "s", IN_ALL_RUNS, |element| element.open),
        ("shear_across", "Pa", IN_PLAN_RUNS, |element| element.shear_across.value),
        ("shear_across_time", "s", IN_PLAN_RUNS, |element| element.shear_across.time),
        ("slip_across", "m", IN_PLAN_RUNS, |element| element.slip_across.value),
        ("slip_across_time", "s", IN_PLAN_RUNS, |element| element.slip_across.time),
    ];

    /// [Envelopes](Run::envelope) as CSV, with the times of the extremes.
    ///
    /// The text has a heading and a line for every element, by [the rule](super#columns-and-numbers-in-files).
    pub fn envelope_csv(&self) -> Csv {
        let columns: Vec<_> = Self::ENVELOPE_COLUMNS
            .iter()
            .filter(|(_, _, is_in_run, _)| is_in_run(self))
            .collect();
        let mut heading = vec!["element".to_owned()];
        heading.extend(columns.iter().map(|(word, unit, ..)| column(word, unit)));
        let rows = self.envelope.iter().enumerate().map(|(element_index, element)| {
            let values = columns.iter().map(move |(.., value)| value(element));
            (format!("{element_index},"), values)
        });
        csv_lines(&heading.join(","), rows)
    }
}

/// Response spectrum of a record or of a floor as CSV.
///
/// The text has a heading and a line for every period, by [the rule](crate::results#columns-and-numbers-in-files).
///
/// ```
/// use basemat::results::spectrum_csv;
/// let spectrum = basemat::motion::el_centro_1940().response_spectrum(&[0.5, 1.0], 0.05, &mut basemat::unobserved)?;
/// let text = spectrum_csv(&spectrum);
/// let heading = "period_s,displacement_m,pseudo_velocity_m_per_s,pseudo_acceleration_m_per_s2,\
///                acceleration_m_per_s2";
/// assert_eq!(text.lines().next(), Some(heading));
/// let first: Vec<f64> = text.lines().nth(1).unwrap().split(',').map(|c| c.parse().unwrap()).collect();
/// assert_eq!((first[0], first[3]), (0.5, spectrum[0].pseudo_acceleration));
/// # Ok::<(), basemat::Error>(())
/// ```
pub fn spectrum_csv(spectrum: &[SpectralOrdinate]) -> Csv {
    let rows = spectrum.iter().map(|ordinate| {
        let numbers = [
            ordinate.period,
            ordinate.displacement,
            ordinate.pseudo_velocity,
            ordinate.pseudo_acceleration,
            ordinate.acceleration,
        ];
        (String::new(), numbers)
    });
    csv_lines(
        "period_s,displacement_m,pseudo_velocity_m_per_s,pseudo_acceleration_m_per_s2,\
         acceleration_m_per_s2",
        rows,
    )
}

former_constants! {
    Run { ENVELOPE: [EnvelopeColumn; 22] = ENVELOPE_COLUMNS, "use `ENVELOPE_COLUMNS`"; }
}
