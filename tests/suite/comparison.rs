//! `bryant compare`, and the ISO-MME channels that `bryant run --mme` writes.

use super::command_call::call;
use super::{PENDULUM, directory};
use serde_json::Value;
use std::f64::consts::PI;
use std::fs;

/// The pendulum with channel codes, sampled at 10 kHz.
fn coded() -> String {
    PENDULUM
        .replace("what: angle }", "what: angle, code: 11CLOK000000ANYP }")
        .replace("every: 0.1 s", "every: 0.1 ms")
}

#[test]
fn a_run_agrees_with_its_own_channels() {
    let directory = directory();
    let path = directory.path();
    fs::write(path.join("coded.yaml"), coded()).unwrap();
    let (_, told) = call(
        path,
        &[
            "run",
            "coded.yaml",
            "--mme",
            "test",
            "--csv",
            "run.csv",
            "--picture",
            "run.svg",
        ],
        0,
    );
    assert!(told.contains("clock.mme"), "{told}");
    // the code is the name, the output is the title: the channel is found by either
    let list = fs::read_to_string(path.join("test/Channel/clock.chn")).unwrap();
    assert!(list.contains("11CLOK000000ANYP / swing"), "{list}");
    let arguments = ["compare", "run.csv", "test", "--json"];
    let rated: Value = serde_json::from_str(&call(path, &arguments, 0).0).unwrap();
    let rated = rated.as_array().unwrap();
    assert_eq!(rated.len(), 2, "{rated:?}");
    for one in rated {
        assert_eq!(
            (&one["rating"], &one["late"]),
            (&1.0.into(), &0.0.into()),
            "{one}"
        );
    }
    // bit for bit: the numbers read from the channel are those in the table
    let table = fs::read_to_string(path.join("run.csv")).unwrap();
    let swing = table
        .lines()
        .skip(1)
        .map(|row| row.split(',').nth(1).unwrap().parse::<f64>().unwrap());
    let channel = fs::read_to_string(path.join("test/Channel/clock.001")).unwrap();
    let samples = channel.lines().filter(|line| !line.contains(':'));
    let bits = |value: f64| value.to_bits();
    assert!(
        swing
            .map(bits)
            .eq(samples.map(|sample| bits(sample.parse().unwrap())))
    );
}

/// A run against the same run with more gravity: the ratings are those of the formula for the two tables.
#[test]
fn another_pendulum_agrees_less() {
    let directory = directory();
    let path = directory.path();
    fs::write(path.join("coded.yaml"), coded()).unwrap();
    for (table, gravity) in [("run.csv", "9.81"), ("heavy.csv", "12")] {
        let set = format!("gravity={gravity}");
        call(
            path,
            &[
                "run",
                "coded.yaml",
                "--set",
                &set,
                "--csv",
                table,
                "--picture",
                "run.svg",
            ],
            0,
        );
    }
    let arguments = [
        "compare",
        "run.csv",
        "heavy.csv",
        "--channel",
        "swing=swing",
        "--from",
        "0.1 s",
        "--to",
        "600 ms",
    ];
    let (text, _) = call(path, &arguments, 0);
    assert!(
        text.contains("100.0 ms") && text.contains("600.0 ms"),
        "{text}"
    );
    let json: Value =
        serde_json::from_str(&call(path, &[&arguments[..], &["--json"]].concat(), 0).0).unwrap();
    let one = &json[0];
    let read = |table: &str| -> Vec<f64> {
        let text = fs::read_to_string(path.join(table)).unwrap();
        text.lines()
            .skip(1001)
            .take(5001)
            .map(|row| row.split(',').nth(1).unwrap().parse().unwrap())
            .collect()
    };
    let (ours, theirs) = (read("run.csv"), read("heavy.csv"));
    let largest = theirs
        .iter()
        .fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let score = |(a, b): (&f64, &f64)| {
        let apart = (a - b).abs() / largest;
        ((0.5 - apart) / 0.45).clamp(0.0, 1.0).powi(2)
    };
    let corridor = ours.iter().zip(&theirs).map(score).sum::<f64>() / 5001.0;
    assert!(
        (one["corridor"].as_f64().unwrap() - corridor).abs() < 1e-9,
        "{one}"
    );
    assert!(
        one["rating"].as_f64().unwrap() < 0.99 && one["late"].as_f64().unwrap() > 0.0,
        "{one}"
    );
    // if both are filtered, the agreement is not much worse
    call(path, &[&arguments[..], &["--filter", "CFC60"]].concat(), 0);
}

/// A signal beside itself rates 1, also if it is periodic, whatever separates the columns of the two tables.
#[test]
fn a_file_agrees_with_itself() {
    let directory = directory();
    let path = directory.path();
    let write = |name: &str, separator: &str| {
        let mut text = [
            "time [s]",
            "sine [N]",
            "ramp [N]",
            "decay [N]",
            "fall [m/s]",
            "rest [N]",
        ]
        .join(separator);
        for i in 0..1000 {
            let t = 1e-4 * f64::from(i);
            let values = [
                t,
                (2.0 * PI * 500.0 * t).sin(),
                7.0 - 3.0 * t,
                (-20.0 * t).exp(),
                9.81 * t,
                4.0,
            ];
            text.push_str(&format!(
                "\n{}",
                values.map(|x| format!("{x:.7}")).join(separator)
            ));
        }
        fs::write(path.join(name), text).unwrap();
    };
    write("comma.csv", ",");
    write("semicolon.csv", ";");
    write("tab.csv", "\t");
    for other in ["comma.csv", "semicolon.csv", "tab.csv"] {
        let rated = call(path, &["compare", "comma.csv", other, "--json"], 0).0;
        let rated: Value = serde_json::from_str(&rated).unwrap();
        let rated = rated.as_array().unwrap();
        assert_eq!(rated.len(), 5, "{rated:?}");
        for one in rated {
            assert_eq!(
                (&one["rating"], &one["late"]),
                (&1.0.into(), &0.0.into()),
                "{one}"
            );
        }
    }
}

#[test]
fn what_cannot_be_compared_is_refused_with_the_remedy() {
    let directory = directory();
    let path = directory.path();
    let write = |name: &str, text: &str| fs::write(path.join(name), text).unwrap();
    let table = |name: &str, unit: &str, every: f64, count: usize| {
        let mut text = format!("time [s],swing [{unit}],other [N]\n");
        for i in 0..count {
            let t = i as f64 * every;
            text.push_str(&format!("{t},{},{}\n", (20.0 * t).sin(), t));
        }
        write(name, &text);
    };
    table("fine.csv", "rad", 1e-4, 500);
    table("degrees.csv", "deg", 1e-4, 500);
    table("coarse.csv", "rad", 1e-3, 50);
    table("newton.csv", "N", 1e-4, 500);
    write("foreign.csv", "time [s],x [N]\n0,1\n0.1,2\n");
    write(
        "twice.csv",
        "time [s],swing [rad],swing [deg]\n0,1,2\n0.1,2,3\n",
    );
    write("german.csv", "time [s];swing [rad]\n0,0;1,5\n0,1;2\n");
    for (arguments, told) in [
        (
            &["fine.csv", "coarse.csv"][..],
            "--every '0.1 ms'; or --resample",
        ),
        (
            &["fine.csv", "newton.csv"],
            "its unit is `rad`, and that of \"swing\" is `N`",
        ),
        (
            &["fine.csv", "foreign.csv"],
            "no channel of the same name\n  help: say which are the same: --channel 'swing=x'",
        ),
        (
            &["fine.csv", "fine.csv", "--channel", "swing=swimg"],
            "did you mean \"swing\"?",
        ),
        (&["fine.csv", "twice.csv"], "has 2 channels \"swing\""),
        (&["twice.csv", "fine.csv"], "has 2 channels \"swing\""),
        (
            &["fine.csv", "german.csv"],
            "german.csv:2: \"0,0\" is no number\n  help: its comma is a decimal mark",
        ),
        (
            &["fine.csv", "fine.csv", "--to", "1 s"],
            "both have samples from 0 s to 0.0499 s",
        ),
        (
            &["fine.csv", "fine.csv", "--channel", "swing"],
            "give two names",
        ),
        (
            &["fine.csv", "fine.csv", "--filter", "CFC90"],
            "no filter class `CFC90`",
        ),
        (
            &[
                "coarse.csv",
                "coarse.csv",
                "--resample",
                "--filter",
                "CFC600",
            ],
            "CFC600 needs a sample every 0.167 ms",
        ),
    ] {
        let (_, error) = call(path, &[&["compare"], arguments].concat(), 2);
        assert!(error.contains(told), "{arguments:?}: {error}");
    }
    call(path, &["compare", "fine.csv", "nowhere.csv"], 2);
    call(
        path,
        &["compare", "fine.csv", "coarse.csv", "--resample"],
        0,
    );
    // 1 rad compared with 1 deg: they differ as much as possible
    let (text, _) = call(
        path,
        &[
            "compare",
            "fine.csv",
            "degrees.csv",
            "--channel",
            "swing=swing",
        ],
        0,
    );
    assert!(text.contains("poor"), "{text}");
    // only channels at equal intervals
    let (_, error) = call(
        path,
        &["run", "clock.yaml", "--mme", "test", "--every", "0.3 s"],
        2,
    );
    assert!(error.contains("1 s is no whole number of 0.3 s"), "{error}");
}

#[test]
fn channel_codes_are_checked_and_follow_components_and_sides() {
    let directory = directory();
    let path = directory.path();
    let run = |code: &str, component: &str| {
        let output = format!(
            "of: clock/rod, at: cg, what: position, component: {component}, code: {code} }}"
        );
        let text = PENDULUM.replace(
            "of: clock/rod, at: cg, what: position, component: z }",
            &output,
        );
        fs::write(path.join("code.yaml"), text).unwrap();
    };
    for (code, told) in [
        ("11HEADCG00H3AC", "16 capital letters"),
        ("11HEADCG00H3AC?A", "? as its 15th"),
        ("11headcg00h3acxa", "16 capital"),
    ] {
        run(code, "z");
        let (_, error) = call(path, &["check", "code.yaml"], 2);
        assert!(
            error.contains(told) && error.contains("code.yaml:"),
            "{error}"
        );
    }
    run("11HEADCG00H3ACZA", "[x, z]");
    let (_, error) = call(path, &["check", "code.yaml"], 2);
    assert!(
        error.contains("has the channel code 11HEADCG00H3ACZA, too"),
        "{error}"
    );
    run("11HEADCG00H3AC?A", "[x, resultant]");
    let (_, error) = call(path, &["run", "code.yaml", "--mme", "test"], 2);
    assert!(
        error.contains("says CFC1000") && error.contains("--every '0.1 ms'"),
        "{error}"
    );
    let fine = [
        "run",
        "code.yaml",
        "--mme",
        "test",
        "--every",
        "0.1 ms",
        "--csv",
        "run.csv",
    ];
    call(path, &fine, 0);
    let list = fs::read_to_string(path.join("test/Channel/clock.chn")).unwrap();
    // a channel written as CFC1000 is the filtered table
    let arguments = [
        "compare", "run.csv", "test", "--filter", "CFC1000", "--json",
    ];
    let rated: Value = serde_json::from_str(&call(path, &arguments, 0).0).unwrap();
    assert_eq!(rated.as_array().unwrap().len(), 3, "{rated}");
    // the length of the rod is the same in both, and never changes
    assert_eq!(rated[2]["rating"], 1.0, "{rated}");
    assert!(
        list.contains("11HEADCG00H3ACXA") && list.contains("11HEADCG00H3ACRA"),
        "{list}"
    );
}
