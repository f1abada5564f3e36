//! Material of an element, shared by its clones.

use std::sync::Arc;

use super::SolidMaterial;
use crate::fem::material::Material;

/// Material of an element: linear elastic, or any [`SolidMaterial`].
///
/// Quadrilaterals in plane strain take it by `impl Into<SharedMaterial>`, so that they accept a [`Material`] or a law
/// directly. Bricks, shells and beams are linear elastic. Clones share the law, which never changes.
#[derive(Debug, Clone)]
pub struct SharedMaterial {
    kind: LawKind,
}

#[derive(Debug, Clone)]
enum LawKind {
    Elastic(Material),
    Inelastic(Arc<dyn SolidMaterial>),
}

impl SharedMaterial {
    /// The linear elastic material; `None` for an inelastic one.
    pub fn elastic(&self) -> Option<&Material> {
        match &self.kind {
            LawKind::Elastic(material) => Some(material),
            LawKind::Inelastic(_) => None,
        }
    }

    /// The law of an inelastic material; `None` for a linear elastic one.
    pub fn inelastic(&self) -> Option<&dyn SolidMaterial> {
        match &self.kind {
            LawKind::Elastic(_) => None,
            LawKind::Inelastic(law) => Some(law.as_ref()),
        }
    }

    /// The material as a law.
    pub fn law(&self) -> &dyn SolidMaterial {
        match &self.kind {
            LawKind::Elastic(material) => material,
            LawKind::Inelastic(law) => law.as_ref(),
        }
    }
}

impl<M: SolidMaterial> From<M> for SharedMaterial {
    fn from(material: M) -> Self {
        let kind = match material.as_elastic() {
            Some(elastic) => LawKind::Elastic(elastic),
            None => LawKind::Inelastic(Arc::new(material)),
        };
        Self { kind }
    }
}

/// Equal elastic materials, or the same shared law.
impl PartialEq for SharedMaterial {
    fn eq(&self, other: &Self) -> bool {
        match (&self.kind, &other.kind) {
            (LawKind::Elastic(material), LawKind::Elastic(other_material)) => {
                material == other_material
            }
            (LawKind::Inelastic(law), LawKind::Inelastic(other_law)) => Arc::ptr_eq(law, other_law),
            _ => false,
        }
    }
}
