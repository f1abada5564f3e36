//! Finite-element models as lists of points and pieces, from which a mesh can be made in any view.

use basemat::Result;
use basemat::fem::{
    Beam, BeamSection, Dashpot, Direction, DruckerPrager, Element, Hex8, Iwan, LumpedMass,
    Material, Mesh, Quad4, Quad8, QuadFormulation, SharedMaterial, Shell, SpaceBeam, Spring, Truss,
};
use basemat::structure::{DofCombination, FemModel, RayleighDamping};

use super::user;
use super::view::View;

/// An element on points of a [`Blueprint`]; lengths in m, masses in kg.
#[derive(Debug, Clone)]
pub(crate) enum Piece {
    Quad([usize; 4]),
    Quad8([usize; 8]),
    Brick([usize; 8]),
    /// Corners and thickness.
    Shell(Vec<usize>, f64),
    /// Ends and depth of a plane beam, per metre.
    Beam([usize; 2], f64),
    /// Ends and side of a square beam in space, with a vector in its local plane.
    SpaceBeam([usize; 2], f64, [f64; 3]),
    Truss([usize; 2], f64),
    Mass(usize, f64),
    /// Ends and axial stiffness, N/m.
    Spring([usize; 2], f64),
    /// Ends and axial coefficient, N s/m, in the plane per metre.
    Dashpot([usize; 2], f64),
}

/// Law of the quadrilaterals of a [`Blueprint`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum QuadLaw {
    Elastic,
    /// Clay of this strength, Pa.
    Clay(f64),
    /// Sand of this cohesion, Pa.
    Sand(f64),
}

/// A model in SI units.
#[derive(Debug, Clone)]
pub(crate) struct Blueprint {
    /// Points `[x, y, z]`; in the plane y is zero.
    pub(crate) points: Vec<[f64; 3]>,
    pub(crate) pieces: Vec<Piece>,
    pub(crate) in_space: bool,
    pub(crate) young: f64,
    pub(crate) density: f64,
    pub(crate) quad_law: QuadLaw,
    /// Point whose displacements are compared.
    pub(crate) top: usize,
    /// Leader and followers of a rigid link.
    pub(crate) link: Option<(usize, Vec<usize>)>,
    /// Leaders and followers of ties.
    pub(crate) ties: Vec<[usize; 2]>,
    /// Damping ratio of Rayleigh damping at 1 and 20 Hz; zero without.
    pub(crate) damping: f64,
    pub(crate) p_delta: bool,
}

pub(crate) const POISSON_RATIO: f64 = 0.2;
/// Strain at the strength of clay, relative to the strength over the shear modulus.
const LIMIT_STRAIN_RATIO: f64 = 100.0;
/// Friction and dilation angle of sand, rad.
const FRICTION_ANGLE: f64 = 0.6;
const DILATION_ANGLE: f64 = 0.2;

impl Blueprint {
    /// A model without points; forces in the plane are per metre.
    pub(crate) fn new(in_space: bool, young: f64, density: f64) -> Self {
        Self {
            points: Vec::new(),
            pieces: Vec::new(),
            in_space,
            young,
            density,
            quad_law: QuadLaw::Elastic,
            top: 0,
            link: None,
            ties: Vec::new(),
            damping: 0.0,
            p_delta: false,
        }
    }

    pub(crate) fn point(&mut self, point: [f64; 3]) -> usize {
        self.points.push(point);
        self.points.len() - 1
    }

    /// Points of a grid over a rectangle about the origin at a height, row by row.
    pub(crate) fn grid(&mut self, sides: [f64; 2], counts: [usize; 2], z: f64) -> Vec<Vec<usize>> {
        let mut rows = Vec::new();
        for row in 0..=counts[1] {
            let y = sides[1] * (row as f64 / counts[1] as f64 - 0.5);
            let mut nodes = Vec::new();
            for column in 0..=counts[0] {
                let x = sides[0] * (column as f64 / counts[0] as f64 - 0.5);
                nodes.push(self.point([x, y, z]));
            }
            rows.push(nodes);
        }
        rows
    }

    /// Corners of the cells of a grid, counter-clockwise.
    pub(crate) fn cells(rows: &[Vec<usize>]) -> Vec<[usize; 4]> {
        let pairs = rows.windows(2);
        pairs
            .flat_map(|pair| {
                let columns = 0..pair[0].len() - 1;
                columns.map(move |k| [pair[0][k], pair[0][k + 1], pair[1][k + 1], pair[1][k]])
            })
            .collect()
    }

    /// Index of a point among the nodes of a view's mesh.
    pub(crate) fn node(&self, point: usize, view: &View) -> usize {
        if view.renumbered { self.points.len() - 1 - point } else { point }
    }

    /// The model as a view writes it.
    pub(crate) fn model(&self, view: &View) -> Result<FemModel> {
        let mut mesh = if self.in_space { Mesh::in_space() } else { Mesh::new() };
        for point in view.ordered(self.points.clone()) {
            let point = view.point(point);
            if self.in_space {
                mesh.add_node_at(point)?
            } else {
                mesh.add_node(point[0], point[2])?
            };
        }
        for piece in view.ordered(self.pieces.clone()) {
            self.add_piece(&mut mesh, piece, view)?;
        }
        self.completed(mesh, view)
    }

    /// The model of a mesh, with link, damping and P–Δ.
    pub(crate) fn completed(&self, mesh: Mesh, view: &View) -> Result<FemModel> {
        let frame = &view.frame;
        let mut model = FemModel::on_base(mesh)?;
        if let Some((leader, followers)) = &self.link {
            let followers: Vec<usize> =
                followers.iter().map(|point| self.node(*point, view)).collect();
            model = model.with_rigid_link(self.node(*leader, view), &view.ordered(followers))?;
        }
        for tie in &self.ties {
            let nodes = tie.map(|point| self.node(point, view));
            model = model.with_tied_nodes(nodes[0], &nodes[1..])?;
        }
        if self.damping > 0.0 {
            let frequencies = [1.0 / frame.time, 20.0 / frame.time];
            let damping = RayleighDamping::from_ratios(frequencies, [self.damping; 2])?;
            model = model.with_rayleigh(damping);
        }
        if self.p_delta {
            model = model
                .with_p_delta(basemat_problems::scenes::SCENE_GRAVITY * frame.acceleration())?;
        }
        Ok(model)
    }

    /// Material of the quadrilaterals as a view writes it.
    pub(crate) fn quad_material(&self, view: &View) -> Result<SharedMaterial> {
        let pressure = view.frame.pressure();
        let density = self.density * view.frame.density();
        let elastic = Material::new(self.young * pressure, POISSON_RATIO, density)?;
        let material: SharedMaterial = match self.quad_law {
            QuadLaw::Elastic => return Ok(elastic.into()),
            QuadLaw::Clay(strength) => {
                let shear_modulus = 0.5 * self.young / (1.0 + POISSON_RATIO);
                let limit_strain = LIMIT_STRAIN_RATIO * strength / shear_modulus;
                let shear_modulus = shear_modulus * pressure;
                let strength = strength * pressure;
                Iwan::hyperbolic(shear_modulus, strength, limit_strain, POISSON_RATIO, density)?
                    .into()
            }
            QuadLaw::Sand(cohesion) => {
                DruckerPrager::new(elastic, cohesion * pressure, FRICTION_ANGLE, DILATION_ANGLE)?
                    .into()
            }
        };
        Ok(if view.by_user { user::UserMaterial(material).into() } else { material })
    }

    /// Section of a beam in space of this side.
    pub(crate) fn section(side: f64) -> Result<BeamSection> {
        let moment = side.powi(4) / 12.0;
        BeamSection::new(side * side, [moment, 1.7 * moment], 1.6 * moment)
    }

    /// Adds the element of a piece as a view writes it.
    pub(crate) fn add_piece(&self, mesh: &mut Mesh, piece: Piece, view: &View) -> Result<usize> {
        let frame = &view.frame;
        let length = frame.length;
        let pressure = frame.pressure();
        let material =
            Material::new(self.young * pressure, POISSON_RATIO, self.density * frame.density())?;
        // Force over length, and mass, of this model.
        let stiffness = if self.in_space { pressure * length } else { pressure };
        let mass_unit = if self.in_space { frame.mass } else { frame.mass / length };
        let is_mirrored = frame.mirrored;
        let nodes_of = |points: &[usize]| -> Vec<usize> {
            points.iter().map(|point| self.node(*point, view)).collect()
        };
        match piece {
            Piece::Quad(corners) => {
                let corners = if is_mirrored { reversed(corners) } else { corners };
                let nodes = fixed(nodes_of(&corners));
                let material = self.quad_material(view)?;
                let formulation = QuadFormulation::for_material(&material);
                add(mesh, Quad4::new(nodes, material, formulation), view)
            }
            Piece::Quad8([a, b, c, d, ab, bc, cd, da]) => {
                let points = if is_mirrored {
                    [d, c, b, a, cd, bc, ab, da]
                } else {
                    [a, b, c, d, ab, bc, cd, da]
                };
                let material = self.quad_material(view)?;
                add(mesh, Quad8::new(fixed(nodes_of(&points)), material), view)
            }
            Piece::Brick([a, b, c, d, e, f, g, h]) => {
                let points =
                    if is_mirrored { [d, c, b, a, h, g, f, e] } else { [a, b, c, d, e, f, g, h] };
                add(mesh, Hex8::new(fixed(nodes_of(&points)), material), view)
            }
            Piece::Shell(corners, thickness) => {
                add(mesh, Shell::new(nodes_of(&corners), material, thickness * length)?, view)
            }
            Piece::Beam(ends, depth) => {
                let depth = depth * length;
                let moment = depth.powi(3) / 12.0;
                let young = self.young * pressure;
                let density = self.density * frame.density();
                add(mesh, Beam::new(fixed(nodes_of(&ends)), young, depth, moment, density)?, view)
            }
            Piece::SpaceBeam(ends, side, plane) => {
                let section = Self::section(side * length)?;
                add(
                    mesh,
                    SpaceBeam::new(fixed(nodes_of(&ends)), material, section, view.vector(plane))?,
                    view,
                )
            }
            Piece::Truss(ends, area) => {
                let young = self.young * pressure;
                let area = area * length * length;
                let density = self.density * frame.density();
                add(mesh, Truss::in_space(fixed(nodes_of(&ends)), young, area, density)?, view)
            }
            Piece::Mass(point, mass) => {
                let node = self.node(point, view);
                let mass = mass * mass_unit;
                if self.in_space {
                    add(mesh, LumpedMass::in_space(node, mass, [0.0; 3])?, view)
                } else {
                    add(mesh, LumpedMass::new(node, mass)?, view)
                }
            }
            Piece::Spring(ends, coefficient) => add(
                mesh,
                Spring::axial_in_space(fixed(nodes_of(&ends)), coefficient * stiffness)?,
                view,
            ),
            Piece::Dashpot(ends, coefficient) => {
                let coefficient = coefficient * stiffness * frame.time;
                add(mesh, Dashpot::axial(fixed(nodes_of(&ends)), coefficient)?, view)
            }
        }
    }

    /// Displacements of a point along the axes of the view: x, y (none in the plane), up.
    pub(crate) fn rows(
        &self,
        model: &FemModel,
        point: usize,
        view: &View,
    ) -> Result<[DofCombination; 3]> {
        let node = self.node(point, view);
        let up = if self.in_space { Direction::Z } else { Direction::Y };
        let across = if self.in_space {
            model.row(node, Direction::Y)?
        } else {
            DofCombination::default()
        };
        Ok([model.row(node, Direction::X)?, across, model.row(node, up)?])
    }
}

fn reversed([a, b, c, d]: [usize; 4]) -> [usize; 4] {
    [d, c, b, a]
}

/// The list as an array.
fn fixed<const N: usize>(list: Vec<usize>) -> [usize; N] {
    list.try_into()
        .unwrap_or_else(|list: Vec<usize>| panic!("{} nodes, {N} needed", list.len()))
}

/// Adds an element, wrapped as an element of a user if the view has this.
fn add(mesh: &mut Mesh, element: impl Element + 'static, view: &View) -> Result<usize> {
    if view.by_user {
        mesh.add(user::UserElement(Box::new(element)))
    } else {
        mesh.add(element)
    }
}
