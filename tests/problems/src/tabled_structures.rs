//! Flexible structures of the tables `td_*`.

use basemat::fem::{Beam, Element, MassKind};
use basemat::structure::{Base, BaseNode, ShearBuilding, Storey, Structure, Triplets};

/// The three storeys of `td_shearbuilding3_*`.
pub fn three_storeys() -> basemat::Result<ShearBuilding> {
    let storey = Storey {
        height: 1.0,
        mass: 1.0,
        rotary_inertia: 1.0 / 3.0,
        stiffness: 2.0,
        damping: 2.0 * 0.158_885_451_5,
    };
    ShearBuilding::new(2.0, 1.0, 1.0 / 3.0, &[storey; 3])
}

/// The cantilever of `td_EBcantilever_*`: beams on a rigid base with mass and rotary inertia.
///
/// Node 0 is the middle of the base.
pub struct Cantilever {
    beams: Vec<Beam>,
    nodes: Vec<[f64; 3]>,
}

impl Cantilever {
    pub fn new(elements: usize) -> Self {
        // EI = 20, mass per length 1, and an area that keeps the axial mode out of the way.
        Self {
            beams: (0..elements)
                .map(|k| Beam::new([k, k + 1], 20.0, 1.0, 1.0, 1.0).unwrap())
                .collect(),
            nodes: (0..=elements).map(|k| [0.0, 4.0 * k as f64 / elements as f64, 0.0]).collect(),
        }
    }

    /// Degree of freedom of the top's displacement.
    pub fn top(&self) -> usize {
        3 * self.beams.len()
    }

    /// Adds an element matrix of all beams, times a factor.
    fn add_beams(
        &self,
        factor: f64,
        matrix: &mut Triplets,
        fill: impl Fn(&Beam, &[[f64; 3]], &mut [f64]),
    ) {
        for (k, beam) in self.beams.iter().enumerate() {
            let mut block = [0.0; 36];
            fill(beam, &self.nodes[k..k + 2], &mut block);
            let dofs: Vec<usize> = (3 * k..3 * k + 6).collect();
            matrix.add_block(&dofs, &block.map(|x| factor * x));
        }
    }
}

impl Structure for Cantilever {
    fn dofs(&self) -> usize {
        3 * self.nodes.len()
    }

    fn base(&self) -> Base {
        BaseNode::rigid_base(-1.0, 1.0, [0, 1, 2]).into()
    }

    fn mass(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        matrix.add(0, 0, 1.0);
        matrix.add(1, 1, 1.0);
        matrix.add(2, 2, 1.0 / 3.0);
        self.add_beams(1.0, matrix, |beam, nodes, block| {
            beam.mass(nodes, MassKind::Consistent, block);
        });
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        self.add_beams(1.0, matrix, Beam::stiffness);
        Ok(())
    }

    fn damping(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        self.add_beams(0.02, matrix, Beam::stiffness);
        Ok(())
    }
}
