//! The normal form of a model: what is not there leaves nothing behind.
//!
//! A coefficient that is 0, a curve that is 0 everywhere, a force all of whose terms are out, a curve that nothing uses
//! and a parameter that no number mentions are dropped, and so is what they alone gave a meaning: two descriptions that
//! differ in nothing but such mentions have one model, one digest, and one text.

use super::part::Part;
use super::{Active, Body, Dimension, Given, Model, Number, Quantity, Reference, Translation};

impl Model {
    /// Brings the model to its normal form.
    pub fn normalize(&mut self) {
        let dimension = self.dimension;
        if dimension == Dimension::Plane {
            // There is no choice.
            self.coordinates = super::Coordinates::Quaternion;
        }
        for number in self.numbers_mut() {
            unsigned_zero(number);
        }
        for force in &mut self.forces {
            force.kind.settle(dimension);
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

    /// Axes of what is the same in all directions say nothing.
    fn forget_directions(&mut self) {
        let dimension = self.dimension;
        for element in self.systems.iter_mut().flat_map(|s| &mut s.elements) {
            let [x, y, z] = &element.inertia;
            if x == y && y == z {
                element.axes = [Number::ZERO; 3];
            }
        }
        for force in &mut self.forces {
            force.kind.forget_directions(dimension);
        }
    }

    /// Drops forces that do nothing and that no output looks at.
    fn drop_idle(&mut self) {
        let dimension = self.dimension;
        let acts = self.forces.iter().map(|f| f.kind.acts(dimension));
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

    /// Keeps some of the forces, at least those that outputs look at.
    pub(crate) fn keep_forces(&mut self, keep: &[bool]) {
        let new = renumbered(keep);
        for force in looked_at(self).filter_map(Quantity::force_mut) {
            *force = new[*force];
        }
        retain(&mut self.forces, keep);
    }

    /// Drops the vehicles that nothing uses; those left keep their order.
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

    /// Drops the curves that nothing uses; those left keep their order.
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

    /// By switch, whether something waits for it or looks at it.
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

    /// Drops the parameters on which nothing depends; those left keep their order.
    fn keep_used_parameters(&mut self) {
        let mut used = vec![false; self.parameters.len()];
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
        force.kind.bodies_mut().into_iter().for_each(&mut body);
    }
    for quantity in looked_at(model) {
        for body in quantity.bodies_mut() {
            if let Body::Vehicle(vehicle) = body {
                visit(vehicle);
            }
        }
    }
}

/// A motion whose curves are out is uniform, whatever they would have given.
fn settle(translation: &mut Translation) {
    for curve in translation.curves.iter_mut().filter(|curve| !curve.is_in()) {
        curve.leave_out();
    }
    if translation.curves.iter().all(Option::is_none) {
        translation.given = Given::Acceleration;
        translation.stops = None;
    }
}

/// What outputs and switches look at.
fn looked_at(model: &mut Model) -> impl Iterator<Item = &mut Quantity> {
    let outputs = model.outputs.iter_mut();
    let outputs = outputs.flat_map(|output| output.quantity.leaves_mut());
    let switches = model.switches.iter_mut();
    outputs.chain(switches.filter_map(|switch| switch.trigger.quantity_mut()))
}

/// Drops the switches that nothing waits for; those left keep their order.
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

/// Every index of a switch in forces, outputs, and the triggers of the switches in use.
fn for_each_switch(model: &mut Model, used: &[bool], visit: &mut dyn FnMut(&mut usize)) {
    for force in &mut model.forces {
        let Active { since, until } = &mut force.active;
        since.iter_mut().chain(until).for_each(&mut *visit);
        force.kind.switches_mut().into_iter().for_each(&mut *visit);
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

/// Zero has no sign.
fn unsigned_zero(number: &mut Number) {
    if let Number::Constant(value) = number {
        *value += 0.0;
    }
}

/// The index of each that is kept among those kept.
fn renumbered(keep: &[bool]) -> Vec<usize> {
    let mut next = 0;
    let number = |&kept: &bool| {
        let index = next;
        next += usize::from(kept);
        // What is not kept is never asked for, but for a curve scaled by 0.
        if kept { index } else { 0 }
    };
    keep.iter().map(number).collect()
}

fn retain<T>(list: &mut Vec<T>, keep: &[bool]) {
    let mut keep = keep.iter();
    list.retain(|_| keep.next() == Some(&true));
}
