//! Time series as an archive of NumPy arrays.
//!
//! An NPZ file is a ZIP archive of files `name.npy`: a magic number, the length of the header, a Python
//! dictionary of type, order and shape, blanks up to a multiple of 64 bytes, and the numbers (NumPy
//! Enhancement Proposal 1, version 1.0).

use std::io::{self, Cursor, Write};
use std::path::Path;

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::columns::{CONTACT_COLUMNS, MOTION_COLUMNS, contact_numbers, element_ends};
use super::{ContactFrame, TimeSeries};
use crate::coupled::EnergyTerm;
use crate::error::Result;
use crate::interface::Mode;
use crate::text::file::{write_error, write_file};

/// The archive under construction.
struct Archive(ZipWriter<Cursor<Vec<u8>>>);

/// Largest length of the name of an array, bytes: an archive has 16 bits for it.
const MAX_NAME_BYTES: usize = 60_000;
/// NumPy pads headers to a multiple of this, bytes.
const HEADER_ALIGNMENT: usize = 64;
/// Bytes of magic number, version and length before the header, and of the line end after it.
const HEADER_EXTRA_BYTES: usize = 11;
/// Margin below the size from which an entry needs 64-bit lengths, bytes.
const LARGE_FILE_MARGIN: usize = 1024;

impl Archive {
    /// Adds an array of NumPy's type `data_type`, its numbers row by row.
    fn add_array(
        &mut self,
        name: &str,
        data_type: &str,
        shape: &[usize],
        bytes: &[u8],
    ) -> io::Result<()> {
        if name.len() > MAX_NAME_BYTES {
            return Err(io::ErrorKind::InvalidInput.into());
        }
        let axis_lengths: Vec<String> = shape.iter().map(usize::to_string).collect();
        let last_comma = if shape.len() == 1 { "," } else { "" };
        let shape_text = format!("({}{last_comma})", axis_lengths.join(", "));
        let mut header =
            format!("{{'descr': '{data_type}', 'fortran_order': False, 'shape': {shape_text}, }}");
        let unpadded_length = header.len() + HEADER_EXTRA_BYTES;
        let padding_length = unpadded_length.next_multiple_of(HEADER_ALIGNMENT) - unpadded_length;
        header += &" ".repeat(padding_length);
        header.push('\n');
        let header_length = u16::try_from(header.len()).map_err(io::Error::other)?;
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Stored)
            .large_file(bytes.len() >= u32::MAX as usize - LARGE_FILE_MARGIN);
        self.0.start_file(format!("{name}.npy"), options)?;
        self.0.write_all(b"\x93NUMPY\x01\x00")?;
        self.0.write_all(&header_length.to_le_bytes())?;
        self.0.write_all(header.as_bytes())?;
        self.0.write_all(bytes)
    }

    /// Adds an array of numbers, row by row.
    fn add_numbers(
        &mut self,
        name: &str,
        shape: &[usize],
        numbers: impl Iterator<Item = f64>,
    ) -> io::Result<()> {
        let bytes: Vec<u8> = numbers.flat_map(f64::to_le_bytes).collect();
        self.add_array(name, "<f8", shape, &bytes)
    }

    /// Adds the ends of elements; names begin with `prefix`.
    fn add_ends(&mut self, prefix: &str, ends: Vec<(&str, Vec<f64>)>) -> io::Result<()> {
        for (name, values) in ends {
            let name = format!("{prefix}element_{name}");
            self.add_numbers(&name, &[values.len()], values.into_iter())?;
        }
        Ok(())
    }

    /// Adds numbers and modes of each element in these frames; names begin with `prefix`.
    fn add_frames(
        &mut self,
        prefix: &str,
        element_count: usize,
        in_plan: bool,
        frames: &[ContactFrame<'_>],
    ) -> io::Result<()> {
        let shape = [frames.len(), element_count];
        for (name, value) in contact_numbers(in_plan) {
            let numbers = frames.iter().flat_map(|frame| frame.states.iter().map(value));
            self.add_numbers(&format!("{prefix}contact_{name}"), &shape, numbers)?;
        }
        let modes = frames.iter().flat_map(|frame| frame.modes);
        let mode_codes: Vec<u8> = modes.map(|mode| *mode as u8).collect();
        let [_, mode_name, _] = CONTACT_COLUMNS;
        self.add_array(&format!("{prefix}{mode_name}"), "|u1", &shape, &mode_codes)
    }

    /// Adds a list of texts, with four bytes for each character, padded to the longest text.
    fn add_words(&mut self, name: &str, words: &[String]) -> io::Result<()> {
        let max_characters = words.iter().map(|word| word.chars().count()).max().unwrap_or(0);
        let mut bytes = Vec::new();
        for word in words {
            let padding = std::iter::repeat('\0');
            for character in word.chars().chain(padding).take(max_characters) {
                bytes.extend(u32::from(character).to_le_bytes());
            }
        }
        self.add_array(name, &format!("<U{max_characters}"), &[words.len()], &bytes)
    }
}

impl TimeSeries {
    /// Writes the archive of [`TimeSeries::write_npz`] to a file; creates its folder if necessary.
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File) if the file cannot be written.
    pub fn save_npz(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        let mut bytes = Vec::new();
        self.write_npz(&mut bytes).map_err(write_error(path))?;
        write_file(path, bytes)
    }

    /// Writes all time series and frames as an archive of NumPy arrays.
    ///
    /// In Python: `numpy.load("run.npz")["base_shear_n_per_m"]`. Feature `npz`. Arrays are not compressed.
    ///
    /// | arrays | shape | |
    /// |---|---|---|
    /// | `time_s`; scalars and probes, called as [in CSV](TimeSeries::csv) | kept steps | |
    /// | `foundation_0_settlement_m` …, the scalars of each foundation | kept steps | with [`Recorder::foundations`](super::Recorder::foundations) |
    /// | `kinetic_energy_j_per_m` … `input_energy_j_per_m`, `soil_error_bound_j_per_m` | kept steps | terms of the [energy balance](crate::coupled::EnergyBalance); in plan `_j` |
    /// | `element_left_m`, `element_right_m`; in plan `element_front_m`, `element_back_m` | elements | ends of the contact elements |
    /// | with walls `element_bottom_m`, `element_top_m` | elements | their heights |
    /// | `contact_time_s` | frames | with [`Recorder::contact`](super::Recorder::contact) |
    /// | `contact_gap_m`, `contact_slip_m`, `contact_pressure_pa`, `contact_shear_pa` | frames × elements | |
    /// | in plan `contact_slip_across_m`, `contact_shear_across_pa` | frames × elements | along y |
    /// | `contact_mode`, integers | frames × elements | indices into `contact_mode_words` |
    /// | `contact_mode_words` | modes | texts |
    /// | `joint_0_normal_force_n_per_m` …, the scalars of each joint | kept steps | |
    /// | `joint_0_element_left_m`, `joint_0_contact_gap_m` …, of each joint as of the base | elements, frames × elements | |
    /// | `motion_time_s` | frames | with [`Recorder::motion`](super::Recorder::motion) |
    /// | `motion_displacement`, `motion_velocity` | frames × degrees of freedom | as in [`MotionFrame`](super::MotionFrame) |
    /// | `motion_free_field_m` | frames × 2 | to the right, up |
    /// | in plan `motion_free_field_across_m` | frames | along y |
    ///
    /// # Errors
    /// Errors of `out`, and invalid input for a probe whose name is longer than 60 000 bytes.
    pub fn write_npz(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut archive = Archive(ZipWriter::new(Cursor::new(Vec::new())));
        let step_count = self.times().len();
        for (name, values) in self.columns().iter().zip(self.column_values()) {
            archive.add_numbers(name, &[step_count], values.iter().copied())?;
        }
        for term in EnergyTerm::ALL_TERMS {
            let values =
                self.energy_balances().iter().map(|energy_balance| energy_balance.term(term));
            archive.add_numbers(&term.column(self.in_plan()), &[step_count], values)?;
        }
        self.add_contact(&mut archive)?;
        self.add_joints(&mut archive)?;
        self.add_motion(&mut archive)?;
        out.write_all(archive.0.finish()?.get_ref())
    }

    fn add_contact(&self, archive: &mut Archive) -> io::Result<()> {
        archive.add_ends("", self.base_ends())?;
        if self.recorder.contact.is_none() {
            return Ok(());
        }
        let [time_name, _, words_name] = CONTACT_COLUMNS;
        let frames: Vec<_> = self.contact_frames().collect();
        archive.add_numbers(time_name, &[frames.len()], frames.iter().map(|frame| frame.time))?;
        archive.add_frames("", self.elements().len(), self.in_plan(), &frames)?;
        archive.add_words(words_name, &Mode::ALL.map(|mode| mode.to_string()))
    }

    fn add_joints(&self, archive: &mut Archive) -> io::Result<()> {
        for (joint, elements) in self.joint_elements().iter().enumerate() {
            let prefix = format!("joint_{joint}_");
            archive.add_ends(&prefix, element_ends(elements, true))?;
            if self.recorder.contact.is_some() {
                let frames = self.joint_frames(joint).map_err(io::Error::other)?;
                let frames: Vec<_> = frames.collect();
                archive.add_frames(&prefix, elements.len(), self.in_plan(), &frames)?;
            }
        }
        Ok(())
    }

    fn add_motion(&self, archive: &mut Archive) -> io::Result<()> {
        if self.recorder.motion.is_none() {
            return Ok(());
        }
        let [time_name, displacement_name, velocity_name, free_field_name, free_field_across_name] =
            MOTION_COLUMNS;
        let frame_count = self.motion_frames().count();
        let dof_count = self.motion_frames().next().map_or(0, |frame| frame.displacement.len());
        let times = self.motion_frames().map(|frame| frame.time);
        archive.add_numbers(time_name, &[frame_count], times)?;
        let values = self.motion_frames().flat_map(|frame| frame.displacement.iter().copied());
        archive.add_numbers(displacement_name, &[frame_count, dof_count], values)?;
        let values = self.motion_frames().flat_map(|frame| frame.velocity.iter().copied());
        archive.add_numbers(velocity_name, &[frame_count, dof_count], values)?;
        let values = self.motion_frames().flat_map(|frame| frame.free_field);
        archive.add_numbers(free_field_name, &[frame_count, 2], values)?;
        if self.in_plan() {
            let values = self.motion_frames().map(|frame| frame.free_field_across);
            archive.add_numbers(free_field_across_name, &[frame_count], values)?;
        }
        Ok(())
    }
}
