//! Failures in words.

use crate::models::BARE;
use bryant_runtime::failure::{Culprit, Failure, Quantity, Reason};
use bryant_runtime::{Info, OutputInfo};

const QUATERNION: Info = Info {
    name: "top",
    dimension: 3,
    coordinates: &["top.w", "top.x", "top.y", "top.z"],
    velocities: &["top.p", "top.q", "top.r"],
    kinds: &[],
    units: &[],
    outputs: &[OutputInfo {
        name: "lap belt force",
        unit: "N",
    }],
    ..BARE
};
const LEAVABLE: Info = Info {
    time_ends: false,
    curves: &[bryant_runtime::CurveInfo {
        name: "belt lap: curve",
        unit: "",
        first: 0.0,
        last: 0.1,
        ends: [0.0, 6e3],
        extrapolate: bryant_runtime::Extrapolate::Error,
        told: true,
        kind: bryant_runtime::CurveKind::Curve,
    }],
    ..QUATERNION
};
const BRYANT: Info = Info {
    coordinates: &["top.angle1", "top.angle2", "top.angle3"],
    ..QUATERNION
};

fn failure<'a>(info: &'a Info<'a>, reason: Reason) -> Failure<'a> {
    let t = 0.25;
    Failure { t, reason, info }
}

#[test]
fn a_small_step_names_time_velocity_and_stiffness() {
    let reason = Reason::StepTooSmall {
        step: 1e-15,
        index: 5,
        culprit: Culprit::Unknown,
    };
    let failed = failure(&QUATERNION, reason);
    assert_eq!(failed.coordinate(), Some("top.q"));
    let text = failed.to_string();
    assert!(
        text.starts_with("at t = 0.25 s the velocity \"top.q\" asks for a step of 1e-15 s"),
        "{text}"
    );
    assert!(text.contains("too stiff"), "{text}");
}

#[test]
fn bryant_angles_are_not_to_blame() {
    // their chart changes before they are singular
    let reason = Reason::StepTooSmall {
        step: 1e-15,
        index: 1,
        culprit: Culprit::Unknown,
    };
    let [angles, quaternion] = [&BRYANT, &QUATERNION].map(|info| failure(info, reason).cause());
    assert_eq!(angles, quaternion);
}

#[test]
fn what_is_not_finite_names_the_output_that_shares_it() {
    let reason = Reason::NonFinite {
        index: 0,
        of: Quantity::Derivative,
        output: Some(0),
        culprit: Culprit::Unknown,
    };
    let text = failure(&QUATERNION, reason).to_string();
    assert!(text.contains("rate of the coordinate \"top.w\""), "{text}");
    assert!(text.contains("output \"lap belt force\""), "{text}");
    // a curve that may be left is not named as a cause, and a model without curves names none
    assert!(!text.contains("curve"), "{text}");
    let text = failure(&LEAVABLE, reason).to_string();
    assert!(text.contains("left its range"), "{text}");
}

#[test]
fn an_output_alone_is_named_and_no_coordinate() {
    let reason = Reason::NonFinite {
        index: 0,
        of: Quantity::Output,
        output: Some(0),
        culprit: Culprit::Unknown,
    };
    let failed = failure(&QUATERNION, reason);
    assert_eq!(failed.coordinate(), None);
    let text = failed.to_string();
    assert!(
        text.starts_with("at t = 0.25 s the output \"lap belt force\" is not finite; likely cause: numbers so large"),
        "{text}"
    );
}

#[test]
fn an_index_beyond_the_state_is_no_panic() {
    let reason = Reason::StepTooSmall {
        step: 1e-15,
        index: 99,
        culprit: Culprit::Unknown,
    };
    assert_eq!(failure(&BRYANT, reason).coordinate(), None);
    assert!(!failure(&BRYANT, reason).to_string().is_empty());
}
