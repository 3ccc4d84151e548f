//! The balance of energy of a run, for people: kinetic energy at the end = at the start + work of each effect + gap.

use bryant_runtime::program::{Energy, Header};
use serde_json::{Value, json};

/// Works below this share of the largest are summed up in one line, unless all are requested.
const SMALL: f64 = 2e-3;

/// The balance as a table: a line for each effect that matters, or for each effect; the last line has no line end.
pub fn text(header: &Header, energy: &Energy, all: bool) -> String {
    let largest = energy.works.iter().fold(0.0f64, |m, w| m.max(w.abs()));
    let matters = |work: f64| all || work.abs() >= SMALL * largest;
    let named = || header.powers.iter().zip(energy.works.iter().copied());
    let mut rows = vec![("kinetic energy at the start".to_owned(), energy.start)];
    rows.extend(
        named()
            .filter(|(_, work)| matters(*work))
            .map(|(name, work)| (name.clone(), work)),
    );
    let rest: Vec<f64> = named()
        .map(|(_, work)| work)
        .filter(|w| !matters(*w))
        .collect();
    if !rest.is_empty() {
        let plural = if rest.len() == 1 { "" } else { "s" };
        let name = format!("{} smaller effect{plural} (--energy lists all)", rest.len());
        rows.push((name, rest.iter().sum()));
    }
    rows.push(("not accounted for".to_owned(), energy.gap()));
    rows.push(("kinetic energy at the end".to_owned(), energy.end));

    let width = rows.iter().map(|(name, _)| name.chars().count()).max();
    let width = width.unwrap_or(0);
    let largest = largest.max(energy.start).max(energy.end);
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

/// The number rounded to this many decimals; zero has no sign.
fn rounded(value: f64, decimals: usize) -> f64 {
    let scale = bryant_picture::chart::power_of_ten(decimals as i32);
    (value * scale).round() / scale + 0.0
}

/// Digits behind the point that show four digits of the largest value.
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

#[cfg(test)]
mod tests {
    use super::*;

    fn header() -> Header {
        let names = |names: &[&str]| names.iter().map(|n| n.to_string()).collect();
        Header {
            name: "sled".into(),
            digest: String::new(),
            dimension: 2,
            coordinates: vec![],
            velocities: vec![],
            auxiliaries: vec![],
            memory: vec![],
            event_functions: vec![],
            kinks: vec![],
            powers: names(&["field sled", "belt chest", "joint man/head: damping"]),
            outputs: vec![],
            parameters: vec![],
            duration: 1.0,
            every: 0.1,
        }
    }

    fn energy(end: f64) -> Energy {
        Energy {
            start: 0.0,
            end,
            works: vec![1000.0, -900.0, -1.0],
            exchanged: 1901.0,
            momentum_gap: None,
        }
    }

    #[test]
    fn what_is_small_is_summed_up_unless_asked_for() {
        let text = super::text(&header(), &energy(99.0), false);
        assert_eq!(
            text,
            "energy [J]\n  \
               kinetic energy at the start                      0\n  \
               field sled                                    1000\n  \
               belt chest                                    -900\n  \
               1 smaller effect (--energy lists all)           -1\n  \
               not accounted for                            0.0e0\n  \
               kinetic energy at the end                       99"
        );
        let all = super::text(&header(), &energy(99.0), true);
        assert!(all.contains("joint man/head: damping") && !all.contains("smaller"));
    }

    #[test]
    fn a_gap_is_shown() {
        let text = super::text(&header(), &energy(109.0), true);
        let gap = text.lines().find(|line| line.contains("not accounted for"));
        assert!(gap.is_some_and(|line| line.ends_with(" 1.0e1")), "{text}");
        let value = json(&header(), &energy(109.0));
        assert_eq!(value["not_accounted_for"], 10.0);
        assert_eq!(value["work"]["belt chest"], -900.0);
    }
}
