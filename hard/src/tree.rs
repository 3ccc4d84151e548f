//! Trees in space that can be written in several equivalent ways.

use crate::case_model::CaseModel;
use std::fmt::Write as _;

/// A free tree of rigid elements under gravity, with its state at the start.
#[derive(Clone, Debug)]
pub struct Tree {
    /// The elements. Each comes after its carrier, unless the order is permuted.
    pub elements: Vec<Element>,
    /// Position of the root's local origin \[m\].
    pub position: [f64; 3],
    /// Velocity of this origin \[m/s\].
    pub velocity: [f64; 3],
    /// Gravity \[m/s²\].
    pub gravity: [f64; 3],
}

/// An element; its principal axes are those of its local frame.
#[derive(Clone, Debug)]
pub struct Element {
    /// Its name, unique.
    pub name: &'static str,
    /// Index of the element that carries it, and the position of the joint in the frame of that element \[m\]; `None`
    /// for the root.
    pub on: Option<(usize, [f64; 3])>,
    /// Mass \[kg\].
    pub mass: f64,
    /// Centre of gravity in the local frame \[m\].
    pub cg: [f64; 3],
    /// Principal moments of inertia \[kg m²\].
    pub inertia: [f64; 3],
    /// Absolute Bryant angles \[rad\].
    pub angles: [f64; 3],
    /// Angular velocity, absolute axes \[rad/s\].
    pub rate: [f64; 3],
}

type Matrix = [[f64; 3]; 3];

/// Rx(φ₁) Ry(φ₂) Rz(φ₃)
pub fn rotation(angles: [f64; 3]) -> Matrix {
    let [(s1, c1), (s2, c2), (s3, c3)] = angles.map(f64::sin_cos);
    [
        [c2 * c3, -c2 * s3, s2],
        [c1 * s3 + s1 * s2 * c3, c1 * c3 - s1 * s2 * s3, -s1 * c2],
        [s1 * s3 - c1 * s2 * c3, s1 * c3 + c1 * s2 * s3, c1 * c2],
    ]
}

/// The Bryant angles of a rotation; the second must not be ±90°.
fn angles(r: &Matrix) -> [f64; 3] {
    [
        (-r[1][2]).atan2(r[2][2]),
        r[0][2].asin(),
        (-r[0][1]).atan2(r[0][0]),
    ]
}

fn times(r: &Matrix, v: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| r[i][0] * v[0] + r[i][1] * v[1] + r[i][2] * v[2])
}

fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn minus(a: [f64; 3]) -> [f64; 3] {
    a.map(|x| -x)
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

impl Tree {
    /// Five elements, with a branch at the first and one at the second.
    pub fn example() -> Tree {
        let element = |name, on, mass, cg, inertia, angles, rate| Element {
            name,
            on,
            mass,
            cg,
            inertia,
            angles,
            rate,
        };
        Tree {
            elements: vec![
                element(
                    "hub",
                    None,
                    3.0,
                    [0.02, -0.03, 0.05],
                    [0.03, 0.04, 0.05],
                    [0.2, 0.3, -0.4],
                    [1.0, 2.0, -1.0],
                ),
                element(
                    "arm",
                    Some((0, [0.2, 0.0, 0.1])),
                    1.0,
                    [0.1, 0.02, 0.0],
                    [0.001, 0.004, 0.004],
                    [1.0, -0.5, 0.2],
                    [-2.0, 0.5, 3.0],
                ),
                element(
                    "leg",
                    Some((0, [-0.1, 0.1, -0.2])),
                    2.0,
                    [0.0, 0.0, -0.2],
                    [0.02, 0.02, 0.003],
                    [-0.4, 0.1, 2.0],
                    [0.3, -1.0, 2.0],
                ),
                element(
                    "thumb",
                    Some((1, [0.15, 0.05, 0.0])),
                    0.3,
                    [0.02, 0.0, 0.03],
                    [0.0003, 0.0002, 0.0004],
                    [0.5, 0.2, 0.1],
                    [2.0, 1.0, 0.0],
                ),
                element(
                    "hand",
                    Some((1, [0.2, 0.0, 0.0])),
                    0.5,
                    [0.05, 0.0, 0.02],
                    [0.0005, 0.001, 0.001],
                    [0.0, 0.7, 1.2],
                    [1.0, -4.0, 2.0],
                ),
            ],
            position: [0.3, -0.2, 1.0],
            velocity: [1.0, -0.5, 0.2],
            gravity: [0.0, 0.0, -9.81],
        }
    }

    /// The tree with its elements in reverse order.
    pub fn permuted(&self) -> Tree {
        let count = self.elements.len();
        let place = |index: usize| count - 1 - index;
        let mut other = self.clone();
        other.elements.reverse();
        for element in &mut other.elements {
            element.on = element.on.map(|(carrier, at)| (place(carrier), at));
        }
        other
    }

    /// The same tree with another root. The local frame of each element on the path to the new root then begins at the
    /// joint to its new carrier.
    pub fn rooted_at(&self, root: usize) -> Tree {
        let mut other = self.clone();
        // position and velocity of the new root's local origin, computed from the old root downwards
        let mut way = vec![root];
        while let Some((carrier, _)) = self.elements[way[way.len() - 1]].on {
            way.push(carrier);
        }
        for pair in way.windows(2).rev() {
            let (carrier, (_, at)) = (
                &self.elements[pair[1]],
                self.elements[pair[0]].on.unwrap_or_default(),
            );
            let arm = times(&rotation(carrier.angles), at);
            other.position = add(other.position, arm);
            other.velocity = add(other.velocity, cross(carrier.rate, arm));
        }
        // on the path, each carrier is now carried by the element that it carried before, through the same joint
        for pair in way.windows(2) {
            let [carried, carrier] = [pair[0], pair[1]];
            let joint = self.elements[carried].on.unwrap_or_default().1;
            // the position of this joint in the frame of its new carrier, whose local origin may have moved
            let moved = if carried == root {
                [0.0; 3]
            } else {
                other.shift_of(self, carried, &way)
            };
            other.elements[carrier].on = Some((carried, minus(moved)));
            other.elements[carrier].cg = add(self.elements[carrier].cg, minus(joint));
            for (index, element) in self.elements.iter().enumerate() {
                if let Some((on, at)) = element.on
                    && on == carrier
                    && index != carried
                {
                    other.elements[index].on = Some((carrier, add(at, minus(joint))));
                }
            }
        }
        other.elements[root].on = None;
        other
    }

    /// The shift of the local origin of an element on the path, in the frame of the element.
    fn shift_of(&self, before: &Tree, element: usize, way: &[usize]) -> [f64; 3] {
        let place = way.iter().position(|e| *e == element).unwrap_or(0);
        match place {
            0 => [0.0; 3],
            place => before.elements[way[place - 1]].on.unwrap_or_default().1,
        }
    }

    /// The tree with everything rotated, including gravity.
    pub fn turned(&self, r: &Matrix) -> Tree {
        let mut other = self.clone();
        other.position = times(r, self.position);
        other.velocity = times(r, self.velocity);
        other.gravity = times(r, self.gravity);
        for element in &mut other.elements {
            let own = rotation(element.angles);
            let columns = [0, 1, 2].map(|j| times(r, [0, 1, 2].map(|i| own[i][j])));
            let turned = [0, 1, 2].map(|i| [0, 1, 2].map(|j| columns[j][i]));
            element.angles = angles(&turned);
            element.rate = times(r, element.rate);
        }
        other
    }

    /// A scene with only this tree; outputs are the absolute positions of all centres of gravity ("hub x").
    pub fn scene(&self, name: &str) -> CaseModel {
        let mut outputs = String::new();
        self.outputs("tree", "", &mut outputs);
        let text = format!(
            "model: {name}\ndimension: 3\n{}systems:\n{}forces:\n{}outputs:\n{outputs}run: {{ duration: 1 s, every: 20 ms }}\n",
            self.parameters(),
            self.system("tree"),
            self.field("tree")
        );
        CaseModel::new(name, text)
    }

    /// A scene with two trees that do not touch; the outputs of the second begin with "other".
    pub fn scene_of_two(name: &str, a: &Tree, b: &Tree) -> CaseModel {
        let mut outputs = String::new();
        a.outputs("tree", "", &mut outputs);
        b.outputs("second", "other ", &mut outputs);
        let text = format!(
            "model: {name}\ndimension: 3\n{}systems:\n{}{}forces:\n{}{}outputs:\n{outputs}run: {{ duration: 1 s, every: 20 ms }}\n",
            a.parameters(),
            a.system("tree"),
            b.system("second"),
            a.field("tree"),
            b.field("second"),
        );
        CaseModel::new(name, text)
    }

    fn system(&self, name: &str) -> String {
        let three = |v: [f64; 3]| format!("[{:e}, {:e}, {:e}]", v[0], v[1], v[2]);
        let mut text = format!("  - name: {name}\n    elements:\n");
        for element in &self.elements {
            let joint = match element.on {
                Some((carrier, at)) => {
                    format!("on: {}, at: {}, ", self.elements[carrier].name, three(at))
                }
                None => String::new(),
            };
            let _ = writeln!(
                text,
                "      - {{ name: {}, {joint}mass: {:e}, cg: {}, inertia: {} }}",
                element.name,
                element.mass,
                three(element.cg),
                three(element.inertia)
            );
        }
        // two parameters can change the start of each element slightly
        let angles = self.elements.iter().map(|e| {
            let [x, y, z] = e.angles;
            format!("{0}: [{x:e} rad + turn_{0}, {y:e}, {z:e}]", e.name)
        });
        let rates = self.elements.iter().map(|e| {
            let [x, y, z] = e.rate;
            format!("{0}: [{x:e}, {y:e} rad/s + spin_{0}, {z:e}]", e.name)
        });
        let _ = writeln!(
            text,
            "    start:\n      position: {}\n      velocity: {}\n      angles: {{ {} }}\n      rates: {{ {} }}",
            three(self.position),
            three(self.velocity),
            angles.collect::<Vec<_>>().join(", "),
            rates.collect::<Vec<_>>().join(", ")
        );
        text
    }

    /// Parameters that change the start of each element, for example of `hub`: `turn_hub` is added to its first angle,
    /// `spin_hub` to its rate about y.
    fn parameters(&self) -> String {
        let mut text = "parameters:\n".to_owned();
        for element in &self.elements {
            for (what, unit) in [("turn", "rad"), ("spin", "rad/s")] {
                let name = element.name;
                let _ = writeln!(
                    text,
                    "  {what}_{name}: {{ value: 0 {unit}, min: -1 {unit}, max: 1 {unit} }}"
                );
            }
        }
        text
    }

    /// The line of the field with the tree's gravity.
    pub fn field(&self, name: &str) -> String {
        let [x, y, z] = self.gravity;
        format!(
            "  - {{ field: gravity-of-{name}, acceleration: [{x:e}, {y:e}, {z:e}], on: [{name}] }}\n"
        )
    }

    fn outputs(&self, system: &str, before: &str, text: &mut String) {
        for element in &self.elements {
            for axis in ["x", "y", "z"] {
                let name = element.name;
                let _ = writeln!(
                    text,
                    "  - {{ name: {before}{name} {axis}, of: {system}/{name}, what: position, component: {axis} }}"
                );
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_those_of_their_rotation() {
        let given = [0.7, -1.1, 2.3];
        let found = angles(&rotation(given));
        for (a, b) in given.iter().zip(found) {
            assert!((a - b).abs() < 8.0 * f64::EPSILON / f64::cos(1.1));
        }
    }

    /// Absolute position of each centre of gravity, by its element's name.
    fn places(tree: &Tree) -> Vec<(&'static str, [f64; 3])> {
        let origin = |mut index: usize| {
            let mut arm = [0.0; 3];
            while let Some((carrier, at)) = tree.elements[index].on {
                arm = add(arm, times(&rotation(tree.elements[carrier].angles), at));
                index = carrier;
            }
            add(tree.position, arm)
        };
        let place = |(index, e): (usize, &Element)| {
            (e.name, add(origin(index), times(&rotation(e.angles), e.cg)))
        };
        let mut places: Vec<_> = tree.elements.iter().enumerate().map(place).collect();
        places.sort_by_key(|(name, _)| *name);
        places
    }

    #[test]
    fn a_tree_told_otherwise_is_in_the_same_place() {
        let tree = Tree::example();
        for other in [
            tree.permuted(),
            tree.rooted_at(4),
            tree.rooted_at(2),
            tree.rooted_at(3),
        ] {
            for ((name, a), (other, b)) in places(&tree).into_iter().zip(places(&other)) {
                assert_eq!(name, other);
                let away = (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max);
                assert!(away < 1e-14, "{name}: {away:e}");
            }
        }
    }
}
