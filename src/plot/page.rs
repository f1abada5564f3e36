//! A page of text and pictures.

use std::fmt::Display;

use super::Svg;
use super::svg::escaped;

/// HTML page of a text with pictures below it, all in one file.
///
/// `text` is anything printed in columns, such as a [`Run`](crate::results::Run) or an
/// [`Interaction`](crate::analyses::Interaction). A browser opens and prints the page without other files.
///
/// ```
/// use basemat::plot;
///
/// let ramp = [plot::Curve { name: "ramp".to_owned(), points: vec![(0.0, 0.0), (1.0, 2.0)] }];
/// let picture = plot::curves("Tilt", "time, s", "mrad", &ramp)?;
/// let page = plot::page("Run 7", &"friction < 0.4", &[picture]);
/// assert_eq!((page.matches("<svg").count(), page.matches("&lt; 0.4").count()), (1, 1));
/// # Ok::<(), basemat::Error>(())
/// ```
pub fn page(title: &str, text: &dyn Display, pictures: &[Svg]) -> String {
    let title = escaped(title);
    let text = escaped(&text.to_string());
    let pictures: String = pictures.iter().map(Svg::as_str).collect();
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{title}</title>\n\
         <style>svg {{ max-width: 100%; height: auto }}</style></head>\n\
         <body><h1>{title}</h1>\n<pre>{text}</pre>\n{pictures}</body></html>\n"
    )
}
