//! Pictures as bitmaps, for report editors that do not read SVG (feature `png`).

use std::path::Path;
use std::sync::{Arc, OnceLock};

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

use super::Svg;
use crate::error::{Error, Result, require};
use crate::text::file::write_file;

/// Largest bitmap, pixels: 100 million, 400 MB.
const MAX_BITMAP_PIXELS: f64 = 1e8;
/// Error for a picture that the renderer rejects.
const NOT_DRAWN: Error =
    Error::Scene { quantity: "bitmap", needed: "a picture that can be drawn as one" };

/// The font of all bitmaps, which makes them equal on every machine.
fn fonts() -> Arc<fontdb::Database> {
    static FONTS: OnceLock<Arc<fontdb::Database>> = OnceLock::new();
    FONTS.get_or_init(|| Arc::new(load_fonts())).clone()
}

fn load_fonts() -> fontdb::Database {
    let mut fonts = fontdb::Database::new();
    let font: &'static [u8] = dejavu::sans_condensed::regular();
    fonts.load_font_source(fontdb::Source::Binary(Arc::new(font)));
    // The family name in the file; no wider font is loaded that could be confused with it.
    fonts.set_sans_serif_family("DejaVu Sans");
    fonts
}

impl Svg {
    /// The picture as a bitmap in PNG format, with `scale` pixels per unit of the SVG.
    ///
    /// Use a scale of 1 for screens and 3 for print. The font is DejaVu Sans Condensed, which is part of the
    /// crate. An animation shows its start.
    ///
    /// # Errors
    /// [`Error::Input`] for a scale that is not positive, or a bitmap of more than 100 million pixels.
    pub fn png(&self, scale: f64) -> Result<Vec<u8>> {
        let options = Options { fontdb: fonts(), ..Options::default() };
        let tree = Tree::from_str(self.as_str(), &options).map_err(|_| NOT_DRAWN)?;
        let picture_size = tree.size();
        let width = f64::from(picture_size.width()) * scale;
        let height = f64::from(picture_size.height()) * scale;
        // Comparisons with NaN are false, so a scale that is NaN is an error.
        let has_valid_size = width >= 1.0 && height >= 1.0 && width * height <= MAX_BITMAP_PIXELS;
        let needed = "above zero, and a bitmap of 100 million pixels at most";
        require("scale of a bitmap", scale, has_valid_size, needed)?;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let mut bitmap = Pixmap::new(width.ceil() as u32, height.ceil() as u32).ok_or(NOT_DRAWN)?;
        #[allow(clippy::cast_possible_truncation)]
        let scale = scale as f32;
        resvg::render(&tree, Transform::from_scale(scale, scale), &mut bitmap.as_mut());
        bitmap.encode_png().map_err(|_| NOT_DRAWN)
    }

    /// Writes the bitmap of [`Svg::png`] to a file; its folder is made if it does not exist.
    ///
    /// # Errors
    /// As for [`Svg::png`]; [`Error::File`] if the file cannot be written.
    pub fn save_png(&self, path: impl AsRef<Path>, scale: f64) -> Result<()> {
        write_file(path.as_ref(), self.png(scale)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::{Curve, curves};

    fn bitmap_of_chart(title: &str, scale: f64) -> Pixmap {
        let points = vec![(0.0, 0.0), (1.0, 1.0)];
        let line = Curve { name: "line".into(), points };
        let svg = curves(title, "x", "y", &[line]).unwrap();
        Pixmap::decode_png(&svg.png(scale).unwrap()).unwrap()
    }

    /// Number of pixels darker than half.
    fn dark_pixels(bitmap: &Pixmap) -> usize {
        bitmap.pixels().iter().filter(|pixel| pixel.red() < 128).count()
    }

    #[test]
    fn bitmaps_have_the_scaled_size_and_the_letters_of_the_title() {
        let blank = bitmap_of_chart("", 1.0);
        let title = bitmap_of_chart("Base shear", 1.0);
        assert_eq!([blank.width(), blank.height()], [1100, 560]);
        assert_eq!(blank.pixels()[0].red(), 255);
        assert!(
            dark_pixels(&title) > dark_pixels(&blank) + 200,
            "{} {}",
            dark_pixels(&title),
            dark_pixels(&blank)
        );
        let large_bitmap = bitmap_of_chart("Base shear", 2.5);
        assert_eq!([large_bitmap.width(), large_bitmap.height()], [2750, 1400]);
        // Areas grow with the square of the scale.
        let growth = dark_pixels(&large_bitmap) as f64 / dark_pixels(&title) as f64;
        assert!((4.0..9.0).contains(&growth), "{growth}");
    }

    #[test]
    fn the_font_has_every_letter_that_pictures_use() {
        let blank = bitmap_of_chart("", 1.0);
        let fallback = bitmap_of_chart("\u{e000}", 1.0);
        for letter in "µ²³⁻⁵·×÷°′–…αβφπτηξωΔ≤≥≈√∞".chars() {
            let bitmap = bitmap_of_chart(&letter.to_string(), 1.0);
            assert!(bitmap.data() != blank.data(), "{letter} is not drawn");
            assert!(bitmap.data() != fallback.data(), "{letter} is a box");
        }
    }

    #[test]
    fn odd_scales_are_errors() {
        let svg = Svg::new("<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'/>".into());
        assert!(svg.png(1.0).is_ok());
        for scale in [0.0, -1.0, 1e-300, 1e5, f64::NAN, f64::INFINITY] {
            assert!(matches!(svg.png(scale), Err(Error::Input { .. })), "{scale}");
        }
        assert!(Svg::new("no picture".into()).png(1.0).is_err());
    }
}
