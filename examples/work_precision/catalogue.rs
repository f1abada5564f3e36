//! The scenes that are computed.

use basemat::Soil;
use basemat::coupled::{Outline, SimulationBuilder};
use basemat::fem::{Layer, Material, Mesh, QuadFormulation};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::{RickerDisplacement, STANDARD_GRAVITY, el_centro_1940};
use basemat::structure::{FemModel, RigidBlock, ShearBuilding, Storey};

use super::AnyError;
use super::force::Force;
use super::scene::Scene;

const FOOT: f64 = 0.3048;
const PSF: f64 = 47.880_258_980_335_84;
const SLUG_PER_CUBIC_FOOT: f64 = 515.378_818_393_229_5;

/// A block of a reference table: base from −1 to 1, μ = ρ = c_S = 1, bonded, under a Ricker pulse.
pub(crate) struct Table {
    name: &'static str,
    text: &'static str,
    poisson: f64,
    structure: Structure,
}

#[derive(Clone, Copy)]
enum Structure {
    /// Height and density.
    Block(f64, f64),
    Building,
}

macro_rules! table {
    ($name:literal, $file:literal, $poisson:expr, $structure:expr) => {
        Table {
            name: $name,
            text: include_str!(concat!("../../tests/data/td_", $file, ".csv")),
            poisson: $poisson,
            structure: $structure,
        }
    };
}

/// The scenes with tables; the first is swept.
pub(crate) const TABLES: [Table; 7] = [
    table!("block, ν = 1/3", "block_SV_nu0333_h2_rho1", 1.0 / 3.0, Structure::Block(2.0, 1.0)),
    table!("block, ν = 1/4", "block_SV_nu025_h2_rho1", 0.25, Structure::Block(2.0, 1.0)),
    table!("squat block", "block_SV_nu0333_h1_rho1", 1.0 / 3.0, Structure::Block(1.0, 1.0)),
    table!("squat, ν = 1/4", "block_SV_nu025_h1_rho1", 0.25, Structure::Block(1.0, 1.0)),
    table!("slender block", "block_SV_nu0333_h4_rho0.5", 1.0 / 3.0, Structure::Block(4.0, 0.5)),
    table!("slender, ν = 1/4", "block_SV_nu025_h4_rho0.5", 0.25, Structure::Block(4.0, 0.5)),
    table!("shear building", "shearbuilding3_SV_nu0333_sig1", 1.0 / 3.0, Structure::Building),
];

impl Table {
    /// What advice is told of the structure.
    pub(crate) fn outline(&self) -> basemat::Result<Outline> {
        match self.structure {
            Structure::Block(height, density) => Outline::new(2.0, height, 2.0 * height * density),
            // 0.629 rad/s on a fixed base, with 5 % of damping
            Structure::Building => Outline::new(2.0, 3.0, 4.0)?
                .with_frequency(table_building()?.fixed_base_frequency(), 0.05),
        }
    }

    /// The scene and its base shear.
    pub(crate) fn open(&self) -> Result<(Scene, Force), AnyError> {
        let force = Force::from_table(self.text, "V")?;
        let structure = self.structure;
        let scene = Scene {
            name: self.name,
            soil: Soil::new(1.0, self.poisson, 1.0)?,
            width: 2.0,
            duration: force.duration(),
            parts: Box::new(move |builder| {
                let builder = match structure {
                    Structure::Block(height, density) => {
                        builder.structure(RigidBlock::new(2.0, height, density)?)
                    }
                    Structure::Building => builder.structure(table_building()?),
                };
                let pulse = RickerDisplacement::new(1.0, 1.0, 5.0)?;
                // Without dimensions, and without weight.
                Ok(builder.interface(Bonded).motion(pulse).gravity(0.0))
            }),
        };
        Ok((scene, force))
    }
}

/// The three storeys of the table.
fn table_building() -> basemat::Result<ShearBuilding> {
    let storey = Storey {
        height: 1.0,
        mass: 1.0,
        rotary_inertia: 1.0 / 3.0,
        stiffness: 2.0,
        damping: 2.0 * 0.158_885_451_5,
    };
    ShearBuilding::new(2.0, 1.0, 1.0 / 3.0, &[storey; 3])
}

/// The containment of the example of that name, 15 ft wide and 35 ft high, under the first
/// `duration` seconds of El Centro; bonded, or with friction. Ten columns of finite elements,
/// whatever the ground's mesh.
pub(crate) fn containment(
    name: &'static str,
    friction: Option<f64>,
    duration: f64,
) -> Result<Scene, AnyError> {
    let width = 15.0 * FOOT;
    Ok(Scene {
        name,
        soil: Soil::from_wave_speeds(650.0 * FOOT, 1300.0 * FOOT, 3.5 * SLUG_PER_CUBIC_FOOT)?,
        width,
        duration,
        parts: Box::new(move |builder| {
            let builder = builder
                .structure(containment_structure(width)?)
                .motion(el_centro_1940())
                .gravity(STANDARD_GRAVITY);
            with_friction(builder, friction)
        }),
    })
}

/// The paper's time step on ten elements: a P wave crosses half of one.
pub(crate) const CONTAINMENT_STEP: f64 = 0.75 / 1300.0;

fn with_friction(
    builder: SimulationBuilder,
    friction: Option<f64>,
) -> basemat::Result<SimulationBuilder> {
    Ok(match friction {
        None => builder.interface(Bonded),
        Some(friction) => builder.interface(Coulomb::new(friction)?),
    })
}

fn containment_structure(width: f64) -> basemat::Result<FemModel> {
    let solid = |young: f64, density: f64| {
        Material::new(young * PSF, 1.0 / 3.0, density * SLUG_PER_CUBIC_FOOT)
    };
    let (columns, layers) = (10, 13);
    let layer = 35.0 * FOOT / f64::from(layers);
    let rows = usize::try_from(layers - 1).unwrap_or(1);
    let full = QuadFormulation::Full;
    let mesh = Mesh::layered_block(
        -0.5 * width..0.5 * width,
        columns,
        &[
            Layer::new(layer, 1, solid(106_560_369.0, 3.043_48)?).with_formulation(full),
            Layer::new(layer * rows as f64, rows, solid(106_577_648.0, 0.590_06)?)
                .with_formulation(full),
        ],
    )?;
    FemModel::on_base(mesh)
}

/// A five-storey building, bonded, under the first `duration` seconds of El Centro.
pub(crate) fn building(duration: f64) -> Result<Scene, AnyError> {
    Ok(Scene {
        name: "building, El Centro",
        soil: Soil::new(80.0e6, 0.33, 1900.0)?,
        width: 10.0,
        duration,
        parts: Box::new(|builder| {
            let storeys = [Storey::new(3.0, 20.0e3, 40.0e6); 5];
            let building =
                ShearBuilding::new(10.0, 50.0e3, 4.0e5, &storeys)?.with_stiffness_damping(0.05)?;
            Ok(builder.structure(building).interface(Bonded).motion(el_centro_1940()))
        }),
    })
}
