//! Earthquake response of flexible structures whose base can uplift and slide on elastic ground.
//!
//! A structure (finite elements, a rigid block, a shear building, or any model of your own) stands on elastic ground:
//! the flat surface of a homogeneous half-plane or of horizontal layers with damping, a bed of springs, or your own.
//! The ground shakes. Element by element, the base may stick, open, close again and slide with friction. Results are
//! displacements, contact tractions, base shear and moment, uplift, slip and an energy balance. Displacements are
//! small. The model is plane, per metre of thickness, or three-dimensional for bodies on mats, with a ground in plan
//! ([`bem::plan`]).
//!
//! # One complete example
//!
//! ```
//! use basemat::bem::ElasticGround;
//! use basemat::coupled::Probe;
//! use basemat::interface::Coulomb;
//! use basemat::motion::{STANDARD_GRAVITY, el_centro_1940};
//! use basemat::structure::{ShearBuilding, Storey};
//! use basemat::{Simulation, Soil};
//!
//! // Five storeys on a base 10 m wide, soil with a shear wave speed of 205 m/s.
//! let storeys = [Storey::new(3.0, 20.0e3, 40.0e6); 5];
//! let building = ShearBuilding::new(10.0, 50.0e3, 4.0e5, &storeys)?.with_stiffness_damping(0.05)?;
//! let weight = STANDARD_GRAVITY * building.total_mass();
//! let roof = building.roof();
//! let soil = Soil::new(80.0e6, 0.33, 1900.0)?;
//!
//! let mut simulation = Simulation::builder(0.01)
//!     .ground(ElasticGround::under(soil, &building, 10)?)
//!     .structure(building)
//!     .interface(Coulomb::new(0.4)?)
//!     .motion(el_centro_1940())
//!     .probe(Probe::displacement("roof", roof))
//!     .build()?;
//!
//! // Before the shaking, the ground carries the weight and nothing else.
//! let start = simulation.state();
//! assert!((start.normal_force / weight - 1.0).abs() < 1e-9);
//! assert!(start.base_shear.abs() < 1e-9 * weight && start.base_moment.abs() < 1e-9 * weight);
//!
//! let run = simulation.run(300, |state| {
//!     // Coulomb's conditions hold in every element at every step.
//!     for contact in &state.contact {
//!         let tolerance = 1e-6 * weight / 10.0;
//!         assert!(contact.pressure >= -tolerance && contact.gap >= -1e-9);
//!         assert!(contact.shear.abs() <= 0.4 * contact.pressure + tolerance);
//!     }
//! })?;
//! assert_eq!(run.steps, 300);
//! assert!(run.whole.base_shear.magnitude() > 0.0);
//! // The energy balance closes.
//! assert!(run.energy_error < 1e-9);
//! println!("{run}");
//! # Ok::<(), basemat::Error>(())
//! ```
//!
//! # Equations
//!
//! The soil responds to the tractions of all steps so far. The element means of its surface displacement at the end of
//! step N are
//!
//! ```math
//! s^N = s_{ff}^N + \sum_{m=1}^{N} G^{\,N-m+1}\, \tau^m
//! ```
//!
//! with τᵐ constant over element and step, Gⁿ in closed form for the half-plane and by convolution quadrature for
//! layers, and `s_ff` the free field. The structure obeys the midpoint rule (or another [`coupled::TimeScheme`]),
//!
//! ```math
//! M \frac{v_1 - v_0}{\Delta t} + C \bar v + K \bar u + f(\bar u) = p(t_{1/2}) - B^T A\, \tau,
//! \qquad u_1 - u_0 = \Delta t\, \bar v
//! ```
//!
//! with B the element means of the base displacement and A the element lengths. In each element base and soil are
//! related by gap g, slip w, pressure p and shear τ. For hard contact with Coulomb friction,
//!
//! ```math
//! g \ge 0, \quad p \ge 0, \quad p\, g = 0, \qquad
//! |\tau| \le \varphi\, p, \quad \Delta w = 0 \ \text{ or } \ \tau = \varphi\, p\, \mathrm{sgn}\,\Delta w .
//! ```
//!
//! Another [`interface::InterfaceLaw`] has other conditions. The discrete equations satisfy an energy balance exactly,
//! for every time step, mesh and Poisson's ratio:
//!
//! ```text
//! kinetic + strain + hysteresis + damping + algorithmic + midstep_remainder + soil + contact + interface
//!     + static_contact = input
//! ```
//!
//! The soil's term is the work of the tractions on a passive ground, so it is never negative. Contact without tensile
//! strength can only dissipate energy. With the midpoint rule a run therefore cannot become unstable.
//! [`coupled::EnergyBalance`] computes each term from its own definition, and its residual comes with every run. The
//! [theory] has derivations and sources.
//!
//! [theory]: https://github.com/basemat/basemat/blob/main/docs/theory.md
//!
//! # Conventions
//!
//! | what | how |
//! |---|---|
//! | units | SI, per metre of thickness: N/m, N·m/m, kg/m; in plan of the whole body: N, N·m, kg; tractions in Pa |
//! | axes | x to the right, y up, the soil at y ≤ 0; in plan x to the right, y away, z up; fundamental solutions and waves in the soil use z down |
//! | rotations, moments | positive counter-clockwise; in plan they are vectors by the right-hand rule: `base_moment` and `base_rotation` about y, `moment_across` and `rotation_across` about x, `torque` and `twist` about z ([`coupled::State::moment_vector`]) |
//! | settlement | positive downwards, of a foundation's centre since the static state |
//! | pressure | positive in compression |
//! | shear, base shear | what the structure exerts on the soil, positive to the right |
//! | gap, slip | positive when open; positive when the structure moved to the right over the soil |
//! | contact vectors | 2Q numbers for Q elements: Q normal components (pressure; displacement **down**), then Q tangential ones (to the right); in plan Q more (along y) |
//! | degrees of freedom | matrices are written for absolute displacements; [`coupled::State`] and probes contain changes since the static state, relative to the free field's translation, except where they are called absolute |
//! | velocities, accelerations | total |
//! | time | step n ends at t = nΔt; tractions belong to the whole step |
//!
//! # Map
//!
//! | module | what is in it |
//! |---|---|
//! | [`prelude`] | what most programs name, in one `use` |
//! | [`coupled`] | [`Simulation`], its builder, joints between bodies, time schemes, results, energy balance |
//! | [`analyses`] | errors of mesh and step, digits of peaks, comparison with a fixed base, static push-over |
//! | [`results`] | time series, peaks, envelopes, factors of safety, tables for reports |
//! | [`sweep`] | [`sweep::Sweep`]: many simulations over parameters, on all processors with the feature `rayon`; their table, shards |
//! | [`structure`] | finite-element model, shear and storey buildings, rigid block and body, matrices of other programs, reduction, hysteretic springs, and the trait for your own |
//! | [`fem`] | meshes and elements |
//! | [`contact`] | the contact problem of a step, for codes with an integrator of their own |
//! | [`interface`] | bonded, Coulomb and thin-layer contact, and the trait for your own law |
//! | [`soil`] | [`Soil`], damping laws, [`soil::SoilProfile`] of horizontal layers, strength, bearing capacity |
//! | [`bem`] | [`bem::ElasticGround`], [`bem::SpringGround`], grounds of any convolution weights |
//! | [`bem::layered`] | convolution weights of layered ground, impedances of strips on it |
//! | [`bem::plan`] | mats in three dimensions: cells of a ground, impedances |
//! | [`site`] | from the outcrop of the rock to the surface: [`site::SoilColumn`], [`site::InclinedWave`] |
//! | [`history`] | the convolution with all past tractions, its methods and the choice among them |
//! | [`fundamental`] | elastodynamic fundamental solutions |
//! | [`motion`] | records and their files, spectra, baselines, free fields, El Centro 1940 |
//!
//! # Features
//!
//! All features are off by default, and compatible with each other.
//!
//! | feature | what it adds |
//! |---|---|
//! | `embedded` | `bem::embedded`: the ground of structures with walls below the surface, and soil that yields around a foundation, in the plane |
//! | `full-plane` | `bem::full_plane`: boundaries that are not flat, the scheme of Patel & Spyrakos and its stability; `fundamental::FullPlane` |
//! | `io` | `io`: meshes from Gmsh, matrices by Matrix Market, grids for ParaView; `results::DeformedShape`; `sweep`: files |
//! | `reference` | `reference`: closed forms from the literature, to check against |
//! | `plot` | `plot`: pictures of time series, contact, spectra and shapes, as SVG; `results::DeformedShape` |
//! | `png` | `plot`, and the same pictures as PNG |
//! | `rayon` | [`sweep::Sweep`], and convolution weights of layered ground and of ground in plan, on all processors |
//! | `serde` | `Serialize` and `Deserialize` of settings, results, records and [`Checkpoint`](coupled::Checkpoint)s |
//! | `npz` | [`results::TimeSeries`] as an archive of NumPy's arrays |
//!
//! ## Settings and results in serde's formats
//!
//! With the feature `serde` plain data derive `Serialize` and `Deserialize`: soils, profiles, materials, laws given by
//! numbers, schemes, options, probes, records, spectra, and a [`results::Run`] with all its parts. Data that are read
//! are checked as by their constructors. Choices are words, as written by `Display` if they implement it
//! (`"slip_left"`), with their numbers in a map (`{"reduced": {"tolerance": 1e-6}}`). In formats that people read, a
//! number that is NaN is null and infinities are `"inf"` and `"-inf"`, where they can occur (peaks, energy balances,
//! conditions, friction); elsewhere numbers are finite. Floating-point numbers are read back exactly; serde_json needs
//! its feature `float_roundtrip` for this.
//!
//! # Bring your own
//!
//! | for a … of your own | implement | methods needed |
//! |---|---|---|
//! | structure | [`structure::Structure`] | 4 |
//! | nonlinear force in it | [`structure::NonlinearForce`] | 2; 5 with internal variables |
//! | finite element | [`fem::Element`] | 4 |
//! | material of solids that yield | [`fem::SolidMaterial`] | 7 |
//! | element whose force has internal variables | [`fem::InelasticForce`] | 7 |
//! | law of fibres | [`fem::UniaxialMaterial`] | 3 |
//! | spring with internal variables | [`structure::Hysteresis`] | 6 |
//! | law between base and soil | [`interface::InterfaceLaw`] | 1 |
//! | law of the plane that no limits describe | [`interface::PlaneLaw`] | 3 |
//! | ground motion | [`motion::FreeField`], or a closure in [`motion::FreeFieldFn`] | 1 |
//! | coherence of ground motion | [`motion::Coherence`], or a closure in [`motion::CoherenceFn`] | 1 |
//! | soil | [`bem::Ground`] | 6 |
//! | soil that has convolution weights | [`bem::WeightsSource`] and [`history::ConvolutionWeights`] | 2 each |
//! | damping law of a soil | [`soil::Relaxation`] | 1 |
//! | time scheme | [`coupled::TimeScheme`] | 1 |
//! | convolution algorithm | [`history::ConvolutionHistory`] | 4 |
//! | file of a record | [`motion::RecordFormat`] | 1 |
//! | boundary operator (`full-plane`) | `bem::full_plane::BoundaryKernel` | 2 |
//! | waves from below (`full-plane`) | `bem::full_plane::IncidentField` | 2 |
//! | fundamental solution | [`fundamental::FundamentalSolution`] | 3 |
//!
//! The examples `your_own_structure`, `your_own_law` and `your_own_ground` show how; `host_integrator` uses ground and
//! contact in a time integrator of its own.
//!
//! # Examples
//!
//! `containment` is the problem of Patel & Spyrakos; `shear_building`, `square_block` (in three dimensions) and some
//! 30 more each teach one thing on a page; `pictures` draws everything (feature `png`). [The list of
//! examples](https://github.com/basemat/basemat/blob/main/examples/README.md) states what each prints.
#![forbid(unsafe_code)]
#![cfg_attr(docsrs, feature(doc_cfg))]

#[macro_use]
extern crate basemat_base;
#[macro_use]
extern crate basemat_structures;

use basemat_base::{error, geometry, text};
use basemat_linalg as linalg;

pub mod analyses;
pub mod bem;
pub mod contact;
pub mod coupled;
pub mod fem;
pub mod fundamental;
pub mod history;
pub mod interface;
#[cfg(feature = "io")]
pub mod io;
pub mod motion;
#[cfg(feature = "plot")]
pub mod plot;
pub mod prelude;
#[cfg(feature = "reference")]
pub mod reference;
pub mod results;
pub mod site;
pub mod soil;
pub mod structure;
pub mod sweep;

pub use coupled::simulation::Simulation;
#[allow(deprecated, reason = "the path stays for one release")]
#[doc(inline)]
pub use error::set_memory_limit;
#[doc(inline)]
pub use error::{
    Error, FileError, FileFault, MemoryError, Observer, Progress, Result, memory_limit, unobserved,
};
#[doc(inline)]
pub use linalg::Complex;
pub use soil::Soil;

/// The README's program is compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// The tutorial's programs are compiled and run; they assert the numbers of its text.
#[cfg(doctest)]
#[doc = include_str!("../docs/tutorial.md")]
struct Tutorial;

/// Runs the programs of the guide.
#[cfg(doctest)]
#[doc = include_str!("../docs/guide.md")]
struct Guide;
