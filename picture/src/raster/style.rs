//! The part of CSS that drawings use: selectors of one element or of classes, and the properties of [`Style::set`].

use super::RasterError;
use zeno::{Cap, Join};

/// Red, green, blue, each from 0 to 1.
pub type Colour = [f32; 3];

/// The style of a shape.
#[derive(Clone, Debug, PartialEq)]
pub struct Style {
    pub fill: Option<Colour>,
    pub fill_opacity: f32,
    pub stroke: Option<Colour>,
    pub stroke_opacity: f32,
    pub stroke_width: f32,
    pub cap: Cap,
    pub join: Join,
    /// Lengths of dashes and gaps in turn; empty for a solid line.
    pub dashes: Vec<f32>,
    pub font_size: f32,
    pub bold: bool,
}

/// The defaults of SVG.
impl Default for Style {
    fn default() -> Self {
        Self {
            fill: Some([0.0; 3]),
            fill_opacity: 1.0,
            stroke: None,
            stroke_opacity: 1.0,
            stroke_width: 1.0,
            cap: Cap::Butt,
            join: Join::Miter,
            dashes: Vec::new(),
            font_size: 16.0,
            bold: false,
        }
    }
}

impl Style {
    /// Sets a property; `None` if the property or its value is not known.
    fn set(&mut self, property: &str, value: &str) -> Option<()> {
        match property {
            // DejaVu Sans is the only font
            "font-family" => return value.contains("DejaVu Sans").then_some(()),
            "font-size" => self.font_size = number(value.strip_suffix("px")?)?,
            "font-weight" => self.bold = word(&[("bold", true), ("normal", false)], value)?,
            "fill" => self.fill = colour(value)?,
            "fill-opacity" => self.fill_opacity = number(value)?,
            "stroke" => self.stroke = colour(value)?,
            "stroke-opacity" => self.stroke_opacity = number(value)?,
            "stroke-width" => self.stroke_width = number(value)?,
            "stroke-linecap" => {
                self.cap = word(&[("butt", Cap::Butt), ("round", Cap::Round)], value)?
            }
            "stroke-linejoin" => {
                self.join = word(&[("miter", Join::Miter), ("round", Join::Round)], value)?
            }
            "stroke-dasharray" => {
                let lengths = value.split(' ').filter(|_| value != "none");
                self.dashes = lengths.map(number).collect::<Option<_>>()?;
            }
            _ => return None,
        }
        Some(())
    }
}

/// The meaning of a keyword in a property.
fn word<T: Copy>(known: &[(&str, T)], value: &str) -> Option<T> {
    let found = known.iter().find(|(word, _)| *word == value);
    found.map(|(_, meaning)| *meaning)
}

fn number(text: &str) -> Option<f32> {
    let value: f32 = text.parse().ok()?;
    (value.is_finite() && value >= 0.0).then_some(value)
}

/// Reads "none", "#rgb" or "#rrggbb"; the outer `None` if the text is none of these.
fn colour(text: &str) -> Option<Option<Colour>> {
    if text == "none" {
        return Some(None);
    }
    let digits = text.strip_prefix('#')?;
    let value = u32::from_str_radix(digits, 16).ok()?;
    let part = |index: u32| match digits.len() {
        3 => Some((value >> (8 - 4 * index) & 15) as f32 / 15.0),
        6 => Some((value >> (16 - 8 * index) & 255) as f32 / 255.0),
        _ => None,
    };
    Some(Some([part(0)?, part(1)?, part(2)?]))
}

/// The rules of a style sheet, in increasing order of precedence.
pub struct Rules<'a>(Vec<StyleRule<'a>>);

struct StyleRule<'a> {
    /// The element that the rule selects; "" for any.
    element: &'a str,
    classes: Vec<&'a str>,
    declarations: Vec<(&'a str, &'a str)>,
}

impl<'a> Rules<'a> {
    /// Reads CSS.
    pub fn read(css: &'a str) -> Result<Rules<'a>, RasterError> {
        let unknown = |what: &str| RasterError::Style(what.to_owned());
        let mut rules = Vec::new();
        for rule in css.split_inclusive('}').map(str::trim) {
            if rule.is_empty() {
                continue;
            }
            let parts = rule.strip_suffix('}').and_then(|rule| rule.split_once('{'));
            let (selectors, body) = parts.ok_or_else(|| unknown(rule))?;
            let mut declarations = Vec::new();
            for declaration in body.split(';').filter(|text| !text.trim().is_empty()) {
                let (property, value) = declaration.split_once(':').unwrap_or((declaration, ""));
                let (property, value) = (property.trim(), value.trim());
                let known = Style::default().set(property, value);
                known.ok_or_else(|| unknown(declaration))?;
                declarations.push((property, value));
            }
            for selector in selectors.split(',').map(str::trim) {
                if selector.contains(|c: char| !c.is_ascii_alphanumeric() && c != '.') {
                    return Err(unknown(selector));
                }
                let mut words = selector.split('.');
                rules.push(StyleRule {
                    element: words.next().unwrap_or_default(),
                    classes: words.collect(),
                    declarations: declarations.clone(),
                });
            }
        }
        // a rule with more classes wins, then a rule with an element; among equal rules the later one, because sorting
        // is stable
        rules.sort_by_key(|rule| (rule.classes.len(), !rule.element.is_empty()));
        Ok(Rules(rules))
    }

    /// The style of an element with these classes, separated by spaces.
    pub fn style(&self, element: &str, classes: &str) -> Style {
        let mut style = Style::default();
        for (property, value) in self.of(element, classes) {
            // the property was checked when the rules were read
            let _ = style.set(property, value);
        }
        style
    }

    /// True if a rule applies to an element with these classes.
    pub fn any(&self, element: &str, classes: &str) -> bool {
        self.of(element, classes).next().is_some()
    }

    fn of(&self, element: &str, classes: &str) -> impl Iterator<Item = (&'a str, &'a str)> {
        let has = |class: &&str| classes.split(' ').any(|own| own == *class);
        let fits = |rule: &&StyleRule<'a>| {
            (rule.element.is_empty() || rule.element == element) && rule.classes.iter().all(has)
        };
        let rules: Vec<&StyleRule<'a>> = self.0.iter().filter(fits).collect();
        let declarations = rules.into_iter().flat_map(|rule| rule.declarations.clone());
        declarations.collect::<Vec<_>>().into_iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_classes_win_and_then_what_comes_later() {
        let css = ".a.b{fill:#f00}text{fill:#0f0;font-size:12px}.a{fill:#00f}\n.c,.a{stroke:#fff}.d{stroke:none}";
        let rules = Rules::read(css).unwrap();
        let fill = |element, classes| rules.style(element, classes).fill;
        assert_eq!(fill("line", ""), Some([0.0; 3]));
        assert_eq!(fill("text", ""), Some([0.0, 1.0, 0.0]));
        assert_eq!(fill("text", "a"), Some([0.0, 0.0, 1.0]));
        assert_eq!(fill("text", "b a"), Some([1.0, 0.0, 0.0]));
        assert_eq!(rules.style("text", "a").font_size, 12.0);
        let stroke = |classes| rules.style("line", classes).stroke;
        assert_eq!((stroke("c"), stroke("d c")), (Some([1.0; 3]), None));
    }

    #[test]
    fn what_is_not_known_is_refused() {
        for css in [
            ".a{filter:blur(2px)}",
            ".a{fill:red}",
            ".a{stroke-width:thick}",
            ".a{stroke-width:-1}",
            ".a{stroke-linecap:square}",
            ".a{font-family:Arial}",
            ".a .b{fill:#fff}",
            ".a:hover{fill:#fff}",
            ".a{fill:#fff",
            "a",
        ] {
            assert!(Rules::read(css).is_err(), "{css}");
        }
    }
}
