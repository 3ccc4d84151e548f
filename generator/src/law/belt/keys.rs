//! The keys of a belt.

use crate::description::curve::Function;
use crate::description::expand::{Expander, Node};
use crate::description::force::Attachment;
use crate::description::place::At;
use crate::description::quantity::Quantity;
use crate::description::shape::{Key, record};
use crate::model::law::Law;
use crate::model::resolve::Resolver;
use crate::model::resolve::law::{Header, Keys, record};

record! {
    /// A belt between two points.
    Belt as "a belt" {
        /// Name, unique among the belts.
        belt: String,
        /// Whether it acts.
        enabled: Option<bool>,
        /// Acts from this switch on.
        since: Option<String>,
        /// Acts up to this switch.
        until: Option<String>,
        /// Whether it has a mirror image.
        mirror: Option<bool>,
        /// One end.
        from: Attachment,
        /// The other end.
        to: Attachment,
        /// The rings that it runs through on the way, in order from `from`.
        through: Option<Vec<Ring>>,
        /// Tension against relative elongation \[1\] → \[N\].
        force: Option<Function>,
        /// Its slope, where it is a line through 0 \[N\]; with a given length also \[N/m\].
        stiffness: Option<Quantity>,
        /// The same while it falls \[1\] → \[N\].
        unloading: Option<Function>,
        /// Slope of the line between the two \[N\].
        unloading_slope: Option<Quantity>,
        /// Initial distance of the ends less than the untensioned length \[m\].
        slack: Option<Quantity>,
        /// Tension at the start \[N\].
        pretension: Option<Quantity>,
        /// Untensioned length \[m\].
        length: Option<Quantity>,
        /// Viscous coefficient \[N s/m\].
        damping: Option<Quantity>,
        /// Stretch at which damping is fully there \[m\].
        damping_stretch: Option<Quantity>,
        /// Pays out webbing until it locks.
        retractor: Option<Retractor>,
        /// Takes webbing in once it fires.
        pretensioner: Option<Pretensioner>,
        /// Pays out webbing where the tension would pass a force.
        limiter: Option<Limiter>,
    }
}

record! {
    /// A ring that a belt slips through.
    Ring as "a ring" {
        /// Name, unique in its belt.
        ring: String,
        /// `frame`, a vehicle, or an element as `system/element`.
        on: String,
        /// The ring, local frame \[m\].
        at: Vec<Quantity>,
        /// Coefficient of friction.
        friction: Option<Quantity>,
        /// Resistance to slip beside friction \[N s/m\].
        resistance: Option<Quantity>,
    }
}

record! {
    /// A reel that pays out and takes in webbing until it locks.
    Retractor as "a retractor" {
        /// The switch that locks it.
        lock: String,
        /// Tension until then \[N\].
        spool: Option<Quantity>,
        /// Once locked: by what the tension exceeds the spool's while webbing tightens on the reel, against its length \[m\] → \[N\].
        film_spool: Option<Function>,
    }
}

record! {
    /// A device that takes webbing in.
    Pretensioner as "a pretensioner" {
        /// The switch that fires it.
        fire: String,
        /// Time from then until it begins to retract \[s\].
        delay: Option<Quantity>,
        /// Length taken in against the time since it began \[s\] → \[m\].
        retract: Function,
    }
}

record! {
    /// A device that pays out webbing under load.
    Limiter as "a limiter" {
        /// Largest tension \[N\].
        force: Quantity,
    }
}

impl Keys for Belt {
    const KEY: &'static str = "belt";
    const EXCHANGEABLE: Option<[&'static str; 2]> = Some(["from", "to"]);

    fn header(&self) -> Header<'_> {
        Header {
            name: self.belt.clone(),
            called: Some((Self::KEY, &self.belt)),
            enabled: self.enabled,
            since: self.since.as_deref(),
            until: self.until.as_deref(),
        }
    }

    fn check(&self, resolver: &mut Resolver<'_>, at: At<'_>) -> Option<Box<dyn Law>> {
        super::check::belt(resolver, self, at).map(|law| Box::new(law) as Box<dyn Law>)
    }

    fn records() -> Vec<(&'static str, &'static [Key])> {
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
