//! Recipes of scenes: plain data that proptest can shrink, and simulations built from them.

use basemat::bem::{ElasticGround, Grading, SpringGround, Strip};
use basemat::coupled::{
    Coordinates, DissipativeMidpoint, GravityStage, HhtAlpha, Midpoint, Newmark, SimulationBuilder,
    State, Theta,
};
use basemat::fem::{Layer, Material, Mesh, Quad8, Quad8Integration};
use basemat::history::HistoryMethod;
use basemat::interface::{Bonded, Coulomb, ThinLayer};
use basemat::motion::FreeField;
use basemat::structure::{
    CraigBampton, FemModel, RayleighDamping, RigidBlock, ShearBuilding, Storey,
};
use basemat::{Error, Simulation, Soil};

use basemat_problems::scenes::{SCENE_GRAVITY, SI_UNITS, UnitFrame};

use super::shaking::{Shaking, ShakingKind};

/// Steps of a run.
pub(crate) const RUN_STEPS: usize = 80;
/// Width of the base, m.
pub(crate) const BASE_WIDTH: f64 = 4.0;

#[derive(Debug, Clone, Copy)]
pub(crate) enum BuildingRecipe {
    Block { height: f64, density: f64 },
    Tower(TowerRecipe),
    Storeys { count: usize, stiffness: f64, damped: bool },
}

/// A block of finite elements.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TowerRecipe {
    pub(crate) height: f64,
    pub(crate) rows: usize,
    pub(crate) columns: usize,
    /// Young's modulus, Pa.
    pub(crate) young: f64,
    pub(crate) poisson: f64,
    pub(crate) damped: bool,
    pub(crate) form: TowerForm,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum TowerForm {
    Quad4,
    Quad8,
    /// Four-node elements, reduced to the base and two modes.
    Reduced,
}

impl TowerRecipe {
    fn mesh(&self, frame: UnitFrame) -> Result<Mesh, Error> {
        let material =
            Material::new(self.young * frame.pressure(), self.poisson, 2000.0 * frame.density())?;
        let half = 0.5 * BASE_WIDTH * frame.length;
        let height = self.height * frame.length;
        if self.form != TowerForm::Quad8 {
            let layers = [Layer::new(height, self.rows, material)];
            return Mesh::layered_block(-half..half, self.columns, &layers);
        }
        // Nodes at all crossings of a grid of half elements but the middles.
        let half_columns = 2 * self.columns;
        let half_rows = 2 * self.rows;
        let mut mesh = Mesh::new();
        let mut nodes = vec![vec![0; half_columns + 1]; half_rows + 1];
        for (j, row) in nodes.iter_mut().enumerate() {
            for (i, node) in row.iter_mut().enumerate() {
                if i % 2 == 0 || j % 2 == 0 {
                    let x = half * (2.0 * i as f64 / half_columns as f64 - 1.0);
                    *node = mesh.add_node(x, height * j as f64 / half_rows as f64)?;
                }
            }
        }
        // A single element with reduced integration is a mechanism.
        let is_single = self.columns * self.rows == 1;
        let integration =
            if is_single { Quad8Integration::Full } else { Quad8Integration::default() };
        for row in 0..self.rows {
            for column in 0..self.columns {
                let offsets = [[0, 0], [2, 0], [2, 2], [0, 2], [1, 0], [2, 1], [1, 2], [0, 1]];
                let element = offsets.map(|[a, b]| nodes[2 * row + b][2 * column + a]);
                mesh.add(Quad8::new(element, material).with_integration(integration))?;
            }
        }
        Ok(mesh)
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum GroundRecipe {
    HalfPlane { graded: bool, poisson: f64, history: HistoryMethod },
    Springs { dashpots: bool },
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum LawRecipe {
    Coulomb(f64),
    UpliftOnly,
    Bonded,
    /// Friction, and ratio of the stiffness that remains after debonding.
    ThinLayer(f64, f64),
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum SchemeRecipe {
    Midpoint,
    Theta(f64),
    Dissipative(f64),
    Newmark(f64),
    Hht(f64),
}

/// A scene in SI units.
#[derive(Debug, Clone)]
pub(crate) struct SceneRecipe {
    pub(crate) building: BuildingRecipe,
    pub(crate) ground: GroundRecipe,
    pub(crate) elements: usize,
    pub(crate) law: LawRecipe,
    pub(crate) scheme: SchemeRecipe,
    pub(crate) coordinates: Coordinates,
    pub(crate) gravity_stage: GravityStage,
    pub(crate) kind: ShakingKind,
    /// Approximate acceleration of the ground, relative to gravity.
    pub(crate) strength: f64,
    /// c_P Δt relative to the mean element length.
    pub(crate) courant: f64,
    /// Shear modulus of the soil, Pa.
    pub(crate) modulus: f64,
    /// Whether there is no gravity, so that a base that can open moves away.
    pub(crate) weightless: bool,
}

impl SceneRecipe {
    fn soil(&self, frame: UnitFrame) -> Soil {
        let poisson = match self.ground {
            GroundRecipe::HalfPlane { poisson, .. } => poisson,
            GroundRecipe::Springs { .. } => 0.3,
        };
        let modulus = self.modulus * frame.pressure();
        Soil::new(modulus, poisson, 1900.0 * frame.density()).unwrap()
    }

    /// Time step in the units of the frame.
    pub(crate) fn time_step(&self, frame: UnitFrame) -> f64 {
        let length = BASE_WIDTH / self.elements as f64 * frame.length;
        self.courant * length / self.soil(frame).pressure_wave_speed()
    }

    /// Friction coefficient, infinite where nothing slides.
    pub(crate) fn friction(&self) -> f64 {
        match self.law {
            LawRecipe::Coulomb(friction) | LawRecipe::ThinLayer(friction, _) => friction,
            LawRecipe::UpliftOnly | LawRecipe::Bonded => f64::INFINITY,
        }
    }

    /// Weight of the structure in SI units, N/m.
    pub(crate) fn weight(&self) -> f64 {
        let mass = match self.building {
            BuildingRecipe::Block { height, density } => BASE_WIDTH * height * density,
            BuildingRecipe::Tower(TowerRecipe { height, .. }) => BASE_WIDTH * height * 2000.0,
            BuildingRecipe::Storeys { count, .. } => 3e4 + 10e3 * count as f64,
        };
        mass * SCENE_GRAVITY
    }

    /// Rounding of the static state, relative to the weight: rounding of the stiffness forces of a tower, of more or
    /// less flat elements, on a settlement of soft soil.
    pub(crate) fn static_rounding(&self) -> f64 {
        let BuildingRecipe::Tower(TowerRecipe { height, rows, columns, young, poisson, .. }) =
            self.building
        else {
            return 0.0;
        };
        let aspect = BASE_WIDTH / columns as f64 / (height / rows as f64);
        let stiffness = young / (1.0 - 2.0 * poisson) * aspect.max(1.0 / aspect);
        10.0 * f64::EPSILON * stiffness / self.modulus
    }

    /// The scene without reduction: a reduced tower has the rounding of the unreduced stiffness.
    pub(crate) fn unreduced(&self) -> Self {
        let mut unreduced_recipe = self.clone();
        if let BuildingRecipe::Tower(TowerRecipe { form, .. }) = &mut unreduced_recipe.building
            && *form == TowerForm::Reduced
        {
            *form = TowerForm::Quad4;
        }
        unreduced_recipe
    }

    /// Whether pressure and friction obey Signorini and Coulomb exactly.
    pub(crate) fn is_hard(&self) -> bool {
        matches!(self.law, LawRecipe::Coulomb(_) | LawRecipe::UpliftOnly)
    }

    /// Whether elements carry shear while they are open.
    pub(crate) fn has_shear_while_open(&self) -> bool {
        matches!(self.law, LawRecipe::ThinLayer(_, debonded_ratio) if debonded_ratio > 0.0)
    }

    /// Ground motion that begins `delay` steps late.
    fn shaking(&self, frame: UnitFrame, delay: usize) -> Shaking {
        let step = self.time_step(frame);
        let duration = RUN_STEPS as f64 * step;
        Shaking {
            kind: self.kind.clone(),
            // Three periods in the run, peak displacement = acceleration / ω².
            amplitude: self.strength
                * SCENE_GRAVITY
                * frame.acceleration()
                * (duration / 19.0).powi(2),
            sign: frame.sign(),
            delay: delay as f64 * step,
            duration,
        }
    }

    /// Largest second difference of the ground motion over the steps of a run, m/s².
    pub(crate) fn peak_acceleration(&self) -> f64 {
        let step = self.time_step(SI_UNITS);
        let shaking = self.shaking(SI_UNITS, 0);
        let displacements: Vec<[f64; 2]> =
            (0..=3 * RUN_STEPS).map(|k| shaking.displacement(0.0, k as f64 * step)).collect();
        let mut max_difference = 0.0_f64;
        for window in displacements.windows(3) {
            for i in 0..2 {
                let difference = (window[0][i] - 2.0 * window[1][i] + window[2][i]).abs();
                max_difference = max_difference.max(difference);
            }
        }
        max_difference / (step * step)
    }

    /// Simulation whose ground motion begins `delay` steps late.
    pub(crate) fn build(&self, frame: UnitFrame, delay: usize) -> Result<Simulation, Error> {
        self.build_with(frame, self.shaking(frame, delay))
    }

    /// Simulation under another ground motion.
    pub(crate) fn build_with(
        &self,
        frame: UnitFrame,
        motion: impl FreeField + 'static,
    ) -> Result<Simulation, Error> {
        let step = self.time_step(frame);
        let gravity = if self.weightless { 0.0 } else { SCENE_GRAVITY * frame.acceleration() };
        let builder = Simulation::builder(step)
            .motion(motion)
            .gravity(gravity)
            .gravity_stage(self.gravity_stage)
            .coordinates(self.coordinates);
        let builder = self.with_ground(builder, frame)?;
        let builder = self.with_structure(builder, frame)?;
        let builder = match self.law {
            LawRecipe::Coulomb(friction) => builder.interface(Coulomb::new(friction)?),
            LawRecipe::UpliftOnly => builder.interface(Coulomb::uplift_only()),
            LawRecipe::Bonded => builder.interface(Bonded),
            LawRecipe::ThinLayer(friction, debonded_ratio) => {
                let layer = ThinLayer::new(self.soil(frame), frame.length, friction)?;
                builder.interface(layer.with_debonded_ratio(debonded_ratio)?)
            }
        };
        let builder = match self.scheme {
            SchemeRecipe::Midpoint => builder.scheme(Midpoint),
            SchemeRecipe::Theta(theta) => builder.scheme(Theta::new(theta)?),
            SchemeRecipe::Dissipative(gamma) => builder.scheme(DissipativeMidpoint::new(gamma)?),
            SchemeRecipe::Newmark(gamma) => builder.scheme(Newmark::new(gamma, 0.5 * gamma)?),
            SchemeRecipe::Hht(alpha) => builder.scheme(HhtAlpha::new(alpha)?),
        };
        builder.build()
    }

    fn with_ground(
        &self,
        builder: SimulationBuilder,
        frame: UnitFrame,
    ) -> Result<SimulationBuilder, Error> {
        let soil = self.soil(frame);
        let half = 0.5 * BASE_WIDTH * frame.length;
        Ok(match self.ground {
            GroundRecipe::HalfPlane { graded, history, .. } => {
                let grading = if graded { Grading::Cosine } else { Grading::Uniform };
                let strip = Strip::new(-half..half, self.elements, grading)?;
                builder.ground(ElasticGround::new(soil, strip)?.with_history(history).unwrap())
            }
            GroundRecipe::Springs { dashpots } => {
                let stiffness = soil.shear_modulus() / frame.length;
                let bed =
                    SpringGround::new(-half..half, self.elements, stiffness, 0.5 * stiffness)?;
                let impedance =
                    if dashpots { soil.density() * soil.shear_wave_speed() } else { 0.0 };
                builder.ground(bed.with_dashpots(2.0 * impedance, impedance)?)
            }
        })
    }

    fn with_structure(
        &self,
        builder: SimulationBuilder,
        frame: UnitFrame,
    ) -> Result<SimulationBuilder, Error> {
        let width = BASE_WIDTH * frame.length;
        Ok(match self.building {
            BuildingRecipe::Block { height, density } => {
                let height = height * frame.length;
                builder.structure(RigidBlock::new(width, height, density * frame.density())?)
            }
            BuildingRecipe::Tower(tower) => {
                let mut model = FemModel::on_base(tower.mesh(frame)?)?;
                if tower.damped {
                    let frequencies = [2.0 / frame.time, 20.0 / frame.time];
                    model =
                        model.with_rayleigh(RayleighDamping::from_ratios(frequencies, [0.05; 2])?);
                }
                if tower.form == TowerForm::Reduced {
                    builder.structure(CraigBampton::new(2).reduce(model)?)
                } else {
                    builder.structure(model)
                }
            }
            BuildingRecipe::Storeys { count, stiffness, damped } => {
                let mass = frame.mass / frame.length;
                let length = frame.length;
                let storey = Storey::new(3.0 * length, 10e3 * mass, stiffness * frame.pressure());
                let inertia = 5e4 * mass * length * length;
                let building =
                    ShearBuilding::new(width, 3e4 * mass, inertia, &vec![storey; count])?;
                let ratio = if damped { 0.05 } else { 0.0 };
                builder.structure(building.with_stiffness_damping(ratio)?)
            }
        })
    }

    /// All states of a run, the static one first.
    pub(crate) fn run(&self, frame: UnitFrame, delay: usize) -> Result<Vec<State>, Error> {
        let mut simulation = self.build(frame, delay)?;
        let mut states = vec![simulation.state().clone()];
        for _ in 0..RUN_STEPS + delay {
            states.push(simulation.step()?.clone());
        }
        Ok(states)
    }
}
