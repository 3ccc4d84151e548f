//! The balance of energy of a run, for people: kinetic energy at the end = kinetic energy at the start + work of each
//! effect + gap.

use bryant_runtime::program::{Energy, Header};
use serde_json::{Value, json};

/// A line that says how well the balance closes: the gap, and the largest energy in the balance.
pub fn closes(energy: &Energy) -> String {
    let largest = largest(energy);
    if largest == 0.0 {
        return "there is none: nothing moves, and nothing works".to_owned();
    }
    let [gap, largest] = [energy.gap().abs(), largest].map(joules);
    format!("closes to {gap} of {largest}")
}

/// The largest energy in a balance \[J\].
fn largest(energy: &Energy) -> f64 {
    let works = energy.works.iter().fold(0.0f64, |m, w| m.max(w.abs()));
    works.max(energy.start).max(energy.end)
}

/// An energy with two or three digits, in J with the prefix that is easiest to read.
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub fn joules(energy: f64) -> String {
    let multiples = [
        (1e6, "MJ"),
        (1e3, "kJ"),
        (1.0, "J"),
        (1e-3, "mJ"),
        (1e-6, "µJ"),
    ];
    // a value that rounds up to 1000 belongs to the next prefix
    match multiples
        .into_iter()
        .find(|(size, _)| energy >= 0.9995 * size)
    {
        Some((size, unit)) => {
            let value = energy / size;
            let decimals = usize::from(value < 9.95);
            format!("{value:.decimals$} {unit}")
        }
        None if energy == 0.0 => "0 J".to_owned(),
        None => format!("{energy:.0e} J"),
    }
}

/// The balance as a table: a line for each effect. The last line has no line end.
pub fn text(header: &Header, energy: &Energy) -> String {
    let named = header
        .powers
        .iter()
        .cloned()
        .zip(energy.works.iter().copied());
    let mut rows = vec![("kinetic energy at the start".to_owned(), energy.start)];
    rows.extend(named);
    rows.push(("not accounted for".to_owned(), energy.gap()));
    rows.push(("kinetic energy at the end".to_owned(), energy.end));

    let width = rows.iter().map(|(name, _)| name.chars().count()).max();
    let width = width.unwrap_or(0);
    let largest = largest(energy);
    let mut text = "energy [J]".to_owned();
    for (name, value) in &rows {
        let number = if name == "not accounted for" {
            format!("{value:12.1e}")
        } else {
            format!(
                "{:12.*}",
                decimals(largest),
                rounded(*value, decimals(largest))
            )
        };
        text += &format!("\n  {name:width$} {number}");
    }
    text
}

/// The number rounded to `decimals` decimals; zero has no sign.
fn rounded(value: f64, decimals: usize) -> f64 {
    let scale = bryant_picture::chart::power_of_ten(decimals as i32);
    (value * scale).round() / scale + 0.0
}

/// Number of decimals that show four digits of `largest`.
fn decimals(largest: f64) -> usize {
    if largest > 0.0 {
        (3 - libm::log10(largest).floor() as i32).clamp(0, 9) as usize
    } else {
        0
    }
}

/// The balance as JSON.
pub fn json(header: &Header, energy: &Energy) -> Value {
    let works = header.powers.iter().zip(&energy.works);
    let works: serde_json::Map<String, Value> = works
        .map(|(name, work)| (name.clone(), json!(work)))
        .collect();
    json!({
        "unit": "J",
        "kinetic_at_start": energy.start,
        "kinetic_at_end": energy.end,
        "work": works,
        "not_accounted_for": energy.gap(),
        "exchanged": energy.exchanged,
        "momentum_not_accounted_for": energy.momentum_gap,
    })
}
