//! Conditions of warnings: limits, and the warnings of a scene, a motion and a run.

use crate::bem::GroundDescription;
use crate::coupled::run::mistake::Mistake;
use crate::coupled::run::peak::Peak;
use crate::coupled::run::warning::Warning;
use crate::coupled::run::{Quantity, Run, unusual_numbers};
use crate::coupled::scene::Scene;
use crate::coupled::state::energy_balance::EnergyBalance;
use crate::coupled::statics::strength::friction_at_rest;
use crate::interface::{InterfaceLaw, LawForm, Mode};
use crate::motion::FreeField;

impl Warning {
    /// Rotation above which a run warns, rad: its cosine is 0.995.
    const ROTATION_LIMIT: f64 = 0.1;
    /// Settlement over the width of a foundation above which a run warns.
    ///
    /// It is the usual criterion of bearing failure in load tests.
    const SETTLEMENT_LIMIT: f64 = 0.1;
    /// Energy error at the end of a run above which it warns.
    ///
    /// Earlier, while energies are still small, the error may be larger.
    const ENERGY_ERROR_LIMIT: f64 = 1e-9;
    /// Energy created by the time scheme above which a run warns, relative to the largest energy.
    const ALGORITHMIC_ENERGY_LIMIT: f64 = 0.02;

    /// Tension above which a run under weight warns, relative to the largest static pressure.
    pub(crate) const TENSION_LIMIT: f64 = 0.01;

    /// Smallest fraction of a record's intensity that a run should cover.
    const MIN_PASSED_INTENSITY: f64 = 2.0 / 3.0;
    /// Reduction of a slip event by damping above which a run warns.
    const SLIP_LOSS_LIMIT: f64 = 0.1;
    /// Ratio of damping force to friction below which a series gives the loss of slip.
    ///
    /// The first term of the series is sufficient.
    const MAX_SERIES_FORCE_RATIO: f64 = 1e-3;
    /// Smallest acceleration of a moving ground, relative to the peak of its records.
    const MIN_SHAKING_FRACTION: f64 = 0.01;
    /// Response that counts as rounding: slip in m, rotation in rad.
    ///
    /// Shear, and moment with a lever of 1 m, are relative to the normal force.
    const RESPONSE_ROUNDING: f64 = 1e-9;
    /// Relative growth in the last step of a response that counts as constant.
    const CONSTANT_RESPONSE_GROWTH: f64 = 1e-4;
    /// Smallest number of steps of a run whose peaks are checked.
    const MIN_CHECKED_STEPS: usize = 8;
    /// Responses for which a run warns of a largest value in its last step.
    pub(crate) const RESPONSES_CHECKED_AT_END: [Quantity; 4] =
        [Quantity::BaseShear, Quantity::BaseMoment, Quantity::MeanSlip, Quantity::BaseRotation];

    /// Open fraction of a base under water above which a run warns.
    const GAP_UNDER_WATER_LIMIT: f64 = 0.1;

    /// Smallest friction for which mirror images of scenes in plan have differed.
    const HIGH_FRICTION_COEFFICIENT: f64 = 3.0;

    /// Warnings of a scene before its first step.
    ///
    /// `description`: of the ground; `period`: of the structure on a fixed base, s.
    pub(crate) fn of_scene(
        scene: &Scene,
        description: &GroundDescription,
        motion: &dyn FreeField,
        period: f64,
    ) -> Vec<Self> {
        let &GroundDescription { ref soils, sampled_cells, .. } = description;
        let mut warnings: Vec<_> = Self::of_soils(soils).collect();
        // A model not to scale already has the warning of its soil.
        if warnings.is_empty() && period > unusual_numbers::MAX_USUAL_PERIOD {
            warnings.push(Self::Mistake(Mistake::LongPeriod { period }));
        }
        for (foundation, axis, reach) in scene.base.long_overhangs() {
            warnings.push(Self::UncoveredBase { foundation, reach, axis });
        }
        warnings.extend(Self::of_joints(scene));
        warnings.extend(Self::of_time_step(scene.time_step, motion, period));
        if scene.layout().is_plan() {
            warnings.extend(Self::of_high_friction(scene));
        } else if motion.moves_across() {
            warnings.push(Self::MotionAcross);
        }
        if let Some(substituted) = scene.static_state.substituted_friction {
            Self::count_substituted_friction(&mut warnings, substituted);
        }
        if let Some([checked, cells]) = sampled_cells {
            warnings.push(Self::SampledPassivity { checked, cells });
        }
        warnings
    }

    /// Warnings of joints with fewer elements than segments of a flexible side.
    fn of_joints(scene: &Scene) -> impl Iterator<Item = Self> {
        scene.base.joints().iter().enumerate().filter_map(|(joint, placed)| {
            let elements = placed.elements.len();
            let needed = placed.line.segments();
            (elements < needed).then_some(Self::CoarseJoint { joint, elements, needed })
        })
    }

    /// Warnings of an early end, a peak at the end, or an overturned base.
    ///
    /// `acceleration`: largest ground acceleration of the run, m/s². A run that an observer or the caller's own loop ended
    /// does not warn of an early end.
    pub(crate) fn of_end(run: &Run, acceleration: f64, rotation_limit: f64) -> Vec<Self> {
        let end = run.end;
        let motion = &run.ground_motion;
        if run.is_overturned {
            return vec![Self::Overturned { limit: rotation_limit, time: end }];
        }
        let mut warnings = Vec::new();
        if !run.ends_by_steps {
            return warnings;
        }
        if let (Some(duration), Some(passed)) = (motion.duration, motion.passed)
            && passed < Self::MIN_PASSED_INTENSITY
        {
            warnings.push(Self::EndsEarly { end, duration, passed });
        }
        let is_shaken = acceleration > Self::MIN_SHAKING_FRACTION * motion.peak;
        if !is_shaken || run.steps < Self::MIN_CHECKED_STEPS {
            return warnings;
        }
        for (response_index, quantity) in Self::RESPONSES_CHECKED_AT_END.into_iter().enumerate() {
            let peak = run.whole.peak(quantity);
            let is_force = matches!(quantity, Quantity::BaseShear | Quantity::BaseMoment);
            let scale = if is_force { run.whole.static_normal_force.abs() } else { 1.0 };
            let is_response = peak.magnitude() > Self::RESPONSE_ROUNDING * scale;
            let is_growing =
                run.growth_in_last_step(response_index) > Self::CONSTANT_RESPONSE_GROWTH;
            if peak.time == end && is_response && is_growing {
                warnings.push(Self::PeakAtEnd { quantity, end });
                break;
            }
        }
        warnings
    }

    /// Warning of damping that slows a sliding base.
    ///
    /// `rate`: damping of a rigid translation over its mass, 1/s. `slip_duration`: of the longest slip event, s.
    pub(crate) fn of_translation_damping(rate: f64, slip_duration: f64) -> Option<Self> {
        // Sliding to rest against friction lasts ln(1 + x)/rate, with x the damping force over friction at the
        // start. It covers 2 (1 − ln(1 + x)/x)/x of the distance without damping.
        let x = (rate * slip_duration).exp_m1();
        // Digits of the formula cancel if x is small; the first term of its series is 2x/3.
        let loss = if x < Self::MAX_SERIES_FORCE_RATIO {
            2.0 / 3.0 * x
        } else {
            1.0 - 2.0 * (1.0 - x.ln_1p() / x) / x
        };
        (loss > Self::SLIP_LOSS_LIMIT).then_some(Self::DampedSliding { rate, loss })
    }

    /// Warning of points where faces of a base move apart.
    ///
    /// `tears`: number of these points, and coordinates of the first one, m.
    pub(crate) fn of_tears(tears: Option<(usize, [f64; 2])>) -> Option<Self> {
        tears.map(|(points, [x, y])| Self::Mistake(Mistake::TornBase { points, x, y }))
    }

    /// Warning of faces at the height of the base that do not touch the ground.
    ///
    /// `faces`: their number, and the middle of the first one, m.
    pub(crate) fn of_faces_off_ground(faces: Option<(usize, [f64; 2])>) -> Option<Self> {
        faces.map(|(faces, [x, y])| Self::Mistake(Mistake::FacesOffGround { faces, x, y }))
    }

    /// Warning of friction for which steps in plan may have several solutions.
    fn of_high_friction(scene: &Scene) -> Option<Self> {
        let mut friction: f64 = 0.0;
        for law in &scene.laws {
            if law.modes().iter().any(|mode| *mode != Mode::Stick) {
                friction = friction.max(friction_at_rest(law.as_ref(), LawForm::Limits));
            }
        }
        (friction >= Self::HIGH_FRICTION_COEFFICIENT).then_some(Self::HighFriction { friction })
    }

    /// Counts a step that was solved with `substituted` friction instead of a larger one.
    pub(crate) fn count_substituted_friction(warnings: &mut Vec<Self>, substituted: f64) {
        for warning in &mut *warnings {
            if let Self::LessFriction { steps, friction } = warning {
                *steps += 1;
                *friction = friction.min(substituted);
                return;
            }
        }
        warnings.push(Self::LessFriction { steps: 1, friction: substituted });
    }

    /// Warning of a foundation whose settlement exceeds the limit.
    ///
    /// `foundation`: its index. `settlement` and `width` are in m.
    pub(crate) fn of_settlement(foundation: usize, settlement: f64, width: f64) -> Option<Self> {
        let is_large = settlement > Self::SETTLEMENT_LIMIT * width;
        is_large.then_some(Self::LargeSettlement { foundation, settlement, width })
    }

    /// Warning of a gap that water must fill.
    pub(crate) fn of_water(run: &Run) -> Option<Self> {
        let foundations = run.foundations.iter().map(|summary| summary.uplifted_fraction.highest);
        let Peak { value: fraction, time } =
            foundations.max_by(|a, b| a.value.total_cmp(&b.value))?;
        let is_open = run.buoyancy > 0.0 && fraction > Self::GAP_UNDER_WATER_LIMIT;
        is_open.then_some(Self::WaterInGap { fraction, time })
    }

    /// Warnings of a run's largest slip, largest rotation, last energy balance and smallest algorithmic energy.
    ///
    /// `element_length`: mean length of the elements, m.
    pub(crate) fn of_results(
        slip: f64,
        element_length: f64,
        rotation: f64,
        energy_balance: &EnergyBalance,
        smallest_algorithmic_energy: f64,
    ) -> Vec<Self> {
        let slip = slip.abs();
        let rotation = rotation.abs();
        let mut warnings = Vec::new();
        if slip > element_length {
            warnings.push(Self::LargeSlip { slip, element_length });
        }
        if rotation > Self::ROTATION_LIMIT {
            warnings.push(Self::LargeRotation { rotation });
        }
        let residual = energy_balance.residual();
        if residual > Self::ENERGY_ERROR_LIMIT
            || (residual.is_nan() && !energy_balance.is_omitted())
        {
            warnings.push(Self::EnergyBalance { residual });
        }
        let created_fraction = -smallest_algorithmic_energy / energy_balance.scale();
        if created_fraction > Self::ALGORITHMIC_ENERGY_LIMIT {
            warnings.push(Self::AlgorithmicEnergy { made: created_fraction });
        }
        warnings
    }
}
