//! GOAL: incoherent motions have their coherence, keep the record where it is prescribed, and return errors for what is not defined.
//! SCENE: a pulse at cells of different sides, El Centro on a mat and on a strip.
//! REFERENCE: means of Luco and Wong's coherence by sums over many points, sample means over seeds, travelling waves.

use basemat::bem::plan::Plan;
use basemat::bem::{ContactElement, ElasticGround, Ground, Strip};
use basemat::interface::Bonded;
use basemat::motion::{
    AbrahamsonCoherence, Baseline, Coherence, CoherenceFn, FreeField, Incoherence, LucoWong,
    Record, TravellingWave, Triaxial, el_centro_1940, mean_coherence,
};
use basemat::structure::RigidBlock;
use basemat::{Complex, Error, Simulation, Soil};

/// α/c of the coherence, s/m, and the same as its two parameters.
const COHERENCE_SLOWNESS: f64 = 1.0e-3;
const COHERENCE_PARAMETER: f64 = 0.3;
const SHEAR_WAVE_SPEED: f64 = 300.0;

/// Four cells of different sides, not on a lattice.
fn cells() -> Vec<ContactElement> {
    vec![
        ContactElement::in_plan([0.0, 20.0], [0.0, 12.0]),
        ContactElement::in_plan([20.0, 26.0], [0.0, 12.0]),
        ContactElement::in_plan([-30.0, -20.0], [5.0, 45.0]),
        ContactElement::in_plan([40.0, 70.0], [-20.0, -10.0]),
    ]
}

/// Centre of a cell on the surface.
fn place_of(cell: &ContactElement) -> [f64; 2] {
    [cell.center()[0], cell.center()[1]]
}

/// Record whose velocity is a cycle of about 3 Hz, with quiet time around it.
fn pulse() -> Record {
    let displacement_scale = 0.02;
    Record::from_fn(0.01, 12.0, |t| {
        let x = (t - 6.0) / 0.05;
        displacement_scale * (4.0 * x.powi(4) - 12.0 * x * x + 3.0) * (-x * x).exp() / 0.0025
    })
    .unwrap()
}

/// Mean of the coherence over pairs of points of a fine grid in both cells.
fn fine_mean(frequency: f64, receiver: &ContactElement, source: &ContactElement) -> f64 {
    let points = |element: &ContactElement| {
        let mut points = vec![];
        for i in 0..24 {
            for j in 0..24 {
                let x = element.left() + element.length() * (f64::from(i) + 0.5) / 24.0;
                let y = element.depth()[0] + element.sides()[1] * (f64::from(j) + 0.5) / 24.0;
                points.push([x, y]);
            }
        }
        points
    };
    let receivers = points(receiver);
    let sources = points(source);
    let mut sum = 0.0;
    for [x, y] in &receivers {
        for [source_x, source_y] in &sources {
            let squared_distance = (x - source_x).powi(2) + (y - source_y).powi(2);
            let exponent = (std::f64::consts::TAU * frequency * COHERENCE_SLOWNESS).powi(2);
            sum += (-exponent * squared_distance).exp();
        }
    }
    sum / (receivers.len() * sources.len()) as f64
}

/// Means over cells by two Gauss points along each side: the error is (bl)⁴/180 with b = ωα/c and the side l = 40 m.
#[test]
fn mean_coherence_is_that_of_fine_grids() {
    let cells = cells();
    let coherence = LucoWong::new(COHERENCE_PARAMETER, SHEAR_WAVE_SPEED).unwrap();
    for (frequency, tolerance) in [(0.0, 1e-14), (1.0, 6e-5), (2.0, 6e-4), (4.0, 8e-3)] {
        let matrix = mean_coherence(&coherence, frequency, &cells).unwrap();
        for (i, receiver) in cells.iter().enumerate() {
            for (j, source) in cells.iter().enumerate() {
                let expected = fine_mean(frequency, receiver, source);
                let error = (matrix[4 * i + j] - expected).abs();
                assert!(error < tolerance, "{frequency} {i} {j}: {error:e} of {expected}");
            }
        }
    }
    // Classes of equal vectors give the matrix of all pairs.
    let plan = Plan::disc([1.0, 2.0], 20.0, 9).unwrap().elements();
    let as_function = CoherenceFn::new(move |frequency, first, second| {
        coherence.between(frequency, first, second)
    });
    let by_classes = mean_coherence(&coherence, 5.0, &plan).unwrap();
    let by_pairs = mean_coherence(&as_function, 5.0, &plan).unwrap();
    for (a, b) in by_classes.iter().zip(&by_pairs) {
        assert!((a - b).abs() < 1e-13, "{a} {b}");
    }
}

/// Fourier coefficient at a frequency of samples of a function of time.
fn coefficient(frequency: f64, mut sample: impl FnMut(f64) -> f64) -> Complex {
    let mut sum = Complex::real(0.0);
    for k in 0..1600 {
        let time = 0.01 * f64::from(k);
        let phase = Complex::polar(1.0, -std::f64::consts::TAU * frequency * time);
        sum += phase.scale(sample(time));
    }
    sum
}

/// Products of Fourier coefficients have the mean Γ over seeds, within four standard errors.
#[test]
fn sample_coherence_is_the_coherence() {
    const SEED_COUNT: usize = 300;
    let cells = cells();
    let record = pulse();
    let records = Triaxial { x: Some(record.clone()), ..Triaxial::default() };
    let reference = [10.0, 6.0];
    let incoherence =
        Incoherence::new(LucoWong::new(COHERENCE_PARAMETER, SHEAR_WAVE_SPEED).unwrap());
    let incoherence = incoherence.with_reference(reference).unwrap();
    let motions: Vec<_> = (0..SEED_COUNT)
        .map(|seed| incoherence.clone().with_seed(seed as u64).motion(&records, &cells).unwrap())
        .collect();
    // The second frequency is between two with independent phases.
    for frequency in [2.0, 3.25, 5.0] {
        let record_coefficient = coefficient(frequency, |time| record.at(time).displacement);
        let samples: Vec<Vec<Complex>> = motions
            .iter()
            .map(|motion| {
                let ratio = |cell: &ContactElement| {
                    let place = place_of(cell);
                    coefficient(frequency, |time| motion.displacement_at(place, time)[0])
                        / record_coefficient
                };
                cells.iter().map(ratio).collect()
            })
            .collect();
        for (i, receiver) in cells.iter().enumerate() {
            for (j, source) in cells.iter().enumerate() {
                let products: Vec<Complex> = samples
                    .iter()
                    .map(|sample| sample[i] * Complex::new(sample[j].re, -sample[j].im))
                    .collect();
                assert_mean(&products, fine_mean(frequency, receiver, source), 1e-2);
            }
            // The record at the reference point has its phase.
            let point = ContactElement::in_plan([reference[0]; 2], [reference[1]; 2]);
            let relative: Vec<Complex> = samples.iter().map(|sample| sample[i]).collect();
            assert_mean(&relative, fine_mean(frequency, receiver, &point), 1e-2);
        }
    }
}

/// Asserts that the mean of samples is `expected` within four standard errors and a `bias`.
fn assert_mean(samples: &[Complex], expected: f64, bias: f64) {
    let count = samples.len() as f64;
    let sum = samples.iter().fold(Complex::real(0.0), |sum, sample| sum + *sample);
    let mean = sum.scale(1.0 / count);
    let variance = samples.iter().map(|sample| (*sample - mean).squared_modulus()).sum::<f64>()
        / (count - 1.0);
    let standard_error = (variance / count).sqrt();
    let error = (mean - Complex::real(expected)).abs();
    assert!(
        error < 4.0 * standard_error + bias,
        "{mean:?} for {expected}, standard error {standard_error}"
    );
}

fn quiet_record() -> Record {
    let record = el_centro_1940().with_baseline(Baseline::RestToRest { degree: 4 }).unwrap();
    record.padded(5.0, 2.0).unwrap()
}

/// Without incoherence all motions are those of the record, or of a wave that travels.
#[test]
fn coherent_motion_is_the_record() {
    let records = Triaxial {
        x: Some(quiet_record()),
        y: Some(quiet_record().scaled(-0.6).unwrap()),
        up: Some(quiet_record().scaled(0.3).unwrap()),
    };
    let cells = cells();
    let coherent = Incoherence::new(LucoWong::new(0.0, SHEAR_WAVE_SPEED).unwrap());
    let motion = coherent.motion(&records, &cells).unwrap();
    let azimuth = 0.4_f64;
    let velocity = 900.0;
    let reference = [-20.0, 3.0];
    let passing = coherent.with_passage(velocity, azimuth).unwrap();
    let passing = passing.with_reference(reference).unwrap().motion(&records, &cells).unwrap();
    let origin = reference[0] * azimuth.cos() + reference[1] * azimuth.sin();
    let up = Triaxial { up: records.up.clone(), ..Triaxial::default() };
    let wave = TravellingWave::new(up, velocity, origin).unwrap().with_azimuth(azimuth).unwrap();
    for cell in &cells {
        let place = place_of(cell);
        for k in 0..400 {
            let time = 0.0973 * f64::from(k);
            assert_eq!(motion.displacement_at(place, time), records.displacement_at(place, time));
            let expected = wave.displacement_at(place, time)[2];
            let error = (passing.displacement_at(place, time)[2] - expected).abs();
            assert!(error < 1e-14, "{error:e}");
        }
    }
    assert!(motion.displacement_at([0.5, 0.5], 7.0).iter().all(|value| value.is_nan()));
    assert!(motion.moves_across() && motion.records().len() == 3);
    assert_eq!(motion.min_eigenvalue(), 0.0);
}

/// A small cell at the reference point has the record; seeds differ, and repeat to the last bit.
#[test]
fn reference_point_has_the_record() {
    let mut cells = cells();
    cells.push(ContactElement::in_plan([33.0 - 1e-4, 33.0 + 1e-4], [7.0 - 1e-4, 7.0 + 1e-4]));
    let record = quiet_record();
    let records = Triaxial { y: Some(record.clone()), ..Triaxial::default() };
    let incoherence =
        Incoherence::new(LucoWong::new(COHERENCE_PARAMETER, SHEAR_WAVE_SPEED).unwrap());
    let incoherence = incoherence.with_reference([33.0, 7.0]).unwrap();
    let first = incoherence.motion(&records, &cells).unwrap();
    let again = incoherence.motion(&records, &cells).unwrap();
    let other = incoherence.with_seed(1).motion(&records, &cells).unwrap();
    let peak = record.peaks().displacement;
    let mut largest_difference = 0.0_f64;
    for k in 0..300 {
        let time = 0.1 * f64::from(k);
        let at_reference = first.displacement_at([33.0, 7.0], time)[1];
        assert!((at_reference - record.at(time).displacement).abs() < 1e-4 * peak);
        let place = place_of(&cells[2]);
        let values = [&first, &again, &other].map(|motion| motion.displacement_at(place, time));
        assert_eq!(values[0], values[1]);
        largest_difference = largest_difference.max((values[0][1] - values[2][1]).abs());
    }
    assert!(largest_difference > 0.01 * peak, "{largest_difference}");
}

/// Random motion stays near the record in time, and velocities are slopes of displacements.
#[test]
fn random_motion_stays_near_the_record() {
    let cells = cells();
    let record = pulse();
    let records = Triaxial { up: Some(record.clone()), ..Triaxial::default() };
    let incoherence =
        Incoherence::new(LucoWong::new(COHERENCE_PARAMETER, SHEAR_WAVE_SPEED).unwrap());
    let motion = incoherence.motion(&records, &cells).unwrap();
    let place = place_of(&cells[3]);
    let difference =
        |time: f64| motion.displacement_at(place, time)[2] - record.at(time).displacement;
    let mut energies = [0.0, 0.0];
    for k in 0..1500 {
        let time = 0.01 * f64::from(k);
        let is_near = (time - 6.0).abs() < 2.5;
        energies[usize::from(is_near)] += difference(time).powi(2);
    }
    println!("{energies:?}");
    assert!(energies[0] < 0.01 * energies[1] && energies[1] > 0.0, "{energies:?}");
    assert!(difference(0.0) == 0.0 && difference(-1.0) == 0.0);
    assert_eq!(difference(50.0), difference(70.0));
}

/// Text of the error of an incoherent motion.
fn fault(incoherence: &Incoherence, record: Record, elements: &[ContactElement]) -> String {
    let records = Triaxial { x: Some(record), ..Triaxial::default() };
    incoherence.motion(&records, elements).err().unwrap().to_string()
}

#[test]
fn undefined_motions_are_errors() {
    let cells = cells();
    let fine = Incoherence::new(LucoWong::new(COHERENCE_PARAMETER, SHEAR_WAVE_SPEED).unwrap());
    assert!(LucoWong::new(-0.1, 300.0).is_err() && LucoWong::new(0.1, 0.0).is_err());
    assert!(fine.clone().with_passage(0.0, 0.0).is_err());
    assert!(fine.clone().with_passage(500.0, f64::NAN).is_err());
    assert!(fine.clone().with_reference([f64::NAN, 0.0]).is_err());
    assert!(fine.clone().with_bandwidth(0.0).is_err());
    let slow = fine.clone().with_bandwidth(1e-4).unwrap();
    assert!(fault(&slow, quiet_record(), &cells).contains("bandwidth"));
    let moving = Record::new(0.01, vec![1.0; 500]).unwrap();
    assert!(fault(&fine, moving, &cells).contains("velocity at the end"));
    let sudden = el_centro_1940().with_baseline(Baseline::RestToRest { degree: 4 }).unwrap();
    let text = fault(&fine, sudden, &cells);
    assert!(text.contains("before t = 0") && text.contains("quiet time"), "{text}");
    assert!(fault(&fine, quiet_record(), &[cells[0], cells[0]]).contains("overlap"));
    let beyond_one = Incoherence::new(CoherenceFn::of_separation(|_, _| 1.5));
    let text = fault(&beyond_one, quiet_record(), &cells);
    assert!(text.contains("0.5 Hz") && text.contains("1.5"), "{text}");
    let far = ContactElement::in_plan([200.0, 210.0], [0.0, 10.0]);
    let rock = Incoherence::new(AbrahamsonCoherence::HardRockHorizontal).clipped();
    assert!(fault(&rock, quiet_record(), &[cells[0], far]).contains("distance"));
}

/// A function that is no coherence has a negative eigenvalue, which is an error with its frequency, or clipped.
#[test]
fn negative_eigenvalues_are_errors_or_clipped() {
    // Neighbours move together, and others do not: eigenvalues 1, 1 ± √2 of three cells.
    let neighbours = || {
        CoherenceFn::of_separation(|frequency, [x, _]| {
            let is_near = x.abs() < 15.0;
            if is_near || frequency == 0.0 { 1.0 } else { 0.0 }
        })
    };
    let cells: Vec<_> = (0..3)
        .map(|k| {
            ContactElement::in_plan([10.0 * f64::from(k), 10.0 * f64::from(k) + 1.0], [0.0, 1.0])
        })
        .collect();
    let incoherence = Incoherence::new(neighbours()).with_reference([10.5, 0.5]).unwrap();
    let text = fault(&incoherence, quiet_record(), &cells);
    assert!(text.contains("0.5 Hz") && text.contains("eigenvalue"), "{text}");
    let records = Triaxial { x: Some(quiet_record()), ..Triaxial::default() };
    let motion = incoherence.clipped().motion(&records, &cells).unwrap();
    // The reference point is a fourth point, with the motion of the middle cell: 1 + (1 − √17)/2.
    let expected = 1.0 + 0.5 * (1.0 - 17.0_f64.sqrt());
    assert!((motion.min_eigenvalue() - expected).abs() < 1e-12, "{}", motion.min_eigenvalue());
    let error =
        matches!(Incoherence::new(neighbours()).motion(&records, &cells), Err(Error::Item { .. }));
    assert!(error);
}

/// The motion of a strip, and of other elements.
#[test]
fn motions_belong_to_the_elements_of_a_ground() {
    let soil = Soil::from_shear_wave_speed(250.0, 0.3, 1900.0).unwrap();
    let block = RigidBlock::new(20.0, 10.0, 600.0).unwrap();
    let ground =
        |count| ElasticGround::new(soil, Strip::uniform(-10.0..10.0, count).unwrap()).unwrap();
    let records = Triaxial { x: Some(quiet_record()), ..Triaxial::default() };
    let incoherence = Incoherence::new(LucoWong::new(0.5, 250.0).unwrap());
    let motion = || incoherence.motion(&records, ground(8).elements()).unwrap();
    let builder = |count: usize| {
        Simulation::builder(0.01)
            .structure(block.clone())
            .ground(ground(count))
            .interface(Bonded)
            .motion(motion())
    };
    let text = builder(10).build().err().unwrap().to_string();
    assert!(text.contains("elements of this ground"), "{text}");
    let mut simulation = builder(8).build().unwrap();
    let run = simulation.run(900, |_| {}).unwrap();
    assert!(run.energy_error < 1e-9 && run.whole.base_rotation.magnitude() > 0.0);
}
