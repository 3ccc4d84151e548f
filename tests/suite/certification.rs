//! Certification tests of the Hybrid III dummies, 49 CFR Part 572: the corridors that are met, and those that are not.
//! docs/validation.md has the same numbers.

use super::command_call::call;
use super::directory;
use super::tables::{column, run};
use std::f64::consts::PI;

const PAGE: &str = include_str!("../../docs/validation.md");

/// Samples of an output against time \[s\].
struct Signal {
    t: Vec<f64>,
    y: Vec<f64>,
}

impl Signal {
    fn of(scene: &str, every: &str, name: &str, factor: f64) -> Signal {
        let (table, told) = run(scene, &["--every", every]);
        // gravity is left out of some scenes
        let warnings = told.matches("warning").count() - told.matches("no field acts").count();
        assert_eq!(warnings, 0, "{scene}: {told}");
        Signal {
            t: column(&table, "time").to_vec(),
            y: column(&table, name).iter().map(|y| factor * y).collect(),
        }
    }

    /// The largest value before a time, and its index.
    fn peak(&self, before: f64) -> (f64, usize) {
        let all = self.t.iter().zip(&self.y).enumerate();
        let early = all.filter(|(_, (t, _))| **t < before);
        early.fold((f64::NEG_INFINITY, 0), |most, (i, (_, y))| {
            if *y > most.0 { (*y, i) } else { most }
        })
    }

    /// The time when it falls below a level after its peak \[ms\].
    fn falls_through(&self, level: f64) -> f64 {
        let (_, from) = self.peak(0.1);
        for i in from..self.y.len() - 1 {
            let [a, b] = [self.y[i] - level, self.y[i + 1] - level];
            if a >= 0.0 && b < 0.0 {
                return 1e3 * (self.t[i] + a / (a - b) * (self.t[i + 1] - self.t[i]));
            }
        }
        f64::NAN
    }
}

/// Checks a number against its corridor, as the page shows both. The page says which numbers were fitted.
fn judge(scene: &str, what: &str, value: f64, [low, high]: [f64; 2], digits: usize, meets: bool) {
    let is = (low..=high).contains(&value);
    assert_eq!(is, meets, "{scene}, {what}: {value} beside {low} to {high}");
    let verdict = if is { "met" } else { "**missed**" };
    let row = format!("| {what} | {low} to {high} | {value:.digits$} | ");
    let line = PAGE
        .lines()
        .skip_while(|line| *line != format!("### {scene}"));
    let line = line.skip(1).take_while(|line| !line.starts_with("### "));
    let line = line.into_iter().find(|line| line.starts_with(&row));
    let line = line.unwrap_or_else(|| {
        panic!("docs/validation.md lacks, under {scene}:\n{row}… | {verdict} |")
    });
    assert!(line.ends_with(&format!("| {verdict} |")), "{line}");
}

/// A test of a neck: its corridors by their names on the page, and whether each is met.
struct Neck {
    scene: &'static str,
    flexion: bool,
    corridors: &'static [(&'static str, [f64; 2], bool)],
}

const NECKS: [Neck; 6] = [
    Neck {
        scene: "neck-flexion-50m",
        flexion: true,
        corridors: &[
            ("peak rotation [°]", [64.0, 78.0], true),
            ("its time [ms]", [57.0, 64.0], true),
            ("peak moment [N·m]", [88.1, 108.5], true),
            ("time of the peak moment [ms]", [47.0, 58.0], true),
            ("rotation back at 0 [ms]", [113.0, 128.0], true),
            ("moment back at 0 [ms]", [97.0, 107.0], true),
        ],
    },
    Neck {
        scene: "neck-extension-50m",
        flexion: false,
        corridors: &[
            ("peak rotation [°]", [81.0, 106.0], true),
            ("its time [ms]", [72.0, 82.0], true),
            ("peak moment [N·m]", [52.9, 80.0], true),
            ("time of the peak moment [ms]", [65.0, 79.0], true),
            ("rotation back at 0 [ms]", [147.0, 174.0], false),
            ("moment back at 0 [ms]", [120.0, 148.0], true),
        ],
    },
    Neck {
        scene: "neck-flexion-5f",
        flexion: true,
        corridors: &[
            ("peak rotation [°]", [77.0, 91.0], true),
            ("peak moment [N·m]", [69.0, 83.0], true),
            ("moment below 10 N·m [ms]", [80.0, 100.0], true),
        ],
    },
    Neck {
        scene: "neck-extension-5f",
        flexion: false,
        corridors: &[
            ("peak rotation [°]", [99.0, 114.0], true),
            ("peak moment [N·m]", [53.0, 65.0], false),
            ("moment below 10 N·m [ms]", [94.0, 114.0], false),
        ],
    },
    Neck {
        scene: "neck-flexion-6yo",
        flexion: true,
        corridors: &[
            ("peak rotation [°]", [74.0, 92.0], false),
            ("peak moment [N·m]", [27.0, 33.0], false),
            ("moment below 5 N·m [ms]", [103.0, 123.0], true),
        ],
    },
    Neck {
        scene: "neck-extension-6yo",
        flexion: false,
        corridors: &[
            ("peak rotation [°]", [85.0, 103.0], true),
            ("peak moment [N·m]", [19.0, 24.0], false),
            ("moment below 5 N·m [ms]", [123.0, 147.0], true),
        ],
    },
];

#[test]
fn necks_bend_as_the_page_says() {
    for neck in &NECKS {
        let sign = if neck.flexion { 1.0 } else { -1.0 };
        let rotation = Signal::of(neck.scene, "0.25 ms", "rotation", sign * 180.0 / PI);
        // flexion pulls the head back: the moment of the neck on the head is negative
        let moment = Signal::of(neck.scene, "0.25 ms", "moment", -sign);
        let late = 0.1;
        for &(what, corridor, meets) in neck.corridors {
            let (value, digits) = match what {
                "peak rotation [°]" => (rotation.peak(late).0, 1),
                "its time [ms]" => (1e3 * rotation.t[rotation.peak(late).1], 1),
                "peak moment [N·m]" => (moment.peak(late).0, 1),
                "time of the peak moment [ms]" => (1e3 * moment.t[moment.peak(late).1], 1),
                "rotation back at 0 [ms]" => (rotation.falls_through(0.0), 1),
                "moment back at 0 [ms]" => (moment.falls_through(0.0), 1),
                "moment below 10 N·m [ms]" => (moment.falls_through(10.0), 1),
                "moment below 5 N·m [ms]" => (moment.falls_through(5.0), 1),
                other => unreachable!("{other}"),
            };
            judge(neck.scene, what, value, corridor, digits, meets);
        }
    }
}

/// The pendulum stays in the corridors of the regulation for its deceleration \[gn\], or for the change of its velocity
/// \[m/s\], at 10, 20 and 30 ms.
#[test]
fn pendulums_are_braked_within_their_corridors() {
    let decelerations = [
        (
            "neck-flexion-50m",
            [[22.5, 27.5], [17.6, 22.6], [12.5, 18.5]],
            [34.0, 42.0],
        ),
        (
            "neck-extension-50m",
            [[17.2, 21.2], [14.0, 19.0], [11.0, 16.0]],
            [38.0, 46.0],
        ),
    ];
    for (scene, corridors, through_5) in decelerations {
        let (table, _) = run(scene, &["--every", "0.25 ms"]);
        let a = column(&table, "deceleration");
        let a: Vec<f64> = a.iter().map(|a| a.abs() / 9.806_65).collect();
        for (i, [low, high]) in corridors.into_iter().enumerate() {
            let at = a[40 * (i + 1)];
            assert!((low..=high).contains(&at), "{scene} {at}");
        }
        let last = a.iter().rposition(|a| *a >= 5.0).unwrap() as f64 / 4.0;
        assert!(
            (through_5[0]..=through_5[1]).contains(&last),
            "{scene} {last}"
        );
    }
    let changes = [
        ("neck-flexion-5f", [[2.1, 2.5], [4.0, 5.0], [5.8, 7.0]]),
        ("neck-extension-5f", [[1.5, 1.9], [3.1, 3.9], [4.6, 5.6]]),
        ("neck-flexion-6yo", [[1.2, 1.6], [2.4, 3.4], [3.8, 5.0]]),
        ("neck-extension-6yo", [[1.0, 1.4], [2.2, 3.0], [3.2, 4.2]]),
    ];
    for (scene, corridors) in changes {
        let (table, _) = run(scene, &["--every", "0.25 ms"]);
        let a = column(&table, "deceleration");
        for (i, [low, high]) in corridors.into_iter().enumerate() {
            let part = &a[..=40 * (i + 1)];
            let sum: f64 = part.windows(2).map(|two| 0.5 * (two[0] + two[1])).sum();
            let change = sum.abs() * 2.5e-4;
            assert!((low..=high).contains(&change), "{scene} {change}");
        }
    }
}

#[test]
fn chests_are_pressed_as_the_page_says() {
    let corridors = [
        (
            "thorax-impact-50m",
            [[5160.0, 5894.0], [63.5, 72.6], [69.0, 85.0]],
            [true, true, true],
        ),
        (
            "thorax-impact-5f",
            [[3900.0, 4400.0], [50.0, 58.0], [69.0, 85.0]],
            [false, false, true],
        ),
    ];
    for (scene, corridors, meets) in corridors {
        let force = Signal::of(scene, "0.2 ms", "force", 1.0);
        let depth = Signal::of(scene, "0.2 ms", "compression", -1.0);
        let (deepest, turn) = depth.peak(1.0);
        // ∫ F dδ on the way in and on the way back
        let work = |from: usize, to: usize| -> f64 {
            let step =
                |i: usize| 0.5 * (force.y[i] + force.y[i + 1]) * (depth.y[i + 1] - depth.y[i]);
            (from..to).map(step).sum()
        };
        let lost = 100.0 * (1.0 + work(turn, depth.y.len() - 1) / work(0, turn));
        let values = [
            ("peak force [N]", force.peak(1.0).0, 0),
            ("compression [mm]", 1e3 * deepest, 1),
            ("hysteresis [%]", lost, 1),
        ];
        for (i, (what, value, digits)) in values.into_iter().enumerate() {
            judge(scene, what, value, corridors[i], digits, meets[i]);
        }
    }
}

#[test]
fn heads_knees_and_torsos_resist_as_the_page_says() {
    let head = Signal::of("head-drop-50m", "0.05 ms", "acceleration", 1.0 / 9.806_65);
    judge(
        "head-drop-50m",
        "peak acceleration [gn]",
        head.peak(1.0).0,
        [225.0, 275.0],
        0,
        true,
    );
    let knee = Signal::of("knee-impact-50m", "0.05 ms", "force", 1.0);
    judge(
        "knee-impact-50m",
        "peak force [N]",
        knee.peak(1.0).0,
        [4715.0, 5783.0],
        0,
        true,
    );
    // both hips, from the seated position
    let (table, _) = run("hip-flexion-50m", &[]);
    let angle = column(&table, "thigh").iter();
    let angle: Vec<f64> = angle.map(|angle| -angle.to_degrees() - 90.0).collect();
    let torque: Vec<f64> = column(&table, "torque")
        .iter()
        .map(|torque| 0.5 * torque)
        .collect();
    let hip = "hip-flexion-50m";
    let at_30 = angle.iter().rposition(|angle| *angle <= 30.0).unwrap();
    judge(
        hip,
        "torque at 30° [N·m]",
        torque[at_30],
        [0.0, 94.9],
        0,
        true,
    );
    let place = torque.iter().position(|torque| *torque >= 203.4).unwrap();
    judge(
        hip,
        "angle at 203.4 N·m [°]",
        angle[place],
        [40.0, 50.0],
        1,
        true,
    );
    for (scene, corridor) in [
        ("torso-flexion-5f", [320.0, 390.0]),
        ("torso-flexion-6yo", [147.0, 200.0]),
    ] {
        let (table, _) = run(scene, &[]);
        let (angle, force) = (column(&table, "flexion"), column(&table, "force"));
        let place = angle.iter().position(|angle| *angle > PI / 4.0).unwrap();
        let [a, b] = [angle[place - 1], angle[place]];
        let share = (PI / 4.0 - a) / (b - a);
        let at = force[place - 1] + share * (force[place] - force[place - 1]);
        judge(scene, "force at 45° [N]", at, corridor, 0, true);
    }
}

/// A corridor is drawn in the plots of its column, at its place, and refused if there is no such plot.
#[test]
fn corridors_are_drawn_in_their_plots() {
    let directory = directory();
    let path = directory.path();
    let corridor = |text: &'static str, code: i32| {
        let all = [
            "run",
            "knee-impact-50m",
            "--csv",
            "x.csv",
            "--picture",
            "x.svg",
        ];
        let all = [&all[..], &["--plot", "force", "--corridor", text]].concat();
        call(path, &all, code).1
    };
    corridor("force: 1 ms to 3 ms, 4715 N to 5783 N", 0);
    let plot = std::fs::read_to_string(path.join("knee-impact-50m-force-over-time.svg")).unwrap();
    assert_eq!(plot.matches("class=\"corridor\"").count(), 1, "{plot}");
    let told = corridor("time: any, 1 ms to 2 ms", 2);
    assert!(told.contains("no plot shows \"time\""), "{told}");
    let told = corridor("torque: any, 1 to 2", 2);
    assert!(told.contains("the columns are time, force"), "{told}");
}
