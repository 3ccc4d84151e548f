//! The keys of a bushing.

use crate::description::expand::{Expander, Node};
use crate::description::force::Acting;
use crate::description::measure::{
    AngularDamping, AngularStiffness, Displacement, Effort, EffortPerCoordinate, EffortPerRate,
    Length, NotNegative,
};
use crate::description::quantity::Number;
use crate::description::shape::{Flat, record};
use crate::diagnostic::quoted;
use crate::model::declared::{
    Angles, Coefficient, Declaration, Declared, DeclaredLaw, Elastic, Kind, Names, NoKey,
    PointOfBody, Reader, Written, declare, declared_terms,
};
use crate::model::law::Terms;
use crate::model::part::{AXES, Field};
use crate::model::resolve::law::{TitledKeys, record};
use crate::model::{Body, Dimension};

/// The keys of a bushing.
pub type BushingKeys = Written<Bushing>;

declare! {
    /// Springs and dampers in six directions between frames of two bodies.
    Bushing as "a bushing" only written {
        /// name, unique among the bushings
        bushing: String,
        /// when it acts
        acting: Flat<Acting>,
        /// `true` adds its [mirror image](#a-mirror)
        mirror: Option<bool> = "`false`",
    } and kept {
        /// the [frame](#an-end-of-a-bushing) in whose axes the laws are
        from: Mount,
        /// the frame that moves against it, on another body
        to: Mount,
        /// laws of the displacement [by axis](#the-directions-of-a-bushing); in the plane `x` and `z`
        along: AlongAxes,
        /// [laws of the rotation](#the-rotations-of-a-bushing): of the Bryant angles by axis, or of the whole; in the
        /// plane `y`
        about: AboutAxes,
        /// law of the angle of the whole rotation about its axis, in space; it excludes laws of Bryant angles
        turn: AboutAll,
    }
}

declare! {
    /// A frame on a body.
    Mount as "an end of a bushing" {
        /// `frame`, a vehicle, or an element as `system/element`
        on: PointOfBody {
            /// its origin, local frame
            at: Vec<Number<Length>>,
        },
        /// Bryant angles of its axes relative to the local frame; one angle about y in the plane
        axes: Angles = "0",
    }
}

record! {
    /// A law for each axis.
    Directions as "the directions of a bushing" {
        /// the [law](#a-direction-of-a-bushing) along x
        x: Option<Written<Direction>>,
        /// along y
        y: Option<Written<Direction>>,
        /// along z
        z: Option<Written<Direction>>,
    }
}

record! {
    /// A law for each Bryant angle, or one of the rotation as a whole.
    Rotations as "the rotations of a bushing" {
        /// the [law](#a-direction-of-a-bushing) of the Bryant angle about x
        x: Option<Written<Direction>>,
        /// about y
        y: Option<Written<Direction>>,
        /// about z
        z: Option<Written<Direction>>,
        /// in their place: the [law](#the-law-of-a-whole-rotation) of the angle of the whole rotation, about whatever
        /// axis it is
        turn: Option<Turn>,
    }
}

record! {
    /// The law of the angle of the whole rotation.
    Turn as "the law of a whole rotation" {
        /// moment by the angle
        stiffness: Option<Number<NotNegative<AngularStiffness>>>,
        /// viscous coefficient on the relative angular velocity
        damping: Option<Number<NotNegative<AngularDamping>>> = "0",
    }
}

declare! {
    /// The law of one direction.
    #[derive(Default)]
    Direction as "a direction of a bushing" {
        /// curve of the displacement or the angle
        elastic: Elastic<Displacement, Effort, EffortPerCoordinate> {
            /// in its place: [a straight curve](#a-stiffness)
            stiffness: Option<Number<NotNegative<EffortPerCoordinate>>>,
        },
        /// viscous coefficient on its rate
        damping: Coefficient<NotNegative<EffortPerRate>> = "0",
    }
}

impl Declared for Direction {}

impl DeclaredLaw for Bushing {
    const KEY: &'static str = "bushing";
    const RECORDS: &'static [fn() -> TitledKeys] = &[
        record::<Written<Mount>>,
        record::<Directions>,
        record::<Rotations>,
        record::<Turn>,
        record::<Written<Direction>>,
    ];

    fn check(self, name: &str, reader: &mut Reader<'_, '_, '_>) -> Option<Self> {
        if self.from.on.on == self.to.on.on {
            reader.resolver.problems.add(reader.at.key("to").problem(
                format!("both ends of bushing {} are on the same body", quoted(name)),
                "a bushing stands between two bodies; `frame` is the absolute frame",
            ));
        }
        Some(self)
    }
}

impl Terms for Bushing {
    declared_terms!();

    fn flatten(&mut self) -> bool {
        if self.turn != Direction::default() {
            self.about[1] = std::mem::take(&mut self.turn);
        }
        Declaration::flatten(self);
        true
    }
}

/// An end of a bushing.
impl Kind for Mount {
    type Written = Written<Mount>;
    type Kept = Mount;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Mount> {
        Declaration::keep(&mut reader.below(key)?)
    }

    fn add_fields<'a>(kept: &'a mut Mount, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        kept.add_fields(names.within("", &format!("{}.", names.path())), to);
    }

    fn add_bodies<'a>(kept: &'a mut Mount, bodies: &mut Vec<&'a mut Body>) {
        kept.add_bodies(bodies);
    }

    fn flatten(kept: &mut Mount) {
        Declaration::flatten(kept);
    }

    fn mirror(expander: &Expander<'_>, record: &mut Node, key: &str) {
        record.change(key, |end| expander.mirrored_surface(end));
    }
}

/// Laws of the displacement along each axis; in the plane the first and third are used.
pub struct AlongAxes;

/// Laws of the rotation, one for each Bryant angle; in the plane the second is used.
pub struct AboutAxes;

/// The law of the angle φ of the whole rotation about its axis, in space. It stands among those of Bryant angles.
pub struct AboutAll;

impl Kind for AlongAxes {
    type Written = Option<Directions>;
    type Kept = [Direction; 3];

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<[Direction; 3]> {
        reader.slides = true;
        let laws = directions(reader, key, |axis| axis != 1);
        reader.slides = false;
        Some(laws)
    }

    fn add_fields<'a>(kept: &'a mut [Direction; 3], names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        add_directions(kept, names, |axis| axis != 1, to);
    }

    fn flatten(kept: &mut [Direction; 3]) {
        kept[1] = Direction::default();
    }

    fn mirror(expander: &Expander<'_>, record: &mut Node, key: &str) {
        mirror_laws(expander, record, key, |axis| expander.reverses(axis));
    }
}

impl Kind for AboutAxes {
    type Written = Option<Rotations>;
    type Kept = [Direction; 3];

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<[Direction; 3]> {
        Some(directions(reader, key, |axis| axis == 1))
    }

    fn flatten(kept: &mut [Direction; 3]) {
        (kept[0], kept[2]) = Default::default();
    }

    fn add_fields<'a>(kept: &'a mut [Direction; 3], names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        add_directions(kept, names, |axis| axis == 1, to);
    }

    fn mirror(expander: &Expander<'_>, record: &mut Node, key: &str) {
        mirror_laws(expander, record, key, |axis| !expander.reverses(axis));
    }
}

impl Kind for AboutAll {
    type Written = NoKey;
    type Kept = Direction;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Direction> {
        let Some(mut about) = reader.below("about") else {
            return Some(Direction::default());
        };
        let single = AXES.iter().any(|axis| about.has(axis));
        let Some(mut law) = about.below(key) else {
            return Some(Direction::default());
        };
        if law.resolver.planar {
            law.resolver.problems.add(law.at.key_problem(
                "in the plane a rotation has one angle, that about y",
                "write `about: { y: … }`",
            ));
            return Some(Direction::default());
        }
        if single {
            law.resolver.problems.add(law.at.key_problem(
                "there are a law of the whole rotation and laws about single axes",
                "keep `turn`, the same law about any axis, or `x`, `y` and `z`, a law for each Bryant angle",
            ));
        }
        // its keys are among those of a direction
        Direction::read(&mut law)
    }

    fn add_fields<'a>(kept: &'a mut Direction, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        if names.dimension == Dimension::Space {
            kept.add_fields(names.within(" about turn", "about.turn."), to);
        }
    }
}

/// The laws at a key, one for each axis. `in_plane` tells which axes a planar model has.
fn directions(
    reader: &mut Reader<'_, '_, '_>,
    key: &str,
    in_plane: fn(usize) -> bool,
) -> [Direction; 3] {
    let mut laws: [Direction; 3] = Default::default();
    let Some(mut written) = reader.below(key) else {
        return laws;
    };
    for (axis, law) in laws.iter_mut().enumerate() {
        let Some(mut reader) = written.below(AXES[axis]) else {
            continue;
        };
        if reader.resolver.planar && !in_plane(axis) {
            reader.resolver.problems.add(reader.at.key_problem(
                "in the plane nothing moves along y, nor turns about x and z",
                "a planar bushing has `along: { x: …, z: … }` and `about: { y: … }`",
            ));
            continue;
        }
        *law = Direction::read(&mut reader).unwrap_or_default();
    }
    laws
}

/// Adds the terms of the laws of all axes that exist.
fn add_directions<'a>(
    laws: &'a mut [Direction; 3],
    names: &Names<'_>,
    in_plane: fn(usize) -> bool,
    to: &mut Vec<Field<'a>>,
) {
    for (axis, law) in laws.iter_mut().enumerate() {
        if names.dimension == Dimension::Space || in_plane(axis) {
            let (key, axis) = (names.key, AXES[axis]);
            let (about, below) = (format!(" {key} {axis}"), format!("{key}.{axis}."));
            law.add_fields(names.within(&about, &below), to);
        }
    }
}

/// Mirrors the laws of the axes whose coordinate changes its sign. The frames of the image are images, too: these are
/// the displacement along the reversed axis and the angles about the two others. The angle of the whole rotation stays.
fn mirror_laws(
    expander: &Expander<'_>,
    record: &mut Node,
    key: &str,
    turns: impl Fn(usize) -> bool,
) {
    for (axis, name) in AXES.into_iter().enumerate() {
        let laws = record.get_mut(key).filter(|_| turns(axis));
        if let Some(law) = laws.and_then(|laws| laws.get_mut(name)) {
            expander.mirror_law(law);
        }
    }
}
