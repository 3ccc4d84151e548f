//! A channel of a test in ISO-MME (ISO/TS 13499) as the points of a curve over time.
//!
//! Beside `TEST.mme` lies a folder `Channel` with the list `TEST.chn` and a file `TEST.001`, `TEST.002`, … for each channel: lines `key :value`, and then one
//! number in a line.

use super::unit::spelled;
use std::path::{Path, PathBuf};

/// The lines of a file: those with a key, and the others with their numbers in the file.
struct Lines<'t> {
    keys: Vec<(&'t str, &'t str)>,
    data: Vec<(usize, &'t str)>,
}

impl<'t> Lines<'t> {
    fn of(text: &'t str) -> Self {
        let mut lines = Lines {
            keys: Vec::new(),
            data: Vec::new(),
        };
        for (index, line) in text.lines().enumerate() {
            match line.split_once(':') {
                Some((key, value)) => lines.keys.push((key.trim(), value.trim())),
                None if line.trim().is_empty() => {}
                None => lines.data.push((index + 1, line.trim())),
            }
        }
        lines
    }

    fn value(&self, key: &str) -> Option<&'t str> {
        let found = self
            .keys
            .iter()
            .find(|(known, _)| known.eq_ignore_ascii_case(key));
        found.map(|(_, value)| *value)
    }

    /// What the file says of its data if that casts doubt on them.
    fn doubt(&self) -> Option<&'t str> {
        let status = self.value("Data status")?;
        let sound = SOUND.iter().any(|sound| sound.eq_ignore_ascii_case(status));
        (!sound && !matches!(status, "" | "NOVALUE")).then_some(status)
    }
}

/// The folder of the channels of a test and what their files are called, in the spellings that there are.
pub fn folders(mme: &Path) -> Vec<(PathBuf, String)> {
    let folder = mme.parent().unwrap_or(Path::new(""));
    let stem = mme.file_stem().unwrap_or_default().to_string_lossy();
    ["Channel", "channel", "CHANNEL"]
        .map(|name| (folder.join(name), stem.clone().into_owned()))
        .to_vec()
}

/// The number of a channel in the list of a test; or the codes that it has.
pub fn number<'t>(list: &'t str, code: &str) -> Result<u32, Vec<&'t str>> {
    let lines = Lines::of(list);
    let mut codes = Vec::new();
    for (key, value) in &lines.keys {
        let Some(number) = key
            .to_ascii_lowercase()
            .strip_prefix("name of channel")
            .map(|n| n.trim().parse())
        else {
            continue;
        };
        let name = value.split('/').next().unwrap_or_default().trim();
        match number {
            Ok(number) if name == code => return Ok(number),
            _ => codes.push(name),
        }
    }
    Err(codes)
}

/// What `Data status` says of data that can be used.
const SOUND: [&str; 5] = [
    "ok",
    "good",
    "valid",
    "scaling factor applied",
    "linearised data",
];

/// A channel as a table of two columns, time \[s\] and value, with the unit of the value as the model's language spells it.
///
/// # Errors
/// What is wrong with the file, and what would be right.
pub fn table(text: &str, code: &str) -> Result<(String, String), (String, &'static str)> {
    let lines = Lines::of(text);
    let number = |key: &str| -> Result<f64, (String, &'static str)> {
        let found = lines.value(key).and_then(|value| value.parse().ok());
        found.filter(|x: &f64| x.is_finite()).ok_or_else(|| {
            (
                format!("the channel says no number as its `{key}`"),
                "give a channel whose samples are at equal intervals",
            )
        })
    };
    if let Some(own) = lines.value("Channel code").filter(|own| *own != code) {
        return Err((
            format!("the file of the channel {code} says that it is {own}"),
            "look at the list of channels, TEST.chn, and at the file",
        ));
    }
    if lines
        .value("Reference channel")
        .is_some_and(|kind| kind.eq_ignore_ascii_case("explicit"))
    {
        return Err((
            format!("the samples of the channel {code} have times of their own in another channel"),
            "give a channel whose samples are at equal intervals, or the points as a text file",
        ));
    }
    if let Some(status) = lines.doubt() {
        return Err((
            format!("the file of the channel {code} says of its data: `{status}`"),
            "give a channel that is sound; if you know that it is, write `Data status :ok` into its file",
        ));
    }
    let (first, interval) = (
        number("Time of first sample")?,
        number("Sampling interval")?,
    );
    if interval <= 0.0 {
        return Err((
            format!("the sampling interval of the channel {code} is {interval} s"),
            "give a channel whose samples are at equal intervals",
        ));
    }
    if let Some(said) = lines
        .value("Number of samples")
        .and_then(|n| n.parse::<usize>().ok())
        && said != lines.data.len()
    {
        return Err((
            format!(
                "the channel {code} says that it has {said} samples, and there are {}",
                lines.data.len()
            ),
            "look whether the file is whole",
        ));
    }
    let unit = match lines.value("Unit").unwrap_or_default() {
        "" | "NOVALUE" => {
            return Err((
                format!("the channel {code} has no unit"),
                "write its unit into the file: `Unit :m/s^2`",
            ));
        }
        unit => spelled(unit),
    };
    let mut rows = String::new();
    for (index, (line, value)) in lines.data.iter().enumerate() {
        if !value.parse::<f64>().is_ok_and(f64::is_finite) {
            return Err((
                format!(
                    "in line {line} of the file of the channel {code} stands `{value}`, and no number"
                ),
                "a curve has all of its points: cut the channel where samples are missing",
            ));
        }
        let t = first + index as f64 * interval;
        rows.push_str(&format!("{t},{value}\n"));
    }
    Ok((rows, unit.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::{number, table};

    const CHANNEL: &str = "Channel code                :10SLED000000ACX0\r\nUnit                        :m/(s*s)\r\nReference channel           :implicit\r\n\
                           Sampling interval           :0.001\r\nTime of first sample        :-0.002\r\n0\r\n-12.5\r\n1e2\r\n";

    #[test]
    fn a_channel_is_its_times_and_values() {
        let (rows, unit) = table(CHANNEL, "10SLED000000ACX0").unwrap();
        assert_eq!(
            (rows.as_str(), unit.as_str()),
            ("-0.002,0\n-0.001,-12.5\n0,1e2\n", "m/s^2")
        );
    }

    #[test]
    fn what_would_be_a_wrong_curve_is_refused() {
        for (from, to, told) in [
            ("-12.5", "NOVALUE", "line 7"),
            (":implicit", ":explicit", "times of their own"),
            (":0.001", ":NOVALUE", "Sampling interval"),
            (":0.001", ":0", "is 0 s"),
            (
                "Time of first",
                "Number of samples           :4\r\nTime of first",
                "has 4 samples, and there are 3",
            ),
            (":m/(s*s)", ":NOVALUE", "no unit"),
            (":10SLED000000ACX0", ":10SLED000000ACY0", "says that it is"),
            (
                "Unit ",
                "Data status                 :Channel failed\r\nUnit ",
                "`Channel failed`",
            ),
            (
                "Unit ",
                "Data status                 :questionable data\r\nUnit ",
                "`questionable data`",
            ),
        ] {
            let (message, _) = table(&CHANNEL.replace(from, to), "10SLED000000ACX0").unwrap_err();
            assert!(message.contains(told), "{told}: {message}");
        }
    }

    #[test]
    fn sound_data_are_used() {
        for status in ["ok", "OK", "NOVALUE", "", "Scaling factor applied"] {
            let text = CHANNEL.replace("Unit ", &format!("Data status :{status}\r\nUnit "));
            assert!(table(&text, "10SLED000000ACX0").is_ok(), "{status}");
        }
    }

    #[test]
    fn channels_are_found_in_the_list() {
        let list = "Number of channels          :2\nName of channel 001         :11HEADCG00H3ACXA / head\nName of channel 002         :10SLED000000ACX0\n";
        assert_eq!(number(list, "10SLED000000ACX0"), Ok(2));
        assert_eq!(
            number(list, "10SLED"),
            Err(vec!["11HEADCG00H3ACXA", "10SLED000000ACX0"])
        );
    }
}
