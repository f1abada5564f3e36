//! GOAL: an archive of time series has arrays that NumPy reads.
//! SCENE: the block of `results` with contact and motion frames, and without.
//! REFERENCE: the numbers themselves; `tests/data/read_npz.py` compares what is saved here with
//! NumPy's own reader.

use std::collections::BTreeMap;
use std::io::{Cursor, Read};
use std::path::Path;

use basemat::bem::ContactElement;
use basemat::coupled::{EnergyBalance, EnergyTerm, Probe, State};
use basemat::interface::ContactState;
use basemat::results::{Quantity, Recorder, TimeSeries};
use basemat::structure::RigidBlock;
use basemat_problems::faults::is_unwritable;

use super::{FRICTION_COEFFICIENT, Recorded, STEP_COUNT, recorded};
use basemat_problems::scenes::{SI_UNITS, block, friction, scene};

/// The text of a header after `from` and before `to`.
fn between(header: &str, from: &str, to: char) -> String {
    let rest = header.split_once(from).unwrap().1;
    rest.split_once(to).unwrap().0.to_owned()
}

/// A text of NumPy: four bytes a letter, zeros at its end.
fn decoded(bytes: &[u8]) -> String {
    bytes
        .chunks(4)
        .map(|b| char::from_u32(u32::from_le_bytes(b.try_into().unwrap())).unwrap())
        .take_while(|letter| *letter != '\0')
        .collect()
}

/// Type, shape and bytes of an array.
struct NumpyArray {
    kind: String,
    shape: Vec<usize>,
    bytes: Vec<u8>,
}

impl NumpyArray {
    fn read(file: &[u8]) -> Self {
        assert_eq!(&file[..8], b"\x93NUMPY\x01\x00");
        let length = usize::from(u16::from_le_bytes([file[8], file[9]]));
        assert!((10 + length).is_multiple_of(64) && file[9 + length] == b'\n');
        let header = std::str::from_utf8(&file[10..10 + length]).unwrap();
        assert!(header.contains("'fortran_order': False"));
        let shape = between(header, "'shape': (", ')');
        let lengths = shape.split(',').map(str::trim).filter(|length| !length.is_empty());
        let shape = lengths.map(|length| length.parse().unwrap()).collect();
        let kind = between(header, "'descr': '", '\'');
        Self { kind, shape, bytes: file[10 + length..].to_vec() }
    }

    fn numbers(&self) -> Vec<f64> {
        assert_eq!(self.kind, "<f8");
        let numbers: Vec<f64> =
            self.bytes.chunks(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect();
        assert_eq!(numbers.len(), self.shape.iter().product::<usize>());
        numbers
    }

    fn words(&self) -> Vec<String> {
        let letter_count: usize = self.kind.strip_prefix("<U").unwrap().parse().unwrap();
        self.bytes.chunks(4 * letter_count).map(decoded).collect()
    }
}

fn arrays(time_series: &TimeSeries) -> BTreeMap<String, NumpyArray> {
    let mut bytes = Vec::new();
    time_series.write_npz(&mut bytes).unwrap();
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
    let mut arrays = BTreeMap::new();
    for place in 0..archive.len() {
        let mut file = archive.by_index(place).unwrap();
        assert_eq!(file.compression(), zip::CompressionMethod::Stored);
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).unwrap();
        arrays
            .insert(file.name().strip_suffix(".npy").unwrap().to_owned(), NumpyArray::read(&bytes));
    }
    arrays
}

/// Arrays of an archive, and the series they were made of.
struct SavedArchive {
    arrays: BTreeMap<String, NumpyArray>,
    time_series: TimeSeries,
}

impl SavedArchive {
    fn assert_holds(&self, name: &str, shape: &[usize], numbers: &[f64]) {
        let array = &self.arrays[name];
        assert_eq!(array.shape, shape, "{name}");
        assert_eq!(bits(&array.numbers()), bits(numbers), "{name}");
    }

    fn assert_holds_energy(&self, name: &str, energy: fn(&EnergyBalance) -> f64) {
        let balances = self.time_series.energy_balances();
        let numbers: Vec<f64> = balances.iter().map(energy).collect();
        self.assert_holds(name, &[numbers.len()], &numbers);
    }
}

/// A quantity of all elements in all frames.
fn contact_values(frames: &[&State], value: fn(&ContactState) -> f64) -> Vec<f64> {
    frames.iter().flat_map(|state| state.contact.iter().map(value)).collect()
}

fn bits(numbers: &[f64]) -> Vec<u64> {
    numbers.iter().map(|number| number.to_bits()).collect()
}

#[test]
fn arrays_have_the_recorded_values() {
    let recorder = Recorder::new().every(2).contact(5).motion(8);
    let Recorded { time_series, states, .. } = recorded(recorder);
    let archive = SavedArchive { arrays: arrays(&time_series), time_series };
    let time_series = &archive.time_series;
    let recorded_count = STEP_COUNT / 2 + 1;
    archive.assert_holds("time_s", &[recorded_count], time_series.times());
    for quantity in Quantity::recorded(false) {
        archive.assert_holds(
            &quantity.column(false),
            &[recorded_count],
            time_series.series(quantity),
        );
    }
    archive.assert_holds("top_m", &[recorded_count], time_series.probe("top").unwrap());
    let acceleration = time_series.probe("top acceleration").unwrap();
    archive.assert_holds("top_acceleration_m_per_s2", &[recorded_count], acceleration);
    assert_eq!(time_series.energy_balances().len(), recorded_count);
    archive.assert_holds_energy("kinetic_energy_j_per_m", |l| l.kinetic);
    archive.assert_holds_energy("strain_energy_j_per_m", |l| l.strain);
    archive.assert_holds_energy("hysteresis_energy_j_per_m", |l| l.hysteresis);
    archive.assert_holds_energy("damping_energy_j_per_m", |l| l.damping);
    archive.assert_holds_energy("algorithmic_energy_j_per_m", |l| l.algorithmic);
    archive.assert_holds_energy("midstep_remainder_energy_j_per_m", |l| l.midstep_remainder);
    archive.assert_holds_energy("soil_energy_j_per_m", |l| l.soil);
    archive.assert_holds_energy("contact_energy_j_per_m", |l| l.contact);
    archive.assert_holds_energy("interface_energy_j_per_m", |l| l.interface);
    archive.assert_holds_energy("static_contact_energy_j_per_m", |l| l.static_contact);
    archive.assert_holds_energy("input_energy_j_per_m", |l| l.input);
    archive.assert_holds_energy("relative_input_energy_j_per_m", |l| l.relative_input);
    archive.assert_holds_energy("soil_error_bound_j_per_m", |l| l.soil_error_bound);

    let elements = time_series.elements();
    let count = elements.len();
    let edges: Vec<f64> = elements.iter().map(ContactElement::left).collect();
    archive.assert_holds("element_left_m", &[count], &edges);
    let edges: Vec<f64> = elements.iter().map(ContactElement::right).collect();
    archive.assert_holds("element_right_m", &[count], &edges);
    let frames: Vec<_> = states.iter().step_by(5).collect();
    let shape = [frames.len(), count];
    let times: Vec<f64> = frames.iter().map(|s| s.time).collect();
    archive.assert_holds("contact_time_s", &[frames.len()], &times);
    archive.assert_holds("contact_gap_m", &shape, &contact_values(&frames, |c| c.gap));
    archive.assert_holds("contact_slip_m", &shape, &contact_values(&frames, |c| c.slip));
    archive.assert_holds("contact_pressure_pa", &shape, &contact_values(&frames, |c| c.pressure));
    archive.assert_holds("contact_shear_pa", &shape, &contact_values(&frames, |c| c.shear));
    let arrays = &archive.arrays;
    let modes = &arrays["contact_mode"];
    let words = arrays["contact_mode_words"].words();
    assert_eq!((&modes.kind[..], &modes.shape[..]), ("|u1", &shape[..]));
    let computed: Vec<_> =
        modes.bytes.iter().map(|code| words[usize::from(*code)].clone()).collect();
    let expected: Vec<_> =
        frames.iter().flat_map(|s| s.modes.iter().map(ToString::to_string)).collect();
    assert_eq!(computed, expected);

    let frames: Vec<_> = states.iter().step_by(8).collect();
    let times: Vec<f64> = frames.iter().map(|s| s.time).collect();
    archive.assert_holds("motion_time_s", &[frames.len()], &times);
    let displacements: Vec<f64> = frames.iter().flat_map(|s| s.displacement().to_vec()).collect();
    archive.assert_holds("motion_displacement", &[frames.len(), 3], &displacements);
    let velocities: Vec<f64> = frames.iter().flat_map(|s| s.velocity().to_vec()).collect();
    archive.assert_holds("motion_velocity", &[frames.len(), 3], &velocities);
    let ground: Vec<f64> = frames.iter().flat_map(|s| s.free_field).collect();
    archive.assert_holds("motion_free_field_m", &[frames.len(), 2], &ground);
    assert_eq!(arrays.len(), 12 + 2 + EnergyTerm::ALL_TERMS.len() + 9 + 4);
}

/// Files for `tests/data/read_npz.py`.
#[test]
fn archives_are_saved_beside_their_tables() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("npz");
    let Recorded { time_series, .. } = recorded(Recorder::new().contact(4).motion(100));
    time_series.save_npz(folder.join("run.npz")).unwrap();
    time_series.csv().save(folder.join("run.csv")).unwrap();
    time_series.contact_csv().save(folder.join("contact.csv")).unwrap();
    let below = folder.join("run.npz/below_a_file.npz");
    assert!(is_unwritable(&time_series.save_npz(below)));
}

fn unitless_probe(name: &str) -> Probe {
    Probe::displacement(name, RigidBlock::HORIZONTAL_DOF).in_unit("")
}

#[test]
fn names_of_arrays_differ_and_frames_may_be_left_out() {
    let builder = scene(SI_UNITS, 0.6)
        .structure(block(SI_UNITS))
        .interface(friction(FRICTION_COEFFICIENT));
    let names = ["time s", "contact mode", "Größe", "kinetic energy J per m", "größe"];
    let simulation = builder.probes(names.map(unitless_probe)).build().unwrap();
    let arrays = arrays(&Recorder::new().start(&simulation).unwrap());
    for name in ["time_s_2", "contact_mode_2", "größe", "größe_2", "kinetic_energy_j_per_m_2"] {
        assert_eq!(arrays[name].shape, [1], "{name}");
    }
    for name in ["contact_time_s", "contact_mode", "motion_time_s"] {
        assert!(!arrays.contains_key(name));
    }
    // No name of a file is as long as this.
    let long_probe = unitless_probe(&"a".repeat(70_000));
    let builder = scene(SI_UNITS, 0.6)
        .structure(block(SI_UNITS))
        .interface(friction(FRICTION_COEFFICIENT));
    let time_series = Recorder::new().start(&builder.probe(long_probe).build().unwrap()).unwrap();
    assert!(time_series.write_npz(&mut Vec::new()).is_err());
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("npz_refused/long.npz");
    assert!(is_unwritable(&time_series.save_npz(&path)));
    assert!(!path.exists());
}
