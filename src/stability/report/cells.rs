//! The texts of cells, for all tables.

use bryant_hard::{Bound, Check, Found};

/// The bound: "≤ 1e-10 m", or that a statement must hold.
pub fn bound(check: &Check) -> String {
    match check.found {
        Found::Number { bound, unit, .. } => match bound {
            Bound::AtMost(value) => format!("≤ {}", with_unit(value, unit)),
            Bound::AtLeast(value) => format!("≥ {}", with_unit(value, unit)),
        },
        Found::Statement { .. } => "must hold".to_owned(),
    }
}

/// The measured value, or the statement's observation.
pub fn measured(check: &Check) -> String {
    match &check.found {
        Found::Number { measured, unit, .. } => with_unit(*measured, unit),
        Found::Statement { seen, .. } => seen.clone(),
    }
}

/// The margin to the bound: "× 31" if the bound is kept, else "missed".
pub fn margin(check: &Check) -> String {
    if !check.holds() {
        return "missed".to_owned();
    }
    match check.margin() {
        None => "holds".to_owned(),
        Some(factor) if factor.is_infinite() => "exact".to_owned(),
        Some(factor) => format!("× {}", number(factor)),
    }
}

fn with_unit(value: f64, unit: &str) -> String {
    match unit {
        "" => number(value),
        unit => format!("{} {unit}", number(value)),
    }
}

/// A number with three digits, in the shorter of two notations.
pub fn number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    // removes zeros at the end, as of 1.00 or 1.00e-5
    let short = |text: &str| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text.to_owned(),
    };
    if (0.01..1e4).contains(&size) {
        let before = libm::log10(size).floor() as i32;
        let digits = (2 - before).clamp(0, 4) as usize;
        return short(&format!("{value:.digits$}"));
    }
    let text = format!("{value:.2e}");
    match text.split_once('e') {
        Some((digits, exponent)) => format!("{}e{exponent}", short(digits)),
        None => text,
    }
}
