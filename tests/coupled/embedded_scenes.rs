//! GOAL: no energy is lost or found around a trench, whatever the scene; no run panics.
//! SCENE: blocks and buildings in trenches of 0.25 to 2 half widths in half-planes, layers on rock and on rigid bedrock,
//! with friction from 0 to 10, K₀ from 0 to 2, shaking of 0.3 to 8 g, and backfill under loads. HEAVY_TESTS: 200 scenes,
//! else 6.
//! REFERENCE: the energy balance.

use basemat::bem::SharedKernels;
use basemat::bem::embedded::{Trench, TrenchGround};
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

const SCENES_OF_A_TRENCH: u64 = 8;
const STEPS: usize = 96;

/// A trench with its soil, and the weights of all its scenes.
struct Site {
    half: f64,
    depth: f64,
    profile: SoilProfile,
    trench: Trench,
    counts: [usize; 2],
    stages: Stages,
    backfill: Option<Soil>,
    step: f64,
    kernels: SharedKernels,
}

impl Site {
    fn new(random: &mut Random) -> Result<Self> {
        let half = random.log_within(2.0, 10.0);
        let depth = half * random.log_within(0.25, 2.0);
        let soil = |random: &mut Random, speed: f64| {
            let poisson = random.within(0.1, 0.45);
            Soil::from_shear_wave_speed(speed, poisson, random.within(1600.0, 2100.0))
        };
        let speed = random.log_within(80.0, 500.0);
        let damping = |ratio: f64| GeneralizedMaxwell::constant_q(ratio, [0.1, 30.0], 1.0);
        let top = soil(random, speed)?;
        let profile = match random.pick(&[0, 0, 1, 2]) {
            0 => SoilProfile::on_half_plane(top),
            1 => {
                let contrast = random.within(1.2, 4.0);
                SoilProfile::on_half_plane(soil(random, contrast * speed)?)
                    .with_bedrock_damping(damping(0.01)?)
                    .with_layer(top, random.within(0.3, 2.5) * depth)?
                    .with_damping(damping(0.05)?)
            }
            _ => SoilProfile::on_rigid_bedrock()
                .with_layer(top, random.within(0.3, 0.8) * depth)?
                .with_damping(damping(random.within(0.02, 0.1))?)
                .with_layer(soil(random, 1.5 * speed)?, random.within(0.8, 2.0) * depth)?
                .with_damping(damping(0.03)?),
        };
        let backfill = if random.chance(0.2) { Some(soil(random, 0.5 * speed)?) } else { None };
        Ok(Self {
            half,
            depth,
            profile,
            trench: Trench::new(-half..half, depth)?,
            counts: random.pick(&[[2, 2], [4, 2], [4, 3]]),
            stages: random.pick(&[Stages::Two, Stages::Two, Stages::Three]),
            backfill,
            step: random.log_within(0.05, 1.0) * half / speed,
            kernels: SharedKernels::default(),
        })
    }

    fn ground(&self, at_rest: f64) -> Result<TrenchGround> {
        let [base, wall] = self.counts;
        let ground = TrenchGround::new(self.profile.clone(), self.trench.elements(base, wall)?)?
            .with_stages(self.stages)
            .with_pressure_at_rest(at_rest)?;
        let ground = match self.backfill {
            Some(soil) => ground.with_backfill(0.5 * self.half, soil, Elastic)?,
            None => ground,
        };
        Ok(ground.with_shared_kernels(&self.kernels))
    }

    /// Two periods in the run, or a part of El Centro that is as long; quiet before.
    fn record(&self, random: &mut Random) -> Result<Record> {
        let duration = STEPS as f64 * self.step;
        let peak = STANDARD_GRAVITY * random.log_within(0.3, 8.0);
        let record = if random.chance(0.5) {
            let rate = random.within(1.0, 2.0) * std::f64::consts::TAU / duration;
            let pulse = |t: f64| {
                let x = (rate * t - 3.0).powi(2);
                (1.0 - 2.0 * x) * (-x).exp()
            };
            Record::from_fn(self.step, duration, pulse)?
        } else {
            let all = el_centro_1940();
            all.trimmed(1.0, (1.0 + duration).clamp(2.0, 25.0))?
        };
        record.scaled_to_peak(peak)?.padded(random.within(0.0, 0.1) * duration, 0.0)
    }

    fn structure(&self, random: &mut Random) -> Result<WithWalls> {
        let width = 2.0 * self.half;
        let height = self.depth + random.log_within(0.2, 4.0) * self.half;
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
            let share = random.within(0.1, 1.0) * mass * STANDARD_GRAVITY;
            building = building.with_law(0, Bilinear::new(storey.stiffness, share, 0.05)?)?;
        }
        let building: Box<dyn Structure> = Box::new(building.with_stiffness_damping(0.02)?);
        WithWalls::new(building, self.depth)
    }

    fn laws(&self, random: &mut Random) -> Result<Vec<Box<dyn InterfaceLaw>>> {
        let [base, wall] = self.counts;
        let elements = self.trench.elements(base, wall)?;
        let mut friction = || random.pick(&[0.0, 0.05, 0.2, 0.5, 1.0, 3.0, 10.0]);
        let [of_base, of_walls] = [(); 2].map(|()| friction());
        Ok(match random.pick(&[0, 0, 0, 0, 1, 2]) {
            0 => elements.interfaces(Coulomb::new(of_base)?, Coulomb::new(of_walls)?),
            1 => elements.interfaces(Bonded, Coulomb::new(of_walls)?),
            _ => {
                // More than K₀ times the pressure of the soil above.
                let most = random.within(2.5, 6.0) * 2100.0 * STANDARD_GRAVITY * self.depth;
                elements.interfaces(Coulomb::new(of_base)?, Yielding::new(most, of_walls)?)
            }
        })
    }
}

/// Terms of the energy balance that never fall, and the largest fall of both.
#[derive(Debug, Default)]
struct Seen {
    before: EnergyBalance,
    falls: [f64; 2],
    least_soil: f64,
    largest: f64,
    opened: [bool; 2],
    slid: bool,
}

impl Seen {
    fn see(&mut self, state: &State) {
        let own = state.energy_balance;
        let all = [own.kinetic, own.strain, own.soil, own.contact, own.static_contact, own.input];
        self.largest = all.iter().fold(self.largest, |most, term| most.max(term.abs()));
        self.falls[0] = self.falls[0].max(self.before.contact - own.contact);
        self.falls[1] = self.falls[1].max(self.before.hysteresis - own.hysteresis);
        self.least_soil = self.least_soil.min(own.soil);
        self.before = own;
        let walls = [Face::LeftWall, Face::RightWall].map(|wall| state.face(wall).open_fraction);
        self.opened[0] |= walls.iter().any(|open| *open > 0.0);
        self.opened[1] |= state.uplifted_fraction > 0.0;
        self.slid |= state.modes.iter().any(|mode| mode.is_slip());
    }
}

/// One scene: its largest violation of the balance, and what was seen.
fn run(site: &Site, random: &mut Random) -> Result<(f64, Seen)> {
    let ground = site.ground(random.within(0.0, 2.0))?;
    let structure = site.structure(random)?;
    let record = site.record(random)?;
    let vertical = random.chance(0.5);
    let mut builder = Simulation::builder(site.step).interfaces(site.laws(random)?);
    builder = if site.backfill.is_some() {
        // A force at the base, as large as the record's times the soil dug out.
        let dug = 2.0 * site.half * site.depth * 1800.0;
        builder.load(Load::record(0, &record, dug))
    } else {
        let vertical = if vertical { Some(record.scaled(-0.6)?) } else { None };
        let surface = VerticalIncidence { horizontal: Some(record), vertical };
        builder.motion(TrenchMotion::new(&ground, surface, &mut unobserved)?)
    };
    let mut simulation =
        builder.structure(structure).ground(ground).expected_steps(STEPS).build()?;
    let mut seen = Seen::default();
    let run = simulation.run(STEPS, |state| seen.see(state))?;
    Ok((run.energy_error, seen))
}

#[test]
fn energy_balance_closes_around_random_trenches() {
    let (trenches, scenes) = if heavy() { (25, SCENES_OF_A_TRENCH) } else { (2, 3) };
    let (mut worst, mut errors) = ([0.0_f64; 4], vec![]);
    let mut counts = [0; 4];
    for trench in 0..trenches {
        let mut random = Random(4500 + trench);
        let site = Site::new(&mut random).unwrap();
        for scene in 0..scenes {
            let mut random = Random(1000 * trench + scene);
            let (error, seen) = match run(&site, &mut random) {
                Ok(found) => found,
                Err(error) => {
                    errors.push((trench, scene, error));
                    continue;
                }
            };
            assert!(error < 1e-9, "{trench} {scene}: {error:e}");
            let least = -seen.least_soil;
            let parts = [
                error,
                seen.falls[0] / seen.largest,
                seen.falls[1] / seen.largest,
                least / seen.largest,
            ];
            worst.iter_mut().zip(parts).for_each(|(worst, own)| *worst = worst.max(own));
            assert!(parts[1..].iter().all(|part| *part < 1e-11), "{trench} {scene}: {seen:?}");
            let happened = [true, seen.opened[0], seen.opened[1], seen.slid];
            counts.iter_mut().zip(happened).for_each(|(count, own)| *count += usize::from(own));
        }
    }
    println!("worst {worst:?}; runs, walls opened, base opened, slid {counts:?}; {errors:?}");
    // Motions that the soil amplifies on the way down have an error of their own.
    let refused = |error: &Error| matches!(error, Error::Input { .. } | Error::Step { .. });
    assert!(errors.iter().all(|(.., error)| refused(error)), "{errors:?}");
    let all = usize::try_from(trenches * scenes).unwrap();
    // A third of the scenes or more open their walls, open their base, slide.
    assert!(10 * counts[0] >= 9 * all && counts[1..].iter().all(|own| 3 * own > counts[0]));
}
