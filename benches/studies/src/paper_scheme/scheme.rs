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
use basemat_problems::containment::Glue;

/// Soil, interface, time integration and contact iteration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Scheme {
    /// All of them the paper's.
    Paper,
    /// The paper's soil by convolution quadrature, and contact found where the flow chart cycles.
    Quadrature,
    /// The half-plane's soil under the paper's interface and structure.
    HalfPlane,
    /// All of them the crate's.
    Own,
}

pub(crate) const SCHEMES: [Scheme; 4] =
    [Scheme::Paper, Scheme::Quadrature, Scheme::HalfPlane, Scheme::Own];

/// Scene that all schemes compute.
pub(crate) struct Scene {
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

impl Scheme {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Quadrature => "BDF2",
            Self::HalfPlane => "half-plane",
            Self::Own => "basemat",
        }
    }

    /// The simulation on a row.
    pub(crate) fn build(self, scene: &Scene, friction: Option<f64>) -> basemat::Result<Simulation> {
        let model = scene.containment.structure()?;
        let builder = Simulation::builder(scene.time_step)
            .probe(scene.containment.base_shear(&model)?)
            .structure(model)
            .motion(scene.record.clone())
            .gravity(STANDARD_GRAVITY);
        let builder = match self {
            // Assessed once, for all rows, in the report.
            Self::Paper => {
                builder.ground(self.full_plane(scene)?.allow_growth()).contact_search(scene.search)
            }
            Self::Quadrature => builder.ground(self.full_plane(scene)?.allow_growth()),
            Self::HalfPlane | Self::Own => {
                let Containment { elements, .. } = scene.containment;
                let (soil, base) = (scene.containment.soil()?, scene.containment.base());
                builder.ground(ElasticGround::new(soil, Strip::uniform(base, elements)?)?)
            }
        };
        if self == Self::Own {
            own_interface(builder, friction)?.build()
        } else {
            let newmark = Newmark::new(scene.gamma, 0.25 * (scene.gamma + 0.5).powi(2))?;
            paper_interface(builder.scheme(newmark), scene, friction)?.build()
        }
    }

    /// The paper's boundary elements, with its coefficients or those by convolution quadrature.
    pub(crate) fn full_plane(self, scene: &Scene) -> basemat::Result<FullPlaneGround> {
        let Containment { elements, .. } = scene.containment;
        let (soil, base) = (scene.containment.soil()?, scene.containment.base());
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

fn own_interface(
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
    scene: &Scene,
    friction: Option<f64>,
) -> basemat::Result<SimulationBuilder> {
    let (soil, height) = (scene.containment.soil()?, scene.containment.layer_height());
    let layer =
        |friction| ThinLayer::new(soil, height, friction)?.with_thickness_ratio(scene.ratio);
    let Some(friction) = friction else {
        let layer = layer(f64::INFINITY)?;
        let glue = |_| Box::new(InPlane(Glue(layer))) as Box<dyn InterfaceLaw>;
        return Ok(builder.interfaces((0..scene.containment.elements).map(glue).collect()));
    };
    Ok(builder.interface(layer(friction)?))
}
