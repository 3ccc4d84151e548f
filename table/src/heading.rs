//! Headings of columns and the units in them.

use crate::Field;

/// The heading of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Heading<'t> {
    /// The whole heading with its place.
    pub field: Field<'t>,
    /// The heading without its unit.
    pub name: &'t str,
    /// The unit; `None` if there is none.
    pub unit: Option<&'t str>,
}

impl<'t> Heading<'t> {
    /// Splits a heading into name and unit: `ax [g]`. The forms `ax (g)`, `ax/g` and `ax / g` are split only if
    /// `is_unit` is true for the unit.
    pub fn of(field: Field<'t>, is_unit: &dyn Fn(&str) -> bool) -> Heading<'t> {
        let text = field.text;
        let between = |open: char, close: char| {
            let (name, unit) = text.strip_suffix(close)?.rsplit_once(open)?;
            Some((name.trim(), unit.trim()))
        };
        let behind_a_stroke = || {
            let (name, unit) = text.split_once('/')?;
            let (name, unit) = (name.trim(), unit.trim());
            let unit = match unit
                .strip_prefix('(')
                .and_then(|unit| unit.strip_suffix(')'))
            {
                Some(inside) if !inside.contains('(') => inside.trim(),
                _ => unit,
            };
            // `v m/s` and `m/s` have no name before the stroke, so they are not split
            let is_name = !name.is_empty() && !name.contains(char::is_whitespace) && !is_unit(name);
            is_name.then_some((name, unit))
        };
        let found = between('[', ']')
            .or_else(|| behind_a_stroke().filter(|(_, unit)| is_unit(unit)))
            .or_else(|| between('(', ')').filter(|(_, unit)| is_unit(unit)));
        let (name, unit) = match found {
            Some((name, "")) => (name, None),
            Some((name, unit)) => (name, Some(unit)),
            None => (text, None),
        };
        Heading { field, name, unit }
    }

    /// True if `name` means this heading: it is the heading with or without its unit.
    pub fn is_called(&self, name: &str) -> bool {
        let name = name.trim();
        self.field.text == name || self.name == name
    }
}
