//! Texts in notebooks.

/// A text as HTML, in its lines.
pub(crate) fn preformatted(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    format!("<pre style=\"line-height: 1.2\">{text}</pre>")
}
