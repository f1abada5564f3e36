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
    kind: Kind,
}

#[derive(Debug, Clone)]
enum Kind {
    Elastic(Material),
    Inelastic(Arc<dyn SolidMaterial>),
}

impl SharedMaterial {
    /// The linear elastic material; `None` for an inelastic one.
    pub fn elastic(&self) -> Option<&Material> {
        match &self.kind {
            Kind::Elastic(material) => Some(material),
            Kind::Inelastic(_) => None,
        }
    }

    /// The law of an inelastic material; `None` for a linear elastic one.
    pub fn inelastic(&self) -> Option<&dyn SolidMaterial> {
        match &self.kind {
            Kind::Elastic(_) => None,
            Kind::Inelastic(law) => Some(law.as_ref()),
        }
    }

    /// The material as a law.
    pub fn law(&self) -> &dyn SolidMaterial {
        match &self.kind {
            Kind::Elastic(material) => material,
            Kind::Inelastic(law) => law.as_ref(),
        }
    }
}

impl<M: SolidMaterial> From<M> for SharedMaterial {
    fn from(material: M) -> Self {
        let kind = match material.as_elastic() {
            Some(elastic) => Kind::Elastic(elastic),
            None => Kind::Inelastic(Arc::new(material)),
        };
        Self { kind }
    }
}

/// Equal elastic materials, or the same shared law.
impl PartialEq for SharedMaterial {
    fn eq(&self, other: &Self) -> bool {
        match (&self.kind, &other.kind) {
            (Kind::Elastic(material), Kind::Elastic(other_material)) => material == other_material,
            (Kind::Inelastic(law), Kind::Inelastic(other_law)) => Arc::ptr_eq(law, other_law),
            _ => false,
        }
    }
}
