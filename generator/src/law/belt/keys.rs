//! The keys of a belt.

use super::check::{
    self, FilmSpool, FromZero, LimiterForce, RingName, Rings, Tension, UntensionedLength,
};
use crate::description::curve::FunctionOf;
use crate::description::force::{Acting, Attachment as End};
use crate::description::measure::{
    Force, ForcePerElongation, Length, LinearDamping, NotNegative, Positive, Pure, Time, Webbing,
};
use crate::description::quantity::Number;
use crate::description::shape::{Flat, record};
use crate::model::Attachment;
use crate::model::declared::{
    Checked, Coefficient, CurveOf, Declared, DeclaredLaw, Fade, HysteresisOf, OrDefault,
    PointOfBody, Reader, SwitchName, Written, declare,
};
use crate::model::resolve::law::{TitledKeys, record};

/// The keys of a belt.
pub type BeltKeys = Written<Belt>;

declare! {
    /// A belt between two points.
    Belt as "a belt" only written {
        /// name, unique among the belts
        belt: String,
        /// when it acts
        acting: Flat<Acting>,
        /// `true` adds its [mirror image](#a-mirror)
        mirror: Option<bool> = "`false`",
    } and kept {
        /// one [end](#an-attachment)
        from: Attachment,
        /// the other end, on another body
        to: Attachment,
        /// The rings that it runs through, in order from `from`.
        rings: Rings {
            /// the [rings](#a-ring) that it runs through, in order from `from`
            through: Option<Vec<Written<Ring>>>,
        },
        /// curve of the relative elongation
        force: Tension {
            /// instead of `force`: force per relative elongation, [a straight curve](#a-stiffness); with a given
            /// `length` also force per elongation
            stiffness: Option<Number<Positive<Webbing>>>,
        } as "elastic" = "required without `stiffness`",
        /// A different curve for unloading, against the relative elongation.
        hysteresis: HysteresisOf<Pure, Force, ForcePerElongation> {
            /// curve of the force during unloading, nowhere above `force`; see [hysteresis](#hysteresis)
            unloading: Option<FunctionOf<Pure, Force>>,
            /// slope of the line between the two curves
            unloading_slope: Option<Number<NotNegative<ForcePerElongation>>> = "ten times the steepest slope of `force`",
        } as "hysteresis" needs "it has no elastic force",
        /// Untensioned length L₀; not used with a retractor.
        length: UntensionedLength {
            /// L₀ is the initial distance of the ends plus this
            slack: Option<Number<NotNegative<Length>>> = "0",
            /// L₀ is such that the belt pulls with this force at the start; the curve must rise strictly from `[0, 0]`
            pretension: Option<Number<NotNegative<Force>>>,
            /// L₀ itself
            length: Option<Number<Positive<Length>>>,
        } as "length" needs "it has no elastic force",
        /// viscous coefficient on the rate of stretch L − L₀, while the belt is taut
        damping: Coefficient<NotNegative<LinearDamping>> = "0",
        /// damping grows in proportion to the stretch up to this one, so that no force jumps when the belt goes taut;
        /// 0: it acts in full at once
        damping_stretch: Fade<Length> as "damping fades in" needs "there is no damping" = "1 mm",
        /// [pays out webbing](#a-retractor) until it locks
        retractor: Option<Retractor> as "retractor" needs "it has no elastic force",
        /// Tension of the reel beyond that of the spool once the retractor has locked, against the webbing that has
        /// come off the reel since \[m\] → \[N\].
        film_spool: FilmSpool as "film spool" needs "there is no retractor",
        /// [takes webbing in](#a-pretensioner)
        pretensioner: Option<Pretensioner> as "pretensioner" needs "it has no elastic force",
        /// [pays out webbing](#a-limiter) under load
        limiter: LimiterForce as "limiter" needs "it has no elastic force",
    }
}

declare! {
    /// A ring that a belt slips through.
    Ring as "a ring" {
        /// Name, unique in the belt.
        name: RingName {
            /// name, unique in its belt
            ring: String,
        },
        /// `frame`, a vehicle, or an element as `system/element`
        on: PointOfBody {
            /// the ring, local frame
            at: Vec<Number<Length>>,
        },
        /// coefficient of friction μ: webbing slips if the tensions differ by more than the factor e^(μ θ)
        friction: Coefficient<NotNegative<Pure>> as "friction" needs "it has no elastic force" = "0",
        /// resistance to slip beside friction. The smaller it is, the nearer the tensions come to their ratio, and the
        /// smaller the steps must be
        resistance: OrDefault<Positive<LinearDamping>> = "50",
    }
}

impl Declared for Ring {}

declare! {
    /// A reel that pays out and takes in webbing until it locks.
    Retractor as "a retractor" {
        /// the [switch](#a-switch) that locks it
        lock: SwitchName,
        /// tension until then; the curve must rise strictly from `[0, 0]`
        spool: OrDefault<NotNegative<Force>> {
            /// webbing that tightens on the locked reel: the tension in excess of the spool tension against the webbing
            /// given, a curve from `[0, 0]` on that never falls. The reel takes the webbing back when the tension
            /// falls. Both happen under a resistance of 50 N·s/m
            film_spool: Option<FunctionOf<Length, Force>>,
        } = "0",
    }
}

impl Declared for Retractor {}

declare! {
    /// A device that takes webbing in.
    Pretensioner as "a pretensioner" {
        /// the [switch](#a-switch) that fires it
        fire: SwitchName,
        /// time from the switch until it begins
        delay: Coefficient<NotNegative<Time>> = "0",
        /// length of webbing taken in (L₀ decreases by it) against the time since it began; from `[0, 0]` on
        retract: Checked<CurveOf<Time, Length>, FromZero>,
    }
}

impl Declared for Pretensioner {}

record! {
    /// A device that pays out webbing under load.
    Limiter as "a limiter" {
        /// largest tension, including damping; the curve must rise strictly from `[0, 0]`
        force: Number<Positive<Force>>,
    }
}

impl DeclaredLaw for Belt {
    const KEY: &'static str = "belt";
    const EXCHANGEABLE: Option<[&'static str; 2]> = Some(["from", "to"]);
    const RECORDS: &'static [fn() -> TitledKeys] = &[
        record::<End>,
        record::<Written<Ring>>,
        record::<Written<Retractor>>,
        record::<Written<Pretensioner>>,
        record::<Limiter>,
    ];

    fn check_keys(_: &str, reader: &Reader<'_, '_, '_>) {
        check::check_keys(reader);
    }

    fn check(mut self, name: &str, reader: &mut Reader<'_, '_, '_>) -> Option<Self> {
        if self.damping.is_none() {
            self.damping_stretch = None;
        }
        check::check_bodies(reader, name, &self);
        check::check_tensions(reader, &self);
        Some(self)
    }
}
