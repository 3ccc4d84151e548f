//! All numbers of a model.
//!
//! Every struct is destructured here without `..`, so that a new number does not compile until it is declared here.

use super::curve::ScaledCurve;
use super::joint::{Follows, Freedom};
use super::mechanism::Model;
use super::number::Number;
use super::output::Output;
use super::part::{Field, Part};
use super::quantity::{Leaf, Quantity};
use super::switch::{Switch, Trigger};
use super::system::{Element, Reference, System, Translation, Vehicle};

fn of_vehicle(vehicle: &mut Vehicle) -> Vec<&mut Number> {
    let Vehicle {
        name: _,
        position,
        velocity,
        translation,
        angles,
        angles_at_start,
    } = vehicle;
    let mut numbers = Vec::new();
    numbers.extend(position.iter_mut().chain(velocity).chain(angles_at_start));
    let curves = translation.curves.iter_mut().flat_map(Part::numbers);
    let angles = angles.iter_mut().flat_map(Part::numbers);
    numbers.extend(curves.chain(angles).map(|ruled| ruled.number));
    numbers
}

fn of_system(system: &mut System) -> Vec<&mut Number> {
    let System {
        name: _,
        elements,
        reference,
        position,
        velocity,
    } = system;
    let mut numbers = Vec::new();
    numbers.extend(elements.iter_mut().flat_map(of_element));
    numbers.extend(position.iter_mut().chain(velocity));
    match reference {
        Reference::Free | Reference::Fixed => {}
        Reference::Prescribed(translation) => {
            let curves = translation.curves.iter_mut().flat_map(Part::numbers);
            numbers.extend(curves.map(|ruled| ruled.number));
        }
        Reference::Riding { vehicle: _, at } => numbers.extend(at),
    }
    numbers
}

fn of_switch(switch: &mut Switch) -> Vec<&mut Number> {
    let Switch {
        name: _,
        trigger,
        after,
        shown: _,
    } = switch;
    let mut numbers = Vec::new();
    numbers.extend(after);
    match trigger {
        Trigger::Time(time) => numbers.push(time),
        Trigger::Above(quantity, threshold) | Trigger::Below(quantity, threshold) => {
            numbers.push(threshold);
            numbers.extend(of_quantity(quantity));
        }
    }
    numbers
}

impl Model {
    /// All numbers of the model.
    pub fn numbers_mut(&mut self) -> Vec<&mut Number> {
        let dimension = self.dimension;
        let Model {
            name: _,
            title: _,
            dimension: _,
            coordinates: _,
            parameters: _,
            curves: _,
            vehicles,
            systems,
            forces,
            switches,
            outputs,
            run: _,
            shown: _,
            units: _,
            digest: _,
        } = self;
        let mut numbers = Vec::new();
        numbers.extend(vehicles.iter_mut().flat_map(of_vehicle));
        numbers.extend(systems.iter_mut().flat_map(of_system));
        for force in forces {
            for field in force.law.fields(dimension) {
                match field {
                    Field::Body(_) => {}
                    Field::Number(_, _, number) => numbers.push(number),
                    // The borrow of a term lasts as long as that of the law.
                    Field::Term(_, part) => {
                        numbers.extend(part.numbers().into_iter().map(|ruled| ruled.number));
                    }
                }
            }
        }
        for Output {
            name: _,
            quantity,
            unit: _,
            code: _,
            filter: _,
            channel: _,
        } in outputs
        {
            numbers.extend(of_quantity(quantity));
        }
        numbers.extend(switches.iter_mut().flat_map(of_switch));
        numbers
    }

    /// All uses of curves.
    pub fn curve_uses_mut(&mut self) -> Vec<&mut ScaledCurve> {
        let dimension = self.dimension;
        let mut uses = Vec::new();
        for vehicle in &mut self.vehicles {
            uses.extend(of_translation(&mut vehicle.translation));
            uses.extend(vehicle.angles.iter_mut().flat_map(Part::curves));
        }
        for system in &mut self.systems {
            if let Reference::Prescribed(translation) = &mut system.reference {
                uses.extend(of_translation(translation));
            }
        }
        for force in &mut self.forces {
            for field in force.law.fields(dimension) {
                if let Field::Term(_, part) = field {
                    uses.extend(part.curves());
                }
            }
        }
        uses
    }
}

/// The curves of a prescribed motion.
fn of_translation(translation: &mut Translation) -> impl Iterator<Item = &mut ScaledCurve> {
    let Translation {
        given: _,
        curves,
        stops,
    } = translation;
    curves.iter_mut().chain([stops]).flatten()
}

fn of_quantity(quantity: &mut Quantity) -> Vec<&mut Number> {
    match quantity {
        Quantity::Point { at, .. } => at.iter_mut().collect(),
        Quantity::Formula(formula) => {
            let leaves = formula.leaves.iter_mut();
            let numbers = leaves.flat_map(|leaf| match leaf {
                Leaf::Number(number) => vec![number],
                Leaf::Quantity(quantity) => of_quantity(quantity),
            });
            numbers.collect()
        }
        Quantity::Rotation { .. }
        | Quantity::JointLoad { .. }
        | Quantity::ForceOn { .. }
        | Quantity::ForceOnPoints { .. }
        | Quantity::OfForce { .. }
        | Quantity::Freedom { .. }
        | Quantity::Switch { .. }
        | Quantity::System { .. } => Vec::new(),
    }
}

fn of_element(element: &mut Element) -> impl Iterator<Item = &mut Number> {
    let Element {
        name: _,
        parent: _,
        at,
        joint,
        mass,
        cg,
        inertia,
        axes,
        angles,
        angular_velocity,
        points,
    } = element;
    let vectors = [at, cg, inertia, axes, angles, angular_velocity];
    let freedoms = joint.freedoms_mut().iter_mut().flat_map(of_freedom);
    let points = points.iter_mut();
    let points = points.flat_map(|point| point.at.iter_mut().chain(&mut point.angles));
    let own = vectors.into_iter().flatten().chain([mass]);
    own.chain(freedoms).chain(points)
}

fn of_freedom(freedom: &mut Freedom) -> impl Iterator<Item = &mut Number> {
    let Freedom {
        name: _,
        kind,
        axis,
        zero,
        position,
        rate,
        armature,
        follows,
    } = freedom;
    let coupled = follows.iter_mut().flat_map(|follows| {
        let Follows {
            element: _,
            freedom: _,
            ratio,
            offset,
        } = follows;
        [ratio, offset]
    });
    let own = [zero, position, rate, armature];
    axis.iter_mut()
        .chain(own)
        .chain(kind.number_mut())
        .chain(coupled)
}
