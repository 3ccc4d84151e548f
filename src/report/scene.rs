//! The moving parts of a report as JSON: bodies, their shapes, and the forces between them, at every sample.

use crate::pose::{Frame, Vec3, quaternion};
use crate::scene::mesh::Mesh;
use crate::scene::{BodyPoint, Ellipsoid, Line, LineKind, Plane, Push, Scene};
use serde_json::{Value, json};

/// A number with six digits.
pub fn short(value: f64) -> Value {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(f64::NAN);
    match rounded {
        // -0 would take two letters more than 0
        0.0 => json!(0),
        _ => json!(rounded),
    }
}

fn vector(vector: Vec3) -> Value {
    vector.map(short).to_vec().into()
}

/// A scene in the form that the page reads. The frame is the body −1.
pub fn json(scene: &Scene) -> Value {
    json!({
        "planar": scene.planar,
        "times": scene.times.iter().map(|t| short(*t)).collect::<Vec<_>>(),
        "bodies": scene.bodies.iter().map(|body| json!({
            "name": body.name,
            "system": body.system.map_or(-1, |system| system as i64),
            "parent": body.parent,
        })).collect::<Vec<_>>(),
        "frames": scene.frames.iter().map(|all| all.iter().flat_map(frame).collect::<Value>()).collect::<Vec<_>>(),
        "bones": scene.bones.iter().map(|[from, to]| {
            json!([index(from.body), vector(from.at), index(to.body), vector(to.at)])
        }).collect::<Vec<_>>(),
        "points": scene.points.iter().map(|(name, place)| {
            json!({ "name": name, "body": index(place.body), "at": vector(place.at) })
        }).collect::<Vec<_>>(),
        "ellipsoids": scene.ellipsoids.iter().map(ellipsoid).collect::<Vec<_>>(),
        "planes": scene.planes.iter().map(plane).collect::<Vec<_>>(),
        "lines": scene.lines.iter().flat_map(|line| segments(scene, line)).collect::<Vec<_>>(),
        "meshes": scene.meshes.iter().map(mesh).collect::<Vec<_>>(),
        "follow": index(scene.followed()),
        "view": scene.view().name(),
        "pushes": scene.pushes.iter().map(|all| all.iter().map(push).collect::<Value>()).collect::<Vec<_>>(),
    })
}

fn index(body: Option<usize>) -> i64 {
    body.map_or(-1, |body| body as i64)
}

/// Position and quaternion of a body.
fn frame(frame: &Frame) -> [Value; 7] {
    let [x, y, z] = frame.origin;
    let [a, b, c, d] = quaternion(frame.rotation);
    [x, y, z, a, b, c, d].map(short)
}

fn ellipsoid(ellipsoid: &Ellipsoid) -> Value {
    json!({
        "body": index(ellipsoid.center.body),
        "at": vector(ellipsoid.center.at),
        "turn": quaternion(ellipsoid.turn).map(short),
        "semi": vector(ellipsoid.semi),
        "degree": ellipsoid.degree,
        "size": ellipsoid.fill.as_ref().map(|fill| {
            (0..fill.len()).map(|k| short(ellipsoid.size(k))).collect::<Vec<_>>()
        }),
    })
}

/// Corners as whole numbers of steps from the low corner, and triangles as indices of corners, 16 bits each, or 32 if
/// there are more corners than that; both in base64.
fn mesh(mesh: &Mesh) -> Value {
    let [low, high] = mesh.triangles.around();
    let size = (0..3).fold(1e-9f64, |size, i| size.max(high[i] - low[i]));
    let step = size / f64::from(u16::MAX);
    let places = mesh.triangles.places.iter();
    let places = places.flat_map(|place| {
        (0..3).flat_map(|i| (((place[i] - low[i]) / step).round() as u16).to_le_bytes())
    });
    let wide = mesh.triangles.places.len() > usize::from(u16::MAX);
    let corners = mesh.triangles.corners.iter().flatten();
    let corners = corners.flat_map(|corner| match wide {
        true => corner.to_le_bytes().to_vec(),
        false => (*corner as u16).to_le_bytes().to_vec(),
    });
    json!({
        "body": index(mesh.body),
        "low": vector(low),
        "step": short(step),
        "places": base64(&places.collect::<Vec<u8>>()),
        "wide": wide,
        "corners": base64(&corners.collect::<Vec<u8>>()),
    })
}

fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let byte = |i: usize| u32::from(three.get(i).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for i in 0..4 {
            text.push(match i <= three.len() {
                true => char::from(LETTERS[(bits >> (18 - 6 * i) & 63) as usize]),
                false => '=',
            });
        }
    }
    text
}

fn plane(plane: &Plane) -> Value {
    json!({
        "body": index(plane.body),
        "corners": plane.corners.map(vector),
        "normal": vector(plane.normal),
    })
}

/// The segments of a line: both ends, the force at each time, positive where it pulls, and at each time the points
/// between the ends, if there are any.
fn segments(scene: &Scene, line: &Line) -> Vec<Value> {
    let kind = match line.kind {
        LineKind::Belt => "belt",
        LineKind::Spring => "spring",
        LineKind::Bushing => "bushing",
    };
    let place = |place: &BodyPoint| json!([index(place.body), vector(place.at)]);
    let segment = |(i, ends): (usize, &[BodyPoint])| {
        let pulls = line.pulls.get(i).into_iter().flatten();
        json!({
            "name": line.name,
            "kind": kind,
            "from": place(&ends[0]),
            "to": place(&ends[1]),
            "way": between(scene, line, i),
            "force": pulls.map(|pull| short(*pull)).collect::<Vec<_>>(),
        })
    };
    line.points.windows(2).enumerate().map(segment).collect()
}

/// The points between the ends of a segment, to 0.1 mm.
fn between(scene: &Scene, line: &Line, segment: usize) -> Value {
    let at = |k| {
        let path = scene.path(k, line, segment);
        let between = path[1..path.len() - 1].as_flattened();
        between
            .iter()
            .map(|x| json!((x * 1e4).round() / 1e4))
            .collect::<Vec<_>>()
    };
    let all: Vec<Vec<Value>> = (0..scene.times.len()).map(at).collect();
    match all.first() {
        Some(first) if !first.is_empty() => json!(all),
        _ => Value::Null,
    }
}

/// Index of the force, point, and the force on the body.
fn push(push: &Push) -> Value {
    let numbers = push.at.into_iter().chain(push.on_body).map(short);
    std::iter::once(json!(push.force)).chain(numbers).collect()
}
