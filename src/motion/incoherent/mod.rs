//! Free field that differs from element to element at random.

use std::collections::HashMap;
use std::sync::Arc;

mod cell_coherence;
mod difference;
mod random_part;

use basemat_fourier::num_complex::Complex64;

use super::{Coherence, FreeField, Record, Triaxial};
use crate::error::{Result, finite, memory, positive, require, require_part};
use crate::geometry::{ContactElement, Patch};
use cell_coherence::CellCoherence;
use difference::{DifferenceSeries, Knots, VelocitySpectrum};
use random_part::{Factor, NegativeEigenvalues, PhaseSequence};

/// Incoherence of the ground motion under a base, from which an [`IncoherentMotion`] is made.
///
/// Default: both directions have the same coherence, all elements move without delay, the reference point is the middle of
/// the base, the bandwidth is 0.5 Hz, the seed is 0, and negative eigenvalues are errors.
#[derive(Clone)]
pub struct Incoherence {
    horizontal: Arc<dyn Coherence>,
    /// Coherence of the vertical motion, if it differs from the horizontal one.
    vertical: Option<Arc<dyn Coherence>>,
    /// Slowness of the wave along x and along y, s/m.
    slowness: [f64; 2],
    /// Point at which the motion is that of the records, m; the middle of the base if `None`.
    reference: Option<[f64; 2]>,
    /// Interval between frequencies with independent phases, Hz.
    bandwidth: f64,
    seed: u64,
    negative_eigenvalues: NegativeEigenvalues,
}

short_debug! {
    Incoherence; self;
    slowness: self.slowness,
    reference: self.reference,
    bandwidth: self.bandwidth,
    seed: self.seed,
}

/// Default interval between frequencies with independent phases, Hz.
const DEFAULT_BANDWIDTH: f64 = 0.5;

impl Incoherence {
    /// Incoherence of this `coherence` in all directions.
    pub fn new(coherence: impl Coherence + 'static) -> Self {
        Self {
            horizontal: Arc::new(coherence),
            vertical: None,
            slowness: [0.0; 2],
            reference: None,
            bandwidth: DEFAULT_BANDWIDTH,
            seed: 0,
            negative_eigenvalues: NegativeEigenvalues::Rejected,
        }
    }

    /// Replaces the coherence of the vertical motion.
    #[must_use]
    pub fn with_vertical(self, coherence: impl Coherence + 'static) -> Self {
        Self { vertical: Some(Arc::new(coherence)), ..self }
    }

    /// Adds a wave that passes with an apparent velocity (m/s) in the direction `azimuth` (rad).
    ///
    /// The azimuth is counter-clockwise from x as seen from above. Each element moves later than the reference point by the
    /// time that the wave takes to its centre, as for [`TravellingWave`](super::TravellingWave). Components of the records
    /// stay along x, y and up.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a velocity of zero or NaN, or an azimuth that is not finite.
    pub fn with_passage(self, apparent_velocity: f64, azimuth: f64) -> Result<Self> {
        let slowness = 1.0 / apparent_velocity;
        let needed = "not zero (infinite: everywhere at once)";
        require("apparent velocity", apparent_velocity, slowness.is_finite(), needed)?;
        finite("azimuth of a wave", azimuth)?;
        Ok(Self { slowness: [slowness * azimuth.cos(), slowness * azimuth.sin()], ..self })
    }

    /// Replaces the reference point `[x, y]` (m), at which the ground has the motion of the records.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the point is finite.
    pub fn with_reference(self, point: [f64; 2]) -> Result<Self> {
        finite("x of the reference point", point[0])?;
        finite("y of the reference point", point[1])?;
        Ok(Self { reference: Some(point), ..self })
    }

    /// Replaces the interval (Hz) between frequencies with independent random phases.
    ///
    /// The random part of the motion precedes and follows the record by about one to two periods of this interval. Between
    /// these frequencies variances are interpolated by cubics, and correlations of the random parts are means of both neighbours: the
    /// coherence must not change much within the interval.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the bandwidth is positive.
    pub fn with_bandwidth(self, bandwidth: f64) -> Result<Self> {
        positive("bandwidth of the random motion", bandwidth)?;
        Ok(Self { bandwidth, ..self })
    }

    /// Replaces the seed: each seed gives other random phases, and the same on every machine.
    #[must_use]
    pub fn with_seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }

    /// Replaces negative eigenvalues of the coherence between elements by zero.
    ///
    /// The coherence then is that of a random motion, with the variances unchanged and the correlations nearest to the model.
    /// [`IncoherentMotion::min_eigenvalue`] returns the most negative eigenvalue that was replaced.
    #[must_use]
    pub fn clipped(self) -> Self {
        Self { negative_eigenvalues: NegativeEigenvalues::Clipped, ..self }
    }

    /// Motion of the contact elements of a ground, from the records at the reference point.
    ///
    /// The work grows as elements² times rank, for each multiple of the bandwidth up to half the sampling frequency of the
    /// records; frequencies at which the records have less than 10⁻⁶ of their largest amplitude are left out. Two numbers are
    /// stored for each element, component and sample.
    ///
    /// # Errors
    /// [`Error::Scene`](crate::Error::Scene) for elements of walls, or of a ground in the plane and in plan;
    /// [`Error::Input`](crate::Error::Input) for elements that overlap, a distance beyond
    /// [`Coherence::max_distance`], a record that does not end at rest or without quiet time at its beginning, a bandwidth so small that
    /// the motion spreads over more than four lengths of the record, and, within an
    /// [`Error::Item`](crate::Error::Item) that names the frequency, for a coherence beyond ±1 or a negative eigenvalue;
    /// [`Error::Memory`](crate::Error::Memory).
    pub fn motion(
        &self,
        records: &Triaxial,
        elements: &[ContactElement],
    ) -> Result<IncoherentMotion> {
        let patch = Patch::of_any_count(elements.to_vec())?;
        let needed = "on the surface: incoherent motion is not defined at walls";
        require_part("contact elements of an incoherent motion", !patch.has_walls(), needed)?;
        let reference = self.reference.unwrap_or_else(|| patch.center());
        let across_record = records.y.as_ref().filter(|_| patch.is_plan());
        let component_records = [records.x.as_ref(), across_record, records.up.as_ref()];
        let horizontal = self.horizontal.as_ref();
        let groups: &[(&dyn Coherence, &[usize])] = match &self.vertical {
            None => &[(horizontal, &[0, 1, 2])],
            Some(vertical) => &[(horizontal, &[0, 1]), (vertical.as_ref(), &[2])],
        };
        let mut min_eigenvalue = 0.0_f64;
        let mut differences = [None, None, None];
        for (coherence, group) in groups {
            let cells = CellCoherence::new(*coherence, reference, elements)?;
            let mut components = Vec::new();
            for component in *group {
                if let Some(record) = component_records[*component] {
                    components.push(RandomComponent::new(*component, record, self)?);
                }
            }
            min_eigenvalue = min_eigenvalue.min(self.fill_knots(&cells, &mut components)?);
            for RandomComponent { component, spectrum, knots, .. } in components {
                check_memory(elements.len(), spectrum.sample_count())?;
                differences[component] =
                    Some(DifferenceSeries::new(&spectrum, &knots, elements.len())?);
            }
        }
        let mut indices = HashMap::with_capacity(elements.len());
        let mut delays = Vec::with_capacity(elements.len());
        for (index, element) in elements.iter().enumerate() {
            let place = [element.center()[0], element.center()[1]];
            indices.insert(place_key(place), index);
            let delay = self.slowness[0] * (place[0] - reference[0])
                + self.slowness[1] * (place[1] - reference[1]);
            delays.push(delay);
        }
        let records = [&records.x, &records.y, &records.up];
        let components = [0, 1, 2].map(|component| {
            let difference = differences[component].take();
            records[component].clone().map(|record| ComponentMotion { record, difference })
        });
        Ok(IncoherentMotion {
            components,
            elements: elements.to_vec(),
            indices,
            delays,
            min_eigenvalue,
        })
    }

    /// Computes means and random parts of components of one coherence; returns the smallest eigenvalue.
    fn fill_knots(
        &self,
        cells: &CellCoherence<'_>,
        components: &mut [RandomComponent],
    ) -> Result<f64> {
        let element_count = cells.order() - 1;
        let mut means = vec![1.0; element_count];
        let mut min_eigenvalue = 0.0_f64;
        let knot_count = components.iter().map(|c| c.is_significant.len()).max().unwrap_or(0);
        for knot in 0..knot_count {
            let is_significant = |c: &RandomComponent| c.is_significant.get(knot) == Some(&true);
            // All elements move together at frequency zero.
            let factor = if knot > 0 && components.iter().any(is_significant) {
                let frequency = knot as f64 * self.bandwidth;
                let negative_eigenvalues = self.negative_eigenvalues;
                Some(Factor::new(cells, negative_eigenvalues, frequency)?)
            } else {
                None
            };
            if let Some(factor) = &factor {
                means.clone_from(&factor.means);
                min_eigenvalue = min_eigenvalue.min(factor.min_eigenvalue);
            }
            for component in &mut *components {
                let factor = factor.as_ref().filter(|_| is_significant(component));
                component.add_knot(&means, factor);
            }
        }
        Ok(min_eigenvalue)
    }
}

/// Component of the motion while its random part is computed.
struct RandomComponent {
    /// 0 for x, 1 for y, 2 for up.
    component: usize,
    spectrum: VelocitySpectrum,
    /// Whether the record has motion around each knot.
    is_significant: Vec<bool>,
    phases: PhaseSequence,
    knots: Knots,
}

impl RandomComponent {
    /// Component of a record, without knots.
    fn new(component: usize, record: &Record, incoherence: &Incoherence) -> Result<Self> {
        let bandwidth = incoherence.bandwidth;
        let spectrum = VelocitySpectrum::new(record, bandwidth)?;
        Ok(Self {
            component,
            is_significant: spectrum.significant_knots(bandwidth),
            spectrum,
            phases: PhaseSequence::new(incoherence.seed, component),
            knots: Knots { bandwidth, means: vec![], deviations: vec![], random_parts: vec![] },
        })
    }

    /// Adds the next knot: means, and the random part of its factor if the record has motion there.
    fn add_knot(&mut self, means: &[f64], factor: Option<&Factor>) {
        let Self { knots, phases, .. } = self;
        knots.means.push(means.to_vec());
        let Some(factor) = factor else {
            knots.deviations.push(vec![0.0; means.len()]);
            knots.random_parts.push(vec![Complex64::default(); means.len()]);
            return;
        };
        if let [random_part] = &mut knots.random_parts[..] {
            // Deviations are zero at the first knot, but not beside it.
            *random_part = factor.unit_random_delays(phases);
        }
        knots.deviations.push(factor.deviations());
        knots.random_parts.push(factor.unit_random_part(phases));
    }
}

/// Bytes per element and sample: a displacement and a velocity.
const BYTES_PER_SAMPLE: f64 = 16.0;
/// Bytes per pair of elements: the coherence, its factor, and eigenvectors.
const BYTES_PER_PAIR: f64 = 40.0;

/// Checks that the motions of all elements fit into memory.
fn check_memory(element_count: usize, sample_count: usize) -> Result<()> {
    let count = element_count as f64;
    let bytes = count * (BYTES_PER_SAMPLE * sample_count as f64 + BYTES_PER_PAIR * count);
    Ok(memory::check("elements of an incoherent motion", count, bytes)?)
}

/// Key of a place in the table of elements.
fn place_key([x, y]: [f64; 2]) -> [u64; 2] {
    // Adding zero removes the sign of a negative zero.
    [(x + 0.0).to_bits(), (y + 0.0).to_bits()]
}

/// Component of an incoherent motion.
struct ComponentMotion {
    /// Motion at the reference point.
    record: Record,
    /// Motion of each element minus the record; `None` for a component that the ground ignores.
    difference: Option<DifferenceSeries>,
}

impl ComponentMotion {
    /// Displacement (m) of an element at a time (s), without the delay of the wave.
    fn displacement(&self, element: usize, time: f64) -> f64 {
        let difference = self.difference.as_ref().map_or(0.0, |series| series.at(element, time));
        self.record.at(time).displacement + difference
    }
}

/// Free field whose motion differs from element to element at random, with a given coherence.
///
/// The reference point has the motion of the records. Relative to it the Fourier coefficients of elements i and j have the
/// mean product Γ_ij over many seeds, Γ being the mean of the [`Coherence`] over all pairs of points in both elements: rigid and
/// flexible bases filter the motion, rock and twist. Components are independent of each other. In the plane the motion
/// does not change along y.
///
/// The motion is defined at the centres of its elements only, and NaN elsewhere. A run on a ground with other elements returns
/// an error.
///
/// ```
/// use basemat::Soil;
/// use basemat::bem::{ElasticGround, Ground};
/// use basemat::bem::plan::Plan;
/// use basemat::motion::{Baseline, FreeField, Incoherence, LucoWong, Triaxial, el_centro_1940};
/// let soil = Soil::from_shear_wave_speed(300.0, 1.0 / 3.0, 1900.0)?;
/// let ground = ElasticGround::in_plan(soil, Plan::rectangle(-15.0..15.0, -15.0..15.0, 6)?)?;
/// let record = el_centro_1940().with_baseline(Baseline::RestToRest { degree: 4 })?.padded(4.0, 2.0)?;
/// let records = Triaxial { x: Some(record.clone()), ..Triaxial::default() };
/// let incoherence = Incoherence::new(LucoWong::new(0.25, 300.0)?).with_seed(1);
/// let motion = incoherence.motion(&records, ground.elements())?;
/// let [x, y, _] = ground.elements()[0].center();
/// let corner = motion.displacement_at([x, y], 8.0)[0];
/// let middle = record.at(8.0).displacement;
/// assert!(corner != middle && (corner - middle).abs() < 0.03);
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct IncoherentMotion {
    /// Along x, along y and up.
    components: [Option<ComponentMotion>; 3],
    elements: Vec<ContactElement>,
    /// Index of the element with each centre.
    indices: HashMap<[u64; 2], usize>,
    /// Time by which each element moves later than the reference point, s.
    delays: Vec<f64>,
    min_eigenvalue: f64,
}

short_debug! {
    IncoherentMotion; self; elements: self.elements.len(), min_eigenvalue: self.min_eigenvalue
}

impl IncoherentMotion {
    /// Most negative eigenvalue of the coherence that was replaced by zero; zero if none was.
    pub fn min_eigenvalue(&self) -> f64 {
        self.min_eigenvalue
    }
}

impl FreeField for IncoherentMotion {
    fn displacement(&self, x: f64, time: f64) -> [f64; 2] {
        let displacement = self.displacement_at([x, 0.0], time);
        [displacement[0], displacement[2]]
    }

    fn displacement_at(&self, place: [f64; 2], time: f64) -> [f64; 3] {
        let Some(&element) = self.indices.get(&place_key(place)) else {
            return [f64::NAN; 3];
        };
        let element_time = time - self.delays[element];
        [0, 1, 2].map(|component| {
            let component = self.components[component].as_ref();
            component.map_or(0.0, |component| component.displacement(element, element_time))
        })
    }

    fn elements(&self) -> Option<&[ContactElement]> {
        Some(&self.elements)
    }

    fn moves_across(&self) -> bool {
        self.components[1].is_some()
    }

    fn records(&self) -> Vec<&Record> {
        self.components.iter().flatten().map(|component| &component.record).collect()
    }
}

/// Coherence between the means of the motion over contact elements, row-major.
///
/// The mean of the coherence at a `frequency` (Hz) over all pairs of points in two elements, with two Gauss points along each
/// side. A bonded base whose motion is Σ w_i u_i then has the mean square w* Γ w of the free field's.
///
/// # Errors
/// [`Error::Input`](crate::Error::Input) for elements that overlap or a distance beyond [`Coherence::max_distance`], and
/// within an [`Error::Item`](crate::Error::Item) for a coherence beyond ±1.
pub fn mean_coherence(
    coherence: &dyn Coherence,
    frequency: f64,
    elements: &[ContactElement],
) -> Result<Vec<f64>> {
    let patch = Patch::of_any_count(elements.to_vec())?;
    let cells = CellCoherence::new(coherence, patch.center(), elements)?;
    let order = cells.order();
    let matrix = cells.matrix(frequency)?;
    let rows = matrix.chunks_exact(order).skip(1);
    Ok(rows.flat_map(|row| row[1..].iter().copied()).collect())
}
