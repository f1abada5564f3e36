//! Errors of structures.

/// Why a structure cannot stand on a ground, whatever its loads.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StructureError {
    /// A structure with stiffness to a fixed point: the ground alone must hold it up.
    #[error(
        "the structure must translate freely, without supports: moved {direction} by 1 m it meets \
         {force:.2e} N at degree of freedom {dof}, {ratio:.1e} of the stiffness around (entries of a \
         stiffness matrix in a file need eleven digits or more)"
    )]
    Restrained {
        /// Direction of the translation that is resisted.
        direction: &'static str,
        /// Force per metre of translation at the degree of freedom, N/m; if the structure is held so that it can hardly
        /// translate, the force at the contact nodes.
        force: f64,
        /// The degree of freedom with the largest force relative to the stiffness around.
        dof: usize,
        /// That force relative to the stiffness around.
        ratio: f64,
    },
    /// A part of a structure that no stiffness joins to its contact nodes: it would neither weigh on the ground
    /// nor move.
    #[error(
        "part of the structure is not joined to its base by any stiffness: {place} (dashpots alone \
         hold nothing up)"
    )]
    Detached {
        /// The degrees of freedom of all such parts, ascending.
        dofs: Vec<usize>,
        /// The structure's names of them: see [`Structure::describe`](crate::structure::Structure::describe).
        place: String,
    },
    /// A structure that buckles, held at its contact nodes, under the axial forces of its static state.
    #[error(
        "the structure buckles under the axial forces of its static state: held at its contact \
         nodes it carries {factor:.3e} of them"
    )]
    Buckling {
        /// Fraction of the axial forces at which it buckles.
        factor: f64,
    },
}
