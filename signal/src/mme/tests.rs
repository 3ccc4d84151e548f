//! ISO-MME files that this crate writes, and files as others write them.

use super::{About, read, write};
use crate::{Channel, Recording, Signal};
use std::fs;
use std::path::Path;

fn channel(name: &str, title: &str, values: Vec<f64>) -> Channel {
    Channel {
        name: name.to_owned(),
        title: title.to_owned(),
        unit: "m/s^2".to_owned(),
        ..Channel::of(Signal {
            first: -0.1,
            interval: 1e-4,
            values,
        })
    }
}

#[test]
fn what_is_written_is_read_back_bit_for_bit() {
    let values = vec![
        0.1 + 0.2,
        -0.0,
        1e-308,
        f64::MAX,
        f64::NAN,
        5e-324,
        -1.0 / 3.0,
    ];
    let recording = Recording {
        channels: vec![
            channel("11HEADCG00H3ACXA", "head: acceleration, x", values),
            channel("belt force", "", vec![1.0, 2.0]),
        ],
        damaged: Vec::new(),
    };
    let folder = tempfile::tempdir().unwrap();
    let about = About {
        title: "a seat".to_owned(),
        source: "a program".to_owned(),
    };
    write(folder.path(), "run", &recording, &about).unwrap();
    for path in [folder.path().to_owned(), folder.path().join("run.mme")] {
        let found = read(&path).unwrap();
        assert_eq!(found.channels.len(), 2);
        for (found, given) in found.channels.iter().zip(&recording.channels) {
            assert_eq!(found.unit, given.unit);
            assert_eq!((found.signal.first, found.signal.interval), (-0.1, 1e-4));
            let bits = |values: &[f64]| values.iter().map(|x| x.to_bits()).collect::<Vec<u64>>();
            // NaN has no digits
            let bits = |values: &[f64]| {
                bits(
                    &values
                        .iter()
                        .map(|x| if x.is_nan() { f64::NAN } else { *x })
                        .collect::<Vec<f64>>(),
                )
            };
            assert_eq!(bits(&found.signal.values), bits(&given.signal.values));
        }
        let names = |one: &Channel| (one.name.clone(), one.title.clone());
        let named = found.channels.iter().map(names);
        // the channel without a code gets one from its number and its quantity
        let expected = [
            ("11HEADCG00H3ACXA", "head: acceleration, x"),
            ("10X002000000AC00", "belt force"),
        ];
        assert!(named.eq(expected.map(|(name, title)| (name.to_owned(), title.to_owned()))));
        assert!(found.channel("belt force").is_ok());
    }
    // a shorter recording of the same name leaves no channel of the longer one
    let shorter = Recording {
        channels: recording.channels[1..].to_vec(),
        damaged: Vec::new(),
    };
    write(folder.path(), "run", &shorter, &about).unwrap();
    assert_eq!(read(folder.path()).unwrap().channels.len(), 1);
}

/// Files as a laboratory writes them: CRLF, ISO 8859-1, keys of more than 28 columns, times in a separate channel.
fn laboratory(folder: &Path) {
    let inner = folder.join("CHANNEL");
    fs::create_dir(&inner).unwrap();
    fs::write(
        folder.join("T1.MME"),
        b"Title                       :Pr\xfcfung\r\n",
    )
    .unwrap();
    let times = "Channel code                :11TIRS00000000TI\r\nUnit :s\r\nNumber of samples :3\r\n-0.1\r\n-0.05\r\n0\r\n";
    fs::write(inner.join("T1.001"), times).unwrap();
    let force = b"Name of the channel         :Gurtkraft \xfc\r\nChannel code                :11SEBE0000B3FO0D\r\n\
        Unit                        :kN\r\nA key that has far more than 28 columns :x\r\n\
        Reference channel           :explicit\r\nReference channel name      :11TIRS00000000TI\r\n\
        Sampling interval           :NOVALUE\r\n1.5\r\nNOVALUE\r\n-2E-1\r\n";
    fs::write(inner.join("T1.002"), force).unwrap();
    fs::write(inner.join("T1.chn"), "Number of channels :2\r\n").unwrap();
}

#[test]
fn files_of_a_laboratory_are_read() {
    let folder = tempfile::tempdir().unwrap();
    laboratory(folder.path());
    let found = read(&folder.path().join("T1.MME")).unwrap();
    let [force] = found.channels.as_slice() else {
        panic!("{found:?}");
    };
    assert_eq!(
        (force.name.as_str(), force.title.as_str()),
        ("11SEBE0000B3FO0D", "Gurtkraft ü")
    );
    assert_eq!(
        (
            force.unit.as_str(),
            force.signal.first,
            force.signal.interval
        ),
        ("kN", -0.1, 0.05)
    );
    assert_eq!(
        (force.signal.values[0], force.signal.values[2]),
        (1.5, -0.2)
    );
    assert!(force.signal.values[1].is_nan());
}

/// The same times in other units, and a unit that is none of time.
#[test]
fn times_of_a_channel_have_its_unit() {
    let folder = tempfile::tempdir().unwrap();
    laboratory(folder.path());
    let file = folder.path().join("CHANNEL/T1.001");
    let text = fs::read_to_string(&file).unwrap();
    let expected = read(folder.path()).unwrap();
    let milliseconds = text
        .replace("Unit :s", "Unit :ms")
        .replace("-0.1", "-100")
        .replace("-0.05", "-50");
    let unsaid = text.replace("Unit :s", "Unit :NOVALUE");
    for text in [milliseconds, unsaid] {
        fs::write(&file, text).unwrap();
        let found = read(folder.path()).unwrap();
        let [found, expected] = [&found, &expected].map(|one| &one.channels[0].signal);
        assert!(
            (found.first - expected.first).abs() < 1e-15 && (found.interval - 0.05).abs() < 1e-15
        );
    }
    fs::write(&file, text.replace("Unit :s", "Unit :N")).unwrap();
    let error = damage(folder.path());
    assert!(
        error.contains("T1.001") && error.contains("no unit of time"),
        "{error}"
    );
    fs::write(
        &file,
        text.replace("Unit :s", "Data status :No Data\r\nUnit :s"),
    )
    .unwrap();
    let error = damage(folder.path());
    assert!(error.contains("No Data"), "{error}");
}

#[test]
fn a_channel_says_that_it_failed() {
    for (status, doubt) in [
        ("ok", None),
        ("OK", None),
        ("NOVALUE", None),
        ("", None),
        ("Scaling factor applied", None),
        ("Channel failed", Some("Channel failed")),
        ("questionable data", Some("questionable data")),
        ("no data", Some("no data")),
        ("meaningless data", Some("meaningless data")),
        ("system failed", Some("system failed")),
    ] {
        let folder = tempfile::tempdir().unwrap();
        laboratory(folder.path());
        let text = format!(
            "Channel code :11HEAD0000H3ACXA\nData status :{status}\nTime of first sample :0\nSampling interval :1e-4\n1\n2\n"
        );
        fs::write(folder.path().join("CHANNEL/T1.003"), text).unwrap();
        let found = read(folder.path()).unwrap();
        let found = found.channel("11HEAD0000H3ACXA").unwrap();
        assert_eq!(found.doubt.as_deref(), doubt, "{status}");
    }
}

/// What is wrong with a test: the damage of a channel, or an error where it is not known which channel is damaged.
fn damage(folder: &Path) -> String {
    match read(folder) {
        Ok(found) => found.damaged.first().unwrap().error.clone(),
        Err(error) => error.to_string(),
    }
}

#[test]
fn what_is_wrong_is_said_with_its_place() {
    let wrong = [
        (
            "Sampling interval :1e-4\nNumber of samples :3\n1\n2\n",
            "T1.003:3: the file says that it has 3 samples, but has 2",
        ),
        (
            "Sampling interval :1e-4\n1\nx\n",
            "T1.003:4: `x` is neither a number",
        ),
        (
            "Sampling interval :1e-4\n1\ninf\n",
            "T1.003:4: `inf` is neither a number",
        ),
        (
            "Sampling interval :1e-4\n1\n2,5\n",
            "T1.003:4: \"2,5\" is no number",
        ),
        (
            "Sampling interval :1e-4\n1\n\n2\n",
            "T1.003:5: the line above is empty",
        ),
        (
            "Sampling interval :1e-4\n",
            "T1.003:1: the channel has no samples",
        ),
        ("Unit :N\n1\n2\n", "`Sampling interval` must be there"),
        (
            "Sampling interval :0\n1\n2\n",
            "T1.003:2: the sampling interval is 0 s",
        ),
        (
            "Sampling interval :short\n1\n2\n",
            "`short`, which is not a number",
        ),
        (
            "Sampling interval :1e-4\nSampling interval :1e-3\n1\n2\n",
            "T1.003:3: `Sampling interval` has a second value",
        ),
        (
            "Reference channel :sometimes\n1\n",
            "T1.003:2: `Reference channel` is `sometimes`",
        ),
        (
            "Reference channel :explicit\n1\n",
            "which channel has the times",
        ),
        (
            "Reference channel :explicit\nReference channel name :none\n1\n",
            "T1.003:3: its times are those of the channel `none`, which does not exist",
        ),
        (
            "Reference channel :explicit\nReference channel name :11TIRS00000000TI\n1\n2\n",
            "its samples are 2, and its times in 11TIRS00000000TI 3",
        ),
    ];
    for (text, told) in wrong {
        let folder = tempfile::tempdir().unwrap();
        laboratory(folder.path());
        let text = format!("Time of first sample :0\n{text}");
        fs::write(folder.path().join("CHANNEL/T1.003"), text).unwrap();
        let error = damage(folder.path());
        assert!(error.contains(told), "{error}");
    }
    let folder = tempfile::tempdir().unwrap();
    laboratory(folder.path());
    let unknown = "Sampling interval :1e-4\n1\n2\n";
    fs::write(folder.path().join("CHANNEL/T1.003"), unknown).unwrap();
    let error = damage(folder.path());
    assert!(
        error.contains("`Time of first sample` must be there"),
        "{error}"
    );
    let empty = tempfile::tempdir().unwrap();
    let error = read(empty.path()).unwrap_err().to_string();
    assert!(error.contains("no file .mme"), "{error}");
}

#[test]
fn a_list_that_contradicts_the_files_is_refused() {
    for (list, told) in [
        (
            "Number of channels :3\n",
            "T1.chn:1: the list has 3 channels, but there are 2 files",
        ),
        (
            "Name of channel 003 :x\n",
            "T1.chn:1: there is no file .003",
        ),
        (
            "Name of channel 2 :x\nName of channel 002 :y\n",
            "T1.chn:2: the list has the channel 002 twice",
        ),
        (
            "Name of channel two :x\n",
            "`Name of channel two` has no number",
        ),
        (
            "Name of channel 002 :11SEBE0000B6FO0D / belt\n",
            "T1.002:2: the file says that this is 11SEBE0000B3FO0D",
        ),
    ] {
        let folder = tempfile::tempdir().unwrap();
        laboratory(folder.path());
        fs::write(folder.path().join("CHANNEL/T1.chn"), list).unwrap();
        let error = damage(folder.path());
        assert!(error.contains(told), "{error}");
    }
}
