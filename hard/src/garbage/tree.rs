//! Random valid models as users write them: trees of a few elements, with all parts of the language.

use crate::random::Random;

/// A model that is being written.
struct Writer<'a> {
    random: &'a mut Random,
    plane: bool,
    /// `system/element`.
    elements: Vec<String>,
    vehicle: bool,
    /// Joints that already have a force.
    jointed: Vec<usize>,
}

/// A random model in the plane, or in space; if the word `bryant` occurs in its text, it uses Bryant angles.
pub fn model(random: &mut Random) -> String {
    let plane = random.one_in(2);
    let mut writer = Writer {
        random,
        plane,
        elements: Vec::new(),
        vehicle: false,
        jointed: Vec::new(),
    };
    writer.write()
}

impl Writer<'_> {
    fn write(&mut self) -> String {
        let mut text = "model: random\n".to_owned();
        text += match self.plane {
            true => "dimension: 2\n",
            false => "dimension: 3\ncoordinates: bryant\n",
        };
        text += "parameters:\n  heavy: { value: 1.7, min: 0.1 }\n  far: 0.9\n  stiff: { value: 800, min: 0 }\n";
        text += "curves:\n  \
                 spring: { points: [[-2, -3], [-0.5, -1], [1, 1.5], [2, 4]], extrapolate: linear }\n  \
                 soft: { points: [[-2, -3], [-0.5, -1], [0, 0], [1, 1.5], [2, 4]], interpolate: cubic, extrapolate: linear }\n  \
                 line: { points: [[0, 0], [1, 1]], extrapolate: linear }\n  \
                 rising: { points: [[0, 0], [0.5, 0.3], [1, 1.2]], extrapolate: linear }\n  \
                 pulse: { points: [[0, 0.5], [0.2, 2], [0.5, -1], [0.9, 0.3]] }\n  \
                 way: { points: [[0, 0], [0.2, 0.1], [0.5, -0.2], [0.8, 0.1]], interpolate: cubic }\n  \
                 turn: { points: [[0, 0], [1, 1.3]], interpolate: cubic, extrapolate: linear }\n";
        if self.random.one_in(3) {
            self.vehicle = true;
            let moved = self.motion();
            let angles = match (self.plane, self.random.below(3)) {
                (_, 0) => String::new(),
                (true, _) => ", angles: turn".to_owned(),
                (false, _) => ", angles: [turn, way, { curve: turn, times: -0.5 }]".to_owned(),
            };
            text += &format!("vehicles:\n  - {{ name: car, {moved}{angles} }}\n");
        }
        text += "systems:\n";
        for s in 0..1 + self.random.below(2) {
            text += &self.system(s);
        }
        text += "forces:\n";
        for f in 0..1 + self.random.below(6) {
            text += &self.force(f);
        }
        text += "switches:\n  - { switch: soon, when: { time: 0.2 } }\n  - { switch: later, when: { time: 0.6 }, after: 0.1 }\n";
        text + "run: { duration: 1, every: 0.01 }\n"
    }

    fn number(&mut self, from: f64, to: f64) -> String {
        let value = self.random.uniform(from, to);
        match self.random.below(12) {
            0 => format!("{value:.3} * far"),
            _ => format!("{value:.3}"),
        }
    }

    fn vector(&mut self, size: f64) -> String {
        let count = if self.plane { 2 } else { 3 };
        let numbers: Vec<String> = (0..count)
            .map(|_| match self.random.below(6) {
                // some components are 0, so that terms vanish
                0 => "0".to_owned(),
                _ => self.number(-size, size),
            })
            .collect();
        format!("[{}]", numbers.join(", "))
    }

    /// A rotation: one angle in the plane, three in space.
    fn turns(&mut self, size: f64) -> String {
        match self.plane {
            true => self.number(-size, size),
            false => self.vector(size),
        }
    }

    /// A random motion of a point whose motion is prescribed.
    fn motion(&mut self) -> String {
        let (key, curves) = match self.random.below(3) {
            0 => (
                "displacement",
                ["way", "{ curve: way, times: -0.7, stretch: 1.3 }", "0"],
            ),
            1 => ("velocity", ["pulse", "{ curve: pulse, times: 2 }", "0.4"]),
            _ => (
                "acceleration",
                ["{ curve: pulse, times: 5 }", "pulse", "far"],
            ),
        };
        let count = if self.plane { 2 } else { 3 };
        let curves: Vec<&str> = (0..count)
            .map(|_| match key {
                "displacement" => curves[self.random.below(2)],
                _ => *self.random.one_of(&curves),
            })
            .collect();
        format!("{key}: [{}]", curves.join(", "))
    }

    fn system(&mut self, s: usize) -> String {
        let reference = match self.random.below(if self.vehicle { 5 } else { 4 }) {
            0 | 1 => "free".to_owned(),
            2 => "fixed".to_owned(),
            3 => format!("{{ {} }}", self.motion()),
            _ => format!("{{ on: car, at: {} }}", self.vector(0.5)),
        };
        let count = 1 + self.random.below(if self.plane { 8 } else { 5 });
        let mut text = format!("  - name: s{s}\n    reference: {reference}\n    elements:\n");
        for e in 0..count {
            let on = match e {
                0 => String::new(),
                _ => format!("on: e{}, at: {}, ", self.random.below(e), self.vector(0.4)),
            };
            let mass = self.random.uniform(0.5, 5.0);
            // moments of a solid ellipsoid with these semi-axes are always physical
            let squares = [0, 1, 2].map(|_| self.random.uniform(0.03, 0.2f64).powi(2));
            let sum: f64 = squares.iter().sum();
            let moments = squares.map(|square| format!("{:e}", mass / 5.0 * (sum - square)));
            let inertia = match self.plane {
                true => moments[1].clone(),
                false => format!("[{}]", moments.join(", ")),
            };
            let axes = match !self.plane && self.random.one_in(3) {
                true => format!(", axes: {}", self.vector(2.0)),
                false => String::new(),
            };
            let mass = match self.random.below(6) {
                0 => "heavy".to_owned(),
                _ => format!("{mass:.3}"),
            };
            let cg = self.vector(0.2);
            text += &format!(
                "      - {{ name: e{e}, {on}mass: {mass}, cg: {cg}, inertia: {inertia}{axes} }}\n"
            );
            self.elements.push(format!("s{s}/e{e}"));
        }
        text
    }

    /// Two different bodies on which a force acts.
    fn two_bodies(&mut self) -> [String; 2] {
        let first = self.random.below(self.elements.len());
        let mut others = vec!["frame".to_owned()];
        others.extend(self.vehicle.then(|| "car".to_owned()));
        others.extend(
            self.elements
                .iter()
                .enumerate()
                .filter(|(i, _)| *i != first)
                .map(|(_, e)| e.clone()),
        );
        let other = self.random.one_of(&others).clone();
        [self.elements[first].clone(), other]
    }

    fn while_active(&mut self) -> &'static str {
        match self.random.below(8) {
            0 => ", since: soon",
            1 => ", until: later",
            2 => ", since: soon, until: later",
            _ => "",
        }
    }

    fn torque(&mut self) -> String {
        let mut keys = Vec::new();
        if self.random.one_in(2) {
            keys.push("elastic: { curve: spring, times: stiff / 100 }".to_owned());
            if self.random.one_in(2) {
                keys.push(format!("neutral: {}", self.number(-0.5, 0.5)));
            }
        }
        if self.random.one_in(2) {
            keys.push(format!("damping: {}", self.number(0.1, 2.0)));
        }
        if self.random.one_in(3) {
            keys.push(format!(
                "friction: {}, friction_speed: 0.5",
                self.number(0.1, 2.0)
            ));
        }
        if self.random.one_in(3) {
            keys.push("stop: { from: -0.4, to: 0.3, stiffness: 30, damping: 2 }".to_owned());
        }
        if self.random.one_in(4) {
            keys.push("lock: { by: soon, stiffness: 20, damping: 1 }".to_owned());
        }
        if keys.is_empty() {
            keys.push("damping: 0.5".to_owned());
        }
        keys.join(", ")
    }

    fn force(&mut self, f: usize) -> String {
        let active = self.while_active();
        match self.random.below(6) {
            0 | 1 => self.joint(active),
            2 => {
                let count = if self.plane { 2 } else { 3 };
                let kinds = [
                    "0",
                    "-9.81",
                    "pulse",
                    "{ curve: pulse, times: 3, stretch: far }",
                ];
                let components: Vec<&str> =
                    (0..count).map(|_| *self.random.one_of(&kinds)).collect();
                format!(
                    "  - {{ field: f{f}, acceleration: [{}]{active} }}\n",
                    components.join(", ")
                )
            }
            3 => {
                let on = self.elements[self.random.below(self.elements.len())].clone();
                let at = match self.random.below(3) {
                    0 => String::new(),
                    1 => ", at: cg".to_owned(),
                    _ => format!(", at: {}", self.vector(0.3)),
                };
                let moment = match self.random.one_in(2) {
                    true => format!(", moment: {}", self.turns(3.0)),
                    false => String::new(),
                };
                let force = self.vector(20.0);
                format!("  - {{ load: l{f}, on: {on}{at}, force: {force}{moment}{active} }}\n")
            }
            4 => {
                let [from, to] = self.two_bodies();
                let (a, b) = (self.vector(0.3), self.vector(0.9));
                let rest = match self.random.below(6) {
                    0 => ", slack: 0.02",
                    1 => ", pretension: 5",
                    2 => ", length: 0.3, damping: 3",
                    3 => ", damping: 4, damping_stretch: 0.01, limiter: { force: 300 }",
                    4 => ", retractor: { lock: soon, spool: 2 }, damping: 1",
                    _ => {
                        ", unloading_slope: 9000, pretensioner: { fire: soon, retract: { points: [[0, 0], [0.3, 0.05]] } }"
                    }
                };
                format!(
                    "  - {{ belt: b{f}, from: {{ on: {from}, at: {a} }}, to: {{ on: {to}, at: {b} }}, force: {{ curve: rising, \
                     times: stiff }}{rest}{active} }}\n"
                )
            }
            _ => self.contact(f, active),
        }
    }

    fn joint(&mut self, active: &str) -> String {
        let child = self.random.below(self.elements.len());
        if self.jointed.contains(&child) {
            return format!(
                "  - {{ load: again{}, on: {}, force: {} }}\n",
                self.random.bits(),
                self.elements[child].clone(),
                self.vector(5.0)
            );
        }
        self.jointed.push(child);
        let name = self.elements[child].clone();
        let torque = self.torque();
        let law = match (self.plane, self.random.below(3)) {
            (true, _) => torque,
            (false, 0) => format!(
                "flexion: {{ elastic: {{ points: [[0, 0], [1, 5]], extrapolate: linear }}, damping: 0.3 }}, torsion: {{ {torque} }}"
            ),
            (false, _) => {
                let (second, third) = (self.torque(), self.torque());
                match self.random.below(3) {
                    0 => format!("about: {{ x: {{ {torque} }} }}"),
                    1 => format!("about: {{ y: {{ {torque} }}, z: {{ {second} }} }}"),
                    _ => format!(
                        "about: {{ x: {{ {torque} }}, y: {{ {second} }}, z: {{ {third} }} }}"
                    ),
                }
            }
        };
        format!("  - {{ joint: {name}, {law}{active} }}\n")
    }

    fn contact(&mut self, f: usize, active: &str) -> String {
        let [on, other] = self.two_bodies();
        let axes = |plane: bool| {
            if plane {
                "[0.3, 0.2]"
            } else {
                "[0.3, 0.25, 0.2]"
            }
        };
        let (center, at) = (self.vector(0.2), self.vector(0.5));
        let axes = axes(self.plane);
        let against = match self.random.below(3) {
            0 => format!("with: {{ on: {other}, center: {at}, semi_axes: {axes} }}"),
            kind => {
                let normal = if self.plane {
                    "[0.2, 1]"
                } else {
                    "[0.2, -0.3, 1]"
                };
                let extent = match (kind, self.plane) {
                    (1, _) => "",
                    (_, true) => ", extent: 0.6, edge: { rule: fade, width: 0.2 }",
                    (_, false) => ", extent: [0.6, 0.8], edge: { rule: fade, width: 0.2 }",
                };
                format!("plane: {{ on: {other}, at: {at}, normal: {normal}{extent} }}")
            }
        };
        let friction = match self.random.below(3) {
            0 => "",
            1 => ", friction: 0.4, friction_speed: 0.2",
            _ => ", friction: 0.3, friction_displacement: 0.01",
        };
        let damping = if self.random.one_in(2) {
            ", damping: 20, damping_depth: 0.05"
        } else {
            ""
        };
        let turned = if self.plane {
            "0.4"
        } else {
            "[0.3, -0.2, 0.5]"
        };
        format!(
            "  - {{ contact: c{f}, ellipsoid: {{ on: {on}, center: {center}, semi_axes: {axes}, axes: {turned} }}, {against}, \
             elastic: {{ curve: line, times: stiff }}{damping}{friction}{active} }}\n"
        )
    }
}
