//! A case for every effect: what switches it on and off.

/// An effect: the text that switches it on, the texts that switch it off, and the text that never mentions it.
pub struct Case {
    /// Word of the vocabulary, as [`word`](super::word) and [`terms`](super::terms) have it.
    pub word: &'static str,
    /// Name of the effect that [`effect::without`] is to leave out, with the same result; empty where that is another
    /// model.
    pub effect: &'static str,
    pub scene: fn(&str) -> String,
    pub on: &'static str,
    pub off: &'static [&'static str],
    pub never: &'static str,
}

/// A planar man on a sled, with the additional text of a case.
pub fn plane(rest: &str) -> String {
    let rest = complete(rest);
    format!(
        "model: m
dimension: 2
curves: {{ pulse: {{ points: [[0, 0], [0.1, 9]] }}, never: {{ points: [[0, 0], [1, 0]] }} }}
parameters: {{ mu: 0.3, spare: {{ value: 2, min: 1 }} }}
systems:
  - name: man
    elements:
      - {{ name: torso, mass: 30, cg: [0, 0.2], inertia: 1.1 }}
      - {{ name: head, on: torso, at: [0, 0.45], mass: 4.5, cg: [0.02, 0.1], inertia: 0.03 }}
{rest}"
    )
}

/// The same in space.
pub fn space(rest: &str) -> String {
    let rest = complete(rest);
    format!(
        "model: m
dimension: 3
curves: {{ pulse: {{ points: [[0, 0], [0.1, 9]] }}, never: {{ points: [[0, 0], [1, 0]] }} }}
systems:
  - name: man
    elements:
      - {{ name: torso, mass: 30, cg: [0, 0, 0.2], inertia: [1.1, 1, 0.4] }}
      - {{ name: head, on: torso, at: [0, 0, 0.45], mass: 4.5, cg: [0.02, 0, 0.1], inertia: [0.03, 0.03, 0.02] }}
{rest}"
    )
}

/// A case that gives the whole text of the scene.
fn whole(text: &str) -> String {
    text.to_owned()
}

/// The common parts of contacts and belts in all cases.
fn complete(rest: &str) -> String {
    rest.replace(
        "BALL",
        "ellipsoid: { on: man/torso, center: [0, 0.1], semi_axes: [0.1, 0.2] }",
    )
    .replace(
        "FLOOR",
        "plane: { on: frame, at: [0, -0.3], normal: [0, 1] }",
    )
    .replace(
        "ENDS",
        "from: { on: man/torso, at: [0.1, 0.3] }, to: { on: frame, at: [-0.4, 0.7] }",
    )
    .replace(
        "THROUGH",
        "{ points: [[-1, -40], [1, 40]], extrapolate: linear }",
    )
    .replace(
        "BAG",
        "forces: [{ airbag: bag, ellipsoid: { on: frame, center: [0, 0, 0], semi_axes: [0.3, 0.3, 0.3] }, against: [{ on: man/head, center: [0, 0, 0], semi_axes: [0.1, 0.1, 0.1] }]",
    )
    .replace("LINE", "{ points: [[-1, -40], [1, 40]] }")
    .replace("RAMP", "{ points: [[0, 0], [1, 40]], extrapolate: linear }")
}

pub const CASES: &[Case] = &[
    // joints
    Case {
        word: "plane joint elastic",
        effect: "joint man/head: elastic",
        scene: plane,
        on: "forces: [{ joint: man/head, damping: 1, elastic: LINE }]",
        off: &[
            "forces: [{ joint: man/head, damping: 1, elastic: never }]",
            "forces: [{ joint: man/head, damping: 1, elastic: { points: [[0, 0], [1, 0]] } }]",
            "forces: [{ joint: man/head, damping: 1, elastic: { curve: pulse, times: 0 } }]",
            "forces: [{ joint: man/head, damping: 1, elastic: never, neutral: 3 deg }]",
        ],
        never: "forces: [{ joint: man/head, damping: 1 }]",
    },
    Case {
        word: "plane joint neutral angle",
        effect: "joint man/head: neutral angle",
        scene: plane,
        on: "forces: [{ joint: man/head, elastic: LINE, neutral: 5 deg }]",
        off: &["forces: [{ joint: man/head, elastic: LINE, neutral: 0 deg }]"],
        never: "forces: [{ joint: man/head, elastic: LINE }]",
    },
    Case {
        word: "plane joint damping",
        effect: "joint man/head: damping",
        scene: plane,
        on: "forces: [{ joint: man/head, elastic: LINE, damping: 0.2 * mu }]",
        off: &[
            "forces: [{ joint: man/head, elastic: LINE, damping: 0 }]",
            "forces: [{ joint: man/head, elastic: LINE, damping: 0 N*m*s * mu }]",
        ],
        never: "forces: [{ joint: man/head, elastic: LINE }]",
    },
    Case {
        word: "plane joint friction",
        effect: "joint man/head: friction",
        scene: plane,
        on: "forces: [{ joint: man/head, elastic: LINE, friction: 2, friction_speed: mu }]",
        off: &[
            "forces: [{ joint: man/head, elastic: LINE, friction: 0 }]",
            "forces: [{ joint: man/head, elastic: LINE, friction: 0, friction_speed: mu }]",
        ],
        never: "forces: [{ joint: man/head, elastic: LINE }]",
    },
    Case {
        word: "space joint elastic about x",
        effect: "joint man/head: elastic about x",
        scene: space,
        on: "forces: [{ joint: man/head, about: { y: { damping: 1 }, x: { elastic: LINE } } }]",
        off: &[
            "forces: [{ joint: man/head, about: { y: { damping: 1 }, x: { elastic: never } } }]",
        ],
        never: "forces: [{ joint: man/head, about: { y: { damping: 1 } } }]",
    },
    Case {
        word: "space joint elastic about y",
        effect: "joint man/head: elastic about y",
        scene: space,
        on: "forces: [{ joint: man/head, about: { x: { damping: 1 }, y: { elastic: LINE } } }]",
        off: &[
            "forces: [{ joint: man/head, about: { x: { damping: 1 }, y: { elastic: never } } }]",
        ],
        never: "forces: [{ joint: man/head, about: { x: { damping: 1 } } }]",
    },
    Case {
        word: "space joint elastic about z",
        effect: "joint man/head: elastic about z",
        scene: space,
        on: "forces: [{ joint: man/head, about: { y: { damping: 1 }, z: { elastic: LINE } } }]",
        off: &[
            "forces: [{ joint: man/head, about: { y: { damping: 1 }, z: { elastic: never } } }]",
        ],
        never: "forces: [{ joint: man/head, about: { y: { damping: 1 } } }]",
    },
    Case {
        word: "space joint neutral angle about x",
        effect: "joint man/head: neutral angle about x",
        scene: space,
        on: "forces: [{ joint: man/head, about: { x: { elastic: LINE, neutral: 1 } } }]",
        off: &["forces: [{ joint: man/head, about: { x: { elastic: LINE, neutral: 0 } } }]"],
        never: "forces: [{ joint: man/head, about: { x: { elastic: LINE } } }]",
    },
    Case {
        word: "space joint neutral angle about y",
        effect: "joint man/head: neutral angle about y",
        scene: space,
        on: "forces: [{ joint: man/head, about: { y: { elastic: LINE, neutral: 1 } } }]",
        off: &["forces: [{ joint: man/head, about: { y: { elastic: LINE, neutral: 0 } } }]"],
        never: "forces: [{ joint: man/head, about: { y: { elastic: LINE } } }]",
    },
    Case {
        word: "space joint neutral angle about z",
        effect: "joint man/head: neutral angle about z",
        scene: space,
        on: "forces: [{ joint: man/head, about: { z: { elastic: LINE, neutral: 1 } } }]",
        off: &["forces: [{ joint: man/head, about: { z: { elastic: LINE, neutral: 0 } } }]"],
        never: "forces: [{ joint: man/head, about: { z: { elastic: LINE } } }]",
    },
    Case {
        word: "space joint damping about x",
        effect: "joint man/head: damping about x",
        scene: space,
        on: "forces: [{ joint: man/head, about: { y: { friction: 1 }, x: { damping: 2 } } }]",
        off: &["forces: [{ joint: man/head, about: { y: { friction: 1 }, x: { damping: 0 } } }]"],
        never: "forces: [{ joint: man/head, about: { y: { friction: 1 } } }]",
    },
    Case {
        word: "space joint damping about y",
        effect: "joint man/head: damping about y",
        scene: space,
        on: "forces: [{ joint: man/head, about: { y: { friction: 1, damping: 2 } } }]",
        off: &["forces: [{ joint: man/head, about: { y: { friction: 1, damping: 0 } } }]"],
        never: "forces: [{ joint: man/head, about: { y: { friction: 1 } } }]",
    },
    Case {
        word: "space joint damping about z",
        effect: "joint man/head: damping about z",
        scene: space,
        on: "forces: [{ joint: man/head, about: { y: { friction: 1 }, z: { damping: 2 } } }]",
        off: &["forces: [{ joint: man/head, about: { y: { friction: 1 }, z: { damping: 0 } } }]"],
        never: "forces: [{ joint: man/head, about: { y: { friction: 1 } } }]",
    },
    Case {
        word: "space joint friction about x",
        effect: "joint man/head: friction about x",
        scene: space,
        on: "forces: [{ joint: man/head, about: { y: { damping: 1 }, x: { friction: 2 } } }]",
        off: &[
            "forces: [{ joint: man/head, about: { y: { damping: 1 }, x: { friction: 0, friction_speed: 1 } } }]",
        ],
        never: "forces: [{ joint: man/head, about: { y: { damping: 1 } } }]",
    },
    Case {
        word: "space joint friction about y",
        effect: "joint man/head: friction about y",
        scene: space,
        on: "forces: [{ joint: man/head, about: { x: { damping: 1 }, y: { friction: 2 } } }]",
        off: &["forces: [{ joint: man/head, about: { x: { damping: 1 }, y: { friction: 0 } } }]"],
        never: "forces: [{ joint: man/head, about: { x: { damping: 1 } } }]",
    },
    Case {
        word: "space joint friction about z",
        effect: "joint man/head: friction about z",
        scene: space,
        on: "forces: [{ joint: man/head, about: { y: { damping: 1 }, z: { friction: 2 } } }]",
        off: &["forces: [{ joint: man/head, about: { y: { damping: 1 }, z: { friction: 0 } } }]"],
        never: "forces: [{ joint: man/head, about: { y: { damping: 1 } } }]",
    },
    Case {
        word: "plane joint hysteresis",
        effect: "joint man/head: hysteresis",
        scene: plane,
        on: "forces: [{ joint: man/head, elastic: THROUGH, unloading_slope: 80 }]",
        off: &[
            "forces: [{ joint: man/head, elastic: THROUGH, unloading_slope: 0 }]",
            "forces: [{ joint: man/head, elastic: THROUGH, unloading: THROUGH }]",
        ],
        never: "forces: [{ joint: man/head, elastic: THROUGH }]",
    },
    Case {
        word: "plane joint friction holds",
        effect: "joint man/head: friction holds",
        scene: plane,
        on: "forces: [{ joint: man/head, friction: 2, friction_displacement: 0.1 deg }]",
        off: &["forces: [{ joint: man/head, friction: 2, friction_displacement: 0 }]"],
        never: "forces: [{ joint: man/head, friction: 2 }]",
    },
    Case {
        word: "plane joint motor",
        effect: "joint man/head: motor",
        scene: plane,
        on: "forces: [{ joint: man/head, damping: 1, motor: pulse }]",
        off: &[
            "forces: [{ joint: man/head, damping: 1, motor: 0 N*m }]",
            "forces: [{ joint: man/head, damping: 1, motor: never }]",
            "forces: [{ joint: man/head, damping: 1, motor: { curve: pulse, times: 0 } }]",
        ],
        never: "forces: [{ joint: man/head, damping: 1 }]",
    },
    Case {
        word: "plane joint drive",
        effect: "joint man/head: drive",
        scene: plane,
        on: "forces: [{ joint: man/head, damping: 1, drive: { to: pulse, stiffness: 3, damping: 0.2, limit: 5 } }]",
        off: &[
            "forces: [{ joint: man/head, damping: 1, drive: { to: pulse, stiffness: 0, damping: 0, limit: 5 } }]",
        ],
        never: "forces: [{ joint: man/head, damping: 1 }]",
    },
    Case {
        word: "space joint hysteresis about x",
        effect: "joint man/head: hysteresis about x",
        scene: space,
        on: "forces: [{ joint: man/head, about: { x: { elastic: THROUGH, unloading_slope: 80 } } }]",
        off: &[
            "forces: [{ joint: man/head, about: { x: { elastic: THROUGH, unloading_slope: 0 } } }]",
            "forces: [{ joint: man/head, about: { x: { elastic: THROUGH, unloading: THROUGH } } }]",
        ],
        never: "forces: [{ joint: man/head, about: { x: { elastic: THROUGH } } }]",
    },
    Case {
        word: "space joint friction holds about x",
        effect: "joint man/head: friction holds about x",
        scene: space,
        on: "forces: [{ joint: man/head, about: { x: { friction: 2, friction_displacement: 0.1 deg } } }]",
        off: &[
            "forces: [{ joint: man/head, about: { x: { friction: 2, friction_displacement: 0 } } }]",
        ],
        never: "forces: [{ joint: man/head, about: { x: { friction: 2 } } }]",
    },
    Case {
        word: "space joint motor about x",
        effect: "joint man/head: motor about x",
        scene: space,
        on: "forces: [{ joint: man/head, about: { x: { damping: 1, motor: pulse } } }]",
        off: &[
            "forces: [{ joint: man/head, about: { x: { damping: 1, motor: 0 N*m } } }]",
            "forces: [{ joint: man/head, about: { x: { damping: 1, motor: never } } }]",
            "forces: [{ joint: man/head, about: { x: { damping: 1, motor: { curve: pulse, times: 0 } } } }]",
        ],
        never: "forces: [{ joint: man/head, about: { x: { damping: 1 } } }]",
    },
    Case {
        word: "space joint drive about x",
        effect: "joint man/head: drive about x",
        scene: space,
        on: "forces: [{ joint: man/head, about: { x: { damping: 1, drive: { to: pulse, stiffness: 3, damping: 0.2, limit: 5 } } } }]",
        off: &[
            "forces: [{ joint: man/head, about: { x: { damping: 1, drive: { to: pulse, stiffness: 0, damping: 0, limit: 5 } } } }]",
        ],
        never: "forces: [{ joint: man/head, about: { x: { damping: 1 } } }]",
    },
    Case {
        word: "space joint hysteresis about y",
        effect: "joint man/head: hysteresis about y",
        scene: space,
        on: "forces: [{ joint: man/head, about: { y: { elastic: THROUGH, unloading_slope: 80 } } }]",
        off: &[
            "forces: [{ joint: man/head, about: { y: { elastic: THROUGH, unloading_slope: 0 } } }]",
            "forces: [{ joint: man/head, about: { y: { elastic: THROUGH, unloading: THROUGH } } }]",
        ],
        never: "forces: [{ joint: man/head, about: { y: { elastic: THROUGH } } }]",
    },
    Case {
        word: "space joint friction holds about y",
        effect: "joint man/head: friction holds about y",
        scene: space,
        on: "forces: [{ joint: man/head, about: { y: { friction: 2, friction_displacement: 0.1 deg } } }]",
        off: &[
            "forces: [{ joint: man/head, about: { y: { friction: 2, friction_displacement: 0 } } }]",
        ],
        never: "forces: [{ joint: man/head, about: { y: { friction: 2 } } }]",
    },
    Case {
        word: "space joint motor about y",
        effect: "joint man/head: motor about y",
        scene: space,
        on: "forces: [{ joint: man/head, about: { y: { damping: 1, motor: pulse } } }]",
        off: &[
            "forces: [{ joint: man/head, about: { y: { damping: 1, motor: 0 N*m } } }]",
            "forces: [{ joint: man/head, about: { y: { damping: 1, motor: never } } }]",
            "forces: [{ joint: man/head, about: { y: { damping: 1, motor: { curve: pulse, times: 0 } } } }]",
        ],
        never: "forces: [{ joint: man/head, about: { y: { damping: 1 } } }]",
    },
    Case {
        word: "space joint drive about y",
        effect: "joint man/head: drive about y",
        scene: space,
        on: "forces: [{ joint: man/head, about: { y: { damping: 1, drive: { to: pulse, stiffness: 3, damping: 0.2, limit: 5 } } } }]",
        off: &[
            "forces: [{ joint: man/head, about: { y: { damping: 1, drive: { to: pulse, stiffness: 0, damping: 0, limit: 5 } } } }]",
        ],
        never: "forces: [{ joint: man/head, about: { y: { damping: 1 } } }]",
    },
    Case {
        word: "space joint hysteresis about z",
        effect: "joint man/head: hysteresis about z",
        scene: space,
        on: "forces: [{ joint: man/head, about: { z: { elastic: THROUGH, unloading_slope: 80 } } }]",
        off: &[
            "forces: [{ joint: man/head, about: { z: { elastic: THROUGH, unloading_slope: 0 } } }]",
            "forces: [{ joint: man/head, about: { z: { elastic: THROUGH, unloading: THROUGH } } }]",
        ],
        never: "forces: [{ joint: man/head, about: { z: { elastic: THROUGH } } }]",
    },
    Case {
        word: "space joint friction holds about z",
        effect: "joint man/head: friction holds about z",
        scene: space,
        on: "forces: [{ joint: man/head, about: { z: { friction: 2, friction_displacement: 0.1 deg } } }]",
        off: &[
            "forces: [{ joint: man/head, about: { z: { friction: 2, friction_displacement: 0 } } }]",
        ],
        never: "forces: [{ joint: man/head, about: { z: { friction: 2 } } }]",
    },
    Case {
        word: "space joint motor about z",
        effect: "joint man/head: motor about z",
        scene: space,
        on: "forces: [{ joint: man/head, about: { z: { damping: 1, motor: pulse } } }]",
        off: &[
            "forces: [{ joint: man/head, about: { z: { damping: 1, motor: 0 N*m } } }]",
            "forces: [{ joint: man/head, about: { z: { damping: 1, motor: never } } }]",
            "forces: [{ joint: man/head, about: { z: { damping: 1, motor: { curve: pulse, times: 0 } } } }]",
        ],
        never: "forces: [{ joint: man/head, about: { z: { damping: 1 } } }]",
    },
    Case {
        word: "space joint drive about z",
        effect: "joint man/head: drive about z",
        scene: space,
        on: "forces: [{ joint: man/head, about: { z: { damping: 1, drive: { to: pulse, stiffness: 3, damping: 0.2, limit: 5 } } } }]",
        off: &[
            "forces: [{ joint: man/head, about: { z: { damping: 1, drive: { to: pulse, stiffness: 0, damping: 0, limit: 5 } } } }]",
        ],
        never: "forces: [{ joint: man/head, about: { z: { damping: 1 } } }]",
    },
    // fields
    Case {
        word: "plane field x",
        effect: "field sled: x",
        scene: plane,
        on: "forces: [{ field: sled, acceleration: [pulse, 2] }]",
        off: &[
            "forces: [{ field: sled, acceleration: [never, 2] }]",
            "forces: [{ field: sled, acceleration: [0 gn, 2] }]",
            "forces: [{ field: sled, acceleration: [-0.0, 2] }]",
            "forces: [{ field: sled, acceleration: [{ curve: pulse, times: 0 }, 2] }]",
        ],
        never: "forces: [{ field: sled, acceleration: [0, 2] }]",
    },
    Case {
        word: "plane field z",
        effect: "field sled: z",
        scene: plane,
        on: "forces: [{ field: sled, acceleration: [pulse, -9.81 * mu] }]",
        off: &["forces: [{ field: sled, acceleration: [pulse, 0 * mu] }]"],
        never: "forces: [{ field: sled, acceleration: [pulse, 0] }]",
    },
    Case {
        word: "space field x",
        effect: "field sled: x",
        scene: space,
        on: "forces: [{ field: sled, acceleration: [pulse, 2, 3] }]",
        off: &["forces: [{ field: sled, acceleration: [never, 2, 3] }]"],
        never: "forces: [{ field: sled, acceleration: [0, 2, 3] }]",
    },
    Case {
        word: "space field y",
        effect: "field sled: y",
        scene: space,
        on: "forces: [{ field: sled, acceleration: [1, pulse, 3] }]",
        off: &["forces: [{ field: sled, acceleration: [1, never, 3] }]"],
        never: "forces: [{ field: sled, acceleration: [1, 0, 3] }]",
    },
    Case {
        word: "space field z",
        effect: "field sled: z",
        scene: space,
        on: "forces: [{ field: sled, acceleration: [1, 2, pulse] }]",
        off: &["forces: [{ field: sled, acceleration: [1, 2, never] }]"],
        never: "forces: [{ field: sled, acceleration: [1, 2, 0] }]",
    },
    Case {
        word: "field by element",
        effect: "",
        scene: plane,
        on: "forces: [{ field: sled, acceleration: [1, 2], on: [man/head] }]",
        off: &[
            "forces: [{ field: sled, acceleration: [1, 2], on: [man] }]",
            "forces: [{ field: sled, acceleration: [1, 2], on: [man/head, man/torso] }]",
        ],
        never: "forces: [{ field: sled, acceleration: [1, 2] }]",
    },
    // contacts
    Case {
        word: "plane contact elastic",
        effect: "contact seat: elastic",
        scene: plane,
        on: "forces: [{ contact: seat, BALL, FLOOR, damping: 30, elastic: RAMP }]",
        off: &[
            "forces: [{ contact: seat, BALL, FLOOR, damping: 30, elastic: never }]",
            "forces: [{ contact: seat, BALL, FLOOR, damping: 30, elastic: { curve: pulse, times: 0 * mu } }]",
        ],
        never: "forces: [{ contact: seat, BALL, FLOOR, damping: 30 }]",
    },
    Case {
        word: "plane contact damping",
        effect: "contact seat: damping",
        scene: plane,
        on: "forces: [{ contact: seat, BALL, FLOOR, elastic: RAMP, damping: 30 }]",
        off: &["forces: [{ contact: seat, BALL, FLOOR, elastic: RAMP, damping: 0 N*s/m }]"],
        never: "forces: [{ contact: seat, BALL, FLOOR, elastic: RAMP }]",
    },
    Case {
        word: "plane contact friction",
        effect: "contact seat: friction",
        scene: plane,
        on: "forces: [{ contact: seat, BALL, FLOOR, elastic: RAMP, friction: mu }]",
        off: &[
            "forces: [{ contact: seat, BALL, FLOOR, elastic: RAMP, friction: 0 }]",
            "forces: [{ contact: seat, BALL, FLOOR, elastic: RAMP, friction: 0 %, friction_speed: mu }]",
        ],
        never: "forces: [{ contact: seat, BALL, FLOOR, elastic: RAMP }]",
    },
    Case {
        word: "plane contact hysteresis",
        effect: "contact seat: hysteresis",
        scene: plane,
        on: "forces: [{ contact: seat, BALL, FLOOR, elastic: RAMP, unloading_slope: 80 N/m }]",
        off: &["forces: [{ contact: seat, BALL, FLOOR, elastic: RAMP, unloading_slope: 0 }]"],
        never: "forces: [{ contact: seat, BALL, FLOOR, elastic: RAMP }]",
    },
    Case {
        word: "plane contact damping fades in",
        effect: "contact seat: damping fades in",
        scene: plane,
        on: "forces: [{ contact: seat, BALL, FLOOR, damping: 30 }]",
        off: &["forces: [{ contact: seat, BALL, FLOOR, damping: 30, damping_depth: 0 mm }]"],
        never: "forces: [{ contact: seat, BALL, FLOOR, damping: 30, damping_depth: 0 }]",
    },
    Case {
        word: "plane contact friction holds",
        effect: "contact seat: friction holds",
        scene: plane,
        on: "forces: [{ contact: seat, BALL, FLOOR, elastic: RAMP, friction: mu, friction_displacement: 0.1 mm }]",
        off: &[
            "forces: [{ contact: seat, BALL, FLOOR, elastic: RAMP, friction: mu, friction_displacement: 0 }]",
        ],
        never: "forces: [{ contact: seat, BALL, FLOOR, elastic: RAMP, friction: mu }]",
    },
    Case {
        word: "plane contact edge",
        effect: "contact seat: edge",
        scene: plane,
        on: "forces: [{ contact: seat, BALL, plane: { on: frame, at: [0, -0.3], normal: [0, 1], extent: 0.2 }, elastic: RAMP }]",
        off: &[],
        never: "forces: [{ contact: seat, BALL, FLOOR, elastic: RAMP }]",
    },
    // belts
    Case {
        word: "plane belt elastic",
        effect: "",
        scene: plane,
        on: "forces: [{ belt: chest, ENDS, force: RAMP }]",
        off: &["forces: [{ belt: chest, ENDS, force: RAMP, enabled: false }]"],
        never: "",
    },
    Case {
        word: "plane belt damping",
        effect: "belt chest: damping",
        scene: plane,
        on: "forces: [{ belt: chest, ENDS, force: RAMP, damping: 20 }]",
        off: &["forces: [{ belt: chest, ENDS, force: RAMP, damping: 0 }]"],
        never: "forces: [{ belt: chest, ENDS, force: RAMP }]",
    },
    Case {
        word: "plane belt slack",
        effect: "belt chest: slack",
        scene: plane,
        on: "forces: [{ belt: chest, ENDS, force: RAMP, slack: 20 mm }]",
        off: &["forces: [{ belt: chest, ENDS, force: RAMP, slack: 0 mm }]"],
        never: "forces: [{ belt: chest, ENDS, force: RAMP }]",
    },
    Case {
        word: "plane belt pretension",
        effect: "belt chest: pretension",
        scene: plane,
        on: "forces: [{ belt: chest, ENDS, force: RAMP, pretension: 20 N }]",
        off: &["forces: [{ belt: chest, ENDS, force: RAMP, pretension: 0 N }]"],
        never: "forces: [{ belt: chest, ENDS, force: RAMP }]",
    },
    Case {
        word: "plane belt given length",
        effect: "belt chest: given length",
        scene: plane,
        on: "forces: [{ belt: chest, ENDS, force: RAMP, length: 40 cm }]",
        off: &["forces: [{ belt: chest, ENDS, force: RAMP, slack: 0 }]"],
        never: "forces: [{ belt: chest, ENDS, force: RAMP }]",
    },
    // springs
    Case {
        word: "plane spring elastic",
        effect: "spring strut: elastic",
        scene: plane,
        on: "forces: [{ spring: strut, ENDS, stiffness: 3, length: 20 mm, damping: 2 }]",
        off: &["forces: [{ spring: strut, ENDS, elastic: never, length: 20 mm, damping: 2 }]"],
        never: "forces: [{ spring: strut, ENDS, damping: 2 }]",
    },
    Case {
        word: "plane spring damping",
        effect: "spring strut: damping",
        scene: plane,
        on: "forces: [{ spring: strut, ENDS, elastic: RAMP, damping: 2 }]",
        off: &["forces: [{ spring: strut, ENDS, elastic: RAMP, damping: 0 }]"],
        never: "forces: [{ spring: strut, ENDS, elastic: RAMP }]",
    },
    // bushings
    Case {
        word: "plane bushing elastic along x",
        effect: "bushing mount: elastic along x",
        scene: plane,
        on: "forces: [{ bushing: mount, ENDS, along: { x: { stiffness: 3, damping: 5 } }, about: { y: { damping: 1 } } }]",
        off: &[
            "forces: [{ bushing: mount, ENDS, along: { x: { elastic: never, damping: 5 } }, about: { y: { damping: 1 } } }]",
        ],
        never: "forces: [{ bushing: mount, ENDS, along: { x: { damping: 5 } }, about: { y: { damping: 1 } } }]",
    },
    Case {
        word: "plane bushing damping along x",
        effect: "bushing mount: damping along x",
        scene: plane,
        on: "forces: [{ bushing: mount, ENDS, along: { x: { damping: 2, elastic: THROUGH } }, about: { y: { damping: 1 } } }]",
        off: &[
            "forces: [{ bushing: mount, ENDS, along: { x: { damping: 0, elastic: THROUGH } }, about: { y: { damping: 1 } } }]",
        ],
        never: "forces: [{ bushing: mount, ENDS, along: { x: { elastic: THROUGH } }, about: { y: { damping: 1 } } }]",
    },
    Case {
        word: "plane bushing elastic along z",
        effect: "bushing mount: elastic along z",
        scene: plane,
        on: "forces: [{ bushing: mount, ENDS, along: { z: { stiffness: 3, damping: 5 } }, about: { y: { damping: 1 } } }]",
        off: &[
            "forces: [{ bushing: mount, ENDS, along: { z: { elastic: never, damping: 5 } }, about: { y: { damping: 1 } } }]",
        ],
        never: "forces: [{ bushing: mount, ENDS, along: { z: { damping: 5 } }, about: { y: { damping: 1 } } }]",
    },
    Case {
        word: "plane bushing damping along z",
        effect: "bushing mount: damping along z",
        scene: plane,
        on: "forces: [{ bushing: mount, ENDS, along: { z: { damping: 2, elastic: THROUGH } }, about: { y: { damping: 1 } } }]",
        off: &[
            "forces: [{ bushing: mount, ENDS, along: { z: { damping: 0, elastic: THROUGH } }, about: { y: { damping: 1 } } }]",
        ],
        never: "forces: [{ bushing: mount, ENDS, along: { z: { elastic: THROUGH } }, about: { y: { damping: 1 } } }]",
    },
    Case {
        word: "plane bushing elastic about y",
        effect: "bushing mount: elastic about y",
        scene: plane,
        on: "forces: [{ bushing: mount, ENDS, about: { y: { stiffness: 3, damping: 5 } }, along: { x: { stiffness: 7 } } }]",
        off: &[
            "forces: [{ bushing: mount, ENDS, about: { y: { elastic: never, damping: 5 } }, along: { x: { stiffness: 7 } } }]",
        ],
        never: "forces: [{ bushing: mount, ENDS, about: { y: { damping: 5 } }, along: { x: { stiffness: 7 } } }]",
    },
    Case {
        word: "plane bushing damping about y",
        effect: "bushing mount: damping about y",
        scene: plane,
        on: "forces: [{ bushing: mount, ENDS, about: { y: { damping: 2, elastic: THROUGH } }, along: { x: { stiffness: 7 } } }]",
        off: &[
            "forces: [{ bushing: mount, ENDS, about: { y: { damping: 0, elastic: THROUGH } }, along: { x: { stiffness: 7 } } }]",
        ],
        never: "forces: [{ bushing: mount, ENDS, about: { y: { elastic: THROUGH } }, along: { x: { stiffness: 7 } } }]",
    },
    // loads
    Case {
        word: "plane load force x",
        effect: "load rope: force x",
        scene: plane,
        on: "forces: [{ load: rope, on: man/head, force: [pulse, 1], moment: 3 }]",
        off: &["forces: [{ load: rope, on: man/head, force: [never, 1], moment: 3 }]"],
        never: "forces: [{ load: rope, on: man/head, force: [0, 1], moment: 3 }]",
    },
    Case {
        word: "plane load force z",
        effect: "load rope: force z",
        scene: plane,
        on: "forces: [{ load: rope, on: man/head, force: [0, mu], moment: 3 }]",
        off: &[
            "forces: [{ load: rope, on: man/head, force: [0, 0 N], moment: 3 }]",
            "forces: [{ load: rope, on: man/head, at: cg, force: [0, 0], moment: 3 }]",
            "forces: [{ load: rope, on: man/head, at: [mu, 1], force: [never, 0], moment: 3 }]",
        ],
        never: "forces: [{ load: rope, on: man/head, moment: 3 }]",
    },
    Case {
        word: "plane load moment",
        effect: "load rope: moment",
        scene: plane,
        on: "forces: [{ load: rope, on: man/head, force: [1, 0], moment: pulse }]",
        off: &[
            "forces: [{ load: rope, on: man/head, force: [1, 0], moment: never }]",
            "forces: [{ load: rope, on: man/head, force: [1, 0], moment: 0 }]",
        ],
        never: "forces: [{ load: rope, on: man/head, force: [1, 0] }]",
    },
    Case {
        word: "space load force x",
        effect: "load rope: force x",
        scene: space,
        on: "forces: [{ load: rope, on: man/head, force: [pulse, 1, 2] }]",
        off: &["forces: [{ load: rope, on: man/head, force: [never, 1, 2] }]"],
        never: "forces: [{ load: rope, on: man/head, force: [0, 1, 2] }]",
    },
    Case {
        word: "space load force y",
        effect: "load rope: force y",
        scene: space,
        on: "forces: [{ load: rope, on: man/head, force: [1, pulse, 2] }]",
        off: &["forces: [{ load: rope, on: man/head, force: [1, never, 2] }]"],
        never: "forces: [{ load: rope, on: man/head, force: [1, 0, 2] }]",
    },
    Case {
        word: "space load force z",
        effect: "load rope: force z",
        scene: space,
        on: "forces: [{ load: rope, on: man/head, force: [1, 2, pulse] }]",
        off: &["forces: [{ load: rope, on: man/head, force: [1, 2, never] }]"],
        never: "forces: [{ load: rope, on: man/head, force: [1, 2, 0] }]",
    },
    Case {
        word: "space load moment x",
        effect: "load rope: moment x",
        scene: space,
        on: "forces: [{ load: rope, on: man/head, moment: [pulse, 1, 2] }]",
        off: &["forces: [{ load: rope, on: man/head, moment: [never, 1, 2] }]"],
        never: "forces: [{ load: rope, on: man/head, moment: [0, 1, 2] }]",
    },
    Case {
        word: "space load moment y",
        effect: "load rope: moment y",
        scene: space,
        on: "forces: [{ load: rope, on: man/head, moment: [1, pulse, 2] }]",
        off: &["forces: [{ load: rope, on: man/head, moment: [1, never, 2] }]"],
        never: "forces: [{ load: rope, on: man/head, moment: [1, 0, 2] }]",
    },
    Case {
        word: "space load moment z",
        effect: "load rope: moment z",
        scene: space,
        on: "forces: [{ load: rope, on: man/head, moment: [1, 2, pulse] }]",
        off: &["forces: [{ load: rope, on: man/head, moment: [1, 2, never] }]"],
        never: "forces: [{ load: rope, on: man/head, moment: [1, 2, 0] }]",
    },
    // whole forces
    Case {
        word: "force joint",
        effect: "joint man/head",
        scene: plane,
        on: "forces: [{ joint: man/head, damping: mu, friction: 1, elastic: LINE }]",
        off: &[
            "forces: [{ joint: man/head, damping: mu, friction: 1, elastic: LINE, enabled: false }]",
            "forces: [{ joint: man/head, damping: 0, friction: 0, elastic: never }]",
        ],
        never: "",
    },
    Case {
        word: "force field",
        effect: "field sled",
        scene: plane,
        on: "forces: [{ field: sled, acceleration: [pulse, mu] }]",
        off: &[
            "forces: [{ field: sled, acceleration: [pulse, mu], enabled: false }]",
            "forces: [{ field: sled, acceleration: [never, 0] }]",
        ],
        never: "",
    },
    Case {
        word: "force contact",
        effect: "contact seat",
        scene: plane,
        on: "forces: [{ contact: seat, BALL, FLOOR, elastic: RAMP, damping: 3, friction: mu }]",
        off: &[
            "forces: [{ contact: seat, BALL, FLOOR, elastic: RAMP, damping: 3, friction: mu, enabled: false }]",
            "forces: [{ contact: seat, BALL, FLOOR, elastic: never, damping: 0, friction: mu }]",
        ],
        never: "",
    },
    Case {
        word: "force belt",
        effect: "belt chest",
        scene: plane,
        on: "forces: [{ belt: chest, ENDS, force: { curve: pulse, times: mu }, slack: 1 mm, damping: 3 }]",
        off: &[
            "forces: [{ belt: chest, ENDS, force: { curve: pulse, times: mu }, slack: 1 mm, damping: 3, enabled: false }]",
        ],
        never: "",
    },
    Case {
        word: "force spring",
        effect: "spring strut",
        scene: plane,
        on: "forces: [{ spring: strut, ENDS, stiffness: mu, damping: 3 }]",
        off: &[
            "forces: [{ spring: strut, ENDS, stiffness: mu, damping: 3, enabled: false }]",
            "forces: [{ spring: strut, ENDS, elastic: never }]",
        ],
        never: "",
    },
    Case {
        word: "force bushing",
        effect: "bushing mount",
        scene: plane,
        on: "forces: [{ bushing: mount, ENDS, along: { x: { stiffness: mu, damping: 3 } }, about: { y: { elastic: THROUGH } } }]",
        off: &[
            "forces: [{ bushing: mount, ENDS, along: { x: { stiffness: mu, damping: 3 } }, about: { y: { elastic: THROUGH } }, enabled: false }]",
            "forces: [{ bushing: mount, ENDS, along: { x: { elastic: never, damping: 0 } }, about: { y: { elastic: never } } }]",
        ],
        never: "",
    },
    Case {
        word: "force load",
        effect: "load rope",
        scene: plane,
        on: "forces: [{ load: rope, on: man/head, at: cg, force: [pulse, mu], moment: 1 }]",
        off: &[
            "forces: [{ load: rope, on: man/head, at: cg, force: [pulse, mu], moment: 1, enabled: false }]",
            "forces: [{ load: rope, on: man/head, at: cg, force: [never, 0], moment: 0 }]",
        ],
        never: "",
    },
    // dimensions and translations
    Case {
        word: "out of plane",
        effect: "motion out of the x–z plane (along y, about x and z)",
        scene: whole,
        on: "
model: m
dimension: 3
systems:
  - name: a
    elements:
      - { name: b, mass: 2, cg: [0, 0, 1], inertia: [1, 2, 2.5] }
      - { name: c, on: b, at: [0, 0, 2], mass: 1, cg: [0.1, 0, 1], inertia: [3, 4, 5] }
forces:
  - { field: gravity, acceleration: [0, 0, -1 gn] }
  - { joint: a/c, about: { x: { damping: 3 }, y: { damping: 4 } } }
outputs:
  - { name: side, of: a/c, what: position, component: y }
  - { name: height, of: a/c, what: position, component: z }
",
        off: &[],
        never: "
model: m
dimension: 2
systems:
  - name: a
    elements:
      - { name: b, mass: 2, cg: [0, 1], inertia: 2 }
      - { name: c, on: b, at: [0, 2], mass: 1, cg: [0.1, 1], inertia: 4 }
forces:
  - { field: gravity, acceleration: [0, -1 gn] }
  - { joint: a/c, damping: 4 }
outputs:
  - { name: height, of: a/c, what: position, component: z }
",
    },
    Case {
        word: "free translation",
        effect: "system man: free translation of the reference joint",
        scene: plane,
        on: "    reference: free\n",
        off: &[
            "    reference: { acceleration: [0, 0] }\n",
            "    reference: { acceleration: [never, { curve: pulse, times: 0 * mu }] }\n",
        ],
        never: "    reference: fixed\n",
    },
    Case {
        word: "prescribed translation",
        effect: "system man: prescribed motion of the reference joint along z",
        scene: plane,
        on: "    reference: { acceleration: [pulse, mu] }\n",
        off: &[
            "    reference: { acceleration: [pulse, never] }\n",
            "    reference: { acceleration: [pulse, { curve: pulse, times: 0 }] }\n",
        ],
        never: "    reference: { acceleration: [pulse, 0] }\n",
    },
    // inertia
    Case {
        word: "first moment",
        effect: "",
        scene: whole,
        on: "{ model: m, dimension: 2, systems: [{ name: a, elements: [{ name: b, mass: 2, cg: [0, 1], inertia: 2 }] }] }",
        off: &[
            "{ model: m, dimension: 2, parameters: { c: 1 }, systems: [{ name: a, elements: [{ name: b, mass: 2, cg: [0 mm, 0 * c], inertia: 2 }] }] }",
            "{ model: m, dimension: 2, systems: [{ name: a, elements: [{ name: b, mass: 2, cg: [-0.0, 0], inertia: 2 }] }] }",
        ],
        never: "{ model: m, dimension: 2, systems: [{ name: a, elements: [{ name: b, mass: 2, cg: [0, 0], inertia: 2 }] }] }",
    },
    Case {
        word: "gyroscopic moment",
        effect: "",
        scene: whole,
        on: "{ model: m, dimension: 3, systems: [{ name: a, elements: [{ name: b, mass: 2, cg: [0, 0, 0], inertia: [1, 2, 2] }] }] }",
        off: &[
            "{ model: m, dimension: 3, systems: [{ name: a, elements: [{ name: b, mass: 2, cg: [0, 0, 0], inertia: [2, 2, 2], axes: [0, 20 deg, 0] }] }] }",
        ],
        never: "{ model: m, dimension: 3, systems: [{ name: a, elements: [{ name: b, mass: 2, cg: [0, 0, 0], inertia: [2, 2, 2] }] }] }",
    },
    Case {
        word: "armature",
        effect: "element a/b: inertia of rotors on its joint",
        scene: whole,
        on: "{ model: m, dimension: 3, parameters: { c: 1 }, systems: [{ name: a, reference: fixed, elements: [{ name: b, joint: { hinge: x, armature: 3 * c }, mass: 2, cg: [0, 0, 1], inertia: [2, 2, 2] }] }] }",
        off: &[
            "{ model: m, dimension: 3, parameters: { c: 1 }, systems: [{ name: a, reference: fixed, elements: [{ name: b, joint: { hinge: x, armature: 0 }, mass: 2, cg: [0, 0, 1], inertia: [2, 2, 2] }] }] }",
            "{ model: m, dimension: 3, parameters: { c: 1 }, systems: [{ name: a, reference: fixed, elements: [{ name: b, joint: { hinge: x, armature: 0 * c }, mass: 2, cg: [0, 0, 1], inertia: [2, 2, 2] }] }] }",
        ],
        never: "{ model: m, dimension: 3, parameters: { c: 1 }, systems: [{ name: a, reference: fixed, elements: [{ name: b, joint: { hinge: x }, mass: 2, cg: [0, 0, 1], inertia: [2, 2, 2] }] }] }",
    },
    Case {
        word: "coupling",
        effect: "element a/d: coupling of its joint",
        scene: whole,
        on: "{ model: m, dimension: 3, systems: [{ name: a, reference: fixed, elements: [{ name: b, joint: { hinge: x }, mass: 2, cg: [0, 0, 1], inertia: [2, 2, 2] }, { name: d, on: b, at: [0, 0, 1], joint: { hinge: x, follows: { joint: b, ratio: -2 } }, mass: 2, cg: [0, 0, 1], inertia: [2, 2, 2] }] }] }",
        off: &[],
        never: "{ model: m, dimension: 3, systems: [{ name: a, reference: fixed, elements: [{ name: b, joint: { hinge: x }, mass: 2, cg: [0, 0, 1], inertia: [2, 2, 2] }, { name: d, on: b, at: [0, 0, 1], joint: { hinge: x }, mass: 2, cg: [0, 0, 1], inertia: [2, 2, 2] }] }] }",
    },
    // forces of the user's own
    Case {
        word: "plane user function",
        effect: "user air: function",
        scene: plane,
        on: "forces: [{ user: air, function: 'crate::drag', points: { head: { on: man/head, at: cg } }, parameters: { cd: mu, wind: pulse }, states: { z: { initial: 0 } } }]",
        off: &[
            "forces: [{ user: air, function: 'crate::drag', points: { head: { on: man/head, at: cg } }, parameters: { cd: mu, wind: pulse }, curves: { shape: never }, enabled: false }]",
        ],
        never: "",
    },
    Case {
        word: "space user function",
        effect: "user air: function",
        scene: space,
        on: "forces: [{ user: air, function: 'crate::drag', points: { head: { on: man/head, at: cg } }, lines: { l: { from: { on: man/head, at: [0, 0, 0] }, to: { on: frame, at: [0, 0, 0] } } }, bodies: { b: man/head }, joints: { j: man/head } }]",
        off: &[
            "forces: [{ user: air, function: 'crate::drag', points: { head: { on: man/head, at: cg } }, enabled: false }]",
        ],
        never: "",
    },
    // parameters and outputs; every text above has a curve that nothing uses
    Case {
        word: "parameter",
        effect: "",
        scene: plane,
        on: "forces: [{ joint: man/head, damping: mu }]",
        off: &[
            "forces: [{ joint: man/head, damping: 0.3, friction: 0 * mu }]",
            "forces: [{ joint: man/head, damping: 0.3 }, { field: wind, acceleration: [mu, 0], enabled: false }]",
            "forces: [{ joint: man/head, damping: 0.3, friction: 0, friction_speed: mu }]",
            "forces: [{ joint: man/head, damping: 0.3, elastic: { curve: never, times: mu } }]",
            "outputs: [{ name: a, of: man/head, at: [mu, 0], what: velocity, enabled: false }]\nforces: [{ joint: man/head, damping: 0.3 }]",
        ],
        never: "forces: [{ joint: man/head, damping: 0.3 }]",
    },
    Case {
        word: "plane contact hysteresis",
        effect: "contact seat: hysteresis",
        scene: plane,
        on: "forces: [{ contact: seat, BALL, FLOOR, elastic: RAMP, unloading_slope: 9 kN/m }]",
        off: &["forces: [{ contact: seat, BALL, FLOOR, elastic: RAMP, unloading: RAMP }]"],
        never: "forces: [{ contact: seat, BALL, FLOOR, elastic: RAMP }]",
    },
    Case {
        word: "plane contact damping fades in",
        effect: "",
        scene: plane,
        on: "forces: [{ contact: seat, BALL, FLOOR, elastic: RAMP, damping: 30 }]",
        off: &[
            "forces: [{ contact: seat, BALL, FLOOR, elastic: RAMP, damping: 30, damping_depth: 0 }]",
            "forces: [{ contact: seat, BALL, FLOOR, elastic: RAMP, damping: 30, damping_depth: 0 mm }]",
        ],
        never: "forces: [{ contact: seat, BALL, FLOOR, elastic: RAMP, damping: 30, damping_depth: 0 }]",
    },
    Case {
        word: "plane belt hysteresis",
        effect: "belt chest: hysteresis",
        scene: plane,
        on: "forces: [{ belt: chest, ENDS, force: RAMP, unloading_slope: 9 kN }]",
        off: &["forces: [{ belt: chest, ENDS, force: RAMP, unloading: RAMP }]"],
        never: "forces: [{ belt: chest, ENDS, force: RAMP }]",
    },
    Case {
        word: "plane belt damping fades in",
        effect: "",
        scene: plane,
        on: "forces: [{ belt: chest, ENDS, force: RAMP, damping: 20 }]",
        off: &["forces: [{ belt: chest, ENDS, force: RAMP, damping: 20, damping_stretch: 0 }]"],
        never: "forces: [{ belt: chest, ENDS, force: RAMP, damping: 20, damping_stretch: 0 mm }]",
    },
    Case {
        word: "plane belt pretensioner",
        effect: "belt chest: pretensioner",
        scene: plane,
        on: "switches: [{ switch: crash, when: { time: 10 ms } }]\nforces: [{ belt: chest, ENDS, force: RAMP, pretensioner: { fire: crash, retract: { points: [[0, 0], [0.1, 0.1]] } } }]",
        off: &[
            "switches: [{ switch: crash, when: { time: 10 ms } }]\nforces: [{ belt: chest, ENDS, force: RAMP, pretensioner: { fire: crash, retract: never } }]",
        ],
        never: "forces: [{ belt: chest, ENDS, force: RAMP }]",
    },
    Case {
        word: "plane belt limiter",
        effect: "belt chest: limiter",
        scene: plane,
        on: "forces: [{ belt: chest, ENDS, force: RAMP, limiter: { force: 4 kN } }]",
        off: &[],
        never: "forces: [{ belt: chest, ENDS, force: RAMP }]",
    },
    Case {
        word: "plane belt retractor",
        effect: "belt chest: retractor",
        scene: plane,
        on: "switches: [{ switch: crash, when: { time: 10 ms } }]\nforces: [{ belt: chest, ENDS, force: RAMP, retractor: { lock: crash, spool: 5 N } }]",
        off: &[],
        never: "forces: [{ belt: chest, ENDS, force: RAMP }]",
    },
    Case {
        word: "force airbag",
        effect: "airbag bag",
        scene: space,
        on: "BAG, inflow: { fire: crash, flow: { points: [[0, 1], [0.1, 0]] }, temperature: 500 K }, start: { pressure: 2 bar, temperature: 300 K } }]\nswitches: [{ switch: crash, when: { time: 10 ms } }]",
        off: &["BAG, start: { pressure: 2 bar, temperature: 300 K }, enabled: false }]"],
        never: "",
    },
    Case {
        word: "space airbag gas at the start",
        effect: "airbag bag: gas at the start",
        scene: space,
        on: "switches: [{ switch: crash, when: { time: 10 ms } }]\nBAG, inflow: { fire: crash, flow: { points: [[0, 1], [0.1, 0]] }, temperature: 500 K }, start: { pressure: 2 bar, temperature: 300 K } }]",
        off: &[],
        never: "switches: [{ switch: crash, when: { time: 10 ms } }]\nBAG, inflow: { fire: crash, flow: { points: [[0, 1], [0.1, 0]] }, temperature: 500 K } }]",
    },
    Case {
        word: "space airbag inflow",
        effect: "airbag bag: inflow",
        scene: space,
        on: "switches: [{ switch: crash, when: { time: 10 ms } }]\nBAG, inflow: { fire: crash, flow: { points: [[0, 1], [0.1, 0]] }, temperature: 500 K }, start: { pressure: 2 bar, temperature: 300 K } }]",
        off: &[],
        never: "BAG, start: { pressure: 2 bar, temperature: 300 K } }]",
    },
    Case {
        word: "space airbag vent",
        effect: "airbag bag: vent",
        scene: space,
        on: "BAG, start: { pressure: 2 bar, temperature: 300 K }, vent: { area: 0.001 } }]",
        off: &["BAG, start: { pressure: 2 bar, temperature: 300 K }, vent: { area: 0 } }]"],
        never: "BAG, start: { pressure: 2 bar, temperature: 300 K } }]",
    },
    Case {
        word: "plane belt film spool",
        effect: "belt chest: film spool",
        scene: plane,
        on: "switches: [{ switch: crash, when: { time: 10 ms } }]\nforces: [{ belt: chest, ENDS, force: RAMP, retractor: { lock: crash, spool: 5 N, film_spool: RAMP } }]",
        off: &[],
        never: "switches: [{ switch: crash, when: { time: 10 ms } }]\nforces: [{ belt: chest, ENDS, force: RAMP, retractor: { lock: crash, spool: 5 N } }]",
    },
    Case {
        word: "plane belt friction of ring pin",
        effect: "belt chest: friction of ring pin",
        scene: plane,
        on: "forces: [{ belt: chest, ENDS, through: [{ ring: pin, on: frame, at: [0.1, 0.3], friction: 0.2 }], force: RAMP }]",
        off: &[
            "forces: [{ belt: chest, ENDS, through: [{ ring: pin, on: frame, at: [0.1, 0.3], friction: 0 }], force: RAMP }]",
        ],
        never: "forces: [{ belt: chest, ENDS, through: [{ ring: pin, on: frame, at: [0.1, 0.3] }], force: RAMP }]",
    },
    Case {
        word: "plane joint stop",
        effect: "joint man/head: stop",
        scene: plane,
        on: "forces: [{ joint: man/head, damping: 1, stop: { to: 60 deg, stiffness: 1 kN*m } }]",
        off: &["forces: [{ joint: man/head, damping: 1, stop: { to: 60 deg, stiffness: 0 } }]"],
        never: "forces: [{ joint: man/head, damping: 1 }]",
    },
    Case {
        word: "plane joint lock",
        effect: "joint man/head: lock",
        scene: plane,
        on: "switches: [{ switch: crash, when: { time: 10 ms } }]\nforces: [{ joint: man/head, damping: 1, lock: { by: crash, stiffness: 1 kN*m } }]",
        off: &[
            "switches: [{ switch: crash, when: { time: 10 ms } }]\nforces: [{ joint: man/head, damping: 1, lock: { by: crash, stiffness: 0 } }]",
        ],
        never: "forces: [{ joint: man/head, damping: 1 }]",
    },
    Case {
        word: "space joint stop about x",
        effect: "joint man/head: stop about x",
        scene: space,
        on: "forces: [{ joint: man/head, about: { y: { damping: 1 }, x: { stop: { to: 60 deg, stiffness: 1 kN*m } } } }]",
        off: &[
            "forces: [{ joint: man/head, about: { y: { damping: 1 }, x: { stop: { to: 60 deg, stiffness: 0 } } } }]",
        ],
        never: "forces: [{ joint: man/head, about: { y: { damping: 1 } } }]",
    },
    Case {
        word: "space joint lock about x",
        effect: "joint man/head: lock about x",
        scene: space,
        on: "switches: [{ switch: crash, when: { time: 10 ms } }]\nforces: [{ joint: man/head, about: { y: { damping: 1 }, x: { lock: { by: crash, stiffness: 1 kN*m } } } }]",
        off: &[
            "switches: [{ switch: crash, when: { time: 10 ms } }]\nforces: [{ joint: man/head, about: { y: { damping: 1 }, x: { lock: { by: crash, stiffness: 0 } } } }]",
        ],
        never: "forces: [{ joint: man/head, about: { y: { damping: 1 } } }]",
    },
    Case {
        word: "space joint stop about y",
        effect: "joint man/head: stop about y",
        scene: space,
        on: "forces: [{ joint: man/head, about: { x: { damping: 1 }, y: { stop: { to: 60 deg, stiffness: 1 kN*m } } } }]",
        off: &[
            "forces: [{ joint: man/head, about: { x: { damping: 1 }, y: { stop: { to: 60 deg, stiffness: 0 } } } }]",
        ],
        never: "forces: [{ joint: man/head, about: { x: { damping: 1 } } }]",
    },
    Case {
        word: "space joint lock about y",
        effect: "joint man/head: lock about y",
        scene: space,
        on: "switches: [{ switch: crash, when: { time: 10 ms } }]\nforces: [{ joint: man/head, about: { x: { damping: 1 }, y: { lock: { by: crash, stiffness: 1 kN*m } } } }]",
        off: &[
            "switches: [{ switch: crash, when: { time: 10 ms } }]\nforces: [{ joint: man/head, about: { x: { damping: 1 }, y: { lock: { by: crash, stiffness: 0 } } } }]",
        ],
        never: "forces: [{ joint: man/head, about: { x: { damping: 1 } } }]",
    },
    Case {
        word: "space joint stop about z",
        effect: "joint man/head: stop about z",
        scene: space,
        on: "forces: [{ joint: man/head, about: { y: { damping: 1 }, z: { stop: { to: 60 deg, stiffness: 1 kN*m } } } }]",
        off: &[
            "forces: [{ joint: man/head, about: { y: { damping: 1 }, z: { stop: { to: 60 deg, stiffness: 0 } } } }]",
        ],
        never: "forces: [{ joint: man/head, about: { y: { damping: 1 } } }]",
    },
    Case {
        word: "space joint lock about z",
        effect: "joint man/head: lock about z",
        scene: space,
        on: "switches: [{ switch: crash, when: { time: 10 ms } }]\nforces: [{ joint: man/head, about: { y: { damping: 1 }, z: { lock: { by: crash, stiffness: 1 kN*m } } } }]",
        off: &[
            "switches: [{ switch: crash, when: { time: 10 ms } }]\nforces: [{ joint: man/head, about: { y: { damping: 1 }, z: { lock: { by: crash, stiffness: 0 } } } }]",
        ],
        never: "forces: [{ joint: man/head, about: { y: { damping: 1 } } }]",
    },
    Case {
        word: "output",
        effect: "output a",
        scene: plane,
        on: "outputs: [{ name: a, of: man/head, what: velocity }]",
        off: &["outputs: [{ name: a, of: man/head, what: velocity, enabled: false }]"],
        never: "",
    },
];
