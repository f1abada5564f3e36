//! GOAL: histories as an archive of arrays that NumPy reads.
//! SCENE: the block of `main` with contact and motion frames, and without.
//! REFERENCE: the numbers themselves; `tests/data/read_npz.py` compares what is saved here with
//! NumPy's own reader.

use std::collections::BTreeMap;
use std::io::{Cursor, Read};
use std::path::Path;

use basemat::bem::ContactElement;
use basemat::coupled::{EnergyTerm, Probe};
use basemat::results::{Quantity, Recorder, TimeSeries};
use basemat::structure::RigidBlock;
use basemat_problems::faults::is_unwritable;

use super::{FRICTION, Recorded, STEPS, recorded};
use basemat_problems::scenes::{SI, block, friction, scene};

/// Type, shape and bytes of an array.
struct Array {
    kind: String,
    shape: Vec<usize>,
    bytes: Vec<u8>,
}

impl Array {
    fn read(file: &[u8]) -> Self {
        assert_eq!(&file[..8], b"\x93NUMPY\x01\x00");
        let length = usize::from(u16::from_le_bytes([file[8], file[9]]));
        assert!((10 + length).is_multiple_of(64) && file[9 + length] == b'\n');
        let header = std::str::from_utf8(&file[10..10 + length]).unwrap();
        let between = |from: &str, to: char| {
            let rest = header.split_once(from).unwrap().1;
            rest.split_once(to).unwrap().0.to_owned()
        };
        assert!(header.contains("'fortran_order': False"));
        let shape = between("'shape': (", ')');
        let lengths = shape.split(',').map(str::trim).filter(|length| !length.is_empty());
        let shape = lengths.map(|length| length.parse().unwrap()).collect();
        Self { kind: between("'descr': '", '\''), shape, bytes: file[10 + length..].to_vec() }
    }

    fn numbers(&self) -> Vec<f64> {
        assert_eq!(self.kind, "<f8");
        let numbers: Vec<f64> =
            self.bytes.chunks(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect();
        assert_eq!(numbers.len(), self.shape.iter().product::<usize>());
        numbers
    }

    fn words(&self) -> Vec<String> {
        let longest: usize = self.kind.strip_prefix("<U").unwrap().parse().unwrap();
        let letter = |b: &[u8]| char::from_u32(u32::from_le_bytes(b.try_into().unwrap())).unwrap();
        let word = |bytes: &[u8]| -> String {
            bytes.chunks(4).map(letter).take_while(|letter| *letter != '\0').collect()
        };
        self.bytes.chunks(4 * longest).map(word).collect()
    }
}

fn arrays(time_series: &TimeSeries) -> BTreeMap<String, Array> {
    let mut bytes = Vec::new();
    time_series.write_npz(&mut bytes).unwrap();
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
    let count = archive.len();
    let read = |place| {
        let mut file = archive.by_index(place).unwrap();
        assert_eq!(file.compression(), zip::CompressionMethod::Stored);
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).unwrap();
        (file.name().strip_suffix(".npy").unwrap().to_owned(), Array::read(&bytes))
    };
    (0..count).map(read).collect()
}

fn bits(numbers: &[f64]) -> Vec<u64> {
    numbers.iter().map(|number| number.to_bits()).collect()
}

#[test]
fn arrays_are_what_was_kept() {
    let recorder = Recorder::new().every(2).contact(5).motion(8);
    let Recorded { time_series, states, .. } = recorded(recorder);
    let arrays = arrays(&time_series);
    let same = |name: &str, shape: &[usize], numbers: &[f64]| {
        let array = &arrays[name];
        assert_eq!(array.shape, shape, "{name}");
        assert_eq!(bits(&array.numbers()), bits(numbers), "{name}");
    };
    let kept = STEPS / 2 + 1;
    same("time_s", &[kept], time_series.times());
    for quantity in Quantity::recorded(false) {
        same(&quantity.column(false), &[kept], time_series.series(quantity));
    }
    same("top_m", &[kept], time_series.probe("top").unwrap());
    same("top_acceleration_m_per_s2", &[kept], time_series.probe("top acceleration").unwrap());
    let energy_balance = |of: fn(&basemat::coupled::EnergyBalance) -> f64| -> Vec<f64> {
        time_series.energy_balances().iter().map(of).collect()
    };
    same("kinetic_energy_j_per_m", &[kept], &energy_balance(|l| l.kinetic));
    same("strain_energy_j_per_m", &[kept], &energy_balance(|l| l.strain));
    same("hysteresis_energy_j_per_m", &[kept], &energy_balance(|l| l.hysteresis));
    same("damping_energy_j_per_m", &[kept], &energy_balance(|l| l.damping));
    same("algorithmic_energy_j_per_m", &[kept], &energy_balance(|l| l.algorithmic));
    same("soil_energy_j_per_m", &[kept], &energy_balance(|l| l.soil));
    same("contact_energy_j_per_m", &[kept], &energy_balance(|l| l.contact));
    same("interface_energy_j_per_m", &[kept], &energy_balance(|l| l.interface));
    same("static_contact_energy_j_per_m", &[kept], &energy_balance(|l| l.static_contact));
    same("input_energy_j_per_m", &[kept], &energy_balance(|l| l.input));
    same("relative_input_energy_j_per_m", &[kept], &energy_balance(|l| l.relative_input));
    same("soil_error_bound_j_per_m", &[kept], &energy_balance(|l| l.soil_error_bound));

    let elements = time_series.elements();
    let count = elements.len();
    same(
        "element_left_m",
        &[count],
        &elements.iter().map(ContactElement::left).collect::<Vec<_>>(),
    );
    same(
        "element_right_m",
        &[count],
        &elements.iter().map(ContactElement::right).collect::<Vec<_>>(),
    );
    let frames: Vec<_> = states.iter().step_by(5).collect();
    let shape = [frames.len(), count];
    let contact = |of: fn(&basemat::interface::ContactState) -> f64| -> Vec<f64> {
        frames.iter().flat_map(|state| state.contact.iter().map(of)).collect()
    };
    same("contact_time_s", &[frames.len()], &frames.iter().map(|s| s.time).collect::<Vec<_>>());
    same("contact_gap_m", &shape, &contact(|c| c.gap));
    same("contact_slip_m", &shape, &contact(|c| c.slip));
    same("contact_pressure_pa", &shape, &contact(|c| c.pressure));
    same("contact_shear_pa", &shape, &contact(|c| c.shear));
    let (modes, words) = (&arrays["contact_mode"], arrays["contact_mode_words"].words());
    assert_eq!((&modes.kind[..], &modes.shape[..]), ("|u1", &shape[..]));
    let found: Vec<_> = modes.bytes.iter().map(|code| words[usize::from(*code)].clone()).collect();
    let known: Vec<_> =
        frames.iter().flat_map(|s| s.modes.iter().map(ToString::to_string)).collect();
    assert_eq!(found, known);

    let frames: Vec<_> = states.iter().step_by(8).collect();
    same("motion_time_s", &[frames.len()], &frames.iter().map(|s| s.time).collect::<Vec<_>>());
    let displacements: Vec<f64> = frames.iter().flat_map(|s| s.displacement().to_vec()).collect();
    same("motion_displacement", &[frames.len(), 3], &displacements);
    let velocities: Vec<f64> = frames.iter().flat_map(|s| s.velocity().to_vec()).collect();
    same("motion_velocity", &[frames.len(), 3], &velocities);
    let ground: Vec<f64> = frames.iter().flat_map(|s| s.free_field).collect();
    same("motion_free_field_m", &[frames.len(), 2], &ground);
    assert_eq!(arrays.len(), 12 + 2 + EnergyTerm::ALL.len() + 9 + 4);
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

#[test]
fn names_of_arrays_differ_and_frames_may_be_left_out() {
    let probe = |name: &str| Probe::displacement(name, RigidBlock::HORIZONTAL).in_unit("");
    let builder = scene(SI, 0.6).structure(block(SI)).interface(friction(FRICTION));
    let names = ["time s", "contact mode", "Größe", "kinetic energy J per m", "größe"];
    let simulation = builder.probes(names.map(probe)).build().unwrap();
    let arrays = arrays(&Recorder::new().start(&simulation).unwrap());
    for name in ["time_s_2", "contact_mode_2", "größe", "größe_2", "kinetic_energy_j_per_m_2"] {
        assert_eq!(arrays[name].shape, [1], "{name}");
    }
    for name in ["contact_time_s", "contact_mode", "motion_time_s"] {
        assert!(!arrays.contains_key(name));
    }
    // No name of a file is as long as this.
    let long = probe(&"a".repeat(70_000));
    let builder = scene(SI, 0.6).structure(block(SI)).interface(friction(FRICTION));
    let time_series = Recorder::new().start(&builder.probe(long).build().unwrap()).unwrap();
    assert!(time_series.write_npz(&mut Vec::new()).is_err());
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("npz_refused/long.npz");
    assert!(is_unwritable(&time_series.save_npz(&path)));
    assert!(!path.exists());
}
