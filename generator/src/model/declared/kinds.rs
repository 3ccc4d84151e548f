//! The kinds of keys that several laws have.

use super::{Declared, Kind, Loading, Names, NoKey, Reader, Written};
use crate::description::curve::{FunctionOf, OverTime};
use crate::description::expand::{Expander, Node};
use crate::description::force::Attachment as End;
use crate::description::measure::{Angle, InPlace, LENGTH, Length, Measured, NotNegative, SPEED};
use crate::description::place::At;
use crate::description::point::Point;
use crate::description::quantity::{Number as WrittenNumber, OneOrThree, Quantity};
use crate::description::short_forms::ByName;
use crate::description::surface::Ellipsoid as WrittenEllipsoid;
use crate::model::body::{Attachment, Body};
use crate::model::dimension::Dimension;
use crate::model::part::{Field, Part, attachment, components, finite};
use crate::model::resolve::{NOWHERE, Resolver, hysteresis, surface};
use crate::model::rule::Rule;
use crate::model::{Bristle, Ellipsoid, FieldComponent, Friction, Hysteresis, Number, ScaledCurve};
use std::marker::PhantomData;

/// A coefficient, which is a term. One that is 0 counts as not written.
pub struct Coefficient<U>(PhantomData<U>);

impl<U: InPlace> Kind for Coefficient<U> {
    type Written = Option<WrittenNumber<U>>;
    type Kept = Option<Number>;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Self::Kept> {
        reader.coefficient::<U>(key)
    }

    fn add_fields<'a>(kept: &'a mut Self::Kept, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        to.push(Field::Term(names.term(U::RULE), kept));
    }
}

/// A number that may be absent, and is no term of its own.
pub struct Given<U>(PhantomData<U>);

impl<U: InPlace> Kind for Given<U> {
    type Written = Option<WrittenNumber<U>>;
    type Kept = Option<Number>;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Self::Kept> {
        reader.number::<U>(key)
    }

    fn add_fields<'a>(kept: &'a mut Self::Kept, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        to.extend(
            kept.iter_mut()
                .map(|number| Field::Number(names.path(), U::RULE, number)),
        );
    }
}

/// A number that must be written.
pub struct Required<U>(PhantomData<U>);

impl<U: InPlace> Kind for Required<U> {
    type Written = WrittenNumber<U>;
    type Kept = Number;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Number> {
        reader.number::<U>(key)?
    }

    fn add_fields<'a>(kept: &'a mut Number, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        to.push(Field::Number(names.path(), U::RULE, kept));
    }
}

/// The elastic law of a coordinate: a curve at its own key, or the slope of a straight one at the key `stiffness`,
/// which is declared behind it. A function of `X`, measured in `Y`; `S` is the slope.
pub struct Elastic<X, Y, S>(PhantomData<(X, Y, S)>);

impl<X: InPlace, Y: InPlace, S: InPlace> Kind for Elastic<X, Y, S> {
    type Written = Option<FunctionOf<X, Y>>;
    type Kept = Option<ScaledCurve>;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Self::Kept> {
        let curve: Self::Written = reader.written(key)?;
        let stiffness: Option<WrittenNumber<S>> = reader.written("stiffness")?;
        let slides = reader.slides;
        let elastic = reader.resolver.elastic_in(
            (key, curve.as_deref()),
            stiffness.as_deref(),
            reader.at,
            [
                X::expected(slides),
                Y::expected(slides),
                S::expected(slides),
            ],
        );
        reader.loading = Loading {
            key,
            curve: elastic.clone(),
        };
        Some(elastic)
    }

    fn add_fields<'a>(kept: &'a mut Self::Kept, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        let mut term = names.term(Rule::Finite);
        term.keys.push(format!("{}stiffness", names.below));
        to.push(Field::Term(term, kept));
    }
}

/// A point on a body.
impl Kind for Attachment {
    type Written = End;
    type Kept = Attachment;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Attachment> {
        let written: End = reader.written(key)?;
        reader.resolver.end(&written, reader.at.key(key))
    }

    fn add_fields<'a>(kept: &'a mut Attachment, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        attachment(kept, &format!("{}.at", names.path()), to);
    }

    fn add_bodies<'a>(kept: &'a mut Attachment, bodies: &mut Vec<&'a mut Body>) {
        bodies.push(&mut kept.on);
    }

    fn flatten(kept: &mut Attachment) {
        kept.at[1] = Number::ZERO;
    }

    fn mirror(expander: &Expander<'_>, record: &mut Node, key: &str) {
        record.change(key, |end| expander.mirrored_surface(end));
    }
}

/// Components along the absolute axes, each a number or a curve of time: a polar vector.
pub struct PolarVector<U>(PhantomData<U>);

/// Components about the absolute axes, each a number or a curve of time: an axial vector. In the plane there is one,
/// about y.
pub struct AxialVector<U>(PhantomData<U>);

/// No component.
fn nothing() -> [FieldComponent; 3] {
    [0; 3].map(|_| FieldComponent::Constant(Number::ZERO))
}

/// Reduces components to those that do not vanish in the plane: along x and z, or about y.
fn keep_in_plane(components: &mut [FieldComponent; 3], in_plane: fn(usize) -> bool) {
    for (axis, component) in components.iter_mut().enumerate() {
        if !in_plane(axis) {
            *component = FieldComponent::Constant(Number::ZERO);
        }
    }
}

/// Its terms are called by their axes alone, for a law that needs a vector consists of it.
impl<U: Measured> Kind for PolarVector<U> {
    type Written = Vec<OverTime<U>>;
    type Kept = [FieldComponent; 3];

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Self::Kept> {
        let written: Self::Written = reader.written(key)?;
        let at = reader.at.key(key);
        Some(reader.resolver.components(&written, at))
    }

    fn add_fields<'a>(kept: &'a mut Self::Kept, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        components(kept, "", &names.path(), names.dimension, to);
    }

    fn flatten(kept: &mut Self::Kept) {
        keep_in_plane(kept, |axis| axis != 1);
    }

    fn mirror(expander: &Expander<'_>, record: &mut Node, key: &str) {
        let turns = expander.negated_function();
        record.change(key, |vector| {
            expander.reversed(vector, |axis, mirror| axis == mirror, turns)
        });
    }
}

impl<U: Measured> Kind for Option<PolarVector<U>> {
    type Written = Option<Vec<OverTime<U>>>;
    type Kept = [FieldComponent; 3];

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Self::Kept> {
        match reader.has(key) {
            true => PolarVector::<U>::keep(reader, key),
            false => Some(nothing()),
        }
    }

    fn add_fields<'a>(kept: &'a mut Self::Kept, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        let name = format!("{} ", names.name);
        components(kept, &name, &names.path(), names.dimension, to);
    }

    fn flatten(kept: &mut Self::Kept) {
        PolarVector::<U>::flatten(kept);
    }

    fn mirror(expander: &Expander<'_>, record: &mut Node, key: &str) {
        PolarVector::<U>::mirror(expander, record, key);
    }
}

impl<U: Measured> Kind for Option<AxialVector<U>> {
    type Written = Option<OneOrThree<OverTime<U>>>;
    type Kept = [FieldComponent; 3];

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Self::Kept> {
        let written: Self::Written = reader.written(key)?;
        let at = reader.at.key(key);
        let mut kept = nothing();
        if let Some(written) = &written {
            for (axis, component, at) in reader.resolver.about_axes(written, at, U::EXPECTED) {
                kept[axis] = reader.resolver.component(component, at);
            }
        }
        Some(kept)
    }

    fn add_fields<'a>(kept: &'a mut Self::Kept, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        match names.dimension {
            Dimension::Plane => to.push(Field::Term(names.term(Rule::Finite), &mut kept[1])),
            Dimension::Space => {
                let name = format!("{} ", names.name);
                components(kept, &name, &names.path(), names.dimension, to);
            }
        }
    }

    fn flatten(kept: &mut Self::Kept) {
        keep_in_plane(kept, |axis| axis == 1);
    }

    fn mirror(expander: &Expander<'_>, record: &mut Node, key: &str) {
        let turns = expander.negated_function();
        record.change(key, |vector| {
            expander.reversed(vector, |axis, mirror| axis != mirror, turns)
        });
    }
}

/// A record that is a term, which may be absent.
impl<D: Declared> Kind for Option<D> {
    type Written = Option<Written<D>>;
    type Kept = Option<D>;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Option<D>> {
        let below = reader.below(key);
        Some(below.and_then(|mut reader| D::read(&mut reader)))
    }

    fn add_fields<'a>(kept: &'a mut Option<D>, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        to.push(Field::Term(names.term(Rule::Finite), kept));
    }

    fn add_switches<'a>(kept: &'a mut Option<D>, switches: &mut Vec<&'a mut usize>) {
        if let Some(record) = kept {
            record.add_switches(switches);
        }
    }
}

/// A body, and a point in its local frame at the key `at`, which is declared behind it.
pub struct PointOfBody;

impl Kind for PointOfBody {
    type Written = String;
    type Kept = Attachment;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Attachment> {
        let (on, at): (String, Vec<WrittenNumber<Length>>) =
            (reader.written(key)?, reader.written("at")?);
        let at = reader.resolver.vector(&at, reader.at.key("at"));
        let on = reader.resolver.body(&on, reader.at.key(key))?;
        Some(Attachment { on, at })
    }

    fn add_fields<'a>(kept: &'a mut Attachment, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        attachment(kept, &format!("{}at", names.below), to);
    }

    fn add_bodies<'a>(kept: &'a mut Attachment, bodies: &mut Vec<&'a mut Body>) {
        Attachment::add_bodies(kept, bodies);
    }

    fn flatten(kept: &mut Attachment) {
        Attachment::flatten(kept);
    }
}

/// Bryant angles: three in space, and one in the plane, about y.
pub struct Angles;

impl Kind for Angles {
    type Written = Option<OneOrThree<WrittenNumber<Angle>>>;
    type Kept = [Number; 3];

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<[Number; 3]> {
        let written: Self::Written = reader.written(key)?;
        let at = reader.at.key(key);
        Some(written.map_or(NOWHERE, |angles| reader.resolver.rotation(&angles, at)))
    }

    fn add_fields<'a>(kept: &'a mut [Number; 3], names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        finite(kept, &names.path(), to);
    }

    fn flatten(kept: &mut [Number; 3]) {
        (kept[0], kept[2]) = (Number::ZERO, Number::ZERO);
    }
}

/// The abscissa up to which the damping at the key `damping` grows from 0 to its full size; `None` for full damping at
/// once. It has a default where it is not written.
pub struct Fade<U>(PhantomData<U>);

impl<U: InPlace> Kind for Fade<U> {
    type Written = Option<WrittenNumber<NotNegative<U>>>;
    type Kept = Option<Number>;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Self::Kept> {
        reader.check_needs(
            key,
            &["damping"],
            "there is no damping to fade in",
            "add `damping: …`, or remove this key",
        );
        match reader.has(key) {
            true => reader.coefficient::<U>(key),
            false if U::expected(reader.slides).dimension == LENGTH.dimension => {
                Some(Some(FADING_LENGTH.into()))
            }
            false => Some(Some(FADING_ANGLE.into())),
        }
    }

    fn add_fields<'a>(kept: &'a mut Self::Kept, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        let term = names.term(Rule::NotNegative).only_as_written();
        to.push(Field::Term(term, kept));
    }
}

/// Length over which damping fades in, if the user gives none \[m\].
const FADING_LENGTH: f64 = 1e-3;

/// Angle over which damping fades in, if the user gives none: 1° \[rad\].
const FADING_ANGLE: f64 = std::f64::consts::PI / 180.0;

/// Coulomb friction: its limit `F` at its own key, and the speed `V` up to which it is proportional to speed at the
/// key `friction_speed`, which is declared behind it.
pub struct CoulombFriction<F, V>(PhantomData<(F, V)>);

/// Speed from which on friction has its full size, if the user gives none, where a length slides \[m/s\].
const SLIDING_SPEED: f64 = 0.01;

/// The same where an angle turns \[rad/s\].
const TURNING_SPEED: f64 = 0.1;

impl<F: InPlace, V: InPlace> Kind for CoulombFriction<F, V> {
    type Written = Option<WrittenNumber<NotNegative<F>>>;
    type Kept = Option<Friction>;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Self::Kept> {
        reader.check_needs(
            "friction_speed",
            &[key],
            "a friction speed means nothing without friction",
            "add `friction: …`, or remove `friction_speed`",
        );
        let slides = V::expected(reader.slides).dimension == SPEED.dimension;
        let usual = if slides { SLIDING_SPEED } else { TURNING_SPEED };
        let speed = reader.number::<V>("friction_speed")?;
        let limit = reader.coefficient::<F>(key)?;
        Some(limit.map(|limit| Friction {
            limit,
            tolerance: speed.unwrap_or(usual.into()),
        }))
    }

    fn add_fields<'a>(kept: &'a mut Self::Kept, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        to.push(Field::Term(names.term(Rule::NotNegative), kept));
    }
}

/// The bristle by which the friction at the key `friction` holds: its deflection at the key `friction_displacement`.
pub struct FrictionBristle<U>(PhantomData<U>);

impl<U: InPlace> Kind for FrictionBristle<U> {
    type Written = NoKey;
    type Kept = Option<Bristle>;

    fn keep(reader: &mut Reader<'_, '_, '_>, _: &'static str) -> Option<Self::Kept> {
        let key = "friction_displacement";
        reader.check_needs(
            key,
            &["friction"],
            "a friction displacement means nothing without friction",
            "add `friction: …`, or remove `friction_displacement`",
        );
        let displacement = reader.coefficient::<U>(key)?;
        Some(displacement.map(|displacement| Bristle { displacement }))
    }

    fn add_fields<'a>(kept: &'a mut Self::Kept, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        let names = names.of("friction_displacement", names.name, names.needs);
        to.push(Field::Term(names.term(Rule::Positive), kept));
    }
}

/// The hysteresis of the elastic law that was read last: the keys `unloading`, a function of `X` measured in `Y`, and
/// `unloading_slope`, measured in `S`.
pub struct HysteresisOf<X, Y, S>(PhantomData<(X, Y, S)>);

impl<X: InPlace, Y: InPlace, S: InPlace> Kind for HysteresisOf<X, Y, S> {
    type Written = NoKey;
    type Kept = Option<Hysteresis>;

    fn keep(reader: &mut Reader<'_, '_, '_>, _: &'static str) -> Option<Self::Kept> {
        let curve: Option<FunctionOf<X, Y>> = reader.written("unloading")?;
        let slope: Option<WrittenNumber<S>> = reader.written("unloading_slope")?;
        let (slides, loading) = (reader.slides, std::mem::take(&mut reader.loading));
        let written = hysteresis::Unloading {
            curve: curve.as_deref(),
            slope: slope.as_deref(),
            loading: (
                loading.key,
                reader.has(loading.key) || reader.has("stiffness"),
            ),
            at: reader.at,
            expected: [
                X::expected(slides),
                Y::expected(slides),
                S::expected(slides),
            ],
        };
        Some(reader.resolver.hysteresis(loading.curve.as_ref(), written))
    }

    fn add_fields<'a>(kept: &'a mut Self::Kept, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        let names = names.of("unloading", names.name, names.needs);
        let mut term = names.term(Rule::Finite);
        term.keys.push(format!("{}unloading_slope", names.below));
        to.push(Field::Term(term, kept));
    }
}

/// A number or a curve of time, which is a term; 0 counts as not written.
pub struct TermOverTime<U>(PhantomData<U>);

impl<U: InPlace> Kind for TermOverTime<U> {
    type Written = Option<OverTime<U>>;
    type Kept = Option<FieldComponent>;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Self::Kept> {
        let written: Self::Written = reader.written(key)?;
        let (at, expected) = (reader.at.key(key), U::expected(reader.slides));
        let kept = written.map(|value| reader.resolver.component_in(&value, at, expected));
        Some(kept.filter(Part::is_in))
    }

    fn add_fields<'a>(kept: &'a mut Self::Kept, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        let term = names.term(Rule::Finite).only_as_written();
        to.push(Field::Term(term, kept));
    }
}

/// A number or a curve of time that must be written.
pub struct RequiredOverTime<U>(PhantomData<U>);

impl<U: InPlace> Kind for RequiredOverTime<U> {
    type Written = OverTime<U>;
    type Kept = FieldComponent;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<FieldComponent> {
        let written: Self::Written = reader.written(key)?;
        let (at, expected) = (reader.at.key(key), U::expected(reader.slides));
        Some(reader.resolver.component_in(&written, at, expected))
    }

    fn add_fields<'a>(kept: &'a mut FieldComponent, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        to.push(Field::Term(names.term(Rule::Finite), kept));
    }
}

/// A switch by its name: an index into [`Model::switches`](crate::model::Model::switches).
pub struct SwitchName;

impl Kind for SwitchName {
    type Written = String;
    type Kept = usize;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<usize> {
        let name: String = reader.written(key)?;
        reader.resolver.switch_id(&name, reader.at.key(key))
    }

    fn add_switches<'a>(kept: &'a mut usize, switches: &mut Vec<&'a mut usize>) {
        switches.push(kept);
    }
}

/// An ellipsoid of a body, in place or by its name. Its degree is not kept.
impl Kind for Ellipsoid {
    type Written = ByName<WrittenEllipsoid>;
    type Kept = Ellipsoid;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Ellipsoid> {
        let written: Self::Written = reader.written(key)?;
        surface::ellipsoid(reader.resolver, &written, reader.at.key(key))
    }

    fn add_fields<'a>(kept: &'a mut Ellipsoid, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        let Ellipsoid {
            center,
            semi_axes,
            axes,
        } = kept;
        let key = names.path();
        attachment(center, &format!("{key}.center"), to);
        for (axis, number) in semi_axes.iter_mut().enumerate() {
            // in the plane the second semi-axis is not used
            let (place, rule) = match (names.dimension, axis) {
                (Dimension::Space, _) => (axis, Rule::Positive),
                (Dimension::Plane, 1) => (axis, Rule::Finite),
                (Dimension::Plane, _) => (axis / 2, Rule::Positive),
            };
            to.push(Field::Number(
                format!("{key}.semi_axes[{place}]"),
                rule,
                number,
            ));
        }
        finite(axes, &format!("{key}.axes"), to);
    }

    fn add_bodies<'a>(kept: &'a mut Ellipsoid, bodies: &mut Vec<&'a mut Body>) {
        bodies.push(&mut kept.center.on);
    }

    fn flatten(kept: &mut Ellipsoid) {
        kept.center.at[1] = Number::ZERO;
        kept.semi_axes[1] = Number::ZERO;
        Angles::flatten(&mut kept.axes);
    }

    fn mirror(expander: &Expander<'_>, record: &mut Node, key: &str) {
        record.change(key, |surface| expander.mirrored_by_name(surface));
    }
}

/// Ellipsoids of bodies.
impl Kind for Vec<Ellipsoid> {
    type Written = Vec<ByName<WrittenEllipsoid>>;
    type Kept = Vec<Ellipsoid>;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Vec<Ellipsoid>> {
        let written: Self::Written = reader.written(key)?;
        let list = reader.at.key(key);
        let each = written.iter().enumerate();
        let all: Vec<Option<Ellipsoid>> = each
            .map(|(index, one)| surface::ellipsoid(reader.resolver, one, list.item(index)))
            .collect();
        all.into_iter().collect()
    }

    fn add_fields<'a>(kept: &'a mut Vec<Ellipsoid>, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        for (index, ellipsoid) in kept.iter_mut().enumerate() {
            let below = format!("{}[{index}]", names.path());
            Ellipsoid::add_fields(ellipsoid, &names.within("", &below).of("", "", ""), to);
        }
    }

    fn add_bodies<'a>(kept: &'a mut Vec<Ellipsoid>, bodies: &mut Vec<&'a mut Body>) {
        bodies.extend(kept.iter_mut().map(|ellipsoid| &mut ellipsoid.center.on));
    }

    fn mirror(expander: &Expander<'_>, record: &mut Node, key: &str) {
        expander.mirrored_list(record, key);
    }
}

/// A number that has a default, which is that of the declaration.
pub struct OrDefault<U>(PhantomData<U>);

impl<U: InPlace> Kind for OrDefault<U> {
    type Written = Option<WrittenNumber<U>>;
    type Kept = Number;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Number> {
        let written: Self::Written = reader.written(key)?;
        let expected = U::expected(reader.slides);
        let default = Quantity::Text(reader.default.to_owned());
        let number = written.as_deref().unwrap_or(&default);
        Some(
            reader
                .resolver
                .number_in(number, reader.at.key(key), expected),
        )
    }

    fn add_fields<'a>(kept: &'a mut Number, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        to.push(Field::Number(names.path(), U::RULE, kept));
    }
}

/// A record that is always there; where it is not written, all of its keys have their defaults.
pub struct Present<D>(PhantomData<D>);

impl<D: Declared> Kind for Present<D> {
    type Written = Option<Written<D>>;
    type Kept = D;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<D> {
        match reader.has(key) {
            true => D::read(&mut reader.below(key)?),
            false => D::read(&mut reader.without_keys()),
        }
    }

    fn add_fields<'a>(kept: &'a mut D, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        kept.add_fields(names.within("", &format!("{}.", names.path())), to);
    }
}

/// A curve that must be written: a function of `X`, measured in `Y`. `Option<CurveOf<X, Y>>` is one that may be absent,
/// a term.
pub struct CurveOf<X, Y>(PhantomData<(X, Y)>);

impl<X: Measured, Y: Measured> Kind for CurveOf<X, Y> {
    type Written = FunctionOf<X, Y>;
    type Kept = ScaledCurve;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<ScaledCurve> {
        let written: Self::Written = reader.written(key)?;
        reader.resolver.function(&written, reader.at.key(key))
    }

    fn add_fields<'a>(kept: &'a mut ScaledCurve, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        to.push(Field::Term(names.term(Rule::Finite), kept));
    }
}

impl<X: Measured, Y: Measured> Kind for Option<CurveOf<X, Y>> {
    type Written = Option<FunctionOf<X, Y>>;
    type Kept = Option<ScaledCurve>;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Self::Kept> {
        let written: Self::Written = reader.written(key)?;
        let at = reader.at.key(key);
        Some(written.and_then(|curve| reader.resolver.function(&curve, at)))
    }

    fn add_fields<'a>(kept: &'a mut Self::Kept, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        to.push(Field::Term(names.term(Rule::Finite), kept));
    }
}

/// A condition on what is kept of a key.
pub trait Condition<T> {
    /// Reports a value that does not keep it, which is written at `at`.
    fn check(kept: &T, resolver: &Resolver<'_>, at: At<'_>);
}

/// `K` under the condition `C`.
pub struct Checked<K, C>(PhantomData<(K, C)>);

impl<K: Kind, C: Condition<K::Kept>> Kind for Checked<K, C> {
    type Written = K::Written;
    type Kept = K::Kept;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<K::Kept> {
        let kept = K::keep(reader, key)?;
        C::check(&kept, reader.resolver, reader.at.key(key));
        Some(kept)
    }

    fn add_fields<'a>(kept: &'a mut K::Kept, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        K::add_fields(kept, names, to);
    }
}

/// An element, and a point of it at the key `at`, which is declared behind it; by default its joint.
pub struct PointOfElement;

impl Kind for PointOfElement {
    type Written = String;
    type Kept = Attachment;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Attachment> {
        let path: String = reader.written(key)?;
        let place = reader.at.key(key);
        if path == "frame" {
            let (law, _) = reader.resolver.owner.split_once(' ').unwrap_or_default();
            reader.resolver.problems.add(place.problem(
                format!("a {law} on the absolute frame moves nothing"),
                "name an element, as `system/element`",
            ));
            return None;
        }
        let element = reader.resolver.element_id(&path, place)?;
        let point: Option<Point> = reader.written("at")?;
        let place = reader.at.key("at");
        Some(Attachment {
            on: Body::Element(element),
            at: point.map_or(NOWHERE, |point| {
                reader.resolver.point(&point, element, place)
            }),
        })
    }

    fn add_fields<'a>(kept: &'a mut Attachment, _: &Names<'_>, to: &mut Vec<Field<'a>>) {
        attachment(kept, "at", to);
    }

    fn add_bodies<'a>(kept: &'a mut Attachment, bodies: &mut Vec<&'a mut Body>) {
        Attachment::add_bodies(kept, bodies);
    }

    fn flatten(kept: &mut Attachment) {
        Attachment::flatten(kept);
    }

    fn mirror(expander: &Expander<'_>, record: &mut Node, key: &str) {
        record.change(key, |element| expander.body(element));
        record.change("at", |point| expander.polar(point));
    }
}
