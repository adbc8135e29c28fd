//! Text that may come from anywhere, such as the names of files.

/// The text without what no XML may hold, on one line.
pub(crate) fn clean(text: &str) -> String {
    let refused = |c: char| c.is_control() || matches!(c, '\u{2028}' | '\u{2029}' | '\u{fffe}' | '\u{ffff}');
    text.chars().map(|c| if refused(c) { char::REPLACEMENT_CHARACTER } else { c }).collect()
}

/// The clean text, with marks that mean something to XML written as what they are.
pub(super) fn escaped(text: &str) -> String {
    clean(text).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// About how wide a text of this font size is; on the safe side, since the reader's machine chooses the font.
pub(crate) fn width(text: &str, size: f64) -> f64 {
    text.chars().map(advance).sum::<f64>() * size
}

/// A character's width in font sizes.
fn advance(c: char) -> f64 {
    match c {
        'i' | 'j' | 'l' | 'I' | 't' | 'f' | 'r' | '.' | ',' | ':' | ';' | '\'' | '|' | '/' | ' ' | '(' | ')' => 0.4,
        'm' | 'w' | 'M' | 'W' | '@' | '%' => 0.95,
        'A'..='Z' | '_' | '&' | '<' | '>' | '…' => 0.72,
        // Scripts whose characters fill a square begin here.
        '\u{1100}'.. => 1.0,
        _ => 0.63,
    }
}

/// The clean text if it fits into `room`; otherwise its beginning and, longer, its end, which tells files apart.
pub(crate) fn shortened(text: &str, size: f64, room: f64) -> String {
    let text = clean(text);
    if width(&text, size) <= room {
        return text;
    }
    let characters: Vec<char> = text.chars().collect();
    let room = room - width("…", size);
    let start = fitting(characters.iter(), size, room / 3.0);
    let end = fitting(characters.iter().rev(), size, room * 2.0 / 3.0);
    characters[..start].iter().chain(&['…']).chain(&characters[characters.len() - end..]).collect()
}

/// How many of the characters fit into `room`.
fn fitting<'a>(characters: impl Iterator<Item = &'a char>, size: f64, room: f64) -> usize {
    let ends = characters.scan(0.0, |end, &c| {
        *end += advance(c) * size;
        Some(*end)
    });
    ends.take_while(|&end| end <= room).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_name_keeps_its_ends() {
        let name = format!("runs/{}/camera.mp4", "long".repeat(80));
        let short = shortened(&name, 20.0, 400.0);
        assert!(short.starts_with("runs/") && short.contains('…') && short.ends_with("/camera.mp4"), "{short}");
        assert!(width(&short, 20.0) <= 400.0);
        assert_eq!(shortened("camera.mp4", 20.0, 400.0), "camera.mp4");
        assert_eq!(shortened("camera.mp4", 20.0, 0.0), "…");
    }

    #[test]
    fn what_xml_cannot_hold_is_replaced() {
        assert_eq!(clean("a\u{1}b\nc\u{ffff}"), "a\u{fffd}b\u{fffd}c\u{fffd}");
        assert_eq!(escaped("<a & b>"), "&lt;a &amp; b&gt;");
    }
}
