//! A finished picture.

use std::path::Path;

use plotters::prelude::*;

use crate::error::{Error, Result, write_file};

/// Size of the pictures, pixels.
pub(super) const SIZE: (u32, u32) = (1100, 560);

/// Text of a picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Svg(String);

impl Svg {
    pub(super) fn new(text: String) -> Self {
        Self(text)
    }

    /// The SVG's text.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// Writes it to a file; its folder is made if it is not there.
    ///
    /// # Errors
    /// [`Error::Write`] if that fails.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<()> {
        write_file(path.as_ref(), &self.0)
    }
}

/// Where charts are drawn.
pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

/// Whatever goes wrong while drawing into memory.
pub(super) type Drawing<T> = std::result::Result<T, Box<dyn std::error::Error + Send + Sync>>;

/// Draws on a white sheet.
pub(super) fn picture(draw: impl FnOnce(&Area<'_>) -> Drawing<()>) -> Result<Svg> {
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        let drawn = area.fill(&WHITE).map_err(Into::into).and_then(|()| draw(&area));
        let done = drawn.and_then(|()| area.present().map_err(Into::into));
        done.map_err(|_| Error::Scene {
            quantity: "picture",
            needed: "values that a chart can show: finite, and not all too large",
        })?;
    }
    Ok(Svg::new(text))
}
