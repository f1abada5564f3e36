//! Scenes whose steps the study `performance` and the benchmark `step` time.
//!
//! Each scene leaves out computations that its steps do not need.

use basemat::bem::{ElasticGround, Strip};
use basemat::coupled::{Coordinates, Probe, SimulationBuilder, State};
use basemat::fem::{Layer, Material, Mesh};
use basemat::interface::{Bonded, Coulomb, InterfaceLaw};
use basemat::motion::{Baseline, Record, STANDARD_GRAVITY, VerticalIncidence, el_centro_1940};
use basemat::structure::{FemModel, RigidBlock};
use basemat::{Result, Simulation, Soil};

/// Length of an element, m: 1.5 ft.
pub const ELEMENT_LENGTH: f64 = 0.4572;
/// Number of elements on the contact length of the headline problem, 15 ft.
pub const ELEMENT_COUNT: usize = 10;
/// Number of steps of the whole record with [`time_step`].
pub const RECORD_STEPS: usize = 54_000;

/// The soil of the headline problem: ν = 1/3, waves of 650 and 1300 ft/s.
pub fn soil() -> Result<Soil> {
    Soil::from_wave_speeds(198.12, 396.24, 1804.0)
}

/// Time step in which a pressure wave crosses half an element, s.
pub fn time_step() -> f64 {
    0.5 * ELEMENT_LENGTH / 396.24
}

/// A strip of `count` equal elements.
pub fn strip(count: usize) -> Result<Strip> {
    let half = 0.5 * ELEMENT_LENGTH * count as f64;
    Strip::uniform(-half..half, count)
}

/// The headline problem without an interface law, and its ground.
///
/// It is the paper's model under El Centro: a basemat and twelve layers of the containment, 35 ft high in all.
pub fn headline(count: usize) -> Result<(SimulationBuilder, ElasticGround)> {
    let half = 0.5 * ELEMENT_LENGTH * count as f64;
    let psf = 47.880_259;
    let slug_per_cubic_foot = 515.378_818;
    let layer_height = 35.0 * 0.3048 / 13.0;
    let foundation = Material::new(106_560_369.0 * psf, 1.0 / 3.0, 3.043_48 * slug_per_cubic_foot)?;
    let superstructure =
        Material::new(106_577_648.0 * psf, 1.0 / 3.0, 0.590_06 * slug_per_cubic_foot)?;
    let layers = [
        Layer::new(layer_height, 1, foundation),
        Layer::new(12.0 * layer_height, 12, superstructure),
    ];
    let tower = FemModel::on_base(Mesh::layered_block(-half..half, ELEMENT_COUNT, &layers)?)?;
    let builder = Simulation::builder(time_step())
        .structure(tower)
        .motion(el_centro_1940())
        .gravity(STANDARD_GRAVITY);
    Ok((builder, ElasticGround::new(soil()?, strip(count)?)?))
}

/// El Centro, at rest at its end, accelerations for `duration` seconds.
pub fn repeated_record(duration: f64) -> Result<Record> {
    let record = el_centro_1940().with_baseline(Baseline::RestToRest { degree: 5 })?;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "minutes at most")]
    let sample_count = 2 + (duration / record.time_step()).ceil() as usize;
    let accelerations = record.accelerations().iter().copied().cycle().take(sample_count);
    Record::new(record.time_step(), accelerations.collect())
}

/// A scene of the table of step times.
pub struct TimedScene {
    pub name: &'static str,
    /// Computations that its steps do not need.
    pub left_out: &'static str,
    pub make: fn(SimulationBuilder) -> Result<SimulationBuilder>,
    /// Quantity that an observer reads after each step.
    pub observe: fn(&State) -> f64,
}

fn friction(builder: SimulationBuilder, friction: f64) -> Result<SimulationBuilder> {
    Ok(builder.interface(Coulomb::new(friction)?))
}

fn vertical(builder: SimulationBuilder, law: impl InterfaceLaw + 'static) -> SimulationBuilder {
    builder.interface(law).motion(VerticalIncidence {
        vertical: Some(el_centro_1940()),
        ..VerticalIncidence::default()
    })
}

fn read_nothing(_: &State) -> f64 {
    0.0
}

/// All scenes of the table.
pub const TIMED_SCENES: [TimedScene; 12] = [
    TimedScene {
        name: "bonded",
        left_out: "the mode search: one solve with factors made once",
        make: |builder| Ok(builder.interface(Bonded)),
        observe: read_nothing,
    },
    TimedScene {
        name: "bonded, without energy balance",
        left_out: "the mode search, the energy balance",
        make: |builder| Ok(builder.interface(Bonded).without_energy_balance()),
        observe: read_nothing,
    },
    TimedScene {
        name: "bonded, without weight",
        left_out: "the mode search; by `build` the static state",
        make: |builder| Ok(builder.interface(Bonded).gravity(0.0)),
        observe: read_nothing,
    },
    TimedScene {
        name: "bonded, symmetric load",
        left_out: "the mode search; symmetry is not made use of",
        make: |builder| Ok(vertical(builder, Bonded)),
        observe: read_nothing,
    },
    TimedScene {
        name: "frictionless, vertical motion",
        left_out: "tangential tractions: a system of Q instead of 2Q; symmetry is not made use of",
        make: |builder| Ok(vertical(builder, Coulomb::new(0.0)?)),
        observe: read_nothing,
    },
    TimedScene {
        name: "uplift only",
        left_out: "elements that are open: no degrees of freedom",
        make: |builder| Ok(builder.interface(Coulomb::uplift_only())),
        observe: read_nothing,
    },
    TimedScene {
        name: "uplift and sliding, friction 0.4",
        left_out: "the same; no observers: nothing of the structure's interior is computed",
        make: |builder| friction(builder, 0.4),
        observe: read_nothing,
    },
    TimedScene {
        name: "the same, without energy balance",
        left_out: "the energy balance",
        make: |builder| friction(builder.without_energy_balance(), 0.4),
        observe: read_nothing,
    },
    TimedScene {
        name: "the same, three probes",
        left_out: "degrees of freedom that no probe asks for",
        make: |builder| {
            let probes = [("a", 0), ("b", 1), ("c", 2)]
                .map(|(name, dof)| Probe::displacement(name, vec![(dof, 1.0)]));
            friction(builder.probes(probes), 0.4)
        },
        observe: read_nothing,
    },
    TimedScene {
        name: "the same, all displacements read at every step",
        left_out: "nothing",
        make: |builder| friction(builder, 0.4),
        observe: |state| state.absolute_displacement().iter().sum(),
    },
    TimedScene {
        name: "the same, in degrees of freedom instead of modes",
        left_out: "the modes: back-substitution with sparse factors",
        make: |builder| friction(builder.coordinates(Coordinates::Physical), 0.4),
        observe: read_nothing,
    },
    TimedScene {
        name: "rigid block, friction 0.4",
        left_out: "all but three degrees of freedom of the structure",
        make: |builder| {
            let width = ELEMENT_LENGTH * ELEMENT_COUNT as f64;
            friction(builder.structure(RigidBlock::new(width, 35.0 * 0.3048, 400.0)?), 0.4)
        },
        observe: read_nothing,
    },
];

impl TimedScene {
    /// The scene, prepared for `steps` steps.
    pub fn build(&self, steps: usize) -> Result<Simulation> {
        let (builder, ground) = headline(ELEMENT_COUNT)?;
        (self.make)(builder.ground(ground).expected_steps(steps))?.build()
    }

    /// Advances by `steps` steps; returns the sum of the values that the observer read.
    pub fn march(&self, simulation: &mut Simulation, steps: usize) -> Result<f64> {
        let mut sum = 0.0;
        for _ in 0..steps {
            sum += (self.observe)(simulation.step()?);
        }
        Ok(sum)
    }
}
