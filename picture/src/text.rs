//! Splits text into lines, and typesets units.

/// Splits text into lines of at most `width` characters; a longer word gets a line of its own.
pub fn wrap(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// A unit as people write it: `N*m/s^2` is N·m/s², `deg/s` is °/s.
pub fn typeset(unit: &str) -> String {
    let powers = unit.replace("^2", "²").replace("^3", "³");
    powers.replace('*', "·").replace("deg", "°")
}

#[cfg(test)]
mod tests {
    use super::{typeset, wrap};

    #[test]
    fn lines_are_no_longer_than_asked_for() {
        assert_eq!(wrap("a bb ccc dddd", 6), ["a bb", "ccc", "dddd"]);
        assert_eq!(wrap("chest-acceleration x", 4), ["chest-acceleration", "x"]);
        assert!(wrap(" ", 4).is_empty());
    }

    #[test]
    fn units_are_typeset() {
        let of = |unit: &str| typeset(unit);
        assert_eq!(of("m/s^2") + &of("N*m") + &of("kg*m^2/s"), "m/s²N·mkg·m²/s");
        assert_eq!(of("deg/s") + &of("g"), "°/sg");
    }
}
