//! The schemes that are compared, and the rows of the paper's Table 1.

use basemat::Simulation;
use basemat::bem::full_plane::{
    BoundaryKernel, ConvolutionQuadrature, CqMethod, FullPlaneGround, TimeKernel,
};
use basemat::bem::{ElasticGround, Strip};
use basemat::contact::ContactSearch;
use basemat::coupled::{Newmark, SimulationBuilder};
use basemat::interface::{Bonded, Coulomb, InPlane, InterfaceLaw, ThinLayer};
use basemat::motion::{Record, STANDARD_GRAVITY};

use basemat_problems::containment::Containment;
use basemat_problems::containment::PermanentLayer;

/// Soil, interface, time integration and contact iteration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ComparedScheme {
    /// All of them the paper's.
    Paper,
    /// The paper's soil by convolution quadrature, and contact found where the flow chart cycles.
    Quadrature,
    /// The half-plane's soil under the paper's interface and structure.
    HalfPlane,
    /// All of them the crate's.
    Basemat,
}

pub(crate) const COMPARED_SCHEMES: [ComparedScheme; 4] = [
    ComparedScheme::Paper,
    ComparedScheme::Quadrature,
    ComparedScheme::HalfPlane,
    ComparedScheme::Basemat,
];

/// Scene that all schemes compute.
pub(crate) struct PaperScene {
    pub(crate) containment: Containment,
    pub(crate) record: Record,
    pub(crate) time_step: f64,
    /// Traction-free elements on either side of the full plane's base.
    pub(crate) free: usize,
    /// Sub-elements and Gauss points in each in the paper's kernel, or exact integrals.
    pub(crate) subelements: Option<[usize; 2]>,
    /// Thickness of the layer over the height of the elements beside it.
    pub(crate) ratio: f64,
    /// Newmark's γ, with β = (γ + ½)²/4.
    pub(crate) gamma: f64,
    /// Search for contact modes of the paper's scheme.
    pub(crate) search: ContactSearch,
}

impl ComparedScheme {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Quadrature => "BDF2",
            Self::HalfPlane => "half-plane",
            Self::Basemat => "basemat",
        }
    }

    /// The simulation on a row.
    pub(crate) fn build(
        self,
        scene: &PaperScene,
        friction: Option<f64>,
    ) -> basemat::Result<Simulation> {
        let model = scene.containment.structure()?;
        let builder = Simulation::builder(scene.time_step)
            .probe(scene.containment.base_shear(&model)?)
            .structure(model)
            .motion(scene.record.clone())
            .gravity(STANDARD_GRAVITY);
        let builder = match self {
            // The report assesses it once for all rows.
            Self::Paper => {
                builder.ground(self.full_plane(scene)?.allow_growth()).contact_search(scene.search)
            }
            Self::Quadrature => builder.ground(self.full_plane(scene)?.allow_growth()),
            Self::HalfPlane | Self::Basemat => {
                let Containment { elements, .. } = scene.containment;
                let soil = scene.containment.soil()?;
                let base = scene.containment.base();
                builder.ground(ElasticGround::new(soil, Strip::uniform(base, elements)?)?)
            }
        };
        if self == Self::Basemat {
            coulomb_interface(builder, friction)?.build()
        } else {
            let newmark = Newmark::new(scene.gamma, 0.25 * (scene.gamma + 0.5).powi(2))?;
            paper_interface(builder.scheme(newmark), scene, friction)?.build()
        }
    }

    /// The paper's boundary elements, with its coefficients or those by convolution quadrature.
    pub(crate) fn full_plane(self, scene: &PaperScene) -> basemat::Result<FullPlaneGround> {
        let Containment { elements, .. } = scene.containment;
        let soil = scene.containment.soil()?;
        let base = scene.containment.base();
        let ground = FullPlaneGround::strip(soil, base, elements, scene.free)?;
        let subelements = scene.subelements;
        Ok(ground.with_kernel(move |segments, soil, time_step| {
            if self == Self::Quadrature {
                let kernel = ConvolutionQuadrature::new(soil, segments, time_step, CqMethod::Bdf2)?;
                return Ok(Box::new(kernel) as Box<dyn BoundaryKernel>);
            }
            let kernel = TimeKernel::new(soil, segments, time_step)?;
            Ok(match subelements {
                Some([count, points]) => Box::new(kernel.with_gauss_subelements(count, points)?),
                None => Box::new(kernel),
            })
        }))
    }
}

fn coulomb_interface(
    builder: SimulationBuilder,
    friction: Option<f64>,
) -> basemat::Result<SimulationBuilder> {
    Ok(match friction {
        None => builder.interface(Bonded),
        Some(friction) => builder.interface(Coulomb::new(friction)?),
    })
}

fn paper_interface(
    builder: SimulationBuilder,
    scene: &PaperScene,
    friction: Option<f64>,
) -> basemat::Result<SimulationBuilder> {
    let soil = scene.containment.soil()?;
    let height = scene.containment.layer_height();
    let layer = ThinLayer::new(soil, height, friction.unwrap_or(f64::INFINITY))?
        .with_thickness_ratio(scene.ratio)?;
    if friction.is_some() {
        return Ok(builder.interface(layer));
    }
    let mut laws: Vec<Box<dyn InterfaceLaw>> = Vec::new();
    for _ in 0..scene.containment.elements {
        laws.push(Box::new(InPlane(PermanentLayer(layer))));
    }
    Ok(builder.interfaces(laws))
}
