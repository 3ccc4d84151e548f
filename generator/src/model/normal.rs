//! The normal form of a model: parts that have no effect leave no trace.
//!
//! The normal form drops coefficients that are 0, curves that are 0 everywhere, forces without any term, curves that
//! nothing uses, parameters that no number mentions, and everything that had a meaning only together with these. So two
//! descriptions that differ only in such parts have the same model, the same digest and the same text.

use super::body::Body;
use super::dimension::Dimension;
use super::mechanism::Model;
use super::number::Number;
use super::part::Part;
use super::quantity::Quantity;
use super::switch::Active;
use super::system::{Given, Reference, Translation};

impl Model {
    /// Brings the model to its normal form.
    pub fn normalize(&mut self) {
        let dimension = self.dimension;
        if dimension == Dimension::Plane {
            // In the plane there is no choice.
            self.coordinates = super::Coordinates::Quaternion;
        }
        for number in self.numbers_mut() {
            unsigned_zero(number);
        }
        for force in &mut self.forces {
            force.law.settle(dimension);
        }
        for system in &mut self.systems {
            if let Reference::Prescribed(translation) = &mut system.reference {
                settle(translation);
                let still = system.velocity.iter().all(Number::is_zero);
                if still && translation.curves.iter().all(Option::is_none) {
                    system.reference = Reference::Fixed;
                }
            }
        }
        for vehicle in &mut self.vehicles {
            settle(&mut vehicle.translation);
            for angle in vehicle.angles.iter_mut().filter(|angle| !angle.is_in()) {
                angle.leave_out();
            }
        }
        self.forget_directions();
        self.drop_idle();
        self.keep_used_vehicles();
        self.keep_used_curves();
        self.keep_used_parameters();
        self.digest = self.sha256();
    }

    /// Resets axes of parts that are the same in all directions.
    fn forget_directions(&mut self) {
        let dimension = self.dimension;
        for element in self.systems.iter_mut().flat_map(|s| &mut s.elements) {
            let [x, y, z] = &element.inertia;
            if x == y && y == z {
                element.axes = [Number::ZERO; 3];
            }
        }
        for force in &mut self.forces {
            force.law.forget_directions(dimension);
        }
    }

    /// Drops forces that have no effect and that no output observes.
    fn drop_idle(&mut self) {
        let dimension = self.dimension;
        let acts = self.forces.iter().map(|f| f.law.acts(dimension));
        let mut keep: Vec<bool> = acts.collect();
        for (force, _) in self
            .forces
            .iter_mut()
            .zip(&keep)
            .filter(|(_, acts)| !**acts)
        {
            force.active = Active::default();
        }
        keep_used_switches(self);
        for force in looked_at(self).filter_map(Quantity::force_mut) {
            keep[*force] = true;
        }
        self.keep_forces(&keep);
    }

    /// Keeps some of the forces; these must include all that outputs observe.
    pub(crate) fn keep_forces(&mut self, keep: &[bool]) {
        let new = renumbered(keep);
        for force in looked_at(self).filter_map(Quantity::force_mut) {
            *force = new[*force];
        }
        retain(&mut self.forces, keep);
    }

    /// Drops vehicles that nothing refers to; the others keep their order.
    fn keep_used_vehicles(&mut self) {
        let mut used = vec![false; self.vehicles.len()];
        for_each_vehicle(self, &mut |vehicle| used[*vehicle] = true);
        let new = renumbered(&used);
        for_each_vehicle(self, &mut |vehicle| *vehicle = new[*vehicle]);
        self.shown.retain_mut(|shown| match shown.body_mut() {
            Body::Vehicle(vehicle) => {
                let is_used = used[*vehicle];
                *vehicle = new[*vehicle];
                is_used
            }
            _ => true,
        });
        retain(&mut self.vehicles, &used);
    }

    /// Drops curves that nothing uses; the others keep their order.
    fn keep_used_curves(&mut self) {
        let mut used = vec![false; self.curves.len()];
        for curve in self.curve_uses_mut() {
            used[curve.curve] |= curve.is_in();
        }
        let new = renumbered(&used);
        for curve in self.curve_uses_mut() {
            curve.curve = new[curve.curve];
        }
        retain(&mut self.curves, &used);
    }

    /// For each switch, true if a force waits for it, or an output or a used switch observes it.
    pub fn used_switches(&mut self) -> Vec<bool> {
        let mut used = vec![false; self.switches.len()];
        loop {
            let before = used.clone();
            for_each_switch(self, &before, &mut |switch| used[*switch] = true);
            if used == before {
                return used;
            }
        }
    }

    /// Drops parameters on which nothing depends, but no inputs, which a program sets in their order; the others keep
    /// their order.
    fn keep_used_parameters(&mut self) {
        let mut used: Vec<bool> = self.parameters.iter().map(|p| p.input).collect();
        for number in self.numbers_mut() {
            number.for_each_parameter(&mut |index| used[index] = true);
        }
        if used.iter().all(|&used| used) {
            return;
        }
        let new = renumbered(&used);
        for number in self.numbers_mut() {
            *number = number.with_parameters(&|index| Number::Parameter(new[index]));
        }
        retain(&mut self.parameters, &used);
    }
}

/// Visits every use of a vehicle.
fn for_each_vehicle(model: &mut Model, visit: &mut dyn FnMut(&mut usize)) {
    for system in &mut model.systems {
        if let Reference::Riding { vehicle, .. } = &mut system.reference {
            visit(vehicle);
        }
    }
    let mut body = |body: &mut Body| {
        if let Body::Vehicle(vehicle) = body {
            visit(vehicle);
        }
    };
    for force in &mut model.forces {
        force.law.bodies_mut().into_iter().for_each(&mut body);
    }
    for quantity in looked_at(model) {
        for body in quantity.bodies_mut() {
            if let Body::Vehicle(vehicle) = body {
                visit(vehicle);
            }
        }
    }
}

/// Replaces a prescribed motion without any curve by uniform motion, whatever its curves would have given.
fn settle(translation: &mut Translation) {
    for curve in translation.curves.iter_mut().filter(|curve| !curve.is_in()) {
        curve.leave_out();
    }
    if translation.curves.iter().all(Option::is_none) {
        translation.given = Given::Acceleration;
        translation.stops = None;
    }
}

/// The quantities that outputs and switches observe.
fn looked_at(model: &mut Model) -> impl Iterator<Item = &mut Quantity> {
    let outputs = model.outputs.iter_mut();
    let outputs = outputs.flat_map(|output| output.quantity.leaves_mut());
    let switches = model.switches.iter_mut();
    outputs.chain(switches.filter_map(|switch| switch.trigger.quantity_mut()))
}

/// Drops switches that are not used; the others keep their order.
fn keep_used_switches(model: &mut Model) {
    let used = model.used_switches();
    let mut kept = 0;
    let new: Vec<usize> = used
        .iter()
        .map(|&used| {
            kept += usize::from(used);
            kept.saturating_sub(1)
        })
        .collect();
    for_each_switch(model, &used, &mut |switch| *switch = new[*switch]);
    let mut flags = used.into_iter();
    model.switches.retain(|_| flags.next() == Some(true));
}

/// Visits every index of a switch in forces, in outputs, and in the triggers of used switches.
fn for_each_switch(model: &mut Model, used: &[bool], visit: &mut dyn FnMut(&mut usize)) {
    for force in &mut model.forces {
        let Active { since, until } = &mut force.active;
        since.iter_mut().chain(until).for_each(&mut *visit);
        force.law.switches_mut().into_iter().for_each(&mut *visit);
    }
    let outputs = model.outputs.iter_mut();
    let outputs = outputs.flat_map(|output| output.quantity.leaves_mut());
    let switches = model.switches.iter_mut().zip(used);
    let triggers = switches.filter_map(|(s, &used)| s.trigger.quantity_mut().filter(|_| used));
    for quantity in outputs.chain(triggers) {
        if let Quantity::Switch { switch, .. } = quantity {
            visit(switch);
        }
    }
}

/// Turns −0 into 0.
fn unsigned_zero(number: &mut Number) {
    if let Number::Constant(value) = number {
        *value += 0.0;
    }
}

/// For each entry, its index among those that are kept.
fn renumbered(keep: &[bool]) -> Vec<usize> {
    let mut next = 0;
    let number = |&kept: &bool| {
        let index = next;
        next += usize::from(kept);
        // Only a curve scaled by 0 refers to an entry that is not kept.
        if kept { index } else { 0 }
    };
    keep.iter().map(number).collect()
}

fn retain<T>(list: &mut Vec<T>, keep: &[bool]) {
    let mut keep = keep.iter();
    list.retain(|_| keep.next() == Some(&true));
}
