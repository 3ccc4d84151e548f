//! Writes ISO-MME.

use super::{MOST_CHANNELS, is_code};
use crate::{Channel, Recording, unit};
use bryant_table::mme::NOVALUE;
use std::io;
use std::path::Path;

/// Width of a key in columns.
const WIDTH: usize = 28;

/// A line with a key and its value.
fn line(key: &str, value: &str) -> String {
    format!("{key:<WIDTH$}:{value}\n")
}

/// The description of a run as a whole.
#[derive(Clone, Debug, Default)]
pub struct About {
    /// The title.
    pub title: String,
    /// The source, such as the program with its version.
    pub source: String,
}

/// Writes a recording into `folder`: `NAME.mme`, `Channel/NAME.chn`, `Channel/NAME.001`, …. Folders are created.
/// Channels of an earlier test with this name are removed, because they would count as channels of this test.
///
/// # Errors
/// Those of the file system.
///
/// # Panics
/// There are more channels than [`MOST_CHANNELS`].
pub fn write(folder: &Path, name: &str, recording: &Recording, about: &About) -> io::Result<()> {
    let channels = &recording.channels;
    assert!(
        channels.len() <= MOST_CHANNELS,
        "the extension has three digits"
    );
    let inner = folder.join("Channel");
    std::fs::create_dir_all(&inner)?;
    for entry in std::fs::read_dir(&inner)? {
        let path = entry?.path();
        let number = path.extension().and_then(|extension| extension.to_str());
        let is_number = number.is_some_and(|text| text.len() == 3 && text.parse::<u32>().is_ok());
        if is_number && path.file_stem().is_some_and(|stem| stem == name) {
            std::fs::remove_file(path)?;
        }
    }
    let mut list = line("Instrumentation standard", NOVALUE);
    list.push_str(&line("Number of channels", &channels.len().to_string()));
    for (index, channel) in channels.iter().enumerate() {
        let number = format!("{:03}", index + 1);
        let code = code(channel, &number);
        let key = format!("Name of channel {number}");
        let value = format!("{code} / {}", known(words(channel)));
        list.push_str(&line(&key, &value));
        std::fs::write(
            inner.join(format!("{name}.{number}")),
            text(channel, &code, about),
        )?;
    }
    std::fs::write(inner.join(format!("{name}.chn")), list)?;
    std::fs::write(folder.join(format!("{name}.mme")), test(about))
}

/// The code of a channel. A channel without a code gets one from its number, as an unknown place `X001`, and from the
/// quantity of its unit.
fn code(channel: &Channel, number: &str) -> String {
    if is_code(&channel.name) {
        return channel.name.clone();
    }
    let quantity = match unit::quantity(&channel.unit) {
        Some("m/s^2") => "AC",
        Some("N") => "FO",
        Some("N*m") => "MO",
        Some("m") => "DS",
        Some("m/s") => "VE",
        Some("rad") => "AN",
        Some("rad/s") => "AV",
        Some("rad/s^2") => "AA",
        Some("Pa") => "PR",
        _ => "00",
    };
    format!("10X{number}000000{quantity}00")
}

/// The name of a channel in words.
fn words(channel: &Channel) -> &str {
    match channel.title.as_str() {
        "" if !is_code(&channel.name) => &channel.name,
        title => title,
    }
}

fn known(text: &str) -> String {
    let one_line = text.replace(['\r', '\n'], " ");
    match one_line.trim() {
        "" => NOVALUE.to_owned(),
        text => text.to_owned(),
    }
}

/// The text of the file `NAME.mme` about the test. It has no date, so that the same run gives the same bytes.
fn test(about: &About) -> String {
    [
        ("Data format edition number", "1.6"),
        ("Laboratory name", NOVALUE),
        ("Customer name", NOVALUE),
        ("Customer test ref number", NOVALUE),
        ("Title", &known(&about.title)),
        ("Date of the test", NOVALUE),
        ("Timestamp", NOVALUE),
        ("Number of test objects", "1"),
        ("Name of test object 1", &known(&about.title)),
    ]
    .map(|(key, value)| line(key, value))
    .concat()
}

/// The text of the file of a channel.
fn text(channel: &Channel, code: &str, about: &About) -> String {
    let signal = &channel.signal;
    let number = |value: f64| match value.is_finite() {
        // the fewest digits that read back as the same number
        true => format!("{value:?}"),
        false => NOVALUE.to_owned(),
    };
    let of_extreme = |is_better: fn(f64, f64) -> bool| {
        let mut best: Option<usize> = None;
        for (index, value) in signal.values.iter().enumerate() {
            if value.is_finite() && best.is_none_or(|best| is_better(*value, signal.values[best])) {
                best = Some(index);
            }
        }
        let value = |index: usize| (number(signal.values[index]), number(signal.time(index)));
        best.map_or((NOVALUE.to_owned(), NOVALUE.to_owned()), value)
    };
    let (largest, at_largest) = of_extreme(|a, b| a > b);
    let (smallest, at_smallest) = of_extreme(|a, b| a < b);
    let own = known(words(channel));
    let class = match code.chars().nth(15) {
        Some('A') => "1000",
        Some('B') => "600",
        Some('C') => "180",
        Some('D') => "60",
        _ => NOVALUE,
    };
    let mut text = [
        ("Test object number", "1"),
        ("Name of the channel", own.as_str()),
        ("Laboratory channel code", NOVALUE),
        ("Customer channel code", &own),
        ("Channel code", code),
        ("Unit", &known(&channel.unit)),
        ("Reference channel", "implicit"),
        ("Reference channel name", NOVALUE),
        ("Data source", "simulation"),
        ("Data status", NOVALUE),
        ("Comments", &known(&about.source)),
        ("Channel frequency class", class),
        ("Sampling interval", &number(signal.interval)),
        ("Time of first sample", &number(signal.first)),
        ("Number of samples", &signal.values.len().to_string()),
        ("First global maximum value", &largest),
        ("Time of maximum value", &at_largest),
        ("First global minimum value", &smallest),
        ("Time of minimum value", &at_smallest),
    ]
    .map(|(key, value)| line(key, value))
    .concat();
    for value in &signal.values {
        text.push_str(&number(*value));
        text.push('\n');
    }
    text
}
