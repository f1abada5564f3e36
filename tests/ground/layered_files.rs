//! GOAL: coefficients from a file are those that were computed, or there is an error.
//! SCENE: files of the kernel, of others, of an older format, foreign, cut, extended, every word damaged.
//! REFERENCE: the kernel without a file, to the last bit; the file's own format.

use std::path::{Path, PathBuf};

use basemat::bem::layered::Stages;
use basemat::bem::plan::Plan;
use basemat::bem::{ElasticGround, Ground, SharedKernels, Strip};
use basemat::interface::Coulomb;
use basemat::motion::el_centro_1940;
use basemat::soil::{Relaxation, SoilProfile};
use basemat::structure::RigidBlock;
use basemat::{Complex, Error, FileFault, Simulation, Soil, unobserved};

use basemat_problems::faults::is_value;
use basemat_problems::heavy;
use basemat_problems::profiles::{gmb, p1, p3, two_stages};

/// A file of this test's own, removed at the end.
pub(super) struct Temporary(pub(super) PathBuf);

impl Temporary {
    pub(super) fn new(name: &str) -> Self {
        let name = format!("basemat-{}-{name}.kernel", std::process::id());
        Self(std::env::temp_dir().join(name))
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

fn strip() -> Strip {
    Strip::uniform(-1.0..1.0, 2).unwrap()
}

fn ground() -> ElasticGround {
    two_stages(p1(gmb(5), gmb(1)), &strip())
}

const TIME_STEP: f64 = 0.2;

const LAGS: usize = 200;

/// Bits of all coefficients after a preparation for them.
fn bits(ground: &ElasticGround, time_step: f64) -> Result<Vec<u64>, Error> {
    let kernel = ground.weights(time_step)?;
    kernel.prepare(LAGS, &mut unobserved)?;
    let mut bits = vec![];
    for class in 0..kernel.classes().count() {
        let mut lists = [[0.0; LAGS]; 3];
        let [zz, xx, zx] = &mut lists;
        kernel.coefficients(class, 1, &mut [zz, xx, zx])?;
        bits.extend(lists.iter().flatten().map(|value| value.to_bits()));
    }
    Ok(bits)
}

fn with(path: &Path) -> Result<Vec<u64>, Error> {
    bits(&ground().with_kernel_file(path), TIME_STEP)
}

/// Bits of the displacements by all earlier tractions, over `lags` steps of `time_step` under made-up tractions.
pub(super) fn march(
    ground: &mut dyn Ground,
    time_step: f64,
    lags: usize,
) -> Result<Vec<u64>, Error> {
    ground.prepare(time_step, Some(lags), &mut unobserved)?;
    let size = ground.elements().iter().map(|element| element.directions().len()).sum();
    let (mut field, mut bits) = (vec![0.0; size], vec![]);
    for step in 0..lags {
        ground.history(&mut field)?;
        bits.extend(field.iter().map(|value| value.to_bits()));
        let traction = |n: usize| ((7 * n + 3 * step) % 11) as f64 - 5.0;
        ground.commit(&(0..size).map(traction).collect::<Vec<_>>());
    }
    Ok(bits)
}

/// Coefficients of a ground in plan: the same from a file, of which only its own cells take them.
#[test]
fn files_in_plan_are_taken_to_the_last_bit() {
    let half_space = SoilProfile::on_half_plane(Soil::new(1.0, 0.3, 1.0).unwrap());
    for profile in [half_space, p1(gmb(5), gmb(1))] {
        let file = Temporary::new("plan");
        let plan = |cells| Plan::rectangle(-1.0..1.0, -1.0..1.0, cells).unwrap();
        let alone = |plan| ElasticGround::in_plan(profile.clone(), plan).unwrap();
        let ground = |plan| alone(plan).with_kernel_file(&file.0);
        let march = |mut ground: ElasticGround| march(&mut ground, 0.2, LAGS);
        let wanted = march(alone(plan(3))).unwrap();
        assert!(march(ground(plan(3))).unwrap() == wanted);
        let written = std::fs::read(&file.0).unwrap();
        // Six classes of six kinds, two blocks of lags, and six words around them.
        assert_eq!(written.len(), 8 * (6 * 6 * 256 + 6));
        assert!(march(ground(plan(3))).unwrap() == wanted);
        assert!(std::fs::read(&file.0).unwrap() == written);
        // A file of which one bit is wrong is refused; one with other numbers and their checksum is believed.
        let forged = rewritten(&written, true, |words| words[300] ^= 1 << 40);
        std::fs::write(&file.0, rewritten(&written, false, |words| words[300] ^= 1 << 40)).unwrap();
        assert!(is_damaged(&fault(march(ground(plan(3))))));
        std::fs::write(&file.0, forged).unwrap();
        assert!(march(ground(plan(3))).unwrap() != wanted);
        // Other cells make it anew.
        march(ground(plan(2))).unwrap();
        assert_ne!(std::fs::read(&file.0).unwrap().len(), written.len());
        assert!(march(ground(plan(3))).unwrap() == wanted);
        assert!(std::fs::read(&file.0).unwrap() == written);
    }
}

fn fault(found: Result<Vec<u64>, Error>) -> FileFault {
    match found {
        Err(Error::File(error)) => error.fault,
        other => panic!("{other:?}"),
    }
}

fn is_damaged(fault: &FileFault) -> bool {
    *fault == FileFault::Damaged { quantity: "file".into() }
}

/// The words of a file after a change; with `checksum`, the check sum is corrected.
fn rewritten(original: &[u8], checksum: bool, change: impl Fn(&mut [u64])) -> Vec<u8> {
    let mut words: Vec<u64> =
        original.as_chunks().0.iter().map(|word| u64::from_le_bytes(*word)).collect();
    change(&mut words);
    if checksum {
        let last = words.len() - 1;
        words[last] = words[..last].iter().fold(0xcbf2_9ce4_8422_2325, |hash: u64, word| {
            (hash ^ word).wrapping_mul(0x0000_0100_0000_01b3).rotate_left(23)
        });
    }
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

#[test]
fn a_file_gives_the_same_bits_and_is_used() {
    let file = Temporary::new("same");
    let prepare = |lags: usize| {
        ground()
            .with_kernel_file(&file.0)
            .weights(TIME_STEP)
            .unwrap()
            .prepare(lags, &mut unobserved)
            .unwrap();
    };
    let wanted = bits(&ground(), TIME_STEP).unwrap();
    assert_eq!(with(&file.0).unwrap(), wanted);
    let original = std::fs::read(&file.0).unwrap();
    assert_eq!(
        original.len(),
        8 * (ground().weights(TIME_STEP).unwrap().classes().count() * 3 * 256 + 6)
    );
    assert_eq!(with(&file.0).unwrap(), wanted);
    assert_eq!(std::fs::read(&file.0).unwrap(), original);
    // A number changed with its checksum: it is the file that is read.
    std::fs::write(&file.0, rewritten(&original, true, |words| words[5] = 2.5_f64.to_bits()))
        .unwrap();
    let found = with(&file.0).unwrap();
    assert_eq!((found[0], &found[1..]), (2.5_f64.to_bits(), &wanted[1..]));
    // A shorter file is extended, a longer one kept.
    std::fs::remove_file(&file.0).unwrap();
    prepare(1);
    let short = std::fs::read(&file.0).unwrap();
    assert_eq!(with(&file.0).unwrap(), wanted);
    assert_eq!(std::fs::read(&file.0).unwrap(), original);
    prepare(1);
    assert_eq!(std::fs::read(&file.0).unwrap(), original);
    assert!(short.len() < original.len());
}

/// A law that says nothing about itself.
#[derive(Debug)]
struct Own(f64);

impl Relaxation for Own {
    fn modulus(&self, s: Complex) -> Complex {
        Complex::real(1.0) + s * self.0 / (s + Complex::real(2.0))
    }
}

/// Whatever changes a coefficient makes the file another kernel's: it is replaced.
#[test]
fn files_of_other_kernels_are_made_anew() {
    let file = Temporary::new("other");
    let make = |profile: SoilProfile| two_stages(profile, &strip());
    let longer = Strip::uniform(-1.0..1.1, 2).unwrap();
    let kernels: [(&dyn Fn() -> ElasticGround, f64); 9] = [
        (&ground, TIME_STEP),
        (&|| make(p1(gmb(5), gmb(5))), TIME_STEP),
        (&|| make(p3(gmb(5))), TIME_STEP),
        (&|| make(p3(Own(0.1))), TIME_STEP),
        (&|| make(p3(Own(0.100_000_000_001))), TIME_STEP),
        (&ground, 0.200_000_01),
        (&|| two_stages(p1(gmb(5), gmb(1)), &longer), TIME_STEP),
        (&|| ground().with_stages(Stages::Three), TIME_STEP),
        (&|| ground().with_tolerance(2e-10).unwrap(), TIME_STEP),
    ];
    let mut seen = std::collections::HashSet::new();
    for (make, time_step) in kernels {
        let wanted = bits(&make(), time_step).unwrap();
        assert_eq!(bits(&make().with_kernel_file(&file.0), time_step).unwrap(), wanted);
        let written = std::fs::read(&file.0).unwrap();
        assert_eq!(bits(&make().with_kernel_file(&file.0), time_step).unwrap(), wanted);
        assert!(std::fs::read(&file.0).unwrap() == written);
        assert!(seen.insert(written));
    }
    // An older or newer format, or rule of sampling.
    let original = std::fs::read(&file.0).unwrap();
    for format in [0, 1, 3, u64::MAX] {
        std::fs::write(&file.0, rewritten(&original, true, |words| words[1] = format)).unwrap();
        bits(&kernels[8].0().with_kernel_file(&file.0), TIME_STEP).unwrap();
        assert_eq!(std::fs::read(&file.0).unwrap(), original);
    }
}

#[test]
fn foreign_files_are_refused_and_kept() {
    let file = Temporary::new("foreign");
    for text in ["", "x", "BASEMAT", "basematk and more of it", &"0,1,2\n".repeat(1000)] {
        std::fs::write(&file.0, text).unwrap();
        let fault = fault(with(&file.0));
        assert!(
            matches!(&fault, FileFault::Format { needed, .. } if needed.contains("not written over")),
            "{text:.20}: {fault}"
        );
        assert_eq!(std::fs::read_to_string(&file.0).unwrap(), *text);
    }
    let folder = std::env::temp_dir();
    assert!(matches!(fault(with(&folder)), FileFault::Unreadable(_)));
    // A file where a folder must be.
    let found = with(&file.0.join("below.kernel"));
    assert!(found.is_err(), "{found:?}");
    // No file can have that name.
    assert!(matches!(fault(with(Path::new(""))), FileFault::Unwritable(_)));
    let text = with(&folder).unwrap_err().to_string();
    assert!(text.contains(&folder.display().to_string()), "{text}");
}

#[test]
fn damaged_files_are_refused() {
    let file = Temporary::new("damaged");
    let wanted = with(&file.0).unwrap();
    let original = std::fs::read(&file.0).unwrap();
    let put = |content: &[u8]| std::fs::write(&file.0, content).unwrap();
    for length in [8, 12, 16, 39, 40, 47, 48, 1000, original.len() - 8, original.len() - 1] {
        put(&original[..length]);
        assert!(is_value(&fault(with(&file.0)), "number of bytes"), "{length}");
        assert_eq!(std::fs::read(&file.0).unwrap(), &original[..length]);
    }
    put(&[&original[..], &[0; 8]].concat());
    assert!(is_value(&fault(with(&file.0)), "number of bytes"));
    // More blocks than there can be, with the right checksum.
    for blocks in [0, 1, 3, 25, 26, u64::MAX] {
        put(&rewritten(&original, true, |words| words[4] = blocks));
        assert!(is_value(&fault(with(&file.0)), "number of bytes"), "{blocks}");
    }
    for value in [f64::NAN, f64::INFINITY] {
        put(&rewritten(&original, true, |words| words[77] = value.to_bits()));
        assert!(is_damaged(&fault(with(&file.0))));
    }
    // Two neighbours exchanged.
    put(&rewritten(&original, false, |words| words.swap(20, 21)));
    assert!(is_damaged(&fault(with(&file.0))));
    let every = if heavy() { 311 } else { 1511 };
    // One bit anywhere: an error; in format, fingerprint or number of classes another kernel's file.
    for place in (0..original.len()).step_by(every).chain(0..48) {
        for bit in [0, 7] {
            let mut bytes = original.clone();
            bytes[place] ^= 1 << bit;
            put(&bytes);
            match with(&file.0) {
                Err(Error::File(_)) => {}
                found => {
                    assert!((8..32).contains(&place), "byte {place}");
                    assert_eq!(found.unwrap(), wanted, "byte {place}");
                }
            }
        }
    }
}

/// A run with uplift and sliding, without a file, making it, and from it; and shared.
#[test]
fn runs_from_a_file_are_the_same_to_the_last_bit() {
    let file = Temporary::new("run");
    let shared = SharedKernels::default();
    let run = |path: Option<&Path>| {
        let soil = |speed| Soil::from_shear_wave_speed(speed, 0.33, 1900.0).unwrap();
        let profile = SoilProfile::on_half_plane(soil(500.0)).with_layer(soil(150.0), 6.0).unwrap();
        let block = RigidBlock::new(6.0, 9.0, 2000.0).unwrap();
        let ground = ElasticGround::under(profile, &block, 4).unwrap().with_shared_kernels(&shared);
        let ground = match path {
            Some(path) => ground.with_kernel_file(path),
            None => ground,
        };
        let mut simulation = Simulation::builder(0.01)
            .ground(ground)
            .structure(block)
            .interface(Coulomb::new(0.3).unwrap())
            .motion(el_centro_1940())
            .build()
            .unwrap();
        let mut bits = vec![];
        simulation
            .run(300, |state| {
                bits.extend([state.base_shear.to_bits(), state.base_rotation.to_bits()]);
            })
            .unwrap();
        bits
    };
    let wanted = run(None);
    assert_eq!(shared.count(), 1);
    assert_eq!(run(Some(&file.0)), wanted);
    assert!(file.0.exists() && shared.count() == 2);
    // A damaged file stops a ground that has to read it, and no other.
    std::fs::write(&file.0, "damaged").unwrap();
    assert_eq!(run(Some(&file.0)), wanted);
    let ground = ElasticGround::new(p3(gmb(5)), Strip::uniform(-1.0..1.0, 2).unwrap()).unwrap();
    let mut ground = ground.with_kernel_file(&file.0);
    let found = ground.prepare(0.2, None, &mut unobserved).unwrap_err();
    assert!(matches!(found, Error::File(_)), "{found}");
}
