//! Coordinates in which a linear structure is stepped.

/// Coordinates in which a linear structure is stepped. Results are the same to rounding but for
/// [`Coordinates::Reduced`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case", deny_unknown_fields))]
#[non_exhaustive]
pub enum Coordinates {
    /// Whichever is expected to take less time, with the modes' own computation counted against them; see
    /// [`SimulationBuilder::expected_steps`](crate::coupled::SimulationBuilder::expected_steps). Nonlinear structures,
    /// and those that modes do not decouple, keep their degrees of freedom.
    #[default]
    Auto,
    /// The structure's degrees of freedom: sparse matrices, one back-substitution per step.
    Physical,
    /// The modes of the structure without ground and damping. Needs a linear structure with
    /// symmetric matrices, a positive definite mass and damping that the modes decouple.
    Modes,
    /// Ritz modes, two to four hundred for thousands of degrees of freedom: a rational block Krylov basis of the
    /// responses to contact tractions, loads, probes and an initial motion, projected (Galerkin), so that
    /// it stays passive and the energy balance closes. The settlement under weight is that of all degrees of freedom.
    ///
    /// The tolerance is for the error of responses, as the time scheme steps them, each relative to its
    /// largest: to a unit traction that begins to grow suddenly, displacements of the base, and displacements,
    /// velocities and accelerations that probes read; to a load that jumps, what every probe reads, section forces
    /// included. It is an estimate, from the change as vectors are added: on towers of 2 and 5 % under loads that jump,
    /// errors stayed below half of it. A load that acts for one or two steps is the difference of two jumps, and its own
    /// response is smaller than that to a jump: relative to it, errors may be several times the tolerance (4.5 times
    /// was measured, for a section moment). Accelerations need more vectors, so they are looked at only where a probe
    /// reads them. What no probe reads is as good as the base's motion
    /// makes it; it is not checked.
    ///
    /// A bonded run is a sum of such responses. Contact amplifies their errors, which nothing bounds; on towers of 1
    /// 092 to 13 122 degrees of freedom with 2 and 5 % of damping that slide and uplift, errors of base, roof and base
    /// shear stayed thirty times below the tolerance, and those of the roof's acceleration below it. Undamped
    /// structures are an error: no few vectors have what rings on above the frequency 2/Δt, and their accelerations
    /// would be lost first.
    ///
    /// Needs a linear structure with symmetric matrices, a positive definite mass and proportional damping;
    /// [`ReducedError`](crate::ReducedError) names what is wrong. A load of the structure's own is looked at 17 times
    /// over the expected steps: what acts only in between is projected. Loads of the builder have no such gap. Building
    /// takes three to six times that of other coordinates: orthogonalizing 100 to 250 vectors is 70 % of it, factors at
    /// other shifts are a tenth.
    Reduced {
        /// Relative error of responses to sudden tractions, above 0 and below 1; below about 1e-9
        /// rounding may get in the way.
        tolerance: f64,
    },
}

words_with_numbers! {
    /// One of its words, or an [`Error::Word`](crate::Error::Word).
    ///
    /// ```
    /// use basemat::coupled::Coordinates;
    /// let reduced = Coordinates::Reduced { tolerance: 1e-6 };
    /// assert_eq!("reduced(1e-6)".parse(), Ok(reduced));
    /// assert_eq!(reduced.to_string(), "reduced(1e-6)");
    /// let refused = "ritz".parse::<Coordinates>().unwrap_err();
    /// let known = "auto, physical, modes, reduced(tolerance)";
    /// assert_eq!(refused.to_string(), format!("there is no kind of coordinates 'ritz', only {known}"));
    /// ```
    Coordinates, "kind of coordinates", {
        Auto = "auto", Physical = "physical", Modes = "modes";
        Reduced { tolerance } = "reduced",
    }
}
