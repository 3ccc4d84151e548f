//! What pages tell of laws beside their formula, by tests that do not repeat the equations of the program.

use super::*;

/// A body with its position and rotation moved a little, by six directions.
fn moved(body: &Moving, direction: usize, by: f64) -> Moving {
    let mut position = body.position;
    let mut rotation = body.rotation;
    match direction {
        0..3 => position[direction] += by,
        _ => {
            let mut angles = [0.0; 3];
            angles[direction - 3] = by;
            rotation = product(&turned(angles), &rotation);
        }
    }
    Moving {
        position,
        rotation,
        ..*body
    }
}

/// −∂V along a direction, by differences of the fourth order.
fn slope(body: &Moving, direction: usize, energy: &dyn Fn(&Moving) -> f64) -> f64 {
    let h = 1e-4;
    let at = |steps: f64| energy(&moved(body, direction, steps * h));
    -(8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * h)
}

/// A fading edge: force and moment together are the gradient of the energy w ∫ f dδ. The moment is that of an
/// ellipsoid; of a sphere it is 0.
#[test]
fn an_edge_that_fades_turns_an_ellipsoid() {
    let scene = FreeBody::new(
        "contact: c, ellipsoid: { on: one/body, center: [0, 0, 0], semi_axes: [0.12, 0.09, 0.15] }, plane: { on: frame, at: [0, 0, 0], normal: [0.2, -0.3, 1], along: [1, 0.4, -0.1], extent: [0.3, 0.2], edge: { rule: fade, width: 0.15 } }, elastic: { points: [[0, 0], [0.1, 800]], extrapolate: linear }",
        "",
    );
    let n = unit(NORMAL);
    let t1 = unit(minus(ALONG, times(dot(ALONG, n), n)));
    let tangents = [t1, cross(n, t1)];
    let shares =
        |point: Vector| [0, 1].map(|i| ([0.3, 0.2][i] - dot(tangents[i], point).abs()) / 0.15);
    let energy = |body: &Moving| {
        let (depth, _, point, ..) = touch(body, body.position, AXES);
        let weight = shares(point)
            .map(|x| x.clamp(0.0, 1.0))
            .map(|x| x * x * (3.0 - 2.0 * x));
        weight[0] * weight[1] * 0.5 * 8000.0 * depth.max(0.0).powi(2)
    };
    let mut random = Random::new(14);
    let mut turned = 0;
    for _ in 0..10 * STATES {
        let body = Moving::random(&mut random, [0.0; 3], 0.3);
        let (depth, _, point, ..) = touch(&body, body.position, AXES);
        let near = |x: f64| x.abs() < 0.02 || (x - 1.0).abs() < 0.02;
        // within the differences the energy is smooth
        if depth < 2e-3 || shares(point).iter().any(|x| near(*x)) {
            continue;
        }
        let [force, moment] = [0, 3].map(|k| [0, 1, 2].map(|i| slope(&body, k + i, &energy)));
        let ours = scene.acts(&body, 0.0, &[], &[]);
        let off = norm(minus(ours.force, force)).max(norm(minus(ours.moment, moment)));
        // h⁴/30 times a fifth derivative (some 1e4 N/m · 1e9/m³ at most, where the curvature of the ellipsoid and of S
        // is largest)
        assert!(
            off < 1e-4 * (1.0 + norm(force)),
            "{ours:?} instead of {force:?} {moment:?}"
        );
        // the moment of the force at the deepest point is another one
        let plain = 8000.0 * depth;
        let weight = shares(point)
            .map(|x| x.clamp(0.0, 1.0))
            .map(|x| x * x * (3.0 - 2.0 * x));
        let pressed = times(weight[0] * weight[1] * plain, n);
        let without = cross(minus(point, body.position), pressed);
        turned += usize::from(norm(minus(moment, without)) > 0.05 * norm(moment).max(0.1));
    }
    assert!(turned > 20, "{turned}");
}

/// Belt over a ring, with the words `more`.
fn over_a_ring(more: &str) -> FreeBody {
    FreeBody::new(
        &format!(
            "belt: b, from: {{ on: frame, at: [-1, 0, 0.3] }}, through: [{{ ring: r, on: one/body, at: [0.1, -0.05, 0.02] }}], to: {{ on: frame, at: [1, 0.2, 0] }}, force: {{ points: [[0, 0], [0.1, 500], [1, 2000]], extrapolate: linear }}, length: 1.7, {more}"
        ),
        NOW,
    )
}

/// The spans of both segments from the ring, and their lengths without tension at the start.
fn spans(body: &Moving) -> ([Vector; 2], [f64; 2]) {
    let (from, to) = ([-1.0, 0.0, 0.3], [1.0, 0.2, 0.0]);
    let ring = [0.1, -0.05, 0.02];
    let starts = [from, to].map(|end| norm(minus(end, ring)));
    let lengths = starts.map(|length| 1.7 * length / (starts[0] + starts[1]));
    let point = body.point(ring);
    ([from, to].map(|end| minus(end, point)), lengths)
}

/// Before the switch of `since` nothing pulls and nothing slips; behind it webbing slips without friction by the
/// difference of the tensions.
#[test]
fn a_belt_that_waits_does_not_slip() {
    let scene = over_a_ring("since: now");
    let mut random = Random::new(15);
    let mut slipped = 0;
    for _ in 0..STATES {
        let body = Moving::random(&mut random, [0.0; 3], 0.5);
        let waits = [("now", 1e30)];
        assert_eq!(scene.rates(&body, 0.4, &[0.0], &waits), [0.0]);
        let still = scene.acts(&body, 0.4, &[0.0], &waits);
        assert_eq!((still.force, still.moment), ([0.0; 3], [0.0; 3]));
        let (spans, lengths) = spans(&body);
        let [before, behind] = [0, 1].map(|k| {
            let strain = norm(spans[k]) / lengths[k] - 1.0;
            if strain > 0.0 {
                curve(&WEBBING, strain)
            } else {
                0.0
            }
        });
        let expected = (behind - before) / 50.0;
        let found = scene.rates(&body, 0.4, &[0.0], &[])[0];
        let size = (before + behind + 2e3) / 50.0;
        assert!(
            (found - expected).abs() < 1e4 * f64::EPSILON * size,
            "{found} instead of {expected}"
        );
        slipped += usize::from(expected != 0.0);
    }
    assert!(slipped > STATES / 4);
}

/// The damping of each segment grows with the stretch of this segment [m], not with that of the belt.
#[test]
fn the_damping_of_a_segment_grows_with_its_own_stretch() {
    let scene = over_a_ring("damping: 60, damping_stretch: 0.3");
    let mut random = Random::new(16);
    let mut differ = 0;
    for _ in 0..STATES {
        let body = Moving::random(&mut random, [0.0; 3], 0.5);
        let (spans, lengths) = spans(&body);
        let stretches = [0, 1].map(|k| norm(spans[k]) - lengths[k]);
        let held = [0, 1].map(|k| match stretches[k] > 0.0 {
            true => curve(&WEBBING, stretches[k] / lengths[k]),
            false => 0.0,
        });
        // the webbing that slips lengthens the first segment and shortens the second by this much a second
        let feeds = (held[0] - held[1]) / 50.0;
        let point = body.point([0.1, -0.05, 0.02]);
        let pulls = [0, 1].map(|k| {
            let along = unit(spans[k]);
            let rate = -dot(along, body.velocity_at(point));
            let feeds = if k == 0 { feeds } else { -feeds };
            let strains = (rate - feeds * norm(spans[k]) / lengths[k]) / lengths[k];
            let fade = (stretches[k] / 0.3).min(1.0);
            let tension = match stretches[k] > 0.0 {
                true => (held[k] + 60.0 * 1.7 * strains * fade).max(0.0),
                false => 0.0,
            };
            times(tension, along)
        });
        differ +=
            usize::from(stretches.iter().all(|x| *x > 0.0) && stretches.iter().any(|x| *x < 0.3));
        let page = Wrench::at(&body, point, pulls[0]).and(Wrench::at(&body, point, pulls[1]));
        let size = 1e4 * (held[0] + held[1] + 2e3);
        same("segments", scene.acts(&body, 0.4, &[0.0], &[]), page, size);
    }
    assert!(differ > 20, "{differ}");
}

/// With damping the limiter bounds the whole tension, but it pays out by the stretch alone: as much as the elastic
/// tension would exceed it.
#[test]
fn a_limiter_pays_out_by_the_stretch_alone() {
    let law = |damping: &str| {
        FreeBody::new(
            &format!(
                "belt: b, from: {{ on: one/body, at: [0.1, -0.05, 0.02] }}, to: {{ on: frame, at: [1, 0, 0] }}, force: {{ points: [[0, 0], [0.1, 500], [1, 2000]], extrapolate: linear }}, length: 0.8, limiter: {{ force: 700 }}{damping}"
            ),
            "",
        )
    };
    let scene = law(", damping: 600, damping_stretch: 0");
    let paid = |body: &Moving| {
        let state = scene.state(body, 0.4, &[], &[("paid out", 0.01)]);
        let inputs = Inputs {
            time: state.t,
            coordinates: &state.q,
            velocities: &state.v,
            parameters: &[],
            auxiliaries: &state.z,
            memory: &state.m,
            accelerations: &[],
        };
        let mut memory = scene.equations.memory.iter();
        let next = memory
            .find(|state| state.name.contains("paid out"))
            .map(|state| state.next);
        let roots = [next.expect("a memory of what is paid out")];
        evaluate(
            &scene.equations.graph,
            &roots,
            &inputs,
            &functions(&scene.model),
        )[0]
    };
    // 700 N at 0.1 + 200/1500 · 0.9
    let yields = 1.0 + 0.1 + 200.0 / (1500.0 / 0.9);
    let mut random = Random::new(17);
    let (mut bound, mut yielded) = (0, 0);
    for _ in 0..STATES {
        let body = Moving::random(&mut random, [0.0; 3], 0.5);
        let from = body.point([0.1, -0.05, 0.02]);
        let span = minus([1.0, 0.0, 0.0], from);
        let (length, along) = (norm(span), unit(span));
        let rate = -dot(along, body.velocity_at(from));
        let expected = f64::max(0.01, length / yields - 0.8);
        assert!(
            (paid(&body) - expected).abs() < 1e-13 * length,
            "{} {expected}",
            paid(&body)
        );
        yielded += usize::from(expected > 0.01);
        let strain = length / (0.8 + expected) - 1.0;
        let whole = curve(&WEBBING, strain) + 600.0 * rate;
        let tension = if strain > 0.0 {
            whole.clamp(0.0, 700.0)
        } else {
            0.0
        };
        // bound by the limiter, and yet nothing more is paid out
        bound += usize::from(tension == 700.0 && expected == 0.01);
        let page = Wrench::at(&body, from, times(tension, along));
        // whether it pays out is remembered, from the event on at which it began
        let pays = f64::from(expected > 0.01);
        let memory = [("paid out", 0.01), ("pays out", pays)];
        let ours = scene.acts(&body, 0.4, &[], &memory);
        same("limiter", ours, page, 100.0 * (tension + 2e4 * length));
    }
    assert!(bound > 10 && yielded > 10, "{bound} {yielded}");
}

/// In the plane θ₂ is the difference of two angles that count turns: a bushing that has turned once more resists by 2π
/// k more.
#[test]
fn a_planar_bushing_counts_turns() {
    let text = "model: page\ndimension: 2\nsystems:\n  - name: one\n    elements: [{ name: body, mass: 2, cg: [0, 0], inertia: 0.5 }]\nforces:\n  - { bushing: b, from: { on: frame, at: [0, 0] }, to: { on: one/body, at: [0, 0] }, about: { y: { stiffness: 3 } } }\n";
    let model = read(text).unwrap_or_else(|problems| panic!("{problems:#?}"));
    let engine = Engine::new(Config::new().lists(&model)).unwrap();
    for angle in [
        0.3,
        0.3 + std::f64::consts::TAU,
        0.3 - 4.0 * std::f64::consts::PI,
    ] {
        let state = State {
            t: 0.0,
            q: vec![0.0, 0.0, angle],
            v: vec![0.0; 3],
            z: vec![],
            m: vec![],
            a: Vec::new(),
        };
        let found = at(&engine, &[], &state).unwrap_or_else(|e| panic!("{e}"));
        let expected = -3.0 * angle / 0.5;
        let off = (found.acceleration[2] - expected).abs();
        assert!(
            off < 1e2 * f64::EPSILON * expected.abs(),
            "{:?} instead of {expected}",
            found.acceleration
        );
    }
}
