//! A picture on a page beside the one that its command draws.

use std::path::Path;

/// What differs between two pictures. They should have equally many numbers and the same words, and each number should
/// be within two pixels: another processor may round differently.
pub fn differs(drawn: &str, shown: &str) -> Option<String> {
    // the colours and widths are not what a picture shows
    let without_style = |svg: &str| -> String {
        let (before, rest) = svg.split_once("<style>").unwrap_or((svg, ""));
        let behind = rest.split_once("</style>").map_or("", |(_, behind)| behind);
        format!("{before}{behind}")
    };
    let (drawn, shown) = (&without_style(drawn), &without_style(shown));
    let numbers = |svg: &str| -> Vec<f64> {
        let pieces = svg.split(|c: char| !c.is_ascii_digit() && c != '.' && c != '-');
        pieces.filter_map(|piece| piece.parse().ok()).collect()
    };
    let texts = |svg: &str| -> Vec<String> {
        let pieces = svg.split('<').filter_map(|piece| piece.split_once('>'));
        let texts = pieces.map(|(_, text)| text.trim().to_owned());
        texts.filter(|text| !text.is_empty()).collect()
    };
    if let Some((a, b)) = texts(drawn).iter().zip(&texts(shown)).find(|(a, b)| a != b) {
        return Some(format!("it says {b:?}, and the command draws {a:?}"));
    }
    let (drawn, shown) = (numbers(drawn), numbers(shown));
    if drawn.len() != shown.len() {
        return Some(format!(
            "it has {} numbers, and the command draws {}",
            shown.len(),
            drawn.len()
        ));
    }
    let mut pairs = drawn.iter().zip(&shown);
    let far = pairs.find(|(a, b)| (*a - *b).abs() > 2.0)?;
    Some(format!(
        "it has {} where the command draws {}",
        far.1, far.0
    ))
}

/// The paths of the pictures in lines of a page.
pub fn pictures(lines: &[&str]) -> Vec<String> {
    let mut found = Vec::new();
    for line in lines {
        for piece in line.split("![").skip(1) {
            let path = piece
                .split_once("](")
                .and_then(|(_, rest)| rest.split(')').next());
            found.extend(path.map(str::to_owned));
        }
    }
    found
}

/// Compares a picture with the file that was drawn, and writes it anew if asked.
pub fn compare(shown: &Path, drawn: &Path, update: bool) -> Option<String> {
    let Ok(now) = std::fs::read_to_string(drawn) else {
        return Some(format!(
            "no command of the page draws {}",
            drawn.file_name()?.display()
        ));
    };
    let was = std::fs::read_to_string(shown).unwrap_or_default();
    let found = differs(&now, &was)?;
    if update {
        std::fs::write(shown, now).unwrap();
        return None;
    }
    Some(found)
}

/// The rules themselves, which the test of all pages begins with.
pub fn rules_hold() -> Result<(), String> {
    for (drawn, shown, expected) in [
        (
            "<text>0 ms</text><a x=\"10\"/>",
            "<text>0 ms</text><a x=\"11.5\"/>",
            true,
        ),
        (
            "<text>0 ms</text><a x=\"10\"/>",
            "<text>0 ms</text><a x=\"13\"/>",
            false,
        ),
        (
            "<text>0 ms</text><a x=\"10\"/>",
            "<text>1 ms</text><a x=\"10\"/>",
            false,
        ),
        (
            "<text>0 ms</text><a x=\"10\"/>",
            "<text>0 ms</text><a x=\"10 11\"/>",
            false,
        ),
    ] {
        if differs(drawn, shown).is_none() != expected {
            return Err(format!(
                "{drawn} and {shown}: the same should be {expected}"
            ));
        }
    }
    Ok(())
}
