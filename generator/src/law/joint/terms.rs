//! The terms of laws in a joint: of each rotation, of flexion and torsion, and of a freedom.

use super::check::{Bending, Freedom, Joint, JointTorque, Order};
use crate::model::declared::{Declaration, Names};
use crate::model::law::Terms;
use crate::model::part::{AXES, Field};
use crate::model::requirement::{Curves, List};
use crate::model::rule::Rule;
use crate::model::unloading;
use crate::model::{Body, Dimension, Number};

/// The condition on an elastic curve of a joint that has a hysteresis.
const RETURNS: &str =
    "must be 0 at the neutral angle and push back to it everywhere, to have a hysteresis";

impl Terms for Joint {
    fn add_fields<'a>(&'a mut self, dimension: Dimension, fields: &mut Vec<Field<'a>>) {
        let Joint {
            child,
            about,
            order: _,
            bending,
        } = self;
        fields.push(Field::Body(Body::Element(*child)));
        let names = Names::of_force(dimension);
        if let Some(bending) = bending {
            let Bending {
                axis: _,
                flexion,
                torsion,
            } = &mut **bending;
            flexion.add_fields(names.within(" of flexion", "flexion."), fields);
            torsion.add_fields(names.within(" of torsion", "torsion."), fields);
        }
        for (axis, law) in about.iter_mut().enumerate() {
            match dimension {
                Dimension::Space => {
                    let axis = AXES[axis];
                    let (about, below) = (format!(" about {axis}"), format!("about.{axis}."));
                    law.add_fields(names.within(&about, &below), fields);
                }
                Dimension::Plane if axis == 1 => law.add_fields(names, fields),
                Dimension::Plane => {}
            }
        }
    }

    fn settle_terms(&mut self) {
        let bent = self.bending.iter_mut();
        let bent = bent.flat_map(|b| [&mut b.flexion, &mut b.torsion]);
        self.about
            .iter_mut()
            .chain(bent)
            .for_each(JointTorque::settle);
        let nothing = JointTorque::default();
        let bends = |b: &Bending| b.flexion != nothing || b.torsion != nothing;
        if !self.bending.as_deref().is_some_and(bends) {
            self.bending = None;
        }
    }

    fn require(&self, dimension: Dimension, curves: Curves<'_>, list: &mut List<'_>) {
        for (axis, law) in self.about.iter().enumerate() {
            let below = match dimension {
                Dimension::Plane => String::new(),
                Dimension::Space => format!("about.{}.", AXES[axis]),
            };
            list.law(law, &below, curves);
        }
        if let Some(bending) = &self.bending {
            list.both_ways(&bending.flexion, "flexion.", curves);
            let to = bending.flexion.stop.as_ref().and_then(|s| s.to.as_ref());
            if let Some(to) = to {
                list.number("flexion.stop.to".into(), to, Rule::Positive);
            }
            list.law(&bending.torsion, "torsion.", curves);
        }
    }

    fn switches_mut(&mut self) -> Vec<&mut usize> {
        let torsion = self.bending.iter_mut().map(|b| &mut b.torsion);
        let laws = self.about.iter_mut().chain(torsion);
        laws.flat_map(JointTorque::locks_mut).collect()
    }

    fn flatten(&mut self) -> bool {
        self.about[0] = JointTorque::default();
        self.about[2] = JointTorque::default();
        self.order = Order::default();
        true
    }
}

impl Terms for Freedom {
    fn add_fields<'a>(&'a mut self, dimension: Dimension, fields: &mut Vec<Field<'a>>) {
        let Freedom {
            child,
            freedom: _,
            law,
        } = self;
        fields.push(Field::Body(Body::Element(*child)));
        law.add_fields(Names::of_force(dimension), fields);
    }

    fn settle_terms(&mut self) {
        self.law.settle();
    }

    fn require(&self, _: Dimension, curves: Curves<'_>, list: &mut List<'_>) {
        list.law(&self.law, "", curves);
    }

    fn switches_mut(&mut self) -> Vec<&mut usize> {
        self.law.locks_mut().collect()
    }

    fn flatten(&mut self) -> bool {
        true
    }
}

impl JointTorque {
    /// Index of the switch of the lock, if there is one.
    fn locks_mut(&mut self) -> impl Iterator<Item = &mut usize> {
        self.lock.iter_mut().map(|lock| &mut lock.by)
    }
}

impl List<'_> {
    /// Adds the conditions of the law of one coordinate of a joint.
    fn law(&mut self, law: &JointTorque, below: &str, curves: Curves<'_>) {
        self.stop(law, below);
        self.both_ways(law, below, curves);
    }

    /// Adds the conditions of a hysteresis on both sides of 0: on each side, the unloading curve must lie between 0 and
    /// the loading curve.
    fn both_ways(&mut self, law: &JointTorque, below: &str, curves: Curves<'_>) {
        let (Some(loading), Some(hysteresis)) = (&law.elastic, &law.hysteresis) else {
            return;
        };
        let Some(f) = curves(loading.curve) else {
            return;
        };
        self.steep((f, loading), hysteresis, below, curves);
        let u = hysteresis.unloading.as_ref();
        let u = u.and_then(|scaled| Some((curves(scaled.curve)?, scaled)));
        let nothing = unloading::nothing();
        let none = (&nothing, &unloading::unscaled());
        let ordered = match u {
            Some(u) => vec![
                (
                    u,
                    (f, loading),
                    "unloading",
                    "must lie between 0 and the elastic curve everywhere",
                ),
                (
                    none,
                    u,
                    "unloading",
                    "must lie between 0 and the elastic curve everywhere",
                ),
            ],
            None => vec![(none, (f, loading), "elastic", RETURNS)],
        };
        for (lower, upper, key, must) in ordered {
            let mirrored = [lower, upper].map(|(curve, _)| unloading::turned(curve));
            let sides = [
                unloading::clearances(lower, upper),
                unloading::clearances((&mirrored[0], lower.1), (&mirrored[1], upper.1)),
            ];
            for clearance in sides.into_iter().flatten() {
                self.together(
                    &format!("{below}{key}"),
                    must,
                    clearance,
                    Rule::NotNegative,
                    "let the torque be 0 at the neutral angle and push back to it everywhere; unloading gives back at most what loading took",
                );
            }
        }
    }

    fn stop(&mut self, law: &JointTorque, below: &str) {
        let Some(stop) = &law.stop else { return };
        if let (Some(from), Some(to)) = (&stop.from, &stop.to) {
            self.together(
                &format!("{below}stop.to"),
                "must be larger than `from`",
                Number::difference(to.clone(), from.clone()),
                Rule::Positive,
                "the rotation needs room between the ends; let `from` be smaller than `to`",
            );
        }
    }
}
