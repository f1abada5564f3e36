//! Time series, envelopes and spectra as CSV.

use super::{Quantity, Run, TimeSeries};
use crate::coupled::{EnergyTerm, Probe};
use crate::motion::SpectralOrdinate;
use crate::text::column::{Cell, column, distinct, line};
use crate::text::csv::Csv;

/// A heading and lines of numbers, after the texts that begin them.
fn lines<N: IntoIterator<Item = f64>>(
    heading: &str,
    rows: impl IntoIterator<Item = (String, N)>,
) -> Csv {
    let mut text = format!("{heading}\n");
    for (start, numbers) in rows {
        text += &start;
        text += &line(numbers.into_iter().map(Cell));
    }
    Csv(text)
}

impl TimeSeries {
    /// Times, scalars, probes and the energy balance's input as CSV: a heading and a line for every kept step, by
    /// [the rule](super#columns-and-numbers-in-files).
    pub fn csv(&self) -> Csv {
        let mut columns = self.columns();
        columns.push(EnergyTerm::Input.column());
        let rows = self.energy_balances().iter().enumerate().map(|(k, energy_balance)| {
            let values = self.column_values().map(move |values| values[k]);
            (String::new(), values.chain([energy_balance.input]))
        });
        lines(&columns.join(","), rows)
    }

    /// [Contact frames](TimeSeries::contact_frames) as CSV in long form: a heading and a line for every frame and
    /// element, elements from 0 on with their ends.
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
    /// let mut histories = Recorder::new().contact(5).start(&simulation)?;
    /// simulation.run(10, |state| histories.record(state))?;
    /// let text = histories.contact_csv();
    /// let lines: Vec<_> = text.lines().collect();
    /// assert_eq!(lines[0], "time_s,element,left_m,right_m,mode,gap_m,slip_m,pressure_pa,shear_pa");
    /// // Three frames of two elements.
    /// assert_eq!(lines.len(), 1 + 3 * 2);
    /// assert!(lines[2].starts_with("0.0,1,0.0,2.0,stick,"));
    /// # Ok::<(), basemat::Error>(())
    /// ```
    pub fn contact_csv(&self) -> Csv {
        let rows = self.contact_frames().flat_map(|frame| {
            let contact = frame.states.iter().zip(frame.modes).zip(self.elements()).enumerate();
            contact.map(move |(e, ((state, mode), element))| {
                let [time, left, right] = [frame.time, element.left, element.right].map(Cell);
                let start = format!("{time},{e},{left},{right},{mode},");
                (start, [state.gap, state.slip, state.pressure, state.shear])
            })
        });
        lines("time_s,element,left_m,right_m,mode,gap_m,slip_m,pressure_pa,shear_pa", rows)
    }
}

impl Run {
    /// [Envelopes](Run::envelope) as CSV: a heading and a line for every element, with the times of the extremes, by
    /// [the rule](super#columns-and-numbers-in-files).
    pub fn envelope_csv(&self) -> Csv {
        let rows = self.envelope.iter().enumerate().map(|(e, own)| {
            let mut numbers = vec![own.element.left, own.element.right, own.static_pressure];
            let peaks = [own.pressure.lowest, own.pressure.highest, own.shear, own.gap, own.slip];
            numbers.extend(peaks.iter().flat_map(|peak| [peak.value, peak.time]));
            numbers.push(own.open);
            (format!("{e},"), numbers)
        });
        lines(
            "element,left_m,right_m,static_pressure_pa,lowest_pressure_pa,lowest_pressure_time_s,\
             highest_pressure_pa,highest_pressure_time_s,shear_pa,shear_time_s,gap_m,gap_time_s,\
             slip_m,slip_time_s,open_s",
            rows,
        )
    }
}

/// Response spectrum, of a record or of a floor, as CSV: a heading and a line for every period, by
/// [the rule](crate::results#columns-and-numbers-in-files).
///
/// ```
/// use basemat::results::spectrum_csv;
/// let spectrum = basemat::motion::el_centro_1940().response_spectrum(&[0.5, 1.0], 0.05)?;
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

// The columns of histories, in CSV and in archives of arrays.

/// Elements and contact frames.
pub(super) const CONTACT: [&str; 9] = [
    "element_left_m",
    "element_right_m",
    "contact_time_s",
    "contact_gap_m",
    "contact_slip_m",
    "contact_pressure_pa",
    "contact_shear_pa",
    "contact_mode",
    "contact_mode_words",
];

/// Motion frames.
pub(super) const MOTION: [&str; 4] =
    ["motion_time_s", "motion_displacement", "motion_velocity", "motion_free_field_m"];

impl TimeSeries {
    /// Names of time, scalars and probes; those of probes differ from all others in any file.
    pub(super) fn columns(&self) -> Vec<String> {
        let mut columns = vec![column("time", "s")];
        columns.extend(Quantity::ALL.map(Quantity::column));
        let others = CONTACT.iter().chain(&MOTION).map(|&name| name.to_owned());
        let others = EnergyTerm::ALL.map(EnergyTerm::column).into_iter().chain(others);
        let taken: Vec<String> = columns.iter().cloned().chain(others).collect();
        columns.extend(distinct(&taken, self.probes.iter().map(Probe::column)));
        columns
    }

    /// Their values.
    pub(super) fn column_values(&self) -> impl Iterator<Item = &[f64]> {
        let scalars = Quantity::ALL.iter().map(|&quantity| self.series(quantity));
        let probes = self.probe_values.iter().map(Vec::as_slice);
        std::iter::once(self.times()).chain(scalars).chain(probes)
    }
}
