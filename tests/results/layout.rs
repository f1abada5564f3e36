//! Layout of the texts of an SVG picture: no text may leave the sheet or touch another one.

/// A text and its box: left, top, right, bottom.
type PlacedText = (String, [f64; 4]);

/// The texts of a sheet, and its width and height.
struct PictureTexts {
    texts: Vec<PlacedText>,
    size: [f64; 2],
}

/// Panics if a text that can be seen is not on the sheet, or touches another one.
pub(crate) fn assert_readable(svg: &str, name: &str) {
    let PictureTexts { texts, size: [width, height] } = sheet(svg);
    assert!(!texts.is_empty(), "{name}: no texts");
    for (k, (text, place)) in texts.iter().enumerate() {
        let [left, top, right, bottom] = *place;
        let is_inside = left >= 0.0 && top >= 0.0 && right <= width && bottom <= height;
        assert!(is_inside, "{name}: {text:?} at {place:?} leaves {width} by {height}");
        for (other, [l, t, r, b]) in &texts[..k] {
            let is_apart = right <= *l || *r <= left || bottom <= *t || *b <= top;
            assert!(
                is_apart,
                "{name}: {text:?} at {place:?} touches {other:?} at {:?}",
                [l, t, r, b]
            );
        }
    }
}

/// Texts as the renderer of PNG files lays them out, in a font wider than that of PNG files.
#[cfg(feature = "png")]
fn sheet(svg: &str) -> PictureTexts {
    use resvg::usvg::{Group, Node, Options, TextChunk, TextSpan, Tree};
    fn collect(group: &Group, texts: &mut Vec<PlacedText>) {
        for node in group.children() {
            match node {
                Node::Group(group) => collect(group, texts),
                Node::Text(text) => {
                    let words: String = text.chunks().iter().map(TextChunk::text).collect();
                    let place = text.abs_bounding_box();
                    let sides = [place.left(), place.top(), place.right(), place.bottom()];
                    let mut spans = text.chunks().iter().flat_map(TextChunk::spans);
                    if spans.any(TextSpan::is_visible) {
                        texts.push((words, sides.map(f64::from)));
                    }
                }
                _ => {}
            }
        }
    }
    let mut options = Options::default();
    options.fontdb_mut().load_font_data(dejavu::sans::regular().to_vec());
    options.fontdb_mut().set_sans_serif_family("DejaVu Sans");
    let tree = Tree::from_str(svg, &options).unwrap();
    let mut texts = Vec::new();
    collect(tree.root(), &mut texts);
    PictureTexts { texts, size: [tree.size().width(), tree.size().height()].map(f64::from) }
}

#[cfg(not(feature = "png"))]
fn attribute(tag: &str, name: &str) -> Option<String> {
    let value = tag.split(&format!(" {name}=\"")).nth(1)?;
    value.split('"').next().map(str::to_owned)
}

#[cfg(not(feature = "png"))]
fn number(tag: &str, name: &str) -> Option<f64> {
    attribute(tag, name).and_then(|text| text.parse().ok())
}

/// Texts by the attributes of the SVG file, with 0.6 of the font's size for the width of a letter.
#[cfg(not(feature = "png"))]
fn sheet(svg: &str) -> PictureTexts {
    let opening_tag = svg.split('>').next().unwrap();
    let size = ["width", "height"].map(|side| number(opening_tag, side).unwrap());
    let default: f64 = number(opening_tag, "font-size").unwrap_or(16.0);
    let mut texts = Vec::new();
    for piece in svg.split("<text").skip(1) {
        let (tag, rest) = piece.split_once('>').unwrap();
        let words = rest.split('<').next().unwrap().trim();
        let words = words.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&");
        if words.is_empty() || attribute(tag, "visibility").as_deref() == Some("hidden") {
            continue;
        }
        let em = number(tag, "font-size").unwrap_or(default);
        let length = 0.6 * em * words.chars().count() as f64;
        let x = number(tag, "x").unwrap();
        let y = number(tag, "y").unwrap();
        let start = match attribute(tag, "text-anchor").as_deref() {
            Some("middle") => -0.5 * length,
            Some("end") => -length,
            _ => 0.0,
        };
        let shift = match attribute(tag, "dy").as_deref() {
            Some("0.76em") => 0.76 * em,
            Some("0.5ex") => 0.25 * em,
            Some("-0.5ex") => -0.25 * em,
            _ => 0.0,
        };
        let top = shift - 0.76 * em;
        let bottom = shift + 0.24 * em;
        let place = match attribute(tag, "transform") {
            None => [x + start, y + top, x + start + length, y + bottom],
            // The text is turned to the left.
            Some(turn) if turn.starts_with("rotate(270") => {
                [x + top, y - start - length, x + bottom, y - start]
            }
            Some(turn) => panic!("{turn}"),
        };
        texts.push((words, place));
    }
    PictureTexts { texts, size }
}
