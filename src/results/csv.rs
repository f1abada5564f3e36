//! Time series, envelopes and spectra as CSV.

use super::{ElementEnvelope, Run, TimeSeries};
use crate::coupled::EnergyTerm;
use crate::motion::SpectralOrdinate;
use crate::text::column::{NumberCell, cell_line, column};
use crate::text::csv::Csv;

/// A heading and lines: each begins with a text, then its numbers.
fn lines<N: IntoIterator<Item = f64>>(
    heading: &str,
    rows: impl IntoIterator<Item = (String, N)>,
) -> Csv {
    let mut text = format!("{heading}\n");
    for (start, numbers) in rows {
        text += &start;
        text += &cell_line(numbers.into_iter().map(NumberCell));
    }
    Csv(text)
}

impl TimeSeries {
    /// Times, scalars, probes and the energy balance's input as CSV.
    ///
    /// A heading and a line for every kept step, by [the rule](super#columns-and-numbers-in-files).
    pub fn csv(&self) -> Csv {
        let mut columns = self.columns();
        columns.push(EnergyTerm::Input.column(self.in_plan()));
        let rows = self.energy_balances().iter().enumerate().map(|(k, energy_balance)| {
            let values = self.column_values().map(move |values| values[k]);
            (String::new(), values.chain([energy_balance.input]))
        });
        lines(&columns.join(","), rows)
    }

    /// [Contact frames](TimeSeries::contact_frames) as CSV in long form.
    ///
    /// A heading and a line for every frame and element; elements count from 0 and are given with their ends.
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
        let (ends, numbers) = (self.element_ends(), self.contact_numbers());
        let names = ends.iter().map(|(name, _)| *name).chain(["mode"]);
        let names = names.chain(numbers.iter().map(|(name, _)| name.as_str()));
        let heading: Vec<_> = ["time_s", "element"].into_iter().chain(names).collect();
        let rows = self.contact_frames().flat_map(|frame| {
            let contact = frame.states.iter().zip(frame.modes).enumerate();
            let (ends, numbers) = (&ends, &numbers);
            contact.map(move |(e, (state, mode))| {
                let places: Vec<_> =
                    ends.iter().map(|(_, of)| NumberCell(of[e]).to_string()).collect();
                let start = format!("{},{e},{},{mode},", NumberCell(frame.time), places.join(","));
                (start, numbers.iter().map(move |(_, value)| value(state)))
            })
        });
        lines(&heading.join(","), rows)
    }
}

/// Column of an envelope.
type EnvelopeColumn = (&'static str, &'static str, fn(&Run) -> bool, fn(&ElementEnvelope) -> f64);

const ALWAYS: fn(&Run) -> bool = |_| true;
const IN_PLAN: fn(&Run) -> bool = |run| run.in_plan;
const WITH_WALLS: fn(&Run) -> bool = Run::has_walls;

impl Run {
    /// Columns of an [envelope](Run::envelope): word, SI unit, whether a run has it, value.
    pub const ENVELOPE: [EnvelopeColumn; 22] = [
        ("left", "m", ALWAYS, |own| own.element.left()),
        ("right", "m", ALWAYS, |own| own.element.right()),
        ("front", "m", IN_PLAN, |own| own.element.depth()[0]),
        ("back", "m", IN_PLAN, |own| own.element.depth()[1]),
        ("bottom", "m", WITH_WALLS, |own| own.element.heights()[0]),
        ("top", "m", WITH_WALLS, |own| own.element.heights()[1]),
        ("static_pressure", "Pa", ALWAYS, |own| own.static_pressure),
        ("lowest_pressure", "Pa", ALWAYS, |own| own.pressure.lowest.value),
        ("lowest_pressure_time", "s", ALWAYS, |own| own.pressure.lowest.time),
        ("highest_pressure", "Pa", ALWAYS, |own| own.pressure.highest.value),
        ("highest_pressure_time", "s", ALWAYS, |own| own.pressure.highest.time),
        ("shear", "Pa", ALWAYS, |own| own.shear.value),
        ("shear_time", "s", ALWAYS, |own| own.shear.time),
        ("gap", "m", ALWAYS, |own| own.gap.value),
        ("gap_time", "s", ALWAYS, |own| own.gap.time),
        ("slip", "m", ALWAYS, |own| own.slip.value),
        ("slip_time", "s", ALWAYS, |own| own.slip.time),
        ("open", "s", ALWAYS, |own| own.open),
        ("shear_across", "Pa", IN_PLAN, |own| own.shear_across.value),
        ("shear_across_time", "s", IN_PLAN, |own| own.shear_across.time),
        ("slip_across", "m", IN_PLAN, |own| own.slip_across.value),
        ("slip_across_time", "s", IN_PLAN, |own| own.slip_across.time),
    ];

    /// [Envelopes](Run::envelope) as CSV, with the times of the extremes.
    ///
    /// A heading and a line for every element, by [the rule](super#columns-and-numbers-in-files).
    pub fn envelope_csv(&self) -> Csv {
        let columns: Vec<_> = Self::ENVELOPE.iter().filter(|own| own.2(self)).collect();
        let names = columns.iter().map(|(word, unit, ..)| column(word, unit));
        let heading: Vec<_> = std::iter::once("element".to_owned()).chain(names).collect();
        let rows = self.envelope.iter().enumerate().map(|(e, own)| {
            let columns = &columns;
            (format!("{e},"), columns.iter().map(move |(.., value)| value(own)))
        });
        lines(&heading.join(","), rows)
    }
}

/// Response spectrum of a record or of a floor as CSV.
///
/// A heading and a line for every period, by [the rule](crate::results#columns-and-numbers-in-files).
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
    let rows = spectrum.iter().map(|own| {
        let responses =
            [own.displacement, own.pseudo_velocity, own.pseudo_acceleration, own.acceleration];
        (String::new(), [own.period].into_iter().chain(responses))
    });
    lines(
        "period_s,displacement_m,pseudo_velocity_m_per_s,pseudo_acceleration_m_per_s2,\
         acceleration_m_per_s2",
        rows,
    )
}
