//! Mirror images: of elements and their start, surfaces, forces and outputs that say `mirror: true`.
//!
//! A mirror reverses one axis a. Of a body and its image, the local frames are images of each other too. So a polar
//! vector (a place, a direction, a force) changes the sign of its component along a; an axial one (an angular velocity,
//! a moment) those of the two others; and an orientation Rx(φ₁) Ry(φ₂) Rz(φ₃) between such frames the signs of the two
//! other angles. The [axes of joints](super::axes) are of both kinds.

use super::{Expander, Node};
use crate::description::tree::{Entry, NodeKind};
use crate::diagnostic::quoted;

/// How two sides correspond.
#[derive(Debug)]
pub struct Words {
    /// Word in the names of what is written.
    from: String,
    /// Word in the names of the images.
    to: String,
    /// The axis that is reversed: 0, 1, 2 for x, y, z.
    pub(super) axis: usize,
}

impl Words {
    /// As a file says it: left and right, if it does not.
    pub fn of(written: Option<&Node>) -> Words {
        let word = |key, default: &str| {
            let word = written.and_then(|node| node.word(key));
            word.unwrap_or(default).to_owned()
        };
        Words {
            from: word("from", "left"),
            to: word("to", "right"),
            axis: match word("axis", "y").as_str() {
                "x" => 0,
                "z" => 2,
                _ => 1,
            },
        }
    }

    /// The name of an image: each such word of the name replaced; `None` where there is none.
    fn image(&self, name: &str) -> Option<String> {
        let mut image = String::new();
        let mut found = false;
        for part in name.split_inclusive(|c: char| !c.is_alphanumeric()) {
            let word = part.trim_end_matches(|c: char| !c.is_alphanumeric());
            let rest = &part[word.len()..];
            if word == self.from {
                found = true;
                image += &self.to;
            } else if word == capital(&self.from) {
                found = true;
                image += &capital(&self.to);
            } else {
                image += word;
            }
            image += rest;
        }
        found.then_some(image)
    }
}

fn capital(word: &str) -> String {
    let mut letters = word.chars();
    letters
        .next()
        .map(|first| first.to_uppercase().chain(letters).collect())
        .unwrap_or_default()
}

/// Whether two forces of a kind differ in nothing but their names, or in which of two ends or ellipsoids is which.
fn is_the_same(
    force: &Node,
    image: &Node,
    kind: &str,
    exchangeable: Option<[&'static str; 2]>,
) -> bool {
    let swapped = |node: &Node, [a, b]: [&str; 2]| {
        let mut node = node.clone();
        let (first, second) = (node.remove(a), node.remove(b));
        for (key, value) in [(b, first), (a, second)] {
            if let Some(value) = value {
                node.set(key, value);
            }
        }
        node
    };
    let same = |image: &Node| {
        let keys = force
            .entries()
            .iter()
            .chain(image.entries())
            .map(|e| &e.key);
        let mut keys = keys.filter(|key| *key != kind);
        keys.all(|key| match (force.get(key), image.get(key)) {
            (Some(a), Some(b)) => a.reads_as(b),
            (a, b) => a.is_none() && b.is_none(),
        })
    };
    same(image) || exchangeable.is_some_and(|keys| same(&swapped(image, keys)))
}

impl Expander<'_> {
    /// Writes out the elements with an image, and the start of each.
    pub fn mirror_systems(&mut self, systems: &mut Node) {
        let NodeKind::List(systems) = &mut systems.kind else {
            return;
        };
        for system in systems {
            let name = system.word("name").unwrap_or_default().to_owned();
            if let Some(elements) = system.get_mut("elements") {
                self.mirror_elements(&name, elements);
            }
            let Some(start) = system.get_mut("start") else {
                continue;
            };
            // the axes of the image are such that its coordinates are those of the element
            for key in ["joints", "joint_rates"] {
                if let Some(values) = start.get_mut(key) {
                    self.mirror_start(&name, values, |_, n| n.clone());
                }
            }
            if let Some(angles) = start.get_mut("angles") {
                self.mirror_start(&name, angles, |file, n| file.axial(n));
            }
            if let Some(rates) = start.get_mut("rates") {
                self.mirror_start(&name, rates, |file, n| file.axial(n));
            }
        }
    }

    fn mirror_elements(&mut self, system: &str, elements: &mut Node) {
        let NodeKind::List(items) = &mut elements.kind else {
            return;
        };
        let mut flags = Vec::new();
        for element in items.iter_mut() {
            if let (Some(joint), Some(name)) = (element.get("joint"), element.word("name"))
                && self.problems.language.has_axes(joint.text())
            {
                let path = format!("{system}/{name}");
                self.known.jointed.insert(path);
            }
            let mirrored = element.take_flag("mirror");
            let image = element
                .get("name")
                .filter(|_| mirrored)
                .and_then(|name| self.image_name(name, "element"));
            if let (Some(image), Some(name)) = (&image, element.word("name")) {
                self.known
                    .images
                    .insert(format!("{system}/{name}"), format!("{system}/{image}"));
            }
            flags.push(image);
        }
        let mut all = Vec::new();
        for (element, image) in std::mem::take(items).into_iter().zip(flags) {
            let joint = element.get("joint").filter(|_| image.is_some());
            let joint = joint.map(|joint| self.mirrored_joint(system, joint));
            let image = image.map(|name| {
                let mut image = element.clone();
                image.change("name", |n| n.with_text(name));
                image.change("on", |n| {
                    let path = format!("{system}/{}", n.text().unwrap_or_default());
                    match self.known.images.get(&path) {
                        Some(image) => n.with_text(&image[system.len() + 1..]),
                        None => n.clone(),
                    }
                });
                for key in ["at", "cg"] {
                    image.change(key, |n| self.polar(n));
                }
                image.change("axes", |n| self.axial(n));
                image.change("mesh", |n| self.mesh(n));
                image.change("points", |n| Node {
                    span: n.span,
                    kind: NodeKind::List(n.items().iter().map(|n| self.point(n)).collect()),
                });
                image.change("inertia", |n| self.tensor(n));
                if let Some(anatomy) = image.get_mut("anatomy") {
                    for key in ["forward", "up"] {
                        anatomy.change(key, |n| self.direction(n));
                    }
                }
                if let Some(joint) = joint {
                    image.set("joint", joint);
                }
                image
            });
            all.push(element);
            all.extend(image);
        }
        *items = all;
    }

    /// Adds the images of elements to angles or rates by element, where nothing else is written of them.
    fn mirror_start(
        &self,
        system: &str,
        start: &mut Node,
        mirrored: impl Fn(&Self, &Node) -> Node,
    ) {
        let mut all: Vec<Entry> = Vec::new();
        for entry in start.entries() {
            all.push(entry.clone());
            let image = self.known.images.get(&format!("{system}/{}", entry.key));
            if let Some(image) = image.map(|path| &path[system.len() + 1..])
                && start.get(image).is_none()
            {
                all.push(Entry {
                    key: image.to_owned(),
                    span: entry.span,
                    value: mirrored(self, &entry.value),
                });
            }
        }
        if let NodeKind::Map(entries) = &mut start.kind {
            *entries = all;
        }
    }

    /// Writes out the named surfaces with an image.
    pub fn mirror_surfaces(&mut self, surfaces: &mut Node) {
        let NodeKind::Map(entries) = &mut surfaces.kind else {
            return;
        };
        let mut all = Vec::new();
        for mut entry in std::mem::take(entries) {
            if !entry.value.take_flag("mirror") {
                all.push(entry);
                continue;
            }
            let name = Node::plain(&*entry.key, entry.span);
            let image = self.image_name(&name, "surface").map(|key| {
                let images = &mut self.known.images;
                images.insert(format!("surface {}", entry.key), key.clone());
                Entry {
                    key,
                    span: entry.span,
                    value: self.mirrored_surface(&entry.value),
                }
            });
            all.push(entry);
            all.extend(image);
        }
        *entries = all;
    }

    /// The image of a force that asks for one.
    pub fn mirrored_force(&mut self, force: &mut Node) -> Option<Node> {
        if !force.take_flag("mirror") {
            return None;
        }
        let (law, _) = self.problems.language.law_and_name(force)?;
        let mut image = force.clone();
        (law.image)(self, force, &mut image)?;
        Some(image)
    }

    /// Gives the image of a force of this kind its name.
    pub(crate) fn image_of_named(
        &mut self,
        force: &Node,
        image: &mut Node,
        kind: &str,
    ) -> Option<()> {
        let name = force.word(kind)?;
        let other = self.image_name(force.get(kind)?, kind)?;
        self.known
            .images
            .insert(format!("{kind} {name}"), format!("{kind} {other}"));
        image.change(kind, |n| n.with_text(other));
        Some(())
    }

    /// Reports the image of a force of this kind that is the same force once more.
    pub(crate) fn differs(
        &self,
        force: &Node,
        image: &Node,
        kind: &str,
        exchangeable: Option<[&'static str; 2]>,
    ) -> Option<()> {
        if !is_the_same(force, image, kind, exchangeable) {
            return Some(());
        }
        let name = force.get(kind)?;
        self.problem(
            name.span,
            format!(
                "the mirror image of {} is the same {kind} once more, and would double it",
                quoted(name.text()?)
            ),
            "remove `mirror: true`; or name a body or a surface that has an image",
        );
        None
    }

    /// Makes the image of a law in a joint, which is in the joint of the image of its element.
    pub(crate) fn mirrored_joint_force(&self, force: &Node, image: &mut Node) -> Option<()> {
        let name = force.word("joint")?;
        let Some(path) = self.known.images.get(name) else {
            self.problem(
                force.get("joint")?.span,
                format!("the element {} has no mirror image", quoted(name)),
                "write `mirror: true` in the element as well, or write the force of the other side out",
            );
            return None;
        };
        image.change("joint", |n| n.with_text(path));
        if !self.known.jointed.contains(name) {
            self.mirror_joint(image);
        }
        Some(())
    }

    /// The image of a surface, by the name of its image or in place.
    pub(crate) fn mirrored_by_name(&self, surface: &Node) -> Node {
        match surface.text() {
            Some(name) => match self.known.images.get(&format!("surface {name}")) {
                Some(image) => surface.with_text(image),
                None => surface.clone(),
            },
            None => self.mirrored_surface(surface),
        }
    }

    /// Mirrors each surface or point of a list.
    pub(crate) fn mirrored_list(&self, image: &mut Node, key: &str) {
        if let Some(list) = image.get_mut(key)
            && let NodeKind::List(items) = &mut list.kind
        {
            for item in items {
                *item = self.mirrored_by_name(item);
            }
        }
    }

    /// The image of an output that asks for one: the same of the image of what it looks at.
    pub fn mirrored_output(&mut self, output: &mut Node) -> Option<Node> {
        if !output.take_flag("mirror") {
            return None;
        }
        let name = self.image_name(output.get("name")?, "output")?;
        let of = output.get("of")?;
        let Some(other) = self.image_of(of.text()?) else {
            self.problem(
                of.span,
                format!("{} has no mirror image", quoted(of.text()?)),
                "write `mirror: true` in what it looks at as well, or write the output of the other side out",
            );
            return None;
        };
        let mut image = output.clone();
        image.change("name", |n| n.with_text(name));
        image.change("of", |n| n.with_text(other));
        image.change("code", |n| match n.text() {
            Some(code) => n.with_text(other_side(code)),
            None => n.clone(),
        });
        image.change("at", |n| self.polar(n));
        for key in ["axes", "relative_to", "on"] {
            image.change(key, |n| self.body(n));
        }
        Some(image)
    }

    /// The image of what an output looks at: `man/left-hand`, `joint man/left-knee/residual`, `contact knee-left`.
    fn image_of(&self, of: &str) -> Option<String> {
        if let Some(image) = self.known.images.get(of) {
            return Some(image.clone());
        }
        let path = of.strip_prefix("joint ")?;
        if let Some(image) = self.known.images.get(path) {
            return Some(format!("joint {image}"));
        }
        let (element, name) = path.rsplit_once('/')?;
        let image = self.known.images.get(element)?;
        Some(format!("joint {image}/{name}"))
    }

    /// The name of an image; reported where the name does not say which side it is.
    fn image_name(&self, name: &Node, what: &str) -> Option<String> {
        let text = name.text()?;
        let image = self.words.image(text);
        if image.is_none() {
            let Words { from, to, .. } = &self.words;
            self.problem(
                name.span,
                format!("the name {} does not tell the sides apart", quoted(text)),
                format!("the name of {what}s with a mirror image has the word `{from}`, for which the image has `{to}`; `mirror:` of the file chooses other words"),
            );
        }
        image
    }

    /// The laws of the image of a joint.
    fn mirror_joint(&self, joint: &mut Node) {
        let reversed = |axis: usize| axis != self.words.axis;
        if self.planar && reversed(1) {
            self.mirror_law(joint);
        }
        for (axis, key) in ["x", "y", "z"].into_iter().enumerate() {
            let about = joint.get_mut("about");
            if let Some(law) = about.and_then(|about| about.get_mut(key))
                && reversed(axis)
            {
                self.mirror_law(law);
            }
        }
        let long = match joint.word("axis") {
            Some("x") => 0,
            Some("y") => 1,
            _ => 2,
        };
        if let Some(torsion) = joint.get_mut("torsion")
            && reversed(long)
        {
            self.mirror_law(torsion);
        }
    }

    /// Whether a mirror image has the other direction of this axis.
    pub(crate) fn reverses(&self, axis: usize) -> bool {
        axis == self.words.axis
    }

    /// A law of the coordinate θ as one of −θ, with the opposite force.
    pub(crate) fn mirror_law(&self, law: &mut Node) {
        for key in ["elastic", "unloading"] {
            law.change(key, |n| self.odd_image(n));
        }
        law.change("neutral", negated);
        law.change("motor", self.negated_function());
        if let Some(drive) = law.get_mut("drive") {
            drive.change("to", self.negated_function());
        }
        if let Some(stop) = law.get_mut("stop") {
            let ends = [("from", stop.remove("to")), ("to", stop.remove("from"))];
            for (key, value) in ends {
                if let Some(value) = value {
                    stop.set(key, negated(&value));
                }
            }
        }
    }

    /// The function −f(−x) of a curve f; the curve itself where that is the same.
    fn odd_image(&self, function: &Node) -> Node {
        let curve = match function.text() {
            Some(name) => match self.known.curves.get(name.trim()) {
                Some(curve) => curve,
                // reported where the curve is looked for
                None => return function.clone(),
            },
            None => match function.get("curve") {
                Some(inner) => {
                    let image = self.odd_image(inner);
                    let mut scaled = function.clone();
                    scaled.set("curve", image);
                    return scaled;
                }
                None => function,
            },
        };
        let Some(points) = curve.get("points") else {
            self.problem(
                function.span,
                "the points of this curve are in a file, so that its mirror image is not known",
                "write the force of the other side out, or the points here",
            );
            return function.clone();
        };
        let both = |point: &Node| Node {
            span: point.span,
            kind: NodeKind::List(point.items().iter().map(negated).collect()),
        };
        let images: Vec<Node> = points.items().iter().rev().map(both).collect();
        let same = |a: &Node, b: &Node| {
            let mut pairs = a.items().iter().zip(b.items());
            pairs.all(|(a, b)| a.text() == b.text() || is_zero(a) && is_zero(b))
        };
        let pairs = || images.iter().zip(points.items());
        if pairs().all(|(a, b)| same(a, b)) {
            return function.clone();
        }
        let mut image = curve.clone();
        image.set(
            "points",
            Node {
                span: points.span,
                kind: NodeKind::List(images),
            },
        );
        if function.text().is_some() {
            // its places may be in another text
            image.move_to(function.span);
        }
        image
    }

    /// A surface or an attachment on the image of its body, mirrored in that body's own frame.
    pub(crate) fn mirrored_surface(&self, surface: &Node) -> Node {
        let mut image = surface.clone();
        image.change("on", |n| self.body(n));
        for key in ["at", "center", "normal", "along"] {
            image.change(key, |n| self.polar(n));
        }
        image.change("axes", |n| self.axial(n));
        image
    }

    /// The image of a body; the body itself where it has none.
    pub(crate) fn body(&self, path: &Node) -> Node {
        let image = path.text().and_then(|text| self.known.images.get(text));
        image.map_or_else(|| path.clone(), |image| path.with_text(image))
    }

    /// A direction by the name of an axis: x, -x.
    fn direction(&self, direction: &Node) -> Node {
        let text = direction.text().unwrap_or_default();
        let axis = ["x", "y", "z"][self.words.axis];
        match text.strip_prefix('-') {
            Some(rest) if rest == axis => direction.with_text(axis),
            None if text == axis => direction.with_text(format!("-{axis}")),
            _ => direction.clone(),
        }
    }

    /// The tensor of inertia \[xx, yy, zz, xy, xz, yz\], whose products with the reversed axis change sign; moments are
    /// what they are.
    fn tensor(&self, inertia: &Node) -> Node {
        let items = inertia.items();
        if items.len() != 6 {
            return inertia.clone();
        }
        let pairs = [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]];
        let entry = |([a, b], item): ([usize; 2], &Node)| match a != b
            && (a == self.words.axis || b == self.words.axis)
        {
            true => negated(item),
            false => item.clone(),
        };
        Node {
            span: inertia.span,
            kind: NodeKind::List(pairs.into_iter().zip(items).map(entry).collect()),
        }
    }

    /// The image of meshes: the factor on the axis of the mirror has the other sign.
    fn mesh(&self, mesh: &Node) -> Node {
        let entry = |key: &str, value: Node| Entry {
            key: key.to_owned(),
            span: mesh.span,
            value,
        };
        let list = |items: Vec<Node>| Node {
            span: mesh.span,
            kind: NodeKind::List(items),
        };
        let mut image = match &mesh.kind {
            NodeKind::List(items) => {
                return list(items.iter().map(|item| self.mesh(item)).collect());
            }
            NodeKind::Map(_) => mesh.clone(),
            NodeKind::Scalar { .. } => Node {
                span: mesh.span,
                kind: NodeKind::Map(vec![entry("file", mesh.clone())]),
            },
        };
        self.frame(&mut image);
        let scale = match image.get("scale") {
            Some(scale) if !scale.items().is_empty() => scale.clone(),
            Some(scale) => list(vec![scale.clone(); 3]),
            None => list(vec![Node::plain("1", mesh.span); 3]),
        };
        image.set("scale", self.three(&scale, |axis, mirror| axis == mirror));
        image
    }

    /// The image of a point with a name.
    fn point(&self, point: &Node) -> Node {
        let mut image = point.clone();
        if let Some(name) = point.get("name").and_then(|n| self.image_name(n, "point")) {
            image.change("name", |n| n.with_text(name));
        }
        self.frame(&mut image);
        image
    }

    /// Turns the place and the axes of a frame into their images.
    fn frame(&self, frame: &mut Node) {
        frame.change("at", |n| self.polar(n));
        frame.change("angles", |n| match n.kind {
            // the one about y
            NodeKind::Scalar { .. } if self.words.axis != 1 => negated(n),
            NodeKind::Scalar { .. } => n.clone(),
            _ => self.three(n, |axis, mirror| axis != mirror),
        });
    }

    /// Three numbers, also in the plane, those of some axes negated.
    fn three(&self, list: &Node, which: impl Fn(usize, usize) -> bool) -> Node {
        let numbers = list.items().iter().enumerate();
        let numbers = numbers.map(|(axis, item)| match which(axis, self.words.axis) {
            true => negated(item),
            false => item.clone(),
        });
        Node {
            span: list.span,
            kind: NodeKind::List(numbers.collect()),
        }
    }

    /// A polar vector.
    pub(crate) fn polar(&self, vector: &Node) -> Node {
        match vector.kind {
            NodeKind::List(_) => self.reversed(vector, |axis, mirror| axis == mirror, negated),
            _ => vector.clone(),
        }
    }

    /// An axial vector: one component, about y, in the plane. Bryant angles change the same signs.
    pub(super) fn axial(&self, vector: &Node) -> Node {
        self.reversed(vector, |axis, mirror| axis != mirror, negated)
    }

    /// Negates a number or a function of time.
    pub(crate) fn negated_function(&self) -> impl Fn(&Node) -> Node + '_ {
        |function| {
            let is_curve = match &function.kind {
                NodeKind::Scalar { text, .. } => self.known.curves.contains_key(text.trim()),
                NodeKind::Map(_) => function.get("param").is_none(),
                NodeKind::List(_) => false,
            };
            if !is_curve {
                return negated(function);
            }
            let mut image = match function.get("curve") {
                Some(_) => function.clone(),
                None => Node {
                    span: function.span,
                    kind: NodeKind::Map(vec![Entry {
                        key: "curve".to_owned(),
                        span: function.span,
                        value: function.clone(),
                    }]),
                },
            };
            let one = Node::plain("1", function.span);
            let times = negated(image.get("times").unwrap_or(&one));
            image.set("times", times);
            image
        }
    }

    /// A vector, some components negated: of an axis, given the axis of the mirror.
    pub(crate) fn reversed(
        &self,
        vector: &Node,
        which: impl Fn(usize, usize) -> bool,
        negated: impl Fn(&Node) -> Node,
    ) -> Node {
        let mirror = self.words.axis;
        let NodeKind::List(items) = &vector.kind else {
            // one number, about y
            return match which(1, mirror) {
                true => negated(vector),
                false => vector.clone(),
            };
        };
        let axis = |index: usize| match (self.planar, items.len()) {
            (true, 1) => 1,
            (true, _) => 2 * index,
            (false, _) => index,
        };
        let component = |(index, item): (usize, &Node)| match which(axis(index), mirror) {
            true => negated(item),
            false => item.clone(),
        };
        Node {
            span: vector.span,
            kind: NodeKind::List(items.iter().enumerate().map(component).collect()),
        }
    }
}

/// A number with its sign changed: `0.1 m` → `-0.1 m`, `-a` → `a`, `a + b` → `-(a + b)`, `{ param: a }` → `-a`; zero
/// stays.
pub(super) fn negated(number: &Node) -> Node {
    if is_zero(number) {
        return number.clone();
    }
    let text = match (&number.kind, number.get("param")) {
        (NodeKind::Scalar { text, .. }, _) => text.trim(),
        (_, Some(name)) => {
            return Node::plain(format!("-{}", name.text().unwrap_or_default()), number.span);
        }
        _ => return number.clone(),
    };
    let (sign, rest) = match text.strip_prefix('-') {
        Some(rest) => ("", rest.trim_start()),
        None => ("-", text),
    };
    let behind = after_number(rest);
    let mut before = ' ';
    let is_sum = behind.chars().any(|c| {
        let operator = c == '+' || c == '-' && before != '^';
        before = c;
        operator
    });
    match is_sum {
        true => number.with_text(format!("-({text})")),
        false => number.with_text(format!("{sign}{rest}")),
    }
}

/// Whether a number is written as zero, with or without unit.
fn is_zero(number: &Node) -> bool {
    let Some(text) = number.text() else {
        return false;
    };
    let rest = after_number(text);
    let value = text[..text.len() - rest.len()].trim().parse::<f64>();
    value == Ok(0.0) && !rest.contains(['+', '-'])
}

/// The text behind the number that it begins with.
fn after_number(text: &str) -> &str {
    let numbers = (0..=text.len())
        .rev()
        .filter(|&end| text.is_char_boundary(end));
    let mut numbers = numbers.filter(|&end| {
        let head = &text[..end];
        head.ends_with(|c: char| c.is_ascii_digit() || c == '.') && head.parse::<f64>().is_ok()
    });
    numbers.next().map_or(text, |end| &text[end..])
}

/// A channel code of the other side: its seventh and eighth characters are LE or RI.
fn other_side(code: &str) -> String {
    let sides = [("LE", "RI"), ("RI", "LE")];
    let side = sides.iter().find(|(side, _)| code.get(6..8) == Some(side));
    match (side, code.get(..6), code.get(8..)) {
        (Some((_, other)), Some(before), Some(behind)) => format!("{before}{other}{behind}"),
        _ => code.to_owned(),
    }
}
