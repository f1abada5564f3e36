//! GOAL: the energy balance closes around a trench in every scene, and no run panics.
//! SCENE: blocks and buildings in trenches of 0.25 to 2 half widths in half-planes, layers on rock and on rigid bedrock,
//! with friction from 0 to 10, K₀ from 0 to 2, shaking of 0.3 to 8 g, and backfill under loads. HEAVY_TESTS: 200 scenes,
//! else 6.
//! REFERENCE: the energy balance.

use basemat::bem::SharedKernels;
use basemat::bem::embedded::{Trench, TrenchElements, TrenchGround};
use basemat::bem::layered::Stages;
use basemat::coupled::{EnergyBalance, Face, Load, State};
use basemat::interface::{Bonded, Coulomb, InterfaceLaw, Yielding};
use basemat::motion::{Record, STANDARD_GRAVITY, VerticalIncidence, el_centro_1940};
use basemat::site::TrenchMotion;
use basemat::soil::{Elastic, GeneralizedMaxwell, SoilProfile};
use basemat::structure::{Bilinear, RigidBlock, ShearBuilding, Storey, Structure, WithWalls};
use basemat::{Error, Result, Simulation, Soil, unobserved};

use basemat_problems::heavy;
use basemat_problems::random::Random;

const SCENES_PER_TRENCH: u64 = 8;
const RUN_STEPS: usize = 96;

/// A trench with its soil, and the convolution weights of all its scenes.
struct TrenchSite {
    half_width: f64,
    depth: f64,
    profile: SoilProfile,
    trench: Trench,
    base_elements: usize,
    wall_elements: usize,
    stages: Stages,
    backfill: Option<Soil>,
    time_step: f64,
    kernels: SharedKernels,
}

/// Soil of this shear-wave speed (m/s).
fn random_soil(random: &mut Random, speed: f64) -> Result<Soil> {
    let poisson = random.within(0.1, 0.45);
    Soil::from_shear_wave_speed(speed, poisson, random.within(1600.0, 2100.0))
}

fn damping(ratio: f64) -> Result<GeneralizedMaxwell> {
    GeneralizedMaxwell::constant_q(ratio, [0.1, 30.0], 1.0)
}

impl TrenchSite {
    fn new(random: &mut Random) -> Result<Self> {
        let half_width = random.log_within(2.0, 10.0);
        let depth = half_width * random.log_within(0.25, 2.0);
        let speed = random.log_within(80.0, 500.0);
        let top = random_soil(random, speed)?;
        let profile = match random.pick(&[0, 0, 1, 2]) {
            0 => SoilProfile::on_half_plane(top),
            1 => {
                let contrast = random.within(1.2, 4.0);
                SoilProfile::on_half_plane(random_soil(random, contrast * speed)?)
                    .with_bedrock_damping(damping(0.01)?)
                    .with_layer(top, random.within(0.3, 2.5) * depth)?
                    .with_damping(damping(0.05)?)
            }
            _ => SoilProfile::on_rigid_bedrock()
                .with_layer(top, random.within(0.3, 0.8) * depth)?
                .with_damping(damping(random.within(0.02, 0.1))?)
                .with_layer(random_soil(random, 1.5 * speed)?, random.within(0.8, 2.0) * depth)?
                .with_damping(damping(0.03)?),
        };
        let backfill =
            if random.chance(0.2) { Some(random_soil(random, 0.5 * speed)?) } else { None };
        let [base_elements, wall_elements] = random.pick(&[[2, 2], [4, 2], [4, 3]]);
        Ok(Self {
            half_width,
            depth,
            profile,
            trench: Trench::new(-half_width..half_width, depth)?,
            base_elements,
            wall_elements,
            stages: random.pick(&[Stages::Two, Stages::Two, Stages::Three]),
            backfill,
            time_step: random.log_within(0.05, 1.0) * half_width / speed,
            kernels: SharedKernels::default(),
        })
    }

    fn elements(&self) -> Result<TrenchElements> {
        self.trench.elements(self.base_elements, self.wall_elements)
    }

    fn ground(&self, pressure_ratio: f64) -> Result<TrenchGround> {
        let ground = TrenchGround::new(self.profile.clone(), self.elements()?)?
            .with_stages(self.stages)
            .with_pressure_at_rest(pressure_ratio)?;
        let ground = match self.backfill {
            Some(soil) => ground.with_backfill(0.5 * self.half_width, soil, Elastic)?,
            None => ground,
        };
        Ok(ground.with_shared_kernels(&self.kernels))
    }

    /// A pulse, or a part of El Centro as long as the run, after a quiet start.
    fn record(&self, random: &mut Random) -> Result<Record> {
        let duration = RUN_STEPS as f64 * self.time_step;
        let peak = STANDARD_GRAVITY * random.log_within(0.3, 8.0);
        let record = if random.chance(0.5) {
            let rate = random.within(1.0, 2.0) * std::f64::consts::TAU / duration;
            Record::from_fn(self.time_step, duration, |time: f64| {
                let square = (rate * time - 3.0).powi(2);
                (1.0 - 2.0 * square) * (-square).exp()
            })?
        } else {
            el_centro_1940().trimmed(1.0, (1.0 + duration).clamp(2.0, 25.0))?
        };
        record.scaled_to_peak(peak)?.padded(random.within(0.0, 0.1) * duration, 0.0)
    }

    fn structure(&self, random: &mut Random) -> Result<WithWalls> {
        let width = 2.0 * self.half_width;
        let height = self.depth + random.log_within(0.2, 4.0) * self.half_width;
        let density = random.log_within(200.0, 3000.0);
        if random.chance(0.5) {
            return WithWalls::new(RigidBlock::new(width, height, density)?, self.depth);
        }
        let mass = 0.25 * density * width * height;
        let rate = std::f64::consts::TAU * random.log_within(0.3, 10.0);
        let storey = Storey::new(height / 3.0, mass, 5.0 * mass * rate.powi(2));
        let inertia = mass * width * width / 12.0;
        let mut building = ShearBuilding::new(width, mass, inertia, &[storey; 3])?;
        if random.chance(0.5) {
            let yield_force = random.within(0.1, 1.0) * mass * STANDARD_GRAVITY;
            building = building.with_law(0, Bilinear::new(storey.stiffness, yield_force, 0.05)?)?;
        }
        let building: Box<dyn Structure> = Box::new(building.with_stiffness_damping(0.02)?);
        WithWalls::new(building, self.depth)
    }

    fn laws(&self, random: &mut Random) -> Result<Vec<Box<dyn InterfaceLaw>>> {
        let frictions = [0.0, 0.05, 0.2, 0.5, 1.0, 3.0, 10.0];
        let base_friction = random.pick(&frictions);
        let wall_friction = random.pick(&frictions);
        let elements = self.elements()?;
        let base = Coulomb::new(base_friction)?;
        let wall = Coulomb::new(wall_friction)?;
        Ok(match random.pick(&[0, 0, 0, 0, 1, 2]) {
            0 => elements.interfaces(base, wall),
            1 => elements.interfaces(Bonded, wall),
            _ => {
                // More than K₀ times the pressure of the soil above.
                let strength = random.within(2.5, 6.0) * 2100.0 * STANDARD_GRAVITY * self.depth;
                elements.interfaces(base, Yielding::new(strength, wall_friction)?)
            }
        })
    }
}

/// Largest violations of the energy balance in a run, and the contact that occurred.
#[derive(Debug, Default)]
struct RunExtremes {
    previous_balance: EnergyBalance,
    /// Largest decreases of energies that never decrease.
    contact_decrease: f64,
    hysteresis_decrease: f64,
    smallest_soil_energy: f64,
    largest_energy: f64,
    walls_opened: bool,
    base_opened: bool,
    slid: bool,
}

impl RunExtremes {
    fn update(&mut self, state: &State) {
        let balance = state.energy_balance;
        for energy in [
            balance.kinetic,
            balance.strain,
            balance.soil,
            balance.contact,
            balance.static_contact,
            balance.input,
        ] {
            self.largest_energy = self.largest_energy.max(energy.abs());
        }
        self.contact_decrease =
            self.contact_decrease.max(self.previous_balance.contact - balance.contact);
        self.hysteresis_decrease =
            self.hysteresis_decrease.max(self.previous_balance.hysteresis - balance.hysteresis);
        self.smallest_soil_energy = self.smallest_soil_energy.min(balance.soil);
        self.previous_balance = balance;
        self.walls_opened |= state.face(Face::LeftWall).open_fraction > 0.0;
        self.walls_opened |= state.face(Face::RightWall).open_fraction > 0.0;
        self.base_opened |= state.uplifted_fraction > 0.0;
        self.slid |= state.modes.iter().any(|mode| mode.is_slip());
    }

    /// Violations over the largest energy of the run.
    fn violations(&self) -> [f64; 3] {
        [
            self.contact_decrease / self.largest_energy,
            self.hysteresis_decrease / self.largest_energy,
            -self.smallest_soil_energy / self.largest_energy,
        ]
    }
}

/// Energy error and extremes of one random scene.
fn run_scene(site: &TrenchSite, random: &mut Random) -> Result<(f64, RunExtremes)> {
    let ground = site.ground(random.within(0.0, 2.0))?;
    let structure = site.structure(random)?;
    let record = site.record(random)?;
    let has_vertical = random.chance(0.5);
    let mut builder = Simulation::builder(site.time_step).interfaces(site.laws(random)?);
    builder = if site.backfill.is_some() {
        // A force at the base: the record times the mass of the soil dug out.
        let excavated_mass = 2.0 * site.half_width * site.depth * 1800.0;
        builder.load(Load::record(0, &record, excavated_mass))
    } else {
        let vertical = if has_vertical { Some(record.scaled(-0.6)?) } else { None };
        let surface = VerticalIncidence { horizontal: Some(record), vertical };
        builder.motion(TrenchMotion::new(&ground, surface, &mut unobserved)?)
    };
    let mut simulation =
        builder.structure(structure).ground(ground).expected_steps(RUN_STEPS).build()?;
    let mut extremes = RunExtremes::default();
    let run = simulation.run(RUN_STEPS, |state| extremes.update(state))?;
    Ok((run.energy_error, extremes))
}

#[test]
fn energy_balance_closes_around_random_trenches() {
    let (trenches, scenes) = if heavy() { (25, SCENES_PER_TRENCH) } else { (2, 3) };
    let mut largest_error = 0.0_f64;
    let mut largest_violation = 0.0_f64;
    let mut errors = vec![];
    let mut runs = 0;
    let mut runs_with_open_walls = 0;
    let mut runs_with_open_base = 0;
    let mut runs_with_slip = 0;
    for trench in 0..trenches {
        let mut random = Random(4500 + trench);
        let site = TrenchSite::new(&mut random).unwrap();
        for scene in 0..scenes {
            let mut random = Random(1000 * trench + scene);
            let (error, extremes) = match run_scene(&site, &mut random) {
                Ok(result) => result,
                Err(error) => {
                    errors.push((trench, scene, error));
                    continue;
                }
            };
            assert!(error < 1e-9, "{trench} {scene}: {error:e}");
            largest_error = largest_error.max(error);
            for violation in extremes.violations() {
                largest_violation = largest_violation.max(violation);
                assert!(violation < 1e-11, "{trench} {scene}: {extremes:?}");
            }
            runs += 1;
            runs_with_open_walls += usize::from(extremes.walls_opened);
            runs_with_open_base += usize::from(extremes.base_opened);
            runs_with_slip += usize::from(extremes.slid);
        }
    }
    println!(
        "error {largest_error:e}, violation {largest_violation:e}; {runs} runs, walls opened in \
         {runs_with_open_walls}, base in {runs_with_open_base}, slip in {runs_with_slip}; {errors:?}"
    );
    // Scenes are errors only where the input is invalid (motions that the soil amplifies on the way down) or a step
    // fails.
    for (.., error) in &errors {
        assert!(matches!(error, Error::Input { .. } | Error::Step { .. }), "{errors:?}");
    }
    assert!(10 * runs >= 9 * usize::try_from(trenches * scenes).unwrap());
    for count in [runs_with_open_walls, runs_with_open_base, runs_with_slip] {
        assert!(3 * count > runs, "{count} of {runs}");
    }
}
