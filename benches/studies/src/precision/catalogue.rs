//! The scenes of the study.

use basemat::Soil;
use basemat::coupled::SimulationBuilder;
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::{RickerDisplacement, STANDARD_GRAVITY, el_centro_1940};
use basemat::structure::RigidBlock;

use basemat_problems::containment::{Containment, METRES_PER_FOOT};
use basemat_problems::tabled_structures::three_storeys;

use super::force::ForceSeries;
use super::scene::PrecisionScene;
use crate::AnyError;

/// A block of a reference table: base from −1 to 1, μ = ρ = c_S = 1, bonded, under a Ricker pulse.
pub(crate) struct BlockTable {
    name: &'static str,
    /// File name after `td_`.
    file: &'static str,
    poisson: f64,
    structure: TableStructure,
}

#[derive(Clone, Copy)]
enum TableStructure {
    /// A block of this height and density.
    Block(f64, f64),
    Building,
}

/// The scenes with tables; the first is swept.
pub(crate) const BLOCK_TABLES: [BlockTable; 7] = [
    BlockTable {
        name: "block, ν = 1/3",
        file: "block_SV_nu0333_h2_rho1",
        poisson: 1.0 / 3.0,
        structure: TableStructure::Block(2.0, 1.0),
    },
    BlockTable {
        name: "block, ν = 1/4",
        file: "block_SV_nu025_h2_rho1",
        poisson: 0.25,
        structure: TableStructure::Block(2.0, 1.0),
    },
    BlockTable {
        name: "squat block",
        file: "block_SV_nu0333_h1_rho1",
        poisson: 1.0 / 3.0,
        structure: TableStructure::Block(1.0, 1.0),
    },
    BlockTable {
        name: "squat, ν = 1/4",
        file: "block_SV_nu025_h1_rho1",
        poisson: 0.25,
        structure: TableStructure::Block(1.0, 1.0),
    },
    BlockTable {
        name: "slender block",
        file: "block_SV_nu0333_h4_rho0.5",
        poisson: 1.0 / 3.0,
        structure: TableStructure::Block(4.0, 0.5),
    },
    BlockTable {
        name: "slender, ν = 1/4",
        file: "block_SV_nu025_h4_rho0.5",
        poisson: 0.25,
        structure: TableStructure::Block(4.0, 0.5),
    },
    BlockTable {
        name: "shear building",
        file: "shearbuilding3_SV_nu0333_sig1",
        poisson: 1.0 / 3.0,
        structure: TableStructure::Building,
    },
];

impl BlockTable {
    /// The tabled base shear.
    pub(crate) fn force(&self) -> ForceSeries {
        ForceSeries::from_table(&format!("td_{}.csv", self.file), "V")
    }

    pub(crate) fn scene(&self) -> Result<PrecisionScene, AnyError> {
        let structure = self.structure;
        Ok(PrecisionScene {
            name: self.name,
            soil: Soil::new(1.0, self.poisson, 1.0)?,
            width: 2.0,
            duration: self.force().duration(),
            parts: Box::new(move |builder| {
                let builder = match structure {
                    TableStructure::Block(height, density) => {
                        builder.structure(RigidBlock::new(2.0, height, density)?)
                    }
                    TableStructure::Building => builder.structure(three_storeys()?),
                };
                let pulse = RickerDisplacement::new(1.0, 1.0, 5.0)?;
                // Dimensionless, without weight.
                Ok(builder.interface(Bonded).motion(pulse).gravity(0.0))
            }),
        })
    }
}

/// The containment of the example, but 15 ft wide and 35 ft high, under the first `duration` seconds of El Centro.
///
/// It is bonded or has friction. It has ten columns of finite elements for all meshes of the ground.
pub(crate) fn containment(
    name: &'static str,
    friction: Option<f64>,
    duration: f64,
) -> Result<PrecisionScene, AnyError> {
    let containment = Containment { width: 15.0, height: 35.0, ..Containment::default() };
    Ok(PrecisionScene {
        name,
        soil: containment.soil()?,
        width: containment.width * METRES_PER_FOOT,
        duration,
        parts: Box::new(move |builder| {
            let builder = builder
                .structure(containment.structure()?)
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
