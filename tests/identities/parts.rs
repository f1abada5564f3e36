//! The parts of scenes: grounds, structures, laws, motions, schemes, coordinates. A new part adds its row here, and where
//! the code then compiles only with it; `table.rs` compares the types with the library's.

use basemat_problems::random::Random;

/// Surface in the plane, mat in plan, or trench.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Space {
    Plane,
    Plan,
    Trench,
}

use Space::{Plan, Plane, Trench};

/// Declares the parts of a kind: name, word, spaces in which it exists, and the library's types that it uses.
macro_rules! parts {
    ($(#[$doc:meta])* $kind:ident {
        $($part:ident, $word:literal, [$($space:ident),+], [$($type:literal),*];)+
    }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub(crate) enum $kind {
            $($part,)+
        }

        impl $kind {
            pub(crate) const ALL_PARTS: &[Self] = &[$(Self::$part),+];

            pub(crate) fn word(self) -> &'static str {
                match self { $(Self::$part => $word,)+ }
            }

            pub(crate) fn types(self) -> &'static [&'static str] {
                match self { $(Self::$part => &[$($type),*],)+ }
            }

            fn fits(self, space: Space) -> bool {
                match self { $(Self::$part => [$($space),+].contains(&space),)+ }
            }
        }
    };
}

parts! {
    /// Grounds.
    GroundPart {
        HalfPlane, "half-plane", [Plane, Plan], ["ElasticGround"];
        Layers, "layers", [Plane, Plan, Trench], ["ElasticGround", "WeightsGround"];
        Springs, "springs", [Plane, Plan], ["SpringGround"];
        Hole, "trench", [Trench], ["TrenchGround"];
    }
}

parts! {
    /// Structures.
    BodyPart {
        Block, "block", [Plane, Trench], ["RigidBlock", "WithWalls"];
        Storeys, "storeys", [Plane, Trench], ["ShearBuilding"];
        Slender, "storeys with P–Δ", [Plane], ["ShearBuilding"];
        Hysteretic, "hysteretic storeys", [Plane, Trench], ["ShearBuilding"];
        Damped, "modal damping", [Plane], ["WithModalDamping"];
        Pair, "two structures", [Plane], ["StructureGroup"];
        Sprung, "with a spring", [Plane], ["WithSprings"];
        Matrices, "matrices", [Plane, Plan], ["MatrixModel"];
        Frame, "plane frame", [Plane], ["FemModel", "Beam", "LumpedMass", "Dashpot"];
        Quads, "quadrilaterals", [Plane], ["FemModel", "Quad4"];
        Quads8, "eight-node quadrilaterals", [Plane], ["FemModel", "Quad8", "Material"];
        Clay, "clay that yields", [Plane], ["FemModel", "Quad8", "Iwan"];
        Sand, "sand that yields", [Plane], ["FemModel", "Quad4", "DruckerPrager"];
        ClayPair, "clay beside storeys", [Plane], ["StructureGroup", "FemModel", "Quad8", "Iwan"];
        Reduced, "reduced model", [Plane, Plan], ["ReducedModel"];
        Rigid, "rigid body", [Plan], ["RigidBody"];
        Floors, "floors", [Plan], ["StoreyBuilding"];
        SlenderFloors, "floors with P–Δ", [Plan], ["StoreyBuilding"];
        Shells, "shells and beams", [Plan], ["FemModel", "Shell", "SpaceBeam", "LumpedMass", "Truss"];
        SlenderFrame, "shells and beams with P–Δ", [Plan], ["FemModel", "Shell", "SpaceBeam"];
        Bricks, "bricks", [Plan], ["FemModel", "Hex8", "Spring"];
        Linked, "rigid links", [Plan], ["FemModel", "Shell", "SpaceBeam"];
    }
}

parts! {
    /// Laws between base and ground.
    LawPart {
        Bonded, "bonded", [Plane, Plan, Trench], ["Bonded"];
        Friction, "Coulomb", [Plane, Plan, Trench], ["Coulomb"];
        Tension, "Coulomb with tension", [Plane, Plan], ["Coulomb"];
        Cohesive, "cohesive", [Plane, Plan], ["Cohesive"];
        Yielding, "yielding", [Plane, Plan, Trench], ["Yielding"];
        Cyclic, "cyclic yielding", [Plane, Plan, Trench], ["CyclicYielding"];
        Earth, "earth pressure", [Trench], ["EarthPressure"];
        Layer, "thin layer", [Plane, Plan], ["ThinLayer"];
        Varying, "variable friction", [Plane, Plan, Trench], ["VariableFriction"];
    }
}

parts! {
    /// Motions of the ground, and loads.
    MotionPart {
        Record, "record", [Plane], ["Record"];
        Vertical, "vertical waves", [Plane], ["VerticalIncidence"];
        Function, "function", [Plane], ["FreeFieldFn"];
        Pulse, "Ricker pulse", [Plane], ["RickerDisplacement"];
        Inclined, "SV wave", [Plane, Plan], ["TravellingWave"];
        Pressure, "P wave", [Plane], ["TravellingWave"];
        Across, "SH wave", [Plan], ["TravellingWave"];
        Triaxial, "three records", [Plan], ["Triaxial"];
        Loads, "loads", [Plane, Plan, Trench], ["AtRest"];
        Below, "vertical waves around a trench", [Trench], ["TrenchMotion"];
        BelowInclined, "SV wave around a trench", [Trench], ["TrenchMotion"];
    }
}

parts! {
    /// Time schemes.
    SchemePart {
        Midpoint, "midpoint", [Plane, Plan, Trench], ["Midpoint"];
        Theta, "theta", [Plane, Plan, Trench], ["Theta"];
        Dissipative, "dissipative", [Plane, Plan, Trench], ["DissipativeMidpoint"];
        Newmark, "Newmark", [Plane, Plan, Trench], ["Newmark"];
        Hht, "HHT", [Plane, Plan, Trench], ["HhtAlpha"];
    }
}

parts! {
    /// Coordinates of the structure.
    CoordinatePart {
        Physical, "physical", [Plane, Plan, Trench], [];
        Modes, "modal", [Plane, Plan, Trench], [];
        Reduced, "reduced", [Plane, Plan, Trench], [];
    }
}

impl BodyPart {
    /// Whether the structure has solids that yield.
    pub(crate) fn yields(self) -> bool {
        matches!(self, Self::Clay | Self::Sand | Self::ClayPair)
    }

    /// Whether a structure needs its physical degrees of freedom.
    pub(crate) fn is_nonlinear(self) -> bool {
        self.yields() || matches!(self, Self::Hysteretic | Self::Sprung)
    }

    /// Whether the structure has finite elements that a file of Gmsh can contain.
    pub(crate) fn has_a_gmsh_mesh(self) -> bool {
        matches!(
            self,
            Self::Quads
                | Self::Quads8
                | Self::Clay
                | Self::Sand
                | Self::Shells
                | Self::SlenderFrame
                | Self::Bricks
                | Self::Linked
        )
    }

    /// Whether damping or P–Δ couples the modes of the structure without ground.
    fn couples_modes(self) -> bool {
        match self {
            Self::Slender
            | Self::SlenderFloors
            | Self::SlenderFrame
            | Self::Frame
            | Self::Damped => true,
            _ => self.is_nonlinear(),
        }
    }
}

/// A choice of all parts; the seed gives the numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Choice {
    pub(crate) space: Space,
    pub(crate) ground: GroundPart,
    pub(crate) body: BodyPart,
    pub(crate) law: LawPart,
    pub(crate) motion: MotionPart,
    pub(crate) scheme: SchemePart,
    pub(crate) coordinate: CoordinatePart,
    pub(crate) seed: u64,
}

/// One of the parts that fit.
macro_rules! any {
    ($random:ident, $space:ident, $kind:ident) => {{
        let parts: Vec<$kind> =
            $kind::ALL_PARTS.iter().copied().filter(|part| part.fits($space)).collect();
        $random.pick(&parts)
    }};
}

impl Choice {
    /// Random parts; `yields` says whether the body is one of solids that yield.
    fn draw(random: &mut Random, space: Space, yields: bool) -> Self {
        let bodies: Vec<BodyPart> = BodyPart::ALL_PARTS
            .iter()
            .copied()
            .filter(|body| body.fits(space) && body.yields() == yields)
            .collect();
        let body = random.pick(&bodies);
        let coordinate = if body.couples_modes() {
            CoordinatePart::Physical
        } else {
            any!(random, space, CoordinatePart)
        };
        Self {
            space,
            ground: any!(random, space, GroundPart),
            body,
            law: any!(random, space, LawPart),
            motion: any!(random, space, MotionPart),
            scheme: any!(random, space, SchemePart),
            coordinate,
            seed: random.bits(),
        }
    }

    /// Words of all parts, for the count of pairs.
    pub(crate) fn words(&self) -> [&'static str; 6] {
        [
            self.ground.word(),
            self.body.word(),
            self.law.word(),
            self.motion.word(),
            self.scheme.word(),
            self.coordinate.word(),
        ]
    }

    pub(crate) fn name(&self) -> String {
        format!("{} (seed {})", self.words().join(", "), self.seed)
    }

    fn pairs(&self) -> Vec<[&'static str; 2]> {
        let words = self.words();
        let mut pairs = Vec::new();
        for (k, one) in words.iter().enumerate() {
            pairs.extend(words[k + 1..].iter().map(|other| [*one, *other]));
        }
        pairs
    }
}

/// Random candidates for each scene; the one with the most new pairs is chosen.
const CANDIDATE_COUNT: usize = 60;

/// `count` scenes in a space that cover as many pairs of parts as they can, without solids that yield.
pub(crate) fn covering(space: Space, seed: u64, count: usize) -> Vec<Choice> {
    covering_bodies(space, false, seed, count)
}

/// As [`covering`], of bodies in the plane whose solids yield.
pub(crate) fn covering_yielding(seed: u64, count: usize) -> Vec<Choice> {
    covering_bodies(Space::Plane, true, seed, count)
}

fn covering_bodies(space: Space, yields: bool, seed: u64, count: usize) -> Vec<Choice> {
    let mut random = Random(seed);
    let mut covered: Vec<[&'static str; 2]> = Vec::new();
    let mut chosen_parts = Vec::new();
    for _ in 0..count {
        let candidates = (0..CANDIDATE_COUNT).map(|_| Choice::draw(&mut random, space, yields));
        let best_candidate = candidates.max_by_key(|choice| {
            choice.pairs().iter().filter(|pair| !covered.contains(pair)).count()
        });
        let Some(best_candidate) = best_candidate else { break };
        covered.extend(best_candidate.pairs());
        chosen_parts.push(best_candidate);
    }
    chosen_parts
}
