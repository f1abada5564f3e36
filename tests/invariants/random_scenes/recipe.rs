//! Random scenes: plain data that proptest can shrink, and how a simulation is built from it.

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
use proptest::prelude::*;

use super::shaking::{Kind, Shaking};
use basemat_problems::scenes::{Frame, GRAVITY, SI};

/// Steps of a run.
pub(crate) const STEPS: usize = 80;
/// Width of the base, m.
pub(crate) const WIDTH: f64 = 4.0;

#[derive(Debug, Clone, Copy)]
pub(crate) enum Building {
    Block { height: f64, density: f64 },
    Tower(Tower),
    Storeys { count: usize, stiffness: f64, damped: bool },
}

/// A block of finite elements.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tower {
    height: f64,
    rows: usize,
    columns: usize,
    young: f64,
    poisson: f64,
    damped: bool,
    form: Form,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Form {
    Quad4,
    Quad8,
    /// Four-node elements, reduced to the base and two modes.
    Reduced,
}

impl Tower {
    fn mesh(&self, frame: Frame) -> Result<Mesh, Error> {
        let material =
            Material::new(self.young * frame.pressure(), self.poisson, 2000.0 * frame.density())?;
        let [half, height] = [0.5 * WIDTH, self.height].map(|length| length * frame.length);
        if self.form != Form::Quad8 {
            let layers = [Layer::new(height, self.rows, material)];
            return Mesh::layered_block(-half..half, self.columns, &layers);
        }
        // Nodes at all crossings of a grid of half elements but the middles.
        let (across, up) = (2 * self.columns, 2 * self.rows);
        let mut mesh = Mesh::new();
        let mut nodes = vec![0; (across + 1) * (up + 1)];
        for (k, node) in nodes.iter_mut().enumerate() {
            let (i, j) = (k % (across + 1), k / (across + 1));
            if i % 2 == 0 || j % 2 == 0 {
                let x = half * (2.0 * i as f64 / across as f64 - 1.0);
                *node = mesh.add_node(x, height * j as f64 / up as f64)?;
            }
        }
        // By itself an element with reduced integration is a mechanism.
        let single = self.columns * self.rows == 1;
        let integration = if single { Quad8Integration::Full } else { Quad8Integration::default() };
        for k in 0..self.columns * self.rows {
            let (i, j) = (2 * (k % self.columns), 2 * (k / self.columns));
            let around = [[0, 0], [2, 0], [2, 2], [0, 2], [1, 0], [2, 1], [1, 2], [0, 1]];
            let at = |[a, b]: [usize; 2]| nodes[(j + b) * (across + 1) + i + a];
            mesh.add(Quad8::new(around.map(at), material).with_integration(integration))?;
        }
        Ok(mesh)
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Bed {
    HalfPlane { graded: bool, poisson: f64, history: HistoryMethod },
    Springs { dashpots: bool },
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Law {
    Coulomb(f64),
    UpliftOnly,
    Bonded,
    /// Friction, and share of the stiffness left in debonding.
    ThinLayer(f64, f64),
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Scheme {
    Midpoint,
    Theta(f64),
    Dissipative(f64),
    Newmark(f64),
    Hht(f64),
}

/// A scene in SI units.
#[derive(Debug, Clone)]
pub(crate) struct Recipe {
    pub(crate) building: Building,
    pub(crate) bed: Bed,
    pub(crate) elements: usize,
    pub(crate) law: Law,
    pub(crate) scheme: Scheme,
    pub(crate) coordinates: Coordinates,
    pub(crate) gravity_stage: GravityStage,
    pub(crate) kind: Kind,
    /// Accelerations of the ground, about: of gravity.
    pub(crate) strength: f64,
    /// c_P Δt over the mean element length.
    pub(crate) courant: f64,
    /// Shear modulus of the soil, Pa.
    pub(crate) modulus: f64,
    /// Without gravity: a base that may open flies off and away.
    pub(crate) weightless: bool,
}

impl Recipe {
    fn soil(&self, frame: Frame) -> Soil {
        let poisson = match self.bed {
            Bed::HalfPlane { poisson, .. } => poisson,
            Bed::Springs { .. } => 0.3,
        };
        let modulus = self.modulus * frame.pressure();
        Soil::new(modulus, poisson, 1900.0 * frame.density()).unwrap()
    }

    /// Time step, s; all in the frame's units.
    pub(crate) fn time_step(&self, frame: Frame) -> f64 {
        let length = WIDTH / self.elements as f64 * frame.length;
        self.courant * length / self.soil(frame).pressure_wave_speed()
    }

    /// Friction coefficient, infinite where nothing slides.
    pub(crate) fn friction(&self) -> f64 {
        match self.law {
            Law::Coulomb(friction) | Law::ThinLayer(friction, _) => friction,
            Law::UpliftOnly | Law::Bonded => f64::INFINITY,
        }
    }

    /// Weight of the structure in SI units, N/m.
    pub(crate) fn weight(&self) -> f64 {
        let mass = match self.building {
            Building::Block { height, density } => WIDTH * height * density,
            Building::Tower(Tower { height, .. }) => WIDTH * height * 2000.0,
            Building::Storeys { count, .. } => 3e4 + 10e3 * count as f64,
        };
        mass * GRAVITY
    }

    /// Rounding of the static state, relative to the weight: rounding of the stiffness forces of a tower, of more or
    /// less flat elements, on a settlement of soft soil.
    pub(crate) fn static_rounding(&self) -> f64 {
        let Building::Tower(Tower { height, rows, columns, young, poisson, .. }) = self.building
        else {
            return 0.0;
        };
        let aspect = WIDTH / columns as f64 / (height / rows as f64);
        let stiffness = young / (1.0 - 2.0 * poisson) * aspect.max(1.0 / aspect);
        10.0 * f64::EPSILON * stiffness / self.modulus
    }

    /// The same scene with no tower reduced: a reduced one keeps the rounding of the whole one's stiffness.
    pub(crate) fn whole(&self) -> Self {
        let mut whole = self.clone();
        if let Building::Tower(Tower { form, .. }) = &mut whole.building
            && *form == Form::Reduced
        {
            *form = Form::Quad4;
        }
        whole
    }

    /// Whether pressure and friction obey Signorini and Coulomb exactly.
    pub(crate) fn is_hard(&self) -> bool {
        matches!(self.law, Law::Coulomb(_) | Law::UpliftOnly)
    }

    /// Whether elements carry shear while they are open.
    pub(crate) fn pulls_while_open(&self) -> bool {
        matches!(self.law, Law::ThinLayer(_, share) if share > 0.0)
    }

    /// Ground motion that begins `delay` steps late.
    fn shaking(&self, frame: Frame, delay: usize) -> Shaking {
        let step = self.time_step(frame);
        let duration = STEPS as f64 * step;
        Shaking {
            kind: self.kind.clone(),
            // Three periods in the run, peak displacement = acceleration / ω².
            amplitude: self.strength * GRAVITY * frame.acceleration() * (duration / 19.0).powi(2),
            sign: frame.sign(),
            delay: delay as f64 * step,
            duration,
        }
    }

    /// Largest second difference of the ground motion over the steps of a run, m/s².
    pub(crate) fn peak_acceleration(&self) -> f64 {
        let (step, shaking) = (self.time_step(SI), self.shaking(SI, 0));
        let at = |k: usize| shaking.displacement(0.0, k as f64 * step);
        let second = |k: usize, i: usize| (at(k - 1)[i] - 2.0 * at(k)[i] + at(k + 1)[i]).abs();
        let peaks = (1..3 * STEPS).flat_map(|k| [second(k, 0), second(k, 1)]);
        peaks.fold(0.0, f64::max) / (step * step)
    }

    /// Simulation whose ground motion begins `delay` steps late.
    pub(crate) fn build(&self, frame: Frame, delay: usize) -> Result<Simulation, Error> {
        self.build_with(frame, self.shaking(frame, delay))
    }

    /// Simulation under another ground motion.
    pub(crate) fn build_with(
        &self,
        frame: Frame,
        motion: impl FreeField + 'static,
    ) -> Result<Simulation, Error> {
        let step = self.time_step(frame);
        let gravity = if self.weightless { 0.0 } else { GRAVITY * frame.acceleration() };
        let builder = Simulation::builder(step)
            .motion(motion)
            .gravity(gravity)
            .gravity_stage(self.gravity_stage)
            .coordinates(self.coordinates);
        let builder = self.with_ground(builder, frame)?;
        let builder = self.with_structure(builder, frame)?;
        let builder = match self.law {
            Law::Coulomb(friction) => builder.interface(Coulomb::new(friction)?),
            Law::UpliftOnly => builder.interface(Coulomb::uplift_only()),
            Law::Bonded => builder.interface(Bonded),
            Law::ThinLayer(friction, share) => {
                let layer = ThinLayer::new(self.soil(frame), frame.length, friction)?;
                builder.interface(layer.with_debonded_ratio(share)?)
            }
        };
        let builder = match self.scheme {
            Scheme::Midpoint => builder.scheme(Midpoint),
            Scheme::Theta(theta) => builder.scheme(Theta::new(theta)?),
            Scheme::Dissipative(gamma) => builder.scheme(DissipativeMidpoint::new(gamma)?),
            Scheme::Newmark(gamma) => builder.scheme(Newmark::new(gamma, 0.5 * gamma)?),
            Scheme::Hht(alpha) => builder.scheme(HhtAlpha::new(alpha)?),
        };
        builder.build()
    }

    fn with_ground(
        &self,
        builder: SimulationBuilder,
        frame: Frame,
    ) -> Result<SimulationBuilder, Error> {
        let soil = self.soil(frame);
        let half = 0.5 * WIDTH * frame.length;
        Ok(match self.bed {
            Bed::HalfPlane { graded, history, .. } => {
                let grading = if graded { Grading::Cosine } else { Grading::Uniform };
                let strip = Strip::new(-half..half, self.elements, grading)?;
                builder.ground(ElasticGround::new(soil, strip)?.with_history(history).unwrap())
            }
            Bed::Springs { dashpots } => {
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
        frame: Frame,
    ) -> Result<SimulationBuilder, Error> {
        let width = WIDTH * frame.length;
        Ok(match self.building {
            Building::Block { height, density } => {
                let (height, density) = (height * frame.length, density * frame.density());
                builder.structure(RigidBlock::new(width, height, density)?)
            }
            Building::Tower(tower) => {
                let mut model = FemModel::on_base(tower.mesh(frame)?)?;
                if tower.damped {
                    let frequencies = [2.0 / frame.time, 20.0 / frame.time];
                    model =
                        model.with_rayleigh(RayleighDamping::from_ratios(frequencies, [0.05; 2])?);
                }
                if tower.form == Form::Reduced {
                    builder.structure(CraigBampton::new(2).reduce(model)?)
                } else {
                    builder.structure(model)
                }
            }
            Building::Storeys { count, stiffness, damped } => {
                let (mass, length) = (frame.mass / frame.length, frame.length);
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
    pub(crate) fn run(&self, frame: Frame, delay: usize) -> Result<Vec<State>, Error> {
        let mut simulation = self.build(frame, delay)?;
        let mut states = vec![simulation.state().clone()];
        for _ in 0..STEPS + delay {
            states.push(simulation.step()?.clone());
        }
        Ok(states)
    }
}

/// 10^x with x uniform.
fn decades(from: f64, to: f64) -> impl Strategy<Value = f64> {
    (from.log10()..to.log10()).prop_map(|power| 10.0_f64.powf(power))
}

fn building() -> impl Strategy<Value = Building> {
    prop_oneof![
        (0.5..10.0, decades(300.0, 3000.0))
            .prop_map(|(height, density)| Building::Block { height, density }),
        tower().prop_map(Building::Tower),
        (1_usize..4, decades(1e6, 1e9), any::<bool>())
            .prop_map(|(count, stiffness, damped)| Building::Storeys { count, stiffness, damped }),
    ]
}

fn tower() -> impl Strategy<Value = Tower> {
    let size = (0.5..10.0, 1_usize..4, 1_usize..5);
    let poisson = prop_oneof![3 => Just(0.2), 1 => 0.0..0.4995];
    let form =
        prop_oneof![3 => Just(Form::Quad4), 1 => Just(Form::Quad8), 1 => Just(Form::Reduced)];
    (size, decades(1e8, 3e10), poisson, any::<bool>(), form).prop_map(
        |((height, rows, columns), young, poisson, damped, form)| Tower {
            height,
            rows,
            columns,
            young,
            poisson,
            damped,
            form,
        },
    )
}

fn bed() -> impl Strategy<Value = Bed> {
    let history = prop::sample::select(vec![
        HistoryMethod::Auto,
        HistoryMethod::Direct,
        HistoryMethod::RelaxedFft,
        HistoryMethod::Exponentials,
    ]);
    prop_oneof![
        3 => (any::<bool>(), prop_oneof![7 => 0.0..0.49, 1 => 0.49..0.4995], history)
            .prop_map(|(graded, poisson, history)| Bed::HalfPlane { graded, poisson, history }),
        1 => any::<bool>().prop_map(|dashpots| Bed::Springs { dashpots }),
    ]
}

fn law(most_friction: f64) -> impl Strategy<Value = Law> {
    let low = most_friction.min(1.0);
    prop_oneof![
        1 => Just(Law::Coulomb(0.0)),
        4 => (0.05..low).prop_map(Law::Coulomb),
        2 => (0.5 * low..most_friction).prop_map(Law::Coulomb),
        // Friction without bound does not decide where the shear goes.
        if most_friction < 1.0 { 0 } else { 2 } => Just(Law::UpliftOnly),
        1 => Just(Law::Bonded),
        2 => (0.0..most_friction, prop::sample::select(vec![0.0, 1e-3]))
            .prop_map(|(friction, share)| Law::ThinLayer(friction, share)),
    ]
}

fn scheme() -> impl Strategy<Value = Scheme> {
    prop_oneof![
        3 => Just(Scheme::Midpoint),
        1 => (0.5..1.0).prop_map(Scheme::Theta),
        1 => (0.5..1.0).prop_map(Scheme::Dissipative),
        1 => (0.5..0.8).prop_map(Scheme::Newmark),
        1 => (-1.0 / 3.0..0.0).prop_map(Scheme::Hht),
    ]
}

/// Scenes with friction of `most_friction` or less (and unbounded where nothing slides).
pub(crate) fn recipes(most_friction: f64) -> impl Strategy<Value = Recipe> {
    let coordinates =
        prop::sample::select(vec![Coordinates::Auto, Coordinates::Physical, Coordinates::Modes]);
    let gravity_stage =
        prop::sample::select(vec![GravityStage::Frictionless, GravityStage::Frictional]);
    let parts = (building(), bed(), 1_usize..8, law(most_friction), scheme());
    let rest = (
        coordinates,
        gravity_stage,
        super::shaking::kinds(),
        decades(0.2, 10.0),
        decades(0.2, 5.0),
        decades(1e6, 1e9),
    );
    (parts, rest).prop_map(|((building, bed, elements, law, scheme), rest)| {
        let (coordinates, gravity_stage, kind, strength, courant, modulus) = rest;
        let mut recipe = Recipe {
            building,
            bed,
            elements,
            law,
            scheme,
            coordinates,
            gravity_stage,
            kind,
            strength,
            courant,
            modulus,
            weightless: false,
        };
        // Rayleigh-damped or not, all structures here decouple; a base of one element does not
        // resist rotation.
        recipe.elements = recipe.elements.max(2);
        recipe
    })
}
