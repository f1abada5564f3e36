//! Rectangles, rings, bars and I-sections of fibres.

use std::f64::consts::PI;

use super::UniaxialMaterial;
use super::section::{FiberSection, shared};
use crate::error::{Result, all_finite, at_least, positive};

impl FiberSection {
    /// Adds a rectangle between two `corners` [y, z] (m), cut into `counts` fibres along y and z.
    ///
    /// # Errors
    /// [`Error::NotFinite`](crate::Error::NotFinite) and [`Error::Input`](crate::Error::Input) for corners that are not finite or equal in y or z, and for a material
    /// without a positive modulus; [`Error::Size`](crate::Error::Size) without fibres.
    pub fn with_rectangle(
        self,
        corners: [[f64; 2]; 2],
        counts: [usize; 2],
        material: impl UniaxialMaterial,
    ) -> Result<Self> {
        all_finite("corners of a rectangle of fibres", corners.as_flattened())?;
        let sizes = [0, 1].map(|axis| (corners[1][axis] - corners[0][axis]) / counts[axis] as f64);
        for count in counts {
            at_least("fibres along a side of a rectangle", count, 1)?;
        }
        let area = positive("area of a fibre", (sizes[0] * sizes[1]).abs())?;
        let mut fibers = Vec::with_capacity(counts[0] * counts[1]);
        for i in 0..counts[0] {
            for j in 0..counts[1] {
                let y = corners[0][0] + (i as f64 + 0.5) * sizes[0];
                let z = corners[0][1] + (j as f64 + 0.5) * sizes[1];
                fibers.push(([y, z], area));
            }
        }
        let axial_stiffness = material.modulus() * area * fibers.len() as f64;
        let section = self.with_fibers(&fibers, &shared(material))?;
        Ok(section.with_neglected_stiffness(sizes.map(|size| axial_stiffness * size * size / 12.0)))
    }

    /// Adds a ring (or a disc) about `center` [y, z] (m), cut into `counts` rings and sectors.
    ///
    /// `radii`: inside (0 for a disc) and outside, m. Each fibre lies at the centroid of its part of the ring.
    ///
    /// # Errors
    /// [`Error::NotFinite`](crate::Error::NotFinite) and [`Error::Input`](crate::Error::Input) unless the centre is finite and 0 ≤ inside < outside, and for a material
    /// without a positive modulus; [`Error::Size`](crate::Error::Size) unless there are a ring and three sectors.
    pub fn with_ring(
        self,
        center: [f64; 2],
        radii: [f64; 2],
        counts: [usize; 2],
        material: impl UniaxialMaterial,
    ) -> Result<Self> {
        all_finite("centre of a ring of fibres", &center)?;
        crate::error::not_negative("inner radius of a ring of fibres", radii[0])?;
        let thickness = positive("thickness of a ring of fibres", radii[1] - radii[0])?;
        at_least("rings of fibres", counts[0], 1)?;
        at_least("sectors of fibres", counts[1], 3)?;
        let half_angle = PI / counts[1] as f64;
        let mut fibers = Vec::with_capacity(counts[0] * counts[1]);
        for ring in 0..counts[0] {
            let inner = radii[0] + thickness * ring as f64 / counts[0] as f64;
            let outer = radii[0] + thickness * (ring + 1) as f64 / counts[0] as f64;
            let area = half_angle * (outer * outer - inner * inner);
            let radius = 2.0 * half_angle.sin() * (outer.powi(3) - inner.powi(3)) / (3.0 * area);
            for sector in 0..counts[1] {
                let angle = 2.0 * half_angle * (sector as f64 + 0.5);
                let position = [center[0] + radius * angle.cos(), center[1] + radius * angle.sin()];
                fibers.push((position, area));
            }
        }
        self.with_fibers(&fibers, &shared(material))
    }

    /// Adds `count` bars of `bar_area` (m²) on a straight line between two `ends` [y, z] (m), ends included.
    ///
    /// A single bar lies in the middle. The bars do not replace the concrete around them.
    ///
    /// # Errors
    /// [`Error::NotFinite`](crate::Error::NotFinite) for the ends, [`Error::Size`](crate::Error::Size) without bars, [`Error::Input`](crate::Error::Input) unless area and modulus are
    /// positive.
    pub fn with_bars(
        self,
        ends: [[f64; 2]; 2],
        count: usize,
        bar_area: f64,
        material: impl UniaxialMaterial,
    ) -> Result<Self> {
        at_least("bars of a layer", count, 1)?;
        let position = |bar: usize| {
            let s = if count == 1 { 0.5 } else { bar as f64 / (count - 1) as f64 };
            [0, 1].map(|axis| (1.0 - s) * ends[0][axis] + s * ends[1][axis])
        };
        let fibers: Vec<_> = (0..count).map(|bar| (position(bar), bar_area)).collect();
        self.with_fibers(&fibers, &shared(material))
    }

    /// Adds an I-section about the middle of its height: two flanges and a web, bent about its strong axis along y.
    ///
    /// `depth` over all and `flange_width`, with the thicknesses of web and flanges, m. Each flange has `counts[0]` and
    /// the web `counts[1]` layers of fibres along y. Beams in space also need fibres across the flanges:
    /// [`with_i_section_in_space`](FiberSection::with_i_section_in_space).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless all are positive and the flanges thinner than half of the depth; as
    /// [`with_rectangle`](FiberSection::with_rectangle).
    pub fn with_i_section(
        self,
        sizes: [f64; 2],
        thicknesses: [f64; 2],
        counts: [usize; 2],
        material: impl UniaxialMaterial + Clone,
    ) -> Result<Self> {
        let fiber_counts = counts.map(|count| [count, 1]);
        self.with_i_section_in_space(sizes, thicknesses, fiber_counts, material)
    }

    /// Adds an I-section as [`with_i_section`](FiberSection::with_i_section), cut along y and z.
    ///
    /// `counts`: fibres along y and along z of each flange, then of the web.
    ///
    /// # Errors
    /// As for [`with_i_section`](FiberSection::with_i_section).
    pub fn with_i_section_in_space(
        self,
        [depth, flange_width]: [f64; 2],
        [web_thickness, flange_thickness]: [f64; 2],
        counts: [[usize; 2]; 2],
        material: impl UniaxialMaterial + Clone,
    ) -> Result<Self> {
        positive("flange width of an I-section", flange_width)?;
        positive("web thickness of an I-section", web_thickness)?;
        positive("flange thickness of an I-section", flange_thickness)?;
        let web_height = positive("web height of an I-section", depth - 2.0 * flange_thickness)?;
        let top = 0.5 * depth;
        let edge = 0.5 * web_height;
        let flange = 0.5 * flange_width;
        let web = 0.5 * web_thickness;
        self.with_rectangle([[-top, -flange], [-edge, flange]], counts[0], material.clone())?
            .with_rectangle([[-edge, -web], [edge, web]], counts[1], material.clone())?
            .with_rectangle([[edge, -flange], [top, flange]], counts[0], material)
    }
}
