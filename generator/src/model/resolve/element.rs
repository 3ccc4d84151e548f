//! Elements: one tree for each system, with carriers before what they carry, and realisable masses and moments of
//! inertia.

use super::coupling::couple;
use super::joint::joint_of;
use super::{NOWHERE, Resolver, name::Style};
use crate::description::element::{Element as Written, NamedPoint as WrittenPoint};
use crate::description::measure::Inertia;
use crate::description::place::At;
use crate::description::quantity::{Number as WrittenNumber, OneOrThree};
use crate::diagnostic::{quoted, suggestion};
use crate::model::requirement::ROUNDING;
use crate::model::{Element, NamedPoint, Number};
use crate::rotation::{bryant_angles, principal};
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};

/// The elements of a system: carriers before what they carry, otherwise in the order of the text.
pub(super) fn tree(
    resolver: &Resolver<'_>,
    system: &str,
    written: &[Written],
    list: At<'_>,
) -> Vec<Element> {
    if written.is_empty() {
        resolver.problems.add(list.problem(
            format!("the system {} has no elements", quoted(system)),
            "add at least one: `- { name: body, mass: 1 kg, cg: …, inertia: … }`",
        ));
        return Vec::new();
    }
    let mut index: HashMap<&str, usize> = HashMap::new();
    let mut identifiers: HashMap<String, usize> = HashMap::new();
    for (i, element) in written.iter().enumerate() {
        let place = list.item(i).key("name");
        resolver.check_name(&element.name, "an element", Style::Either, place);
        let identifier = super::name::identifier(&element.name);
        match identifiers.get(&identifier) {
            Some(&earlier) => {
                resolver.check_unique(
                    &element.name,
                    "elements",
                    [written[earlier].name.as_str()],
                    place,
                );
            }
            None => {
                identifiers.insert(identifier, i);
                index.insert(&element.name, i);
            }
        }
    }
    check_points(resolver, written, list);
    let parents = parents(resolver, system, written, &index, list);
    let order = parents_first(resolver, written, &parents, list);
    let mut place = vec![None; written.len()];
    for (new, &old) in order.iter().enumerate() {
        place[old] = Some(new);
    }
    let mut elements: Vec<Element> = order
        .iter()
        .map(|&i| {
            let parent = parents[i].and_then(|p| place[p]);
            element(resolver, system, &written[i], parent, list.item(i))
        })
        .collect();
    let joints: Vec<_> = (order.iter())
        .map(|&i| (written[i].joint.as_ref(), list.item(i).key("joint")))
        .collect();
    couple(resolver, system, &joints, &mut elements);
    elements
}

/// Index of the carrier of each element, in the order of the text. Reports carriers that do not exist, and second
/// roots.
fn parents(
    resolver: &Resolver<'_>,
    system: &str,
    written: &[Written],
    index: &HashMap<&str, usize>,
    list: At<'_>,
) -> Vec<Option<usize>> {
    let mut root: Option<&str> = None;
    let mut parents = Vec::with_capacity(written.len());
    for (i, element) in written.iter().enumerate() {
        let here = list.item(i);
        let Some(on) = &element.on else {
            if let Some(first) = root {
                resolver.problems.add(here.key("name").problem(
                    format!(
                        "the system {} has two roots: neither {} nor {} is on another element",
                        quoted(system),
                        quoted(first),
                        quoted(&element.name)
                    ),
                    format!("say which element carries {} (`on: …, at: …`), or make it a system of its own", quoted(&element.name)),
                ));
            }
            root = root.or(Some(&element.name));
            if element.at.is_some() {
                resolver.problems.add(here.key("at").key_problem(
                    format!(
                        "{} has a joint `at` but is not `on` another element",
                        quoted(&element.name)
                    ),
                    "add `on:`; a root is placed by the system's `start: { position: … }`",
                ));
            }
            parents.push(None);
            continue;
        };
        let parent = index.get(on.as_str()).copied();
        if parent.is_none() {
            let others = written
                .iter()
                .map(|e| e.name.as_str())
                .filter(|n| *n != element.name);
            resolver.problems.add(here.key("on").problem(
                format!(
                    "the carrier {} of element {} does not exist",
                    quoted(on),
                    quoted(&element.name)
                ),
                suggestion(
                    on,
                    others.collect::<Vec<_>>(),
                    "leave `on` out for the root of a system",
                ),
            ));
        }
        if element.at.is_none() {
            resolver.problems.add(here.key("on").key_problem(
                format!(
                    "the joint of element {} on {} has no place",
                    quoted(&element.name),
                    quoted(on)
                ),
                format!(
                    "add `at: {}`, the joint in the frame of {}",
                    if resolver.planar {
                        "[x, z]"
                    } else {
                        "[x, y, z]"
                    },
                    quoted(on)
                ),
            ));
        }
        parents.push(parent);
    }
    parents
}

/// An order in which every carrier precedes what it carries. Among the elements that may come next, the first in the
/// text is chosen.
fn parents_first(
    resolver: &Resolver<'_>,
    written: &[Written],
    parents: &[Option<usize>],
    list: At<'_>,
) -> Vec<usize> {
    let mut children = vec![Vec::new(); parents.len()];
    let mut ready = BinaryHeap::new();
    for (i, parent) in parents.iter().enumerate() {
        match parent {
            Some(parent) => children[*parent].push(i),
            None => ready.push(Reverse(i)),
        }
    }
    let mut order = Vec::with_capacity(parents.len());
    let mut placed = vec![false; parents.len()];
    while let Some(Reverse(i)) = ready.pop() {
        order.push(i);
        placed[i] = true;
        ready.extend(children[i].iter().map(|&c| Reverse(c)));
    }
    // the remaining elements hang on a cycle; each cycle is followed and reported once
    for start in 0..parents.len() {
        let mut trail = Vec::new();
        let mut at = start;
        while !placed[at] && !trail.contains(&at) {
            trail.push(at);
            let Some(parent) = parents[at] else { break };
            at = parent;
        }
        if let Some(first) = trail.iter().position(|&i| i == at).filter(|_| !placed[at]) {
            let mut cycle: Vec<&str> = trail[first..]
                .iter()
                .map(|&i| written[i].name.as_str())
                .collect();
            cycle.push(cycle[0]);
            let shown = if cycle.len() > 12 {
                [&cycle[..6], &["…"], &cycle[cycle.len() - 5..]].concat()
            } else {
                cycle
            };
            resolver.problems.add(list.item(at).key("on").problem(
                format!(
                    "elements carry each other in a circle: {}",
                    shown.join(" on ")
                ),
                "leave `on` and `at` out for the element that is the root",
            ));
        }
        for i in trail {
            placed[i] = true;
        }
    }
    order
}

/// The checked form of an element. Wrong values are replaced by zeros.
fn element(
    resolver: &Resolver<'_>,
    system: &str,
    written: &Written,
    parent: Option<usize>,
    here: At<'_>,
) -> Element {
    let mass = resolver.number(&written.mass, here.key("mass"));
    let tensor = tensor(resolver, &written.inertia, here.key("inertia"));
    let inertia = match &tensor {
        Some((moments, _)) => moments.clone(),
        None => resolver.rotation(&written.inertia, here.key("inertia")),
    };
    let axes = match &written.axes {
        None => tensor.map_or(NOWHERE, |(_, axes)| axes),
        Some(_) if tensor.is_some() => {
            resolver.problems.add(here.key("axes").key_problem(
                "six numbers of `inertia` have their principal axes in them",
                "remove the key `axes`, or give three principal moments",
            ));
            NOWHERE
        }
        Some(_) if resolver.planar => {
            resolver.problems.add(here.key("axes").key_problem(
                "principal axes have no meaning in the plane",
                "remove the key `axes`; `inertia` is the moment about the y axis",
            ));
            NOWHERE
        }
        Some(axes) => resolver.vector(axes, here.key("axes")),
    };
    let element = Element {
        name: written.name.clone(),
        parent,
        at: match (&written.at, &written.on) {
            (Some(at), Some(_)) => resolver.vector(at, here.key("at")),
            _ => NOWHERE,
        },
        joint: joint_of(resolver, written.joint.as_ref(), here.key("joint")),
        mass,
        cg: resolver.vector(&written.cg, here.key("cg")),
        inertia,
        axes,
        angles: NOWHERE,
        angular_velocity: NOWHERE,
        points: points(resolver, written.points.as_deref(), here.key("points")),
    };
    let owner = format!("{system}/{}", written.name);
    resolver.judge(element.requirements(&owner, resolver.dimension()), here);
    element
}

/// The frames of an element.
fn points(
    resolver: &Resolver<'_>,
    written: Option<&[WrittenPoint]>,
    list: At<'_>,
) -> Vec<NamedPoint> {
    let points = written.unwrap_or_default().iter().enumerate();
    let point = |(index, written): (usize, &WrittenPoint)| {
        let here = list.item(index);
        resolver.check_name(&written.name, "a point", Style::Either, here.key("name"));
        let (at, angles) = (written.at.as_ref(), written.angles.as_ref());
        NamedPoint {
            name: written.name.clone(),
            at: at.map_or(NOWHERE, |at| resolver.vector(at, here.key("at"))),
            angles: angles.map_or(NOWHERE, |of| resolver.rotation(of, here.key("angles"))),
        }
    };
    points.map(point).collect()
}

/// Reports points that have the name of an element or of another point.
fn check_points(resolver: &Resolver<'_>, written: &[Written], list: At<'_>) {
    let mut names: Vec<&str> = written.iter().map(|element| &*element.name).collect();
    for (i, element) in written.iter().enumerate() {
        for (k, point) in element.points.iter().flatten().enumerate() {
            let at = list.item(i).key("points").item(k).key("name");
            let earlier = names.iter().copied();
            resolver.check_unique(&point.name, "elements or points", earlier, at);
            names.push(&point.name);
        }
    }
}

/// Principal moments and Bryant angles of the principal axes of an inertia tensor of six numbers, in space; `None` if
/// `inertia` is not a list of six.
fn tensor(
    resolver: &Resolver<'_>,
    written: &OneOrThree<WrittenNumber<Inertia>>,
    here: At<'_>,
) -> Option<([Number; 3], [Number; 3])> {
    let OneOrThree::List(list) = written else {
        return None;
    };
    if resolver.planar || list.len() != 6 {
        return None;
    }
    let mut entries = [0.0; 6];
    for (index, entry) in entries.iter_mut().enumerate() {
        let place = here.item(index);
        match resolver.number(&list[index], place).constant() {
            Some(constant) => *entry = constant,
            None => resolver.problems.add(place.problem(
                "a tensor of six numbers cannot depend on parameters",
                "give three principal moments and `axes`, which can",
            )),
        }
    }
    let [xx, yy, zz, xy, xz, yz] = entries;
    let (moments, axes) = principal(&[[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]);
    // a rod has a moment of 0, which its tensor gives as ±1e-17, or as -1e-14 if it was written with twelve digits
    let largest = moments.iter().copied().fold(0.0, f64::max);
    let is_rounding = |m: f64| (-ROUNDING * largest..=1e-15 * largest).contains(&m);
    let clean = moments.map(|m| if is_rounding(m) { 0.0 } else { m });
    Some((
        clean.map(Number::from),
        bryant_angles(&axes).map(Number::from),
    ))
}
