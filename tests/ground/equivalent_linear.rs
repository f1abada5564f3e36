//! GOAL: strain-compatible properties of sites agree with another program.
//! SCENE: clay, sand and alternate layers on damped rock under El Centro.
//! REFERENCE: pystrata's `EquivalentLinearCalculator` (`equivalent_linear.csv`, from `equivalent_linear.py` beside it).

use std::fmt::Write as _;

use basemat::motion::{Record, STANDARD_GRAVITY, el_centro_1940};
use basemat::results::log_spaced;
use basemat::site::{EquivalentLinear, EquivalentLinearOptions, SoilColumn, VerticalWave};
use basemat::soil::{Hysteretic, SoilProfile, StrainCurves};
use basemat::{Soil, unobserved};

const SITE_NAMES: [&str; 3] = ["clay", "sand", "alternate"];
/// Peak accelerations of the outcrop, g.
const OUTCROP_PEAKS: [f64; 3] = [0.05, 0.2, 0.5];
const REFERENCE_TABLE: &str = include_str!("../data/equivalent_linear.csv");

/// A layer: thickness (m), shear wave speed (m/s), density (kg/m³), strain-dependent curves.
pub(super) struct SiteLayer {
    thickness: f64,
    speed: f64,
    density: f64,
    pub(super) curves: StrainCurves,
}

/// Layers on rock.
pub(super) struct LayeredSite {
    pub(super) layers: Vec<SiteLayer>,
    /// Shear wave speed (m/s), density (kg/m³) and damping ratio of the rock.
    rock: [f64; 3],
}

fn clay_layer(k: u32) -> SiteLayer {
    let plasticity_index = if k < 4 { 30.0 } else { 50.0 };
    SiteLayer {
        thickness: 3.0,
        speed: 130.0 + 12.0 * f64::from(k),
        density: 1700.0,
        curves: StrainCurves::VuceticDobry { plasticity_index },
    }
}

fn sand_layer(k: u32) -> SiteLayer {
    let depth = 3.0 * f64::from(k) + 1.5;
    SiteLayer {
        thickness: 3.0,
        speed: 160.0 * (1.0 + depth / 3.0).powf(0.33),
        density: 1900.0,
        curves: StrainCurves::Epri { depth },
    }
}

fn alternate_layer(k: u32) -> SiteLayer {
    match k {
        12 => SiteLayer {
            thickness: 4.0,
            speed: 420.0,
            density: 2100.0,
            curves: StrainCurves::Linear { damping: 0.02 },
        },
        0 | 4 | 8 => SiteLayer {
            thickness: 1.5,
            speed: 230.0,
            density: 1900.0,
            curves: StrainCurves::SeedIdrissMean,
        },
        2 | 6 | 10 => SiteLayer {
            thickness: 1.5,
            speed: 260.0,
            density: 1950.0,
            curves: StrainCurves::SeedIdrissUpper,
        },
        _ => SiteLayer {
            thickness: 1.5,
            speed: 170.0,
            density: 1800.0,
            curves: darendeli(20.0, 2.0, 15.0e3 + 10.0e3 * f64::from(k), 1.0, 10.0),
        },
    }
}

impl LayeredSite {
    pub(super) fn named(name: &str) -> Self {
        match name {
            "clay" => {
                Self { layers: (0..10).map(clay_layer).collect(), rock: [800.0, 2300.0, 0.01] }
            }
            "sand" => {
                Self { layers: (0..15).map(sand_layer).collect(), rock: [760.0, 2200.0, 0.01] }
            }
            _ => {
                Self { layers: (0..13).map(alternate_layer).collect(), rock: [600.0, 2200.0, 0.02] }
            }
        }
    }

    pub(super) fn column(&self) -> SoilColumn {
        let rock = Soil::from_shear_wave_speed(self.rock[0], 0.25, self.rock[1]).unwrap();
        let law = Hysteretic::new(self.rock[2]).unwrap();
        let mut profile = SoilProfile::on_half_plane(rock).with_bedrock_damping(law);
        for layer in &self.layers {
            let soil = Soil::from_shear_wave_speed(layer.speed, 0.4, layer.density).unwrap();
            profile = profile.with_layer(soil, layer.thickness).unwrap();
        }
        SoilColumn::new(profile, VerticalWave::Shear).unwrap()
    }

    pub(super) fn curves(&self) -> Vec<StrainCurves> {
        self.layers.iter().map(|layer| layer.curves.clone()).collect()
    }
}

pub(super) fn darendeli(
    plasticity_index: f64,
    overconsolidation: f64,
    mean_stress: f64,
    frequency: f64,
    cycles: f64,
) -> StrainCurves {
    StrainCurves::Darendeli { plasticity_index, overconsolidation, mean_stress, frequency, cycles }
}

/// El Centro scaled to a peak acceleration in g.
pub(super) fn motion(peak: f64) -> Record {
    let record = el_centro_1940().resampled(0.01).unwrap().padded(1.0, 15.0).unwrap();
    record.scaled_to_peak(peak * STANDARD_GRAVITY).unwrap()
}

/// Name and parameters of curves, in the form that `equivalent_linear.py` reads.
fn curve_fields(curves: &StrainCurves) -> String {
    match curves {
        StrainCurves::Linear { damping } => format!("linear,{damping}"),
        StrainCurves::SeedIdrissMean => "seed_idriss_mean".into(),
        StrainCurves::SeedIdrissUpper => "seed_idriss_upper".into(),
        StrainCurves::VuceticDobry { plasticity_index } => {
            format!("vucetic_dobry,{plasticity_index}")
        }
        StrainCurves::Epri { depth } => format!("epri,{depth}"),
        StrainCurves::Darendeli {
            plasticity_index,
            overconsolidation,
            mean_stress,
            frequency,
            cycles,
        } => {
            format!(
                "darendeli,{plasticity_index},{overconsolidation},{mean_stress},{frequency},{cycles}"
            )
        }
        other => unreachable!("{other:?}"),
    }
}

/// Curves of every kind.
fn all_curves() -> Vec<StrainCurves> {
    let plasticity_indices = [0.0, 15.0, 30.0, 50.0, 100.0, 200.0];
    let depths = [3.0, 10.0, 20.0, 50.0, 100.0, 200.0];
    let mut list = vec![StrainCurves::SeedIdrissMean, StrainCurves::SeedIdrissUpper];
    list.extend(
        plasticity_indices.map(|plasticity_index| StrainCurves::VuceticDobry { plasticity_index }),
    );
    list.extend(depths.map(|depth| StrainCurves::Epri { depth }));
    list.extend([
        darendeli(0.0, 1.0, 101_325.0, 1.0, 10.0),
        darendeli(30.0, 2.0, 50e3, 1.0, 10.0),
        darendeli(80.0, 8.0, 400e3, 5.0, 30.0),
    ]);
    list
}

/// Numbers of the reference table's lines with this beginning.
fn reference_rows(start: &str) -> Vec<Vec<f64>> {
    let fields = REFERENCE_TABLE.lines().filter_map(|line| line.strip_prefix(start));
    fields.map(|line| line.split(',').map(|x| x.parse().unwrap()).collect()).collect()
}

/// GOAL: modulus ratio and damping of every kind of curve agree with the other program.
#[test]
fn curves_are_those_of_another_program() {
    for curves in all_curves() {
        let rows = reference_rows(&format!("curve,{},", curve_fields(&curves).replace(',', "/")));
        assert!(rows.len() >= 6, "{curves:?}");
        for row in rows {
            let computed = curves.at(row[0]).unwrap();
            for (computed, expected) in computed.iter().zip(&row[1..]) {
                assert!((computed / expected - 1.0).abs() < 2e-6, "{curves:?} {row:?} {computed}");
            }
        }
    }
    // Between two plasticity indices of the publication, values are interpolated linearly.
    let values = [50.0, 75.0, 100.0]
        .map(|plasticity_index| StrainCurves::VuceticDobry { plasticity_index }.at(2e-4).unwrap());
    for k in 0..2 {
        assert!((values[1][k] - 0.5 * (values[0][k] + values[2][k])).abs() < 1e-15);
    }
}

/// Compared results of a site under a motion.
struct SiteResponse {
    /// Site and peak acceleration, as the reference table names them.
    case: String,
    /// Modulus ratio, damping, largest strain and peak acceleration of each layer.
    layers: Vec<[f64; 4]>,
    /// Pseudo-accelerations of the surface.
    spectrum: Vec<f64>,
}

impl SiteResponse {
    fn new(case: String, computed: &EquivalentLinear, periods: &[f64]) -> Self {
        let peaks = &computed.peak_accelerations;
        let layers = computed
            .layers
            .iter()
            .zip(peaks)
            .map(|(layer, peak)| [layer.modulus_ratio, layer.damping, layer.largest_strain, *peak])
            .collect();
        let spectrum = computed.surface.response_spectrum(periods, 0.05, &mut unobserved).unwrap();
        let spectrum = spectrum.iter().map(|point| point.pseudo_acceleration).collect();
        Self { case, layers, spectrum }
    }

    /// Relative errors: modulus, damping, strain, acceleration, spectrum.
    fn largest_errors(&self) -> [f64; 5] {
        let case = &self.case;
        let mut max_errors = [0.0_f64; 5];
        let expected_layers = reference_rows(&format!("layer,{case}"));
        assert_eq!(expected_layers.len(), self.layers.len(), "{case}");
        for (computed, expected) in self.layers.iter().zip(&expected_layers) {
            for k in 0..4 {
                max_errors[k] = max_errors[k].max((computed[k] / expected[k] - 1.0).abs());
            }
        }
        let expected_spectra = reference_rows(&format!("spectrum,{case}"));
        assert_eq!(expected_spectra.len(), 1, "{case}");
        assert_eq!(expected_spectra[0].len(), self.spectrum.len(), "{case}");
        for (computed, expected) in self.spectrum.iter().zip(&expected_spectra[0]) {
            max_errors[4] = max_errors[4].max((computed / expected - 1.0).abs());
        }
        max_errors
    }
}

/// Text of the numbers, each after a comma.
fn comma_list(values: &[f64]) -> String {
    values.iter().fold(String::new(), |text, x| text + "," + &x.to_string())
}

/// GOAL: sites respond as in the other program; the file that is written lets pystrata compute them again.
#[test]
fn sites_respond_as_in_another_program() {
    let periods = log_spaced(0.05, 3.0, 19).unwrap();
    let unscaled_record = motion(1.0);
    let accelerations = comma_list(unscaled_record.accelerations());
    let mut file = format!("motion,{}{accelerations}\n", unscaled_record.time_step());
    writeln!(file, "periods{}", comma_list(&periods)).unwrap();
    for curves in all_curves() {
        writeln!(file, "curve,{}", curve_fields(&curves)).unwrap();
    }
    let mut responses = vec![];
    for name in SITE_NAMES {
        let site = LayeredSite::named(name);
        let column = site.column();
        for peak in OUTCROP_PEAKS {
            let options =
                EquivalentLinearOptions { tolerance: 1e-4, ..EquivalentLinearOptions::default() };
            let computed = column
                .equivalent_linear(&motion(peak), &site.curves(), &options, &mut unobserved)
                .unwrap();
            println!("{name} at {peak} g\n{computed}");
            writeln!(file, "case,{name},{peak}").unwrap();
            for SiteLayer { thickness, speed, density, curves } in &site.layers {
                let curves = curve_fields(curves);
                writeln!(file, "layer,{thickness},{speed},{density},{curves}").unwrap();
            }
            writeln!(file, "rock{}", comma_list(&site.rock)).unwrap();
            let response = SiteResponse::new(format!("{name},{peak},"), &computed, &periods);
            for layer in &response.layers {
                writeln!(file, "computed{}", comma_list(layer)).unwrap();
            }
            writeln!(file, "spectrum{}", comma_list(&response.spectrum)).unwrap();
            responses.push(response);
        }
    }
    std::fs::write(concat!(env!("CARGO_TARGET_TMPDIR"), "/equivalent_linear.csv"), file).unwrap();
    let mut max_errors = [0.0_f64; 5];
    for response in &responses {
        for (max_errors, error) in max_errors.iter_mut().zip(response.largest_errors()) {
            *max_errors = max_errors.max(error);
        }
    }
    println!("modulus, damping, strain, acceleration, spectrum: {max_errors:.5?}");
    assert!(max_errors.iter().all(|error| *error < 1e-3), "{max_errors:?}");
}
