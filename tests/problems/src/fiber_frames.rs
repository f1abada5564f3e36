//! Frames of beams of fibres on footings that may lift off, and random ones.

use basemat::bem::{ElasticGround, SpringGround};
use basemat::fem::{
    Beam, BeamFormulation, BeamQuadrature, BilinearMoment, BilinearSteel, Concrete, Direction,
    FiberBeam, FiberSection, Hinge, LumpedMass, MenegottoPinto, Mesh,
};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::{Record, el_centro_1940};
use basemat::structure::{DofCombination, FemModel, RayleighDamping};
use basemat::{Result, Simulation, Soil};

use crate::random::Random;

/// Rotational stiffness of a hinge over its plastic moment, 1/rad.
const FOOT_STIFFNESS_RATIO: f64 = 300.0;
/// Stiffness of a hinge between the displacements of its nodes, N/m per metre.
const HINGE_STIFFNESS: f64 = 1.0e10;

/// A plane frame of equal storeys and bays. All is per metre of thickness.
#[derive(Debug, Clone)]
pub struct FiberFrame {
    pub storey_count: usize,
    pub bay_count: usize,
    /// Height of a storey and width of a bay, m.
    pub storey_height: f64,
    pub bay_width: f64,
    /// Elements of each column and of each beam.
    pub division_count: usize,
    pub column: FiberSection,
    pub beam: FiberSection,
    pub formulation: BeamFormulation,
    pub quadrature: BeamQuadrature,
    /// Mass at each joint of beams and columns, kg.
    pub joint_mass: f64,
    /// Width of a footing, m.
    pub footing_width: f64,
    /// Gravity of P–Δ; `None` without.
    pub p_delta_gravity: Option<f64>,
    /// Plastic moment of a hinge at the foot of each column, N m; `None` without hinges.
    pub foot_moment: Option<f64>,
}

/// The model of a frame.
#[derive(Debug)]
pub struct FrameModel {
    pub model: FemModel,
    /// Horizontal displacement of the left end of each floor, from the lowest up.
    pub floors: Vec<DofCombination>,
    /// Number of beams of fibres.
    pub fiber_beam_count: usize,
}

impl FiberFrame {
    /// The frame on footings, one under each column.
    pub fn model(&self) -> Result<FrameModel> {
        let mut mesh = Mesh::new();
        let mut lines = Vec::new();
        let mut last_floor = Vec::new();
        let mut fiber_beam_count = 0;
        for column in 0..=self.bay_count {
            let x = self.bay_width * column as f64;
            let half_width = 0.5 * self.footing_width;
            let [left, foot, right] = [
                mesh.add_node(x - half_width, 0.0)?,
                mesh.add_node(x, 0.0)?,
                mesh.add_node(x + half_width, 0.0)?,
            ];
            mesh.add(Beam::new([left, foot], 30.0e9, 0.8, 0.05, 2500.0)?)?;
            mesh.add(Beam::new([foot, right], 30.0e9, 0.8, 0.05, 2500.0)?)?;
            lines.push(vec![left, foot, right]);
            let column_foot = match self.foot_moment {
                Some(moment) => {
                    let column_foot = mesh.add_node(x, 0.0)?;
                    let law = BilinearMoment::new(moment, FOOT_STIFFNESS_RATIO * moment, 0.01)?;
                    mesh.add(Hinge::new([foot, column_foot], HINGE_STIFFNESS, law)?)?;
                    column_foot
                }
                None => foot,
            };
            last_floor.push(column_foot);
        }
        let mut floor_nodes = Vec::new();
        for storey in 1..=self.storey_count {
            let y = self.storey_height * storey as f64;
            let mut floor = Vec::new();
            for (column, below) in last_floor.iter().enumerate() {
                let joint = mesh.add_node(self.bay_width * column as f64, y)?;
                mesh.add(LumpedMass::new(joint, self.joint_mass)?)?;
                fiber_beam_count += self.add_member(&mut mesh, [*below, joint], &self.column)?;
                floor.push(joint);
            }
            for ends in floor.windows(2) {
                fiber_beam_count += self.add_member(&mut mesh, [ends[0], ends[1]], &self.beam)?;
            }
            floor_nodes.push(floor[0]);
            last_floor = floor;
        }
        let model =
            FemModel::on_foundations(mesh, &lines)?.with_rayleigh(RayleighDamping::new(0.0, 1e-3)?);
        let model = match self.p_delta_gravity {
            Some(gravity) => model.with_p_delta(gravity)?,
            None => model,
        };
        let mut floors = Vec::new();
        for node in floor_nodes {
            floors.push(model.row(node, Direction::X)?);
        }
        Ok(FrameModel { model, floors, fiber_beam_count })
    }

    /// Adds a column or beam in equal elements; returns their number.
    fn add_member(
        &self,
        mesh: &mut Mesh,
        ends: [usize; 2],
        section: &FiberSection,
    ) -> Result<usize> {
        let [start, end] = ends.map(|node| mesh.nodes()[node]);
        let mut previous_node = ends[0];
        for k in 1..=self.division_count {
            let s = k as f64 / self.division_count as f64;
            let next_node = if k == self.division_count {
                ends[1]
            } else {
                mesh.add_node(
                    start[0] + s * (end[0] - start[0]),
                    start[1] + s * (end[1] - start[1]),
                )?
            };
            let beam = FiberBeam::new([previous_node, next_node], section, self.quadrature, 300.0)?;
            mesh.add(beam.with_formulation(self.formulation))?;
            previous_node = next_node;
        }
        Ok(self.division_count)
    }
}

/// Material of the members of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrameLaw {
    Bilinear,
    MenegottoPinto,
    ReinforcedConcrete,
}

pub const FRAME_LAWS: [FrameLaw; 3] =
    [FrameLaw::Bilinear, FrameLaw::MenegottoPinto, FrameLaw::ReinforcedConcrete];

/// Section of a member of this depth, m; steel as an I-section, concrete with two layers of bars.
pub fn member_section(law: FrameLaw, depth: f64) -> Result<FiberSection> {
    let steel_sizes = ([depth, 0.6 * depth], [0.03 * depth, 0.05 * depth], [2, 8]);
    let section = FiberSection::new();
    match law {
        FrameLaw::Bilinear => {
            let steel = BilinearSteel::new(355.0e6, 210.0e9, 0.01)?;
            let (outline, thicknesses, counts) = steel_sizes;
            section.with_i_section(outline, thicknesses, counts, steel)
        }
        FrameLaw::MenegottoPinto => {
            let steel = MenegottoPinto::new(355.0e6, 210.0e9, 0.01)?;
            let (outline, thicknesses, counts) = steel_sizes;
            section.with_i_section(outline, thicknesses, counts, steel)
        }
        FrameLaw::ReinforcedConcrete => {
            let concrete = Concrete::new(30.0e6, 0.002, 15.0e6, 0.01)?;
            let bars = MenegottoPinto::new(500.0e6, 200.0e9, 0.01)?;
            let half = 0.5 * depth;
            let cover = 0.85 * half;
            let bar_area = 0.003 * depth * depth;
            section
                .with_rectangle([[-half, -half], [half, half]], [16, 1], concrete)?
                .with_bars([[-cover, -cover], [-cover, cover]], 3, bar_area, bars)?
                .with_bars([[cover, -cover], [cover, cover]], 3, bar_area, bars)
        }
    }
}

/// Frame of ten storeys and two bays with 300 beams of fibres of five points.
pub fn ten_storey_frame(law: FrameLaw, formulation: BeamFormulation) -> Result<FiberFrame> {
    let depths = match law {
        FrameLaw::ReinforcedConcrete => [0.5, 0.45],
        FrameLaw::Bilinear | FrameLaw::MenegottoPinto => [0.45, 0.4],
    };
    Ok(FiberFrame {
        storey_count: 10,
        bay_count: 2,
        storey_height: 3.2,
        bay_width: 6.0,
        division_count: 6,
        column: member_section(law, depths[0])?,
        beam: member_section(law, depths[1])?,
        formulation,
        quadrature: BeamQuadrature::Lobatto(5),
        joint_mass: 12.0e3,
        footing_width: 3.0,
        p_delta_gravity: None,
        foot_moment: None,
    })
}

/// The ten-storey frame on springs under twice El Centro, free to lift off; `time_step` in s.
pub fn ten_storey_simulation(
    law: FrameLaw,
    formulation: BeamFormulation,
    time_step: f64,
) -> Result<Simulation> {
    let FrameModel { model, .. } = ten_storey_frame(law, formulation)?.model()?;
    Simulation::builder(time_step)
        .ground(SpringGround::under(&model, 4, 2.0e8, 2.0e8)?)
        .structure(model)
        .interface(Coulomb::new(0.7)?)
        .motion(el_centro_1940().scaled(2.0)?)
        .build()
}

/// El Centro from its strong part on, with about this peak, m/s².
fn strong_part(peak: f64) -> Result<Record> {
    let record = el_centro_1940();
    let accelerations = record.accelerations().iter().skip(WEAK_SAMPLES);
    Record::new(record.time_step(), accelerations.map(|a| peak / RECORD_PEAK * a).collect())
}

/// Samples of the record before its strong part.
const WEAK_SAMPLES: usize = 70;
/// Peak of the record, m/s².
const RECORD_PEAK: f64 = 3.13;

/// A random frame with its numbers as text.
#[allow(missing_debug_implementations, reason = "not published")]
pub struct RandomFrame {
    pub simulation: Result<Simulation>,
    pub law: FrameLaw,
    pub text: String,
}

/// The frame of a seed.
pub fn random_frame(seed: u64) -> RandomFrame {
    let mut random = Random(seed);
    let storey_count = random.pick(&[1, 2, 3, 4]);
    let bay_count = random.pick(&[1, 2, 3]);
    let law = random.pick(&FRAME_LAWS);
    let formulation =
        random.pick(&[BeamFormulation::DisplacementBased, BeamFormulation::ForceBased]);
    let quadrature = random.pick(&[
        BeamQuadrature::Lobatto(3),
        BeamQuadrature::Lobatto(5),
        BeamQuadrature::Legendre(2),
        BeamQuadrature::Legendre(4),
    ]);
    let division_count = random.pick(&[1, 2, 3]);
    let storey_height = random.within(2.5, 5.0);
    let bay_width = random.within(3.0, 8.0);
    let depths = [random.within(0.25, 0.6), random.within(0.25, 0.6)];
    let joint_mass = random.log_within(2.0e3, 4.0e4);
    let footing_width = random.within(0.8, 2.5);
    let p_delta_gravity = random.chance(0.4).then_some(9.81);
    let time_step = random.log_within(0.002, 0.02);
    let amplitude = random.log_within(0.5, 15.0);
    let frequency = random.log_within(0.4, 5.0);
    let has_record = random.chance(0.5);
    let is_on_springs = random.chance(0.5);
    let is_bonded = random.chance(0.2);
    let friction = random.within(0.3, 0.9);
    let foot_moment = random.chance(0.3).then(|| random.log_within(3.0e4, 1.0e6));
    let text = format!(
        "seed {seed}: {storey_count} storeys of {storey_height:.1} m, {bay_count} bays of {bay_width:.1} m, {law:?}, \
         {formulation:?}, {quadrature:?}, {division_count} elements a member, depths {depths:.2?}, joint mass \
         {joint_mass:.1e}, hinges of {foot_moment:.0?} N m, P–Δ {}, springs {is_on_springs}, bonded {is_bonded}, record {has_record}, \
         {amplitude:.1} m/s² at {frequency:.1} Hz, Δt {time_step:.4}",
        p_delta_gravity.is_some()
    );
    let build = || -> Result<Simulation> {
        let frame = FiberFrame {
            storey_count,
            bay_count,
            storey_height,
            bay_width,
            division_count,
            column: member_section(law, depths[0])?,
            beam: member_section(law, depths[1])?,
            formulation,
            quadrature,
            joint_mass,
            footing_width,
            p_delta_gravity,
            foot_moment,
        };
        let model = frame.model()?.model;
        let motion = if has_record {
            strong_part(amplitude)?
        } else {
            Record::from_fn(time_step, 1.0 / frequency, |time| {
                amplitude * (std::f64::consts::TAU * frequency * time).sin()
            })?
        };
        let builder = Simulation::builder(time_step).motion(motion);
        let builder = if is_on_springs {
            builder.ground(SpringGround::under(&model, 4, 2.0e8, 1.5e8)?)
        } else {
            builder.ground(ElasticGround::under(Soil::new(1.0e8, 0.3, 2000.0)?, &model, 4)?)
        };
        let builder = builder.structure(model);
        if is_bonded {
            builder.interface(Bonded).build()
        } else {
            builder.interface(Coulomb::new(friction)?).build()
        }
    };
    RandomFrame { simulation: build(), law, text }
}
