//! Diagrams as PNG.

use std::sync::Arc;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

use crate::error::{CliError, Result};

/// Open Sans, as far as diagrams need it: Latin, Greek and Cyrillic letters, signs. fonts/README.md tells where it comes from.
const FONT: &[u8] = include_bytes!("../../fonts/OpenSans-subset.ttf");
const FAMILY: &str = "Open Sans";

/// The diagram's picture, a pixel a unit, drawn with no font of this machine.
pub(crate) fn png(svg: &str) -> Result<Vec<u8>> {
    let failed = |error: String| CliError::failed(format!("cannot draw the diagram as PNG: {error}"));
    let mut fonts = fontdb::Database::new();
    fonts.load_font_data(FONT.to_vec());
    fonts.set_sans_serif_family(FAMILY);
    let options = Options { fontdb: Arc::new(fonts), font_family: FAMILY.to_owned(), ..Options::default() };
    let tree = Tree::from_str(svg, &options).map_err(|error| failed(error.to_string()))?;
    let scale = super::UNITS_PER_PX as f32;
    let [width, height] = [tree.size().width(), tree.size().height()].map(|side| (side * scale).round() as u32);
    let mut pixmap = Pixmap::new(width, height).ok_or_else(|| failed(format!("{width}×{height} px are too many")))?;
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixmap.as_mut());
    Ok(pixmap.encode_png().map_err(|error| failed(error.to_string()))?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::{svg, theme};
    use plotters::element::Text;
    use plotters::style::IntoTextStyle as _;

    #[test]
    fn words_are_drawn_without_fonts_of_the_machine() {
        let drawn = |words: &str| {
            let svg = svg("t", [400, 100], |canvas| {
                let style = theme::font(40.0).into_text_style(canvas).color(&theme::INK);
                canvas.draw(&Text::new(words.to_owned(), (20, 20), style))
            });
            let png = png(&svg.expect("it is small")).expect("it is SVG");
            image::load_from_memory(&png).expect("it is PNG").to_luma8()
        };
        let dark = |words| drawn(words).pixels().filter(|pixel| pixel.0[0] < 100).count();
        assert_eq!(drawn("x").dimensions(), (400, 100));
        assert_eq!(dark(""), 0);
        for words in ["oracle 3.43", "ε = 0.1", "95 % – ≤ ×", "äéß", "Ж"] {
            assert!(dark(words) > 100, "{words} is not there");
        }
        // What the font lacks is drawn as a box, not as nothing.
        assert_ne!(drawn("lI"), drawn("Il"));
    }
}
