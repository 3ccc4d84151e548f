//! Slips of the pen, made at many lines of the bundled models: the message names the line, and one mistake neither
//! hides nor invents another.

use bryant_generator::Diagnostics;
use bryant_generator::read_str;

use std::path::{Path, PathBuf};

fn models() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../models")
}

fn problems(file: &str, text: &str) -> Option<Diagnostics> {
    let loader = |path: &Path| std::fs::read_to_string(models().join(path));
    read_str(file, text, &loader).err()
}

/// The bundled models, by their paths in `models/`.
fn bundled() -> Vec<(String, String)> {
    let mut all = Vec::new();
    for folder in ["", "applications/", "certification/"] {
        for entry in std::fs::read_dir(models().join(folder)).unwrap() {
            let name = entry.unwrap().file_name().into_string().unwrap();
            if name.ends_with(".yaml") {
                let file = format!("{folder}{name}");
                let text = std::fs::read_to_string(models().join(&file)).unwrap();
                all.push((file, text));
            }
        }
    }
    all.sort();
    assert!(all.len() >= 15, "{} models", all.len());
    all
}

/// A line with a slip in it; `None` where it cannot be made.
type Slip = fn(&str) -> Option<String>;

/// The line without its comment; lines of text alone have nothing to be mistaken in.
fn content(line: &str) -> Option<&str> {
    let content = line.split(" #").next().unwrap_or(line);
    let is_text =
        content.trim_start().starts_with("title:") || content.trim_start().starts_with('#');
    (!content.trim().is_empty() && !is_text).then_some(content)
}

/// The place behind the first colon of `key: value`.
fn colon(line: &str) -> Option<usize> {
    let at = line.find(": ")?;
    let before = line[..at]
        .trim_start()
        .trim_start_matches("- ")
        .trim_start_matches("{ ");
    let word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    (!before.is_empty() && before.chars().all(word)).then_some(at + 1)
}

/// Every slip, and whether it must be reported at the line itself.
const SLIPS: [(&str, Slip); 9] = [
    ("a tab", |line| {
        let rest = line.strip_prefix("  ")?;
        Some(format!("\t{rest}"))
    }),
    ("no space behind a colon", |line| {
        let at = colon(line)?;
        let value = line[at + 1..].trim_start();
        // a list or mapping in place is recognised by its bracket
        let plain = value.starts_with(|c: char| c.is_ascii_alphanumeric());
        plain.then(|| format!("{}{value}", &line[..at]))
    }),
    ("a no-break space in the indentation", |line| {
        let rest = line.strip_prefix("  ")?;
        Some(format!("\u{a0} {rest}"))
    }),
    ("a no-break space behind a colon", |line| {
        let at = colon(line)?;
        Some(format!(
            "{}\u{a0}{}",
            &line[..at],
            line[at + 1..].trim_start()
        ))
    }),
    ("a wide colon", |line| {
        let at = colon(line)?;
        Some(format!("{}：{}", &line[..at - 1], &line[at..]))
    }),
    ("a decimal comma", |line| {
        let bytes = line.as_bytes();
        let digit = |at: usize| bytes.get(at).is_some_and(u8::is_ascii_digit);
        let at =
            (1..bytes.len()).find(|&at| bytes[at] == b'.' && digit(at - 1) && digit(at + 1))?;
        // names may have numbers, and texts
        let is_text = line[..at].contains('"') || line.trim_start().starts_with("- { name:");
        (!is_text).then(|| format!("{},{}", &line[..at], &line[at + 1..]))
    }),
    ("a wrong unit", |line| {
        let found = [" mm", " kg", " deg", " ms", " kN"]
            .iter()
            .find_map(|unit| {
                let at = line.find(unit)?;
                let number = line[..at].ends_with(|c: char| c.is_ascii_digit());
                number.then_some((at, unit.len()))
            });
        let (at, length) = found?;
        Some(format!("{} qq{}", &line[..at], &line[at + length..]))
    }),
    ("a misspelt key", |line| {
        let at = colon(line)? - 1;
        Some(format!("{}zz{}", &line[..at], &line[at..]))
    }),
    ("a mapping for a value", |line| {
        let at = colon(line)?;
        let value = line[at..].trim();
        let number = value.starts_with(|c: char| c.is_ascii_digit()) && !line.contains('{');
        number.then(|| format!("{} {{ zz: 1 }}", &line[..at]))
    }),
];

/// What cannot be a mistake: user-chosen keys, and lists whose length is free.
fn may_be_meant(slip: &str, line: &str, before: &str) -> bool {
    let names = [
        "parameters:",
        "curves:",
        "surfaces:",
        "groups:",
        "angles:",
        "angular_velocities:",
    ];
    let within = names.iter().any(|name| before.trim_end().ends_with(name));
    match slip {
        // names of the user's, which others refer to, or not
        "a misspelt key" => within || names.iter().any(|name| line.contains(name)),
        _ => false,
    }
}

/// The lines at which each slip is made: every `step`-th where it can be made.
fn each(step: usize, mut visit: impl FnMut(&str, &str, usize, &str, Option<Diagnostics>)) {
    for (file, text) in bundled() {
        let lines: Vec<&str> = text.lines().collect();
        for (slip, change) in SLIPS {
            let mut made = 0;
            let mut section = String::new();
            for (index, line) in lines.iter().enumerate() {
                if !line.starts_with([' ', '#']) && !line.is_empty() {
                    section = line.split(" #").next().unwrap_or(line).to_owned();
                }
                let Some(changed) = content(line).and_then(change) else {
                    continue;
                };
                if may_be_meant(slip, line, &section) {
                    continue;
                }
                made += 1;
                if made % step != 1 % step {
                    continue;
                }
                let mut mutated = lines.clone();
                mutated[index] = &changed;
                let found = problems(&file, &(mutated.join("\n") + "\n"));
                visit(slip, &file, index + 1, &changed, found);
            }
        }
    }
}

#[test]
fn the_message_names_the_line_of_the_slip() {
    let mut count = std::collections::BTreeMap::<String, [usize; 3]>::new();
    let mut missed = Vec::new();
    each(11, |slip, file, line, changed, found| {
        let counted = count.entry(slip.to_owned()).or_default();
        counted[0] += 1;
        let Some(found) = found else {
            counted[2] += 1;
            missed.push(format!("{slip}: {file}:{line} is accepted: {changed}"));
            return;
        };
        match found
            .problems
            .iter()
            .any(|p| p.file == file && p.line == line)
        {
            true => counted[1] += 1,
            false => missed.push(format!(
                "{slip}: {file}:{line} {changed}\n    {}",
                found.problems[0].line()
            )),
        }
    });
    let all: usize = count.values().map(|c| c[0]).sum();
    assert!(all > 150, "{count:?}");
    assert!(missed.is_empty(), "{count:#?}\n{}", missed.join("\n"));
}

/// A key or a value that is wrong is reported, and nothing that only follows from it.
#[test]
fn a_mistake_invents_no_other() {
    let mut invented = Vec::new();
    each(13, |slip, file, line, changed, found| {
        let alone = [
            "a misspelt key",
            "a mapping for a value",
            "a wrong unit",
            "no space behind a colon",
        ];
        let Some(found) = found.filter(|_| alone.contains(&slip)) else {
            return;
        };
        for problem in found
            .problems
            .iter()
            .filter(|p| p.file != file || p.line != line)
        {
            // a key that is missing is reported where its record begins
            if !problem.message.contains("lacks the key") {
                invented.push(format!(
                    "{slip}: {file}:{line} {changed}\n    {}",
                    problem.line()
                ));
            }
        }
    });
    assert!(invented.is_empty(), "{}", invented.join("\n"));
}

/// Two mistakes in different places are both reported, whatever they are.
#[test]
fn a_mistake_hides_no_other() {
    let mut hidden = Vec::new();
    let mut count = 0;
    for (file, text) in bundled() {
        let last = text.lines().position(|line| line.starts_with("run:"));
        let Some(last) = last else { continue };
        // a second mistake that only the last step finds
        let wrong = text
            .lines()
            .nth(last)
            .unwrap()
            .replacen("every:", "every: 1 kg #", 1);
        if !wrong.contains("kg") || !wrong.starts_with("run: {") {
            continue;
        }
        let run = "run: { duration: 1 s, every: 1 kg }";
        let lines: Vec<&str> = text.lines().collect();
        for (index, line) in lines.iter().enumerate().filter(|(index, _)| *index != last) {
            // what a file includes is everywhere: without it nothing can be said
            let includes = ["human:", "part:", "file:"]
                .iter()
                .any(|key| line.contains(key));
            let at = content(line).and_then(colon);
            let Some(at) = at.filter(|_| line.starts_with(' ') && !includes && index % 7 == 0)
            else {
                continue;
            };
            let changed = format!("{}zz{}", &line[..at - 1], &line[at - 1..]);
            let mut mutated = lines.clone();
            mutated[index] = &changed;
            mutated[last] = run;
            let found = problems(&file, &mutated.join("\n")).expect("the unit of `every` is wrong");
            count += 1;
            if !found.problems.iter().any(|p| p.line == last + 1) {
                hidden.push(format!(
                    "{file}:{} {changed}\n    {}",
                    index + 1,
                    found.problems[0].line()
                ));
            }
        }
    }
    assert!(count > 30, "{count}");
    assert!(
        hidden.is_empty(),
        "{} of {count}\n{}",
        hidden.len(),
        hidden.join("\n")
    );
}

/// The four mistakes of the field, together.
#[test]
fn four_mistakes_are_four_messages() {
    let text = "\
model: many
dimension: 2
systems:
  - name: man
    elements:
      - { name: torso, mas: 30 kg, cg: [0, 0.2], inertia: 1.1 }
      - { name: head, on: torzo, at: [0, 0.45 kg], mass: 4.5 kg, cg: [0.02, 0.1], inertia: 0.03 }
forces:
  - { field: sled, acceleration: [pulse, 0] }
";
    let found = problems("many.yaml", text).unwrap();
    let told: Vec<String> = found.problems.iter().map(|p| p.line()).collect();
    for (line, needle) in [(6, "\"mas\""), (7, "torzo"), (7, "kg"), (9, "pulse")] {
        let is = |text: &&String| {
            text.starts_with(&format!("many.yaml:{line}:")) && text.contains(needle)
        };
        assert!(told.iter().any(|text| is(&text)), "{needle}: {told:#?}");
    }
    assert_eq!(told.len(), 4, "{told:#?}");
}

/// Files of other systems mean the same: line ends of Windows and of old computers by Apple, a byte order mark.
#[test]
fn line_ends_and_byte_order_marks_do_not_matter() {
    let (file, text) = bundled().swap_remove(3);
    let loader = |path: &Path| std::fs::read_to_string(models().join(path));
    let digest = |text: &str| read_str(&file, text, &loader).unwrap().0.digest;
    let usual = digest(&text);
    for other in [
        text.replace('\n', "\r\n"),
        text.replace('\n', "\r"),
        format!("\u{feff}{text}"),
        format!("\u{feff}{}", text.replace('\n', "\r\n")),
    ] {
        assert_eq!(digest(&other), usual);
    }
}
