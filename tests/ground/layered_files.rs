//! GOAL: weights from a file are the computed ones, or there is an error.
//! SCENE: files of the same kernel, of other kernels and of older formats; foreign, cut, extended and damaged files.
//! REFERENCE: the kernel without a file, to the last bit; the format of the file.

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

/// A file of one test, removed at its end.
pub(super) struct TemporaryFile {
    pub(super) path: PathBuf,
}

impl TemporaryFile {
    pub(super) fn new(name: &str) -> Self {
        let name = format!("basemat-{}-{name}.kernel", std::process::id());
        Self { path: std::env::temp_dir().join(name) }
    }

    fn read(&self) -> Vec<u8> {
        std::fs::read(&self.path).unwrap()
    }

    fn write(&self, content: impl AsRef<[u8]>) {
        std::fs::write(&self.path, content).unwrap();
    }
}

impl Drop for TemporaryFile {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.path);
    }
}

fn strip() -> Strip {
    Strip::uniform(-1.0..1.0, 2).unwrap()
}

/// Ground of the strip on this profile.
fn ground_on(profile: SoilProfile) -> ElasticGround {
    two_stages(profile, &strip())
}

/// Ground of the strip on a damped layer.
fn ground() -> ElasticGround {
    ground_on(p1(gmb(5), gmb(1)))
}

const TIME_STEP: f64 = 0.2;

/// Lags of the compared weights: two blocks of the file.
const COMPARED_LAGS: usize = 200;

/// Bits of all weights after a preparation for them.
fn weight_bits(ground: &ElasticGround, time_step: f64) -> Result<Vec<u64>, Error> {
    let kernel = ground.weights(time_step)?;
    kernel.prepare(COMPARED_LAGS, &mut unobserved)?;
    let mut bits = vec![];
    for class in 0..kernel.classes().count() {
        let mut weights = [[0.0; COMPARED_LAGS]; 3];
        kernel.coefficients(class, 1, &mut weights.each_mut().map(|list| &mut list[..]))?;
        bits.extend(weights.iter().flatten().map(|value| value.to_bits()));
    }
    Ok(bits)
}

/// Bits of the weights of `ground()` with this file.
fn bits_with_file(path: &Path) -> Result<Vec<u64>, Error> {
    weight_bits(&ground().with_kernel_file(path), TIME_STEP)
}

/// Bits of the displacements due to earlier tractions, over a run with an arbitrary pattern of tractions.
pub(super) fn march(
    ground: &mut dyn Ground,
    time_step: f64,
    steps: usize,
) -> Result<Vec<u64>, Error> {
    ground.prepare(time_step, Some(steps), &mut unobserved)?;
    let size = ground.elements().iter().map(|element| element.directions().len()).sum();
    let mut displacement = vec![0.0; size];
    let mut bits = vec![];
    for step in 0..steps {
        ground.history(&mut displacement)?;
        bits.extend(displacement.iter().map(|value| value.to_bits()));
        let traction: Vec<f64> =
            (0..size).map(|n| ((7 * n + 3 * step) % 11) as f64 - 5.0).collect();
        ground.commit(&traction);
    }
    Ok(bits)
}

/// Bits of a march of a square of `cells` by `cells`, with or without a file.
fn march_in_plan(
    profile: &SoilProfile,
    cells: usize,
    file: Option<&TemporaryFile>,
) -> Result<Vec<u64>, Error> {
    let plan = Plan::rectangle(-1.0..1.0, -1.0..1.0, cells).unwrap();
    let mut ground = ElasticGround::in_plan(profile.clone(), plan).unwrap();
    if let Some(file) = file {
        ground = ground.with_kernel_file(&file.path);
    }
    march(&mut ground, 0.2, COMPARED_LAGS)
}

/// GOAL: weights of a ground in plan are the same from a file; other cells replace it.
#[test]
fn files_in_plan_reproduce_weights_to_the_last_bit() {
    let half_space = SoilProfile::on_half_plane(Soil::new(1.0, 0.3, 1.0).unwrap());
    for profile in [half_space, p1(gmb(5), gmb(1))] {
        let file = TemporaryFile::new("plan");
        let expected = march_in_plan(&profile, 3, None).unwrap();
        assert!(march_in_plan(&profile, 3, Some(&file)).unwrap() == expected);
        let written = file.read();
        // Six classes of six kinds, two blocks of lags, and six words around them.
        assert_eq!(written.len(), 8 * (6 * 6 * 256 + 6));
        assert!(march_in_plan(&profile, 3, Some(&file)).unwrap() == expected);
        assert!(file.read() == written);
        // A file with one wrong bit is an error; one with other numbers and their check sum is accepted.
        file.write(rewritten(&written, false, |words| words[300] ^= 1 << 40));
        assert!(is_damaged(&fault(march_in_plan(&profile, 3, Some(&file)))));
        file.write(rewritten(&written, true, |words| words[300] ^= 1 << 40));
        assert!(march_in_plan(&profile, 3, Some(&file)).unwrap() != expected);
        // Other cells replace it.
        march_in_plan(&profile, 2, Some(&file)).unwrap();
        assert_ne!(file.read().len(), written.len());
        assert!(march_in_plan(&profile, 3, Some(&file)).unwrap() == expected);
        assert!(file.read() == written);
    }
}

fn fault(outcome: Result<Vec<u64>, Error>) -> FileFault {
    match outcome {
        Err(Error::File(error)) => error.fault,
        other => panic!("{other:?}"),
    }
}

fn is_damaged(fault: &FileFault) -> bool {
    *fault == FileFault::Damaged { quantity: "file".into() }
}

/// The words of a file after a change, with or without a corrected check sum.
fn rewritten(original: &[u8], corrects_sum: bool, change: impl Fn(&mut [u64])) -> Vec<u8> {
    let mut words: Vec<u64> =
        original.as_chunks().0.iter().map(|word| u64::from_le_bytes(*word)).collect();
    change(&mut words);
    if corrects_sum {
        let last_index = words.len() - 1;
        words[last_index] =
            words[..last_index].iter().fold(0xcbf2_9ce4_8422_2325, |hash: u64, word| {
                (hash ^ word).wrapping_mul(0x0000_0100_0000_01b3).rotate_left(23)
            });
    }
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// Prepares `ground()` with this file for some lags.
fn prepare_with_file(path: &Path, lags: usize) {
    let kernel = ground().with_kernel_file(path).weights(TIME_STEP).unwrap();
    kernel.prepare(lags, &mut unobserved).unwrap();
}

/// GOAL: weights from a file have the same bits, and the file is used, extended and never shortened.
#[test]
fn a_file_gives_the_same_bits_and_is_used() {
    let file = TemporaryFile::new("same");
    let expected = weight_bits(&ground(), TIME_STEP).unwrap();
    assert_eq!(bits_with_file(&file.path).unwrap(), expected);
    let original = file.read();
    let classes = ground().weights(TIME_STEP).unwrap().classes().count();
    assert_eq!(original.len(), 8 * (classes * 3 * 256 + 6));
    assert_eq!(bits_with_file(&file.path).unwrap(), expected);
    assert_eq!(file.read(), original);
    // A number and the check sum are changed: the result shows that the file is read.
    file.write(rewritten(&original, true, |words| words[5] = 2.5_f64.to_bits()));
    let computed = bits_with_file(&file.path).unwrap();
    assert_eq!((computed[0], &computed[1..]), (2.5_f64.to_bits(), &expected[1..]));
    // A shorter file is extended, a longer one kept.
    std::fs::remove_file(&file.path).unwrap();
    prepare_with_file(&file.path, 1);
    let short_file = file.read();
    assert_eq!(bits_with_file(&file.path).unwrap(), expected);
    assert_eq!(file.read(), original);
    prepare_with_file(&file.path, 1);
    assert_eq!(file.read(), original);
    assert!(short_file.len() < original.len());
}

/// Relaxation law without a description, known by its modulus only.
#[derive(Debug)]
struct UndescribedLaw(f64);

impl Relaxation for UndescribedLaw {
    fn modulus(&self, s: Complex) -> Complex {
        Complex::real(1.0) + s * self.0 / (s + Complex::real(2.0))
    }
}

/// GOAL: the file of a kernel with any other weight is replaced.
#[test]
fn files_of_other_kernels_are_replaced() {
    let file = TemporaryFile::new("other");
    let longer_strip = Strip::uniform(-1.0..1.1, 2).unwrap();
    let kernels: [(&dyn Fn() -> ElasticGround, f64); 9] = [
        (&ground, TIME_STEP),
        (&|| ground_on(p1(gmb(5), gmb(5))), TIME_STEP),
        (&|| ground_on(p3(gmb(5))), TIME_STEP),
        (&|| ground_on(p3(UndescribedLaw(0.1))), TIME_STEP),
        (&|| ground_on(p3(UndescribedLaw(0.100_000_000_001))), TIME_STEP),
        (&ground, 0.200_000_01),
        (&|| two_stages(p1(gmb(5), gmb(1)), &longer_strip), TIME_STEP),
        (&|| ground().with_stages(Stages::Three), TIME_STEP),
        (&|| ground().with_tolerance(2e-10).unwrap(), TIME_STEP),
    ];
    let mut different_files = std::collections::HashSet::new();
    for (ground, time_step) in kernels {
        let expected = weight_bits(&ground(), time_step).unwrap();
        let with_file = || weight_bits(&ground().with_kernel_file(&file.path), time_step).unwrap();
        assert_eq!(with_file(), expected);
        let written = file.read();
        assert_eq!(with_file(), expected);
        assert!(file.read() == written);
        assert!(different_files.insert(written));
    }
    // An older or newer format, or rule of sampling.
    let original = file.read();
    for format in [0, 1, 3, u64::MAX] {
        file.write(rewritten(&original, true, |words| words[1] = format));
        weight_bits(&kernels[8].0().with_kernel_file(&file.path), TIME_STEP).unwrap();
        assert_eq!(file.read(), original);
    }
}

/// GOAL: files that are no kernels cause an error and are not overwritten.
#[test]
fn foreign_files_are_errors_and_kept() {
    let file = TemporaryFile::new("foreign");
    for text in ["", "x", "BASEMAT", "basematk and more of it", &"0,1,2\n".repeat(1000)] {
        file.write(text);
        let fault = fault(bits_with_file(&file.path));
        assert!(
            matches!(&fault, FileFault::Format { needed, .. } if needed.contains("not overwritten")),
            "{text:.20}: {fault}"
        );
        assert_eq!(file.read(), text.as_bytes());
    }
    let folder = std::env::temp_dir();
    assert!(matches!(fault(bits_with_file(&folder)), FileFault::Unreadable(_)));
    // The path names a file where a folder is needed.
    let result = bits_with_file(&file.path.join("below.kernel"));
    assert!(result.is_err(), "{result:?}");
    // No file can have that name.
    assert!(matches!(fault(bits_with_file(Path::new(""))), FileFault::Unwritable(_)));
    let text = bits_with_file(&folder).unwrap_err().to_string();
    assert!(text.contains(&folder.display().to_string()), "{text}");
}

/// GOAL: files of the wrong length, with numbers that are not finite, or with wrong bits are errors.
#[test]
fn damaged_files_are_errors() {
    let file = TemporaryFile::new("damaged");
    let expected = bits_with_file(&file.path).unwrap();
    let original = file.read();
    for length in [8, 12, 16, 39, 40, 47, 48, 1000, original.len() - 8, original.len() - 1] {
        file.write(&original[..length]);
        assert!(is_value(&fault(bits_with_file(&file.path)), "number of bytes"), "{length}");
        assert_eq!(file.read(), &original[..length]);
    }
    file.write([&original[..], &[0; 8]].concat());
    assert!(is_value(&fault(bits_with_file(&file.path)), "number of bytes"));
    // More blocks than there can be, with the right check sum.
    for blocks in [0, 1, 3, 25, 26, u64::MAX] {
        file.write(rewritten(&original, true, |words| words[4] = blocks));
        assert!(is_value(&fault(bits_with_file(&file.path)), "number of bytes"), "{blocks}");
    }
    for value in [f64::NAN, f64::INFINITY] {
        file.write(rewritten(&original, true, |words| words[77] = value.to_bits()));
        assert!(is_damaged(&fault(bits_with_file(&file.path))));
    }
    // Two neighbours exchanged.
    file.write(rewritten(&original, false, |words| words.swap(20, 21)));
    assert!(is_damaged(&fault(bits_with_file(&file.path))));
    // One wrong bit is an error; in format, fingerprint or number of classes it makes the file another kernel's. Some bytes
    // of the file are tested, and all bytes of its head.
    let interval = if heavy() { 311 } else { 1511 };
    for byte in (0..original.len()).step_by(interval).chain(0..48) {
        for bit in [0, 7] {
            let mut bytes = original.clone();
            bytes[byte] ^= 1 << bit;
            file.write(&bytes);
            match bits_with_file(&file.path) {
                Err(Error::File(_)) => {}
                outcome => {
                    assert!((8..32).contains(&byte), "byte {byte}");
                    assert_eq!(outcome.unwrap(), expected, "byte {byte}");
                }
            }
        }
    }
}

fn soil_of_speed(speed: f64) -> Soil {
    Soil::from_shear_wave_speed(speed, 0.33, 1900.0).unwrap()
}

/// Bits of a run of a block that uplifts and slides.
fn run_bits(kernels: &SharedKernels, path: Option<&Path>) -> Vec<u64> {
    let profile = SoilProfile::on_half_plane(soil_of_speed(500.0));
    let profile = profile.with_layer(soil_of_speed(150.0), 6.0).unwrap();
    let block = RigidBlock::new(6.0, 9.0, 2000.0).unwrap();
    let ground = ElasticGround::under(profile, &block, 4).unwrap().with_shared_kernels(kernels);
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
}

/// GOAL: a run has the same bits without a file, writing it, and reading it; and with shared kernels.
#[test]
fn runs_from_a_file_are_the_same_to_the_last_bit() {
    let file = TemporaryFile::new("run");
    let kernels = SharedKernels::default();
    let expected = run_bits(&kernels, None);
    assert_eq!(kernels.count(), 1);
    assert_eq!(run_bits(&kernels, Some(&file.path)), expected);
    assert!(file.path.exists() && kernels.count() == 2);
    // A damaged file stops a ground that has to read it, and no other.
    file.write("damaged");
    assert_eq!(run_bits(&kernels, Some(&file.path)), expected);
    let ground = ElasticGround::new(p3(gmb(5)), Strip::uniform(-1.0..1.0, 2).unwrap()).unwrap();
    let mut ground = ground.with_kernel_file(&file.path);
    let error = ground.prepare(0.2, None, &mut unobserved).unwrap_err();
    assert!(matches!(error, Error::File(_)), "{error}");
}
