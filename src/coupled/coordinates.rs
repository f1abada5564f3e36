//! Coordinates in which a linear structure is stepped.

/// Coordinates in which a linear structure is stepped.
///
/// All coordinates give the same results to rounding, except [`Coordinates::Reduced`]. [`Coordinates::Auto`] therefore
/// never reduces. A rule for structures of finite elements in space on 64 cells, in runs of some thousand steps:
///
/// | degrees of freedom | coordinates |
/// |---|---|
/// | up to 1 000 | `Auto`: all modes, or degrees of freedom if modes do not decouple the structure |
/// | 5 000 and more | `Reduced` if errors of 1e-3 are acceptable and runs are longer than 400 steps; otherwise `Auto` |
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case", deny_unknown_fields))]
#[non_exhaustive]
pub enum Coordinates {
    /// The faster of degrees of freedom and modes, by an estimate.
    ///
    /// The estimate includes the computation of the modes; see
    /// [`SimulationBuilder::expected_steps`](crate::coupled::SimulationBuilder::expected_steps). Nonlinear
    /// structures, and structures that modes do not decouple, are stepped in their degrees of freedom.
    #[default]
    Auto,
    /// The structure's degrees of freedom: sparse matrices, one back-substitution per step.
    Physical,
    /// The modes of the structure without ground and damping.
    ///
    /// The modes exist for a linear structure with symmetric matrices, a positive definite mass, and a damping that they
    /// decouple.
    Modes,
    /// Ritz modes, some hundred for thousands of degrees of freedom.
    ///
    /// The modes span a rational block Krylov basis of the responses to contact tractions, loads, probes and an initial
    /// motion. The structure is projected on them (Galerkin). The reduced structure is therefore passive and satisfies
    /// the energy balance. The settlement under weight is computed with all degrees of freedom.
    ///
    /// The tolerance applies to responses of the time scheme, each relative to its largest value. After the sudden start
    /// of a growing unit traction, these are displacements of the base, and displacements, velocities and accelerations
    /// of probes. After a sudden load, these are all probes, section forces included. The error is estimated from the
    /// change as vectors are added. On towers with 2 and 5 % damping under sudden loads, errors were below half of the
    /// tolerance. A load that acts for one or two steps is the difference of two
    /// sudden loads, and its response is smaller than the response to a sudden load. Relative to the smaller response,
    /// errors may be several times the tolerance (4.5 times was measured, for a section moment). Accelerations need more
    /// vectors, so they are checked only if a probe contains them. Other quantities follow from the base's motion
    /// without a check.
    ///
    /// The response of a bonded run is a sum of such responses. Contact amplifies their errors without a bound. On sliding
    /// and uplifting towers of 1092 to 13 122 degrees of freedom with 2 and 5 % damping, errors of base, roof and base
    /// shear were thirty times smaller than the tolerance, and errors of the roof's acceleration were below it. A
    /// structure of at most 1 000 degrees of freedom is stepped in all of its modes if fewer modes are not accurate.
    ///
    /// **Many forces**: with more than 99 forces, such as the tractions of 34 elements in plan, the modes span the
    /// vibration modes up to a frequency near 2/Δt, the static responses to all forces and one or two powers of K_eff.
    /// The tolerance then applies to tractions and loads that grow over 32 steps by binomial weights: a vibration of
    /// 20 steps a period keeps 67 % of its amplitude, of 10 steps 20 %, of 4 steps 2e-5. Structures without damping, or
    /// with damping in proportion to mass alone, can therefore be reduced. Motion at fewer steps a period, such as
    /// accelerations after a collision, has no error bound. With fewer forces, a structure whose responses do not converge
    /// without damping is an error.
    ///
    /// Measured errors of a block of 1 344 degrees of freedom on 36 cells, which slides and uplifts on 17 % of its
    /// base: at a tolerance of 1e-3, at most 2e-4 in base shear, displacements and pressures with damping in proportion
    /// to stiffness, and 6e-4 without damping. At a tolerance of 1e-4 they were 2e-5 with this damping and 3e-4
    /// without; those of the roof's acceleration were 4e-3 and 4e-2. Twelve harder blocks of 2 400 degrees of freedom
    /// (parts 1e4 times as stiff as others, point masses, none or all of the damping in proportion to mass) had errors
    /// of at most 9e-4 in base shear and displacements and of 3.4e-3 in pressures at 1e-4. Compare two tolerances.
    ///
    /// Probes of section forces add vectors, because such forces respond to tractions less than their stiffness suggests.
    /// On a block of concrete on 36 cells the section shear and moment at half its height had errors of 8e-5 at 1e-4.
    /// Contact amplifies these errors too: at 1e-6 they were 1e-5 to 4e-5 on the soft block. Below 1e-4 the responses of
    /// such probes on a stiff structure may not converge with the few powers of K_eff that are tried. Up to 2 500 degrees
    /// of freedom the structure is then stepped in all of its modes. For a larger structure the error names what to
    /// change.
    /// Solids of 33 075 and 103 788 degrees of freedom on 64 cells took 13 and 65 s, and 0.9 and 2.5 GB, to build at
    /// 1e-4. A step of the first took 0.2 ms in full contact and 0.6 ms with half of the base open.
    ///
    /// The reduction needs a linear structure with symmetric matrices, a positive definite mass and proportional damping;
    /// an error names the missing property. Damping in proportion to mass and to the stiffness without P–Δ, such as
    /// Rayleigh damping of finite elements with P–Δ, couples the modes. The tolerance is then checked with a damping in
    /// proportion to the whole stiffness. Responses to the coupling are added down to a tenth of the root of the
    /// tolerance, and the time of a step grows with the square of the number of vectors. The coupling itself is not
    /// checked. On a tower of 1 092 degrees of freedom at a tolerance of 1e-3, errors were 3e-5 in base shear and
    /// displacements and 1.05e-3 in the roof's acceleration. On a block on 36 cells all errors were at most 1e-4.
    ///
    /// A load that the structure defines is sampled 17 times over the expected steps. A load that acts only between two
    /// samples is projected without a check. This does not concern the builder's loads. Building takes two to six times
    /// as long as with other coordinates. Each element in plan adds three forces, so that 64 cells need 300 to 600
    /// vectors.
    Reduced {
        /// Relative error of responses to tractions, above 0 and below 1.
        ///
        /// Below about 1e-9 rounding may prevent convergence.
        tolerance: f64,
    },
}

words_with_numbers! {
    /// Parses one of its words, or returns [`Error::Name`](crate::Error::Name).
    ///
    /// ```
    /// use basemat::coupled::Coordinates;
    /// let reduced = Coordinates::Reduced { tolerance: 1e-6 };
    /// assert_eq!("reduced(1e-6)".parse(), Ok(reduced));
    /// assert_eq!(reduced.to_string(), "reduced(1e-6)");
    /// let error = "ritz".parse::<Coordinates>().unwrap_err();
    /// let words = "auto, physical, modes, reduced(tolerance)";
    /// assert_eq!(error.to_string(), format!("there is no kind of coordinates 'ritz', only {words}"));
    /// ```
    Coordinates, "kind of coordinates", {
        Auto = "auto", Physical = "physical", Modes = "modes";
        Reduced { tolerance } = "reduced",
    }
}
