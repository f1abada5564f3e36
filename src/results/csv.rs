//! Time series, envelopes and spectra as CSV.

use std::io;
use std::io::Write;
use std::path::Path;

use super::{Quantity, Run, TimeSeries};
use crate::coupled::{EnergyTerm, Probe};
use crate::error::{Result, write_file};
use crate::motion::SpectralOrdinate;
use crate::text::column::{Cell, column, distinct, line};

/// Text that `write` makes, in a file.
fn save(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    let mut text = Vec::new();
    // Writing to memory cannot fail.
    let _ = write(&mut text);
    write_file(path, text)
}

impl TimeSeries {
    /// Writes the CSV of [`TimeSeries::write_csv`] to a file; its folder is made if it is not there.
    ///
    /// # Errors
    /// [`Error::Write`](crate::Error::Write) if that fails.
    pub fn save_csv(&self, path: impl AsRef<Path>) -> Result<()> {
        save(path.as_ref(), |out| self.write_csv(out))
    }

    /// Writes times, scalars, probes and the energy balance's input as CSV: a heading and a line for every
    /// kept step, by [the rule](super#columns-and-numbers-in-files).
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut columns = self.columns();
        columns.push(EnergyTerm::Input.column());
        out.write_all(line(columns).as_bytes())?;
        for (k, energy_balance) in self.energy_balances().iter().enumerate() {
            let numbers =
                self.column_values().map(|values| values[k]).chain([energy_balance.input]);
            out.write_all(line(numbers.map(Cell)).as_bytes())?;
        }
        Ok(())
    }

    /// Writes the CSV of [`TimeSeries::write_contact_csv`] to a file; its folder is made if it is not
    /// there.
    ///
    /// # Errors
    /// [`Error::Write`](crate::Error::Write) if that fails.
    pub fn save_contact_csv(&self, path: impl AsRef<Path>) -> Result<()> {
        save(path.as_ref(), |out| self.write_contact_csv(out))
    }

    /// Writes the [contact frames](TimeSeries::contact_frames) as CSV in long form: a heading and a
    /// line for every frame and element, elements from 0 on with their ends.
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
    /// let mut text = Vec::new();
    /// histories.write_contact_csv(&mut text).unwrap();
    /// let text = String::from_utf8(text).unwrap();
    /// let lines: Vec<_> = text.lines().collect();
    /// assert_eq!(lines[0], "time_s,element,left_m,right_m,mode,gap_m,slip_m,pressure_pa,shear_pa");
    /// // Three frames of two elements.
    /// assert_eq!(lines.len(), 1 + 3 * 2);
    /// assert!(lines[2].starts_with("0.0,1,0.0,2.0,stick,"));
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_contact_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "time_s,element,left_m,right_m,mode,gap_m,slip_m,pressure_pa,shear_pa")?;
        for frame in self.contact_frames() {
            let contact = frame.states.iter().zip(frame.modes).zip(self.elements()).enumerate();
            for (e, ((state, mode), element)) in contact {
                let ends = [element.left, element.right].map(Cell);
                let values = [state.gap, state.slip, state.pressure, state.shear].map(Cell);
                write!(out, "{},{e},{},{},{mode},", Cell(frame.time), ends[0], ends[1])?;
                out.write_all(line(values).as_bytes())?;
            }
        }
        Ok(())
    }
}

impl Run {
    /// Writes the CSV of [`Run::write_envelope_csv`] to a file; its folder is made if it is not there.
    ///
    /// # Errors
    /// [`Error::Write`](crate::Error::Write) if that fails.
    pub fn save_envelope_csv(&self, path: impl AsRef<Path>) -> Result<()> {
        save(path.as_ref(), |out| self.write_envelope_csv(out))
    }

    /// Writes the [envelopes](Run::envelope) as CSV: a heading and a line for every element, with the
    /// times of the extremes, by [the rule](super#columns-and-numbers-in-files).
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_envelope_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(
            out,
            "element,left_m,right_m,static_pressure_pa,lowest_pressure_pa,lowest_pressure_time_s,\
             highest_pressure_pa,highest_pressure_time_s,shear_pa,shear_time_s,gap_m,gap_time_s,\
             slip_m,slip_time_s,open_s"
        )?;
        for (e, own) in self.envelope.iter().enumerate() {
            let mut numbers = vec![own.element.left, own.element.right, own.static_pressure];
            let peaks = [own.pressure.lowest, own.pressure.highest, own.shear, own.gap, own.slip];
            numbers.extend(peaks.iter().flat_map(|peak| [peak.value, peak.time]));
            numbers.push(own.open);
            write!(out, "{e},")?;
            out.write_all(line(numbers.into_iter().map(Cell)).as_bytes())?;
        }
        Ok(())
    }
}

/// Writes the CSV of [`write_spectrum_csv`] to a file; its folder is made if it is not there.
///
/// # Errors
/// [`Error::Write`](crate::Error::Write) if that fails.
pub fn save_spectrum_csv(path: impl AsRef<Path>, spectrum: &[SpectralOrdinate]) -> Result<()> {
    save(path.as_ref(), |out| write_spectrum_csv(out, spectrum))
}

/// Writes a response spectrum, of a record or of a floor, as CSV: a heading and a line for every
/// period, by [the rule](crate::results#columns-and-numbers-in-files).
///
/// ```
/// use basemat::results::write_spectrum_csv;
/// let spectrum = basemat::motion::el_centro_1940().response_spectrum(&[0.5, 1.0], 0.05)?;
/// let mut text = Vec::new();
/// write_spectrum_csv(&mut text, &spectrum).unwrap();
/// let text = String::from_utf8(text).unwrap();
/// let heading = "period_s,displacement_m,pseudo_velocity_m_per_s,pseudo_acceleration_m_per_s2,\
///                acceleration_m_per_s2";
/// assert_eq!(text.lines().next(), Some(heading));
/// let first: Vec<f64> = text.lines().nth(1).unwrap().split(',').map(|c| c.parse().unwrap()).collect();
/// assert_eq!((first[0], first[3]), (0.5, spectrum[0].pseudo_acceleration));
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// Those of `out`.
pub fn write_spectrum_csv(out: &mut dyn Write, spectrum: &[SpectralOrdinate]) -> io::Result<()> {
    writeln!(
        out,
        "period_s,displacement_m,pseudo_velocity_m_per_s,pseudo_acceleration_m_per_s2,\
         acceleration_m_per_s2"
    )?;
    for own in spectrum {
        let numbers = [
            own.period,
            own.displacement,
            own.pseudo_velocity,
            own.pseudo_acceleration,
            own.acceleration,
        ];
        out.write_all(line(numbers.map(Cell)).as_bytes())?;
    }
    Ok(())
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
