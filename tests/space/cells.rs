//! Scenes that these tests share: a ground of springs and dashpots under each cell, and pulses.

use basemat::bem::{ContactElement, Ground, GroundDescription, SpringGround};
use basemat::coupled::{SimulationBuilder, State};
use basemat::interface::InterfaceLaw;
use basemat::motion::{FreeField, Record, Triaxial};
use basemat::structure::{RigidBlock, RigidBody};
use basemat::{Error, Observer, Result, Simulation};

/// Stiffness (Pa/m) and dashpots (Pa·s/m) per area: down, along x, along y.
#[derive(Clone, Copy)]
pub(crate) struct BedProperties {
    pub(crate) stiffness: [f64; 3],
    pub(crate) dashpot: [f64; 3],
}

pub(crate) const BED_PROPERTIES: BedProperties =
    BedProperties { stiffness: [3.0e7, 2.0e7, 1.4e7], dashpot: [6.0e5, 3.0e5, 4.0e5] };

impl BedProperties {
    /// The same bed with the properties along x also along y.
    pub(crate) fn isotropic(self) -> Self {
        Self {
            stiffness: [self.stiffness[0], self.stiffness[1], self.stiffness[1]],
            dashpot: [self.dashpot[0], self.dashpot[1], self.dashpot[1]],
        }
    }
}

/// Independent springs and dashpots under each cell.
#[derive(Clone)]
pub(crate) struct SpringCells {
    pub(crate) elements: Vec<ContactElement>,
    pub(crate) sampled_cells: Option<[usize; 2]>,
    properties: BedProperties,
    time_step: f64,
    displacement: Vec<f64>,
}

impl SpringCells {
    /// Rectangular cells between neighbouring values of `x` and of `y`.
    pub(crate) fn between(x: &[f64], y: &[f64], properties: BedProperties) -> Self {
        let mut elements = Vec::new();
        for row in y.windows(2) {
            for column in x.windows(2) {
                elements.push(ContactElement::in_plan([column[0], column[1]], [row[0], row[1]]));
            }
        }
        let displacement = vec![0.0; 3 * elements.len()];
        Self { elements, sampled_cells: None, properties, time_step: 0.0, displacement }
    }

    /// The same ground after elements were removed.
    pub(crate) fn resized(mut self) -> Self {
        self.displacement = vec![0.0; 3 * self.elements.len()];
        self
    }

    /// Cells under a rectangle about `center`; the outer ones extend beyond its edge by a tenth of their side.
    pub(crate) fn under(
        sides: [f64; 2],
        center: [f64; 2],
        counts: [usize; 2],
        properties: BedProperties,
    ) -> Self {
        let x = cell_boundaries(sides[0], center[0], counts[0]);
        let y = cell_boundaries(sides[1], center[1], counts[1]);
        Self::between(&x, &y, properties)
    }

    pub(crate) fn area(&self, element: usize) -> f64 {
        self.elements[element].area()
    }

    /// Middle of a cell.
    pub(crate) fn middle(&self, element: usize) -> [f64; 2] {
        let center = self.elements[element].center();
        [center[0], center[1]]
    }

    /// Factors of entry `i` of a contact vector.
    fn midpoint_factors(&self, i: usize) -> MidpointFactors {
        let component = i / self.elements.len();
        let half_stiffness = 0.5 * self.properties.stiffness[component];
        let dashpot = self.properties.dashpot[component] / self.time_step;
        MidpointFactors { end: dashpot + half_stiffness, start: dashpot - half_stiffness }
    }

    fn fill_diagonal(&self, matrix: &mut [f64], value: impl Fn(usize) -> f64) {
        let size = self.displacement.len();
        matrix.fill(0.0);
        (0..size).for_each(|i| matrix[i * (size + 1)] = value(i));
    }
}

/// Factors of the displacements at the end (c/Δt + k/2) and at the start (c/Δt − k/2) of a step.
struct MidpointFactors {
    end: f64,
    start: f64,
}

/// Boundaries of `count` cells that reach a tenth of a cell beyond a side at both ends.
fn cell_boundaries(side: f64, center: f64, count: usize) -> Vec<f64> {
    let pitch = side / (count as f64 - 0.2);
    (0..=count).map(|j| center + pitch * (j as f64 - 0.5 * count as f64)).collect()
}

impl Ground for SpringCells {
    fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    fn description(&self) -> GroundDescription {
        GroundDescription { sampled_cells: self.sampled_cells, ..Default::default() }
    }

    fn prepare(&mut self, time_step: f64, _: Option<usize>, _: &mut Observer<'_>) -> Result<()> {
        self.time_step = time_step;
        self.displacement.fill(0.0);
        Ok(())
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.fill_diagonal(matrix, |i| 1.0 / self.midpoint_factors(i).end);
        Ok(())
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        for (i, value) in displacement.iter_mut().enumerate() {
            let factors = self.midpoint_factors(i);
            *value = factors.start * self.displacement[i] / factors.end;
        }
        Ok(())
    }

    fn commit(&mut self, traction: &[f64]) {
        for (i, traction) in traction.iter().enumerate() {
            let factors = self.midpoint_factors(i);
            self.displacement[i] = (traction + factors.start * self.displacement[i]) / factors.end;
        }
    }

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        let count = self.elements.len();
        self.fill_diagonal(matrix, |i| 1.0 / self.properties.stiffness[i / count]);
        Ok(())
    }

    fn save(&self) -> Result<Vec<f64>> {
        Ok(self.displacement.clone())
    }

    fn restore(&mut self, _: usize, values: &[f64]) -> Result<()> {
        if values.len() != self.displacement.len() {
            return Err(Error::part("bed", "has other cells"));
        }
        self.displacement.copy_from_slice(values);
        Ok(())
    }
}

/// Distance from the origin to where the pulses start, beyond all bases, m.
const PULSE_START_DISTANCE: f64 = 30.0;

/// Smooth pulses along x, along y and upwards, each in another direction of travel.
///
/// The field is turned by quarter turns about the vertical axis.
#[derive(Clone, Copy)]
pub(crate) struct CrossingPulses {
    pub(crate) quarter_turns: usize,
}

/// (1 − cos ωt)² in mm, from the arrival at `distance` on.
fn pulse(time: f64, distance: f64, velocity: f64, frequency: f64) -> f64 {
    let local_time = time - (distance + PULSE_START_DISTANCE) / velocity;
    if local_time > 0.0 {
        1e-3 * (1.0 - (frequency * local_time).cos()).powi(2)
    } else {
        0.0
    }
}

impl FreeField for CrossingPulses {
    fn displacement(&self, _: f64, _: f64) -> [f64; 2] {
        unreachable!("a ground in plan needs three directions")
    }

    fn displacement_at(&self, [mut x, mut y]: [f64; 2], time: f64) -> [f64; 3] {
        for _ in 0..self.quarter_turns {
            (x, y) = (y, -x);
        }
        let mut u = pulse(time, 0.8 * x - 0.6 * y, 200.0, 9.0);
        let mut v = -0.6 * pulse(time, 0.6 * x + 0.8 * y, 150.0, 12.0);
        let up = 0.4 * pulse(time, 0.8 * x + 0.6 * y, 500.0, 15.0);
        for _ in 0..self.quarter_turns {
            (u, v) = (-v, u);
        }
        [u, v, up]
    }
}

/// The same scene in the plane and in a slice of space.
pub(crate) struct SliceScenes {
    pub(crate) plane: SimulationBuilder,
    pub(crate) slice: SimulationBuilder,
}

/// A block of 4 m × 6 m on eight elements of the plane, and a slice of it one metre deep, shaken along x alone.
pub(crate) fn plane_and_slice(
    law: impl Fn() -> Box<dyn InterfaceLaw>,
    motion: &Record,
    time_step: f64,
) -> SliceScenes {
    let plane = Simulation::builder(time_step)
        .structure(RigidBlock::new(4.0, 6.0, 1500.0).unwrap())
        .ground(SpringGround::new(-2.0..2.0, 8, 3e7, 2e7).unwrap().with_dashpots(6e5, 3e5).unwrap())
        .interface(law())
        .motion(motion.clone());
    let boundaries: Vec<f64> = (0..=8).map(|k| -2.0 + 0.5 * f64::from(k)).collect();
    let slice = Simulation::builder(time_step)
        .structure(RigidBody::cuboid([4.0, 1.0, 6.0], 1500.0).unwrap())
        .ground(SpringCells::between(&boundaries, &[-0.5, 0.5], BED_PROPERTIES))
        .interface(law())
        .motion(Triaxial { x: Some(motion.clone()), ..Triaxial::default() });
    SliceScenes { plane, slice }
}

/// Pairs of numbers that are equal in the plane and in such a slice.
///
/// Panics if the slice has another motion than along x, z and about y above `rounding`.
pub(crate) fn equal_in_slices(plane: &State, slice: &State, rounding: f64) -> [[f64; 2]; 4] {
    let u = plane.displacement();
    let v = slice.displacement();
    assert!([v[1], v[3], v[5]].iter().all(|u| u.abs() < rounding), "{v:?}");
    [
        [u[0], v[0]],
        [u[2], -v[4]],
        [plane.base_shear, slice.base_shear],
        [plane.base_moment, -slice.base_moment],
    ]
}
