//! The keys of a belt.

use crate::description::curve::FunctionOf;
use crate::description::expand::{Expander, Node};
use crate::description::force::{Acting, Attachment};
use crate::description::measure::{Force, Length, LinearDamping, Pure, Time, Webbing};
use crate::description::place::At;
use crate::description::quantity::Number;
use crate::description::shape::{Flat, Key, record};
use crate::model::law::Law;
use crate::model::resolve::Resolver;
use crate::model::resolve::law::{Keys, record};

record! {
    /// A belt between two points.
    Belt as "a belt" {
        /// name, unique among the belts
        belt: String,
        /// when it acts
        acting: Flat<Acting>,
        /// `true` adds its [mirror image](#a-mirror)
        mirror: Option<bool> = "`false`",
        /// one [end](#an-attachment)
        from: Attachment,
        /// the other end, on another body
        to: Attachment,
        /// the [rings](#a-ring) that it runs through, in order from `from`
        through: Option<Vec<Ring>>,
        /// curve of the relative elongation
        force: Option<FunctionOf<Pure, Force>> = "required without `stiffness`",
        /// instead of `force`: force per relative elongation, [a straight curve](#a-stiffness); with a given `length`
        /// also force per elongation
        stiffness: Option<Number<Webbing>>,
        /// curve of the force during unloading, nowhere above `force`; see [hysteresis](#hysteresis)
        unloading: Option<FunctionOf<Pure, Force>>,
        /// slope of the line between the two curves
        unloading_slope: Option<Number<Force>> = "ten times the steepest slope of `force`",
        /// L₀ is the initial distance of the ends plus this
        slack: Option<Number<Length>> = "0",
        /// L₀ is such that the belt pulls with this force at the start; the curve must rise strictly from `[0, 0]`
        pretension: Option<Number<Force>>,
        /// L₀ itself
        length: Option<Number<Length>>,
        /// viscous coefficient on the rate of stretch L − L₀, while the belt is taut
        damping: Option<Number<LinearDamping>> = "0",
        /// damping grows in proportion to the stretch up to this one, so that no force jumps when the belt goes taut;
        /// 0: it acts in full at once
        damping_stretch: Option<Number<Length>> = "1 mm",
        /// [pays out webbing](#a-retractor) until it locks
        retractor: Option<Retractor>,
        /// [takes webbing in](#a-pretensioner)
        pretensioner: Option<Pretensioner>,
        /// [pays out webbing](#a-limiter) under load
        limiter: Option<Limiter>,
    }
}

record! {
    /// A ring that a belt slips through.
    Ring as "a ring" {
        /// name, unique in its belt
        ring: String,
        /// `frame`, a vehicle, or an element as `system/element`
        on: String,
        /// the ring, local frame
        at: Vec<Number<Length>>,
        /// coefficient of friction μ
        friction: Option<Number<Pure>> = "0",
        /// resistance to slip beside friction. The smaller it is, the nearer the tensions come to their ratio, and the
        /// smaller the steps must be
        resistance: Option<Number<LinearDamping>> = "50",
    }
}

record! {
    /// A reel that pays out and takes in webbing until it locks.
    Retractor as "a retractor" {
        /// the [switch](#a-switch) that locks it
        lock: String,
        /// tension until then; the curve must rise strictly from `[0, 0]`
        spool: Option<Number<Force>> = "0",
        /// webbing that tightens on the locked reel: the tension in excess of the spool tension against the webbing
        /// given, a curve from `[0, 0]` on that never falls. The reel takes the webbing back when the tension falls.
        /// Both happen under a resistance of 50 N·s/m
        film_spool: Option<FunctionOf<Length, Force>>,
    }
}

record! {
    /// A device that takes webbing in.
    Pretensioner as "a pretensioner" {
        /// the [switch](#a-switch) that fires it
        fire: String,
        /// time from the switch until it begins
        delay: Option<Number<Time>> = "0",
        /// length of webbing taken in (L₀ decreases by it) against the time since it began; from `[0, 0]` on
        retract: FunctionOf<Time, Length>,
    }
}

record! {
    /// A device that pays out webbing under load.
    Limiter as "a limiter" {
        /// largest tension, including damping; the curve must rise strictly from `[0, 0]`
        force: Number<Force>,
    }
}

impl Keys for Belt {
    const KEY: &'static str = "belt";
    const EXCHANGEABLE: Option<[&'static str; 2]> = Some(["from", "to"]);

    fn check(&self, resolver: &mut Resolver<'_>, at: At<'_>) -> Option<Box<dyn Law>> {
        super::check::belt(resolver, self, at).map(|law| Box::new(law) as Box<dyn Law>)
    }

    fn records() -> Vec<(&'static str, Vec<Key>)> {
        vec![
            record::<Belt>(),
            record::<Attachment>(),
            record::<Ring>(),
            record::<Retractor>(),
            record::<Pretensioner>(),
            record::<Limiter>(),
        ]
    }

    fn mirror(expander: &Expander<'_>, image: &mut Node) {
        for key in ["from", "to"] {
            image.change(key, |end| expander.mirrored_surface(end));
        }
        expander.mirrored_list(image, "through");
    }
}
