//! Emits an instruction for each step.
//!
//! Steps are emitted in their order. A value stays in its register until it is no longer needed or another value needs the register. In
//! the latter case it is stored in the frame, unless it is already in memory. The instruction that needs an operand outside of a register
//! reads it from memory; if the operand is needed again soon, it is loaded instead.

use super::abi::{Base, Bases};
use super::encode::{
    Binary, Bitwise, Comparison, Encoder, Form, Length, Memory, Operand, Precision, Shape, Signs,
    Vector,
};
use super::rare::Rare;
use super::registers::{NEVER, Registers, Set};
use super::slots::Slots;
use super::steps::{Kind, Origin, Step, Steps};
use super::{Code, Target};
use crate::program::{Input, List};

/// A value that is used again within this many steps is loaded.
const SOON: u32 = 12;

/// The place of a value in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Home {
    Nowhere,
    /// A constant: its offset in bytes from the beginning of the constants.
    Constant(u32),
    /// A slot of a region.
    Slot(Base, u32),
}

/// The function for these steps, which are the steps of `list`.
pub(super) fn emit(steps: Steps, list: &List, target: &Target) -> Code {
    let mut emitter = Emitter::new(&steps, target);
    emitter.bases.enter(&mut emitter.encoder);
    for (index, step) in steps.steps.iter().enumerate() {
        emitter.now = index as u32;
        emitter.step(step);
    }
    emitter.remaining_results();
    if target.length.is_wide() {
        emitter.encoder.zero_upper();
    }
    emitter.bases.leave(&mut emitter.encoder);
    emitter.rare_ways();
    let mut slots = inputs(list);
    slots[Base::Results as usize] = list.results.len() as u32;
    slots[Base::Frame as usize] = emitter.slots.count().div_ceil(1 + u32::from(target.slopes));
    slots[Base::Functions as usize] = steps.callees.len() as u32;
    Code {
        bytes: emitter.encoder.finish(&emitter.constants),
        slots,
        callees: steps.callees,
    }
}

impl Length {
    /// Whether it has more than 16 bytes, which code without AVX does not know.
    pub(super) fn is_wide(self) -> bool {
        matches!(self, Length::ThirtyTwo | Length::SixtyFour)
    }
}

/// The place of an input.
fn place(input: Input) -> (Base, u32) {
    match input {
        Input::Time => (Base::Time, 0),
        Input::State(index) => (Base::State, index),
        Input::Acceleration(index) => (Base::Accelerations, index),
        Input::EventFunction(index) => (Base::EventFunctions, index),
        Input::Parameter(index) => (Base::Parameters, index),
        Input::Derived(index) => (Base::Derived, index),
    }
}

/// The number of slots of the inputs of a list.
fn inputs(list: &List) -> [u32; Base::ALL.len()] {
    let mut slots = [0; Base::ALL.len()];
    for (base, slot) in list.inputs.iter().map(|input| place(*input)) {
        let slots: &mut u32 = &mut slots[base as usize];
        *slots = (*slots).max(slot + 1);
    }
    slots
}

/// The constants as bytes, and the home of each value that is in memory from the start.
fn homes(steps: &Steps, target: &Target) -> (Vec<u8>, Vec<Home>) {
    let mut constants = Vec::new();
    let homes = steps.origins.iter().map(|origin| match origin {
        Origin::Constant(number) => Home::Constant(add_constant(&mut constants, *number, target)),
        Origin::Input { input, slope } => {
            let (base, slot) = place(*input);
            match target.slopes {
                true => Home::Slot(base, 2 * slot + u32::from(*slope)),
                false => Home::Slot(base, slot),
            }
        }
        Origin::Step => Home::Nowhere,
    });
    let homes = homes.collect();
    (constants, homes)
}

/// Appends a constant, in as many copies as instructions read, and returns its offset.
fn add_constant(constants: &mut Vec<u8>, number: f64, target: &Target) -> u32 {
    let at = constants.len() as u32;
    // for 64 bytes, one number is broadcast
    let copies = match target.length {
        Length::ThirtyTwo => 32 / target.precision.bytes(),
        Length::Sixteen => 16 / target.precision.bytes(),
        Length::Scalar | Length::SixtyFour => 1,
    };
    for _ in 0..copies {
        match target.precision {
            Precision::Double => constants.extend(number.to_le_bytes()),
            Precision::Single => constants.extend((number as f32).to_le_bytes()),
        }
    }
    at
}

/// For each value its first use; for each operand of each step and each argument the next use after that step.
struct Uses {
    first: Vec<u32>,
    of_operands: Vec<[u32; 4]>,
    of_arguments: Vec<u32>,
}

fn uses(steps: &Steps) -> Uses {
    let mut next = vec![NEVER; steps.origins.len()];
    let mut of_operands = vec![[NEVER; 4]; steps.steps.len()];
    let mut of_arguments = vec![NEVER; steps.arguments.len()];
    for (index, step) in steps.steps.iter().enumerate().rev() {
        for (after, value) in of_operands[index].iter_mut().zip(step.operands()) {
            *after = next[*value as usize];
        }
        for value in step.operands() {
            next[*value as usize] = index as u32;
        }
        for argument in step.arguments() {
            of_arguments[argument] = next[steps.arguments[argument] as usize];
        }
        for value in &steps.arguments[step.arguments()] {
            next[*value as usize] = index as u32;
        }
    }
    Uses {
        first: next,
        of_operands,
        of_arguments,
    }
}

/// About how often each region is used.
fn uses_of_bases(steps: &Steps, homes: &[Home]) -> [u32; Base::ALL.len()] {
    let mut uses = [0; Base::ALL.len()];
    let operands = steps.steps.iter().flat_map(Step::operands);
    for value in operands.chain(&steps.arguments).chain(&steps.results) {
        if let Home::Slot(base, _) = homes[*value as usize] {
            uses[base as usize] += 1;
        }
    }
    uses[Base::Results as usize] = steps.results.len() as u32;
    // most loads and stores are those of values without a register
    uses[Base::Frame as usize] = u32::MAX;
    for step in &steps.steps {
        if let Kind::Call { .. } | Kind::Rare { .. } = step.kind {
            uses[Base::Functions as usize] += 1;
        }
    }
    uses
}

pub(super) struct Emitter<'a> {
    pub steps: &'a Steps,
    pub shape: Shape,
    /// Whether comparisons write to mask registers.
    pub masks: bool,
    pub encoder: Encoder,
    pub bases: Bases,
    pub registers: Registers,
    homes: Vec<Home>,
    constants: Vec<u8>,
    slots: Slots,
    /// `None` if no number is rare.
    pub rare: Option<Rare>,
    /// Slots that become free after this step.
    vacated: Vec<u32>,
    uses: Uses,
    /// The index of the first result that is this value, or `NEVER`.
    result: Vec<u32>,
    /// Results that are not written when a step defines them, with their values.
    remaining: Vec<(u32, u32)>,
    now: u32,
}

impl<'a> Emitter<'a> {
    fn new(steps: &'a Steps, target: &Target) -> Self {
        let (mut constants, homes) = homes(steps, target);
        let mut uses = uses(steps);
        let calls = steps.steps.iter().filter_map(|step| match step.kind {
            Kind::Call { arguments, .. } => Some(arguments),
            _ => None,
        });
        let most_arguments = calls.max();
        let mut slots = Slots::default();
        if let Some(most) = most_arguments {
            // from slot 0 on: arguments
            slots.take_several(most.max(1));
        }
        let mut result = vec![NEVER; steps.origins.len()];
        let mut remaining = Vec::new();
        for (index, value) in steps.results.iter().enumerate() {
            let first = &mut result[*value as usize];
            match steps.origins[*value as usize] == Origin::Step && *first == NEVER {
                true => *first = index as u32,
                false => remaining.push((index as u32, *value)),
            }
        }
        let masks = target.many_registers || target.length == Length::SixtyFour;
        let registers: u32 = if masks { 32 } else { 16 };
        let rare = Rare::new(steps, registers, &mut slots);
        // a bitwise operation reads 16 bytes
        constants.extend([0; 12]);
        Emitter {
            steps,
            shape: Shape {
                length: target.length,
                precision: target.precision,
            },
            masks,
            encoder: Encoder::with_capacity(steps.steps.len() * 10 + 64),
            bases: Bases::new(
                uses_of_bases(steps, &homes),
                most_arguments.is_some() || rare.is_some(),
            ),
            registers: Registers::new(registers as usize, std::mem::take(&mut uses.first)),
            homes,
            constants,
            slots,
            rare,
            vacated: Vec::new(),
            uses,
            result,
            remaining,
            now: 0,
        }
    }

    fn step(&mut self, step: &Step) {
        let operands = step.operands;
        match step.kind {
            Kind::Binary(operation) => {
                self.binary(operation, operands[0], operands[1], step.defines)
            }
            Kind::Fused(signs) => {
                let [a, b, c, _] = operands;
                self.fused(signs, [a, b, c], step.defines);
            }
            Kind::Select => self.select(operands, step.defines),
            Kind::Sqrt => {
                let source = self.loaded(operands[0], Set::default());
                self.used();
                let result = self.destination();
                let operand = Operand::Register(source);
                self.encoder.sqrt(self.shape, [result, source], operand);
                self.define(step.defines, result);
            }
            Kind::Bits(operation) => self.bits(operation, operands, step.defines),
            Kind::ShiftLeft(places) => {
                let source = self.loaded(operands[0], Set::default());
                self.used();
                let result = self.destination();
                self.encoder.shift_left(self.shape, result, source, places);
                self.define(step.defines, result);
            }
            Kind::Rare { .. } => self.rare(step),
            Kind::Call {
                callee, results, ..
            } => self.call(callee, step.arguments(), step.defines, results),
        }
        self.give_back();
    }

    fn binary(&mut self, operation: Binary, first: u32, second: u32, defines: u32) {
        let [mut first, mut second] = [(first, 0), (second, 1)];
        if matches!(operation, Binary::Add | Binary::Mul) {
            let away = |(value, _): (u32, usize)| self.registers.of(value).is_none();
            let swap = match (away(first), away(second)) {
                (true, true) => self.after(second.1) < self.after(first.1),
                (first_away, second_away) => first_away && !second_away,
            };
            if swap {
                std::mem::swap(&mut first, &mut second);
            }
        }
        let keep = self.registers.of(second.0);
        let keep = keep.map_or(Set::default(), |register| Set::default().with(register));
        let source = self.loaded(first.0, keep);
        let operand = self.operand(second.0, keep.with(source), second.1);
        self.used();
        let result = self.destination();
        self.encoder
            .binary(self.shape, operation, [result, source], operand);
        self.define(defines, result);
    }

    fn bits(&mut self, operation: Bitwise, [first, second, ..]: [u32; 4], defines: u32) {
        let keep = self.registers.of(second);
        let keep = keep.map_or(Set::default(), |register| Set::default().with(register));
        let source = self.loaded(first, keep);
        let keep = keep.with(source);
        // a scalar in memory has less than the 16 bytes that are read, except for constants
        let whole = self.shape.length != Length::Scalar
            || matches!(self.homes[second as usize], Home::Constant(_));
        let mask = match whole {
            true => self.operand(second, keep, 1),
            false => Operand::Register(self.loaded(second, keep)),
        };
        self.used();
        let result = self.destination();
        self.encoder
            .bits(self.shape, operation, [result, source], mask);
        self.define(defines, result);
    }

    /// Emits ±(a · b) ± c. The instruction overwrites one operand.
    fn fused(&mut self, signs: Signs, operands: [u32; 3], defines: u32) {
        let keep = self.at_most_one_in_memory(operands);
        let registers = operands.map(|value| self.registers.of(value));
        let dies = |i: usize| registers[i].is_some() && self.after(i) == NEVER;
        // the addend first, because the factors may be exchanged
        let dying = [2, 0, 1].into_iter().find(|i| dies(*i));
        let overwritten = match dying {
            Some(index) => index,
            // copies an operand that is in memory, or otherwise the addend
            None => (0..3).find(|i| registers[*i].is_none()).unwrap_or(2),
        };
        let others = match overwritten {
            0 => [1, 2],
            1 => [0, 2],
            _ => [0, 1],
        };
        // the last operand may be in memory
        let [second, third] = match registers[others[0]] {
            Some(_) => others,
            None => [others[1], others[0]],
        };
        let form = match (overwritten, third) {
            (2, _) => Form::F231,
            (_, 2) => Form::F213,
            _ => Form::F132,
        };
        let last = match registers[third] {
            Some(register) => Operand::Register(register),
            None => self.operand(operands[third], keep, third),
        };
        let copied = (dying.is_none()).then(|| self.copied(operands[overwritten], keep));
        self.used();
        let second = registers[second].unwrap_or(Vector(0));
        let result = copied.or(registers[overwritten]).unwrap_or(Vector(0));
        self.encoder
            .fused(self.shape, signs, form, [result, second], last);
        self.define(defines, result);
    }

    /// Emits `then` where a < b, `otherwise` elsewhere: a comparison and a selection.
    fn select(&mut self, operands: [u32; 4], defines: u32) {
        let mut keep = Set::default();
        for register in operands
            .iter()
            .filter_map(|value| self.registers.of(*value))
        {
            keep = keep.with(register);
        }
        let first = self.loaded(operands[0], keep);
        keep = keep.with(first);
        let otherwise = self.loaded(operands[3], keep);
        keep = keep.with(otherwise);
        // for scalars, the selection reads whole registers, but memory has only one number
        let scalar = self.shape.length == Length::Scalar;
        if scalar || !self.masks {
            keep = keep.with(self.loaded(operands[2], keep));
        }
        let second = self.operand(operands[1], keep, 1);
        if let Operand::Register(register) = second {
            keep = keep.with(register);
        }
        if self.masks {
            self.encoder
                .compare_to_mask(self.shape, Comparison::Less, first, second);
            let then = self.operand(operands[2], keep, 2);
            self.used();
            let result = self.destination();
            self.encoder
                .blend_by_mask(self.shape, [result, otherwise], then);
            self.define(defines, result);
        } else {
            let result = self.make_room(keep);
            self.encoder
                .compare(self.shape, Comparison::Less, [result, first], second);
            let then = self.operand(operands[2], keep, 2);
            self.used();
            self.encoder
                .blend(self.shape, [result, otherwise], then, result);
            self.define(defines, result);
        }
    }

    /// AppliedForces operands until at most one of them, and no value twice, is only in memory. Returns the registers of the others.
    fn at_most_one_in_memory(&mut self, operands: [u32; 3]) -> Set {
        let mut keep = Set::default();
        for register in operands
            .iter()
            .filter_map(|value| self.registers.of(*value))
        {
            keep = keep.with(register);
        }
        loop {
            let away = (0..3).filter(|i| self.registers.of(operands[*i]).is_none());
            let away: Vec<usize> = away.collect();
            if away.len() < 2 {
                return keep;
            }
            let soonest = away.into_iter().min_by_key(|i| self.after(*i)).unwrap_or(0);
            keep = keep.with(self.loaded(operands[soonest], keep));
        }
    }

    /// The next use of an operand after this step.
    fn after(&self, operand: usize) -> u32 {
        self.uses.of_operands[self.now as usize][operand]
    }

    /// A register with a copy of a value, which may be overwritten.
    fn copied(&mut self, value: u32, keep: Set) -> Vector {
        match self.registers.of(value) {
            Some(source) => {
                let register = self.make_room(keep);
                self.encoder.copy(self.shape, register, source);
                register
            }
            None => {
                let register = self.make_room(keep);
                self.load(register, value);
                register
            }
        }
    }

    /// The register of a value. If it is in none, it is loaded. The registers in `keep` are not used for it.
    pub(super) fn loaded(&mut self, value: u32, keep: Set) -> Vector {
        if let Some(register) = self.registers.of(value) {
            return register;
        }
        let register = self.make_room(keep);
        self.load(register, value);
        self.registers.put(value, register);
        register
    }

    /// A value as the last operand of an instruction; it may be in memory.
    fn operand(&mut self, value: u32, keep: Set, index: usize) -> Operand {
        if let Some(register) = self.registers.of(value) {
            return Operand::Register(register);
        }
        let after = self.after(index);
        if after != NEVER && after - self.now < SOON {
            return Operand::Register(self.loaded(value, keep));
        }
        let broadcast = matches!(self.homes[value as usize], Home::Constant(_))
            && self.shape.length == Length::SixtyFour;
        let memory = self.memory(self.homes[value as usize]);
        match broadcast {
            true => Operand::Broadcast(memory),
            false => Operand::Memory(memory),
        }
    }

    /// Counts the uses of this step, and drops values that are no longer needed.
    pub(super) fn used(&mut self) {
        let steps = self.steps;
        let step = &steps.steps[self.now as usize];
        for (index, value) in step.operands().iter().enumerate() {
            let after = self.after(index);
            self.use_up(*value, after);
        }
    }

    /// The next use of an argument after this step.
    pub(super) fn after_argument(&self, argument: usize) -> u32 {
        self.uses.of_arguments[argument]
    }

    pub(super) fn use_up(&mut self, value: u32, after: u32) {
        self.registers.next[value as usize] = after;
        if after == NEVER {
            self.forget(value);
        }
    }

    /// Drops a value that is no longer needed. The next instruction may still read its slot.
    fn forget(&mut self, value: u32) {
        self.registers.remove(value);
        if let Home::Slot(Base::Frame, slot) = self.homes[value as usize] {
            self.vacated.push(slot);
            self.homes[value as usize] = Home::Nowhere;
        }
    }

    /// Frees the slots of dropped values.
    fn give_back(&mut self) {
        for slot in self.vacated.drain(..) {
            self.slots.give_back(slot);
        }
    }

    /// A register for a result; it may be the register of an operand.
    fn destination(&mut self) -> Vector {
        self.make_room(Set::default())
    }

    /// A free register; if there is none, one is freed.
    pub(super) fn make_room(&mut self, keep: Set) -> Vector {
        if let Some(register) = self.registers.free() {
            return register;
        }
        let homes = &self.homes;
        let stored = |value: u32| homes[value as usize] != Home::Nowhere;
        let victim = self.registers.victim(keep, stored);
        self.store(victim);
        self.registers.remove(victim);
        self.make_room(keep)
    }

    /// Ensures that a value in a register is also in memory.
    fn store(&mut self, value: u32) {
        if self.homes[value as usize] != Home::Nowhere {
            return;
        }
        if let Some(register) = self.registers.of(value) {
            let slot = self.slots.take();
            self.store_to(Base::Frame, slot, register);
            self.homes[value as usize] = Home::Slot(Base::Frame, slot);
        }
    }

    pub(super) fn store_to(&mut self, base: Base, slot: u32, register: Vector) {
        let memory = self.slot(base, slot);
        self.encoder.store(self.shape, memory, register);
    }

    pub(super) fn load_from(&mut self, base: Base, slot: u32, register: Vector) {
        let memory = self.slot(base, slot);
        self.encoder.load(self.shape, register, memory);
    }

    fn load(&mut self, register: Vector, value: u32) {
        self.load_home(register, self.homes[value as usize]);
    }

    pub(super) fn load_home(&mut self, register: Vector, home: Home) {
        let constant = matches!(home, Home::Constant(_));
        let memory = self.memory(home);
        match constant && self.shape.length == Length::SixtyFour {
            true => self.encoder.broadcast(self.shape, register, memory),
            false => self.encoder.load(self.shape, register, memory),
        }
    }

    /// The place of a value in memory.
    pub(super) fn home(&self, value: u32) -> Home {
        self.homes[value as usize]
    }

    /// The offset of a constant in bytes from the beginning of the constants.
    pub(super) fn constant(&self, value: u32) -> u32 {
        match self.homes[value as usize] {
            Home::Constant(at) => at,
            _ => unreachable!("a constant stays where it is"),
        }
    }

    /// The memory operand of a place, valid for the next instruction.
    fn memory(&mut self, home: Home) -> Memory {
        match home {
            Home::Constant(at) => Memory::Constant(at),
            Home::Slot(base, slot) => self.slot(base, slot),
            Home::Nowhere => unreachable!("a value that is neither in a register nor in memory"),
        }
    }

    pub(super) fn slot(&mut self, base: Base, slot: u32) -> Memory {
        let offset = self.offset(slot);
        self.bases.memory(&mut self.encoder, base, offset)
    }

    pub(super) fn offset(&self, slot: u32) -> i32 {
        (slot * self.shape.bytes()).cast_signed()
    }

    /// Records that a value is now in a register, and writes it if it is a result.
    pub(super) fn define(&mut self, value: u32, register: Vector) {
        let result = self.result[value as usize];
        if result != NEVER {
            self.store_to(Base::Results, result, register);
            self.homes[value as usize] = Home::Slot(Base::Results, result);
        }
        if self.registers.next[value as usize] != NEVER {
            self.registers.put(value, register);
        }
    }

    /// Writes results that are inputs, constants, or other results.
    fn remaining_results(&mut self) {
        let register = Vector(0);
        for (result, value) in std::mem::take(&mut self.remaining) {
            self.load(register, value);
            self.store_to(Base::Results, result, register);
        }
    }

    /// Emits a call. All values in registers are stored before, because functions may change every vector register.
    fn call(&mut self, callee: u32, arguments: std::ops::Range<usize>, defines: u32, results: u32) {
        let given = self.arguments(arguments.clone());
        for argument in arguments.clone() {
            let value = self.steps.arguments[argument];
            self.registers.next[value as usize] = self.uses.of_arguments[argument];
        }
        for value in self.registers.values() {
            if self.registers.next[value as usize] != NEVER {
                self.store(value);
            }
            self.registers.remove(value);
        }
        let first = self.result[defines as usize];
        let in_place = |i: u32| self.result[(defines + i) as usize] == first + i;
        let written = match first != NEVER && (0..results).all(in_place) {
            true => (Base::Results, first),
            false => (Base::Frame, self.slots.take_several(results)),
        };
        if self.shape.length.is_wide() {
            self.encoder.zero_upper();
        }
        let [given, written_at] = [given, written].map(|(base, slot)| (base, self.offset(slot)));
        self.bases
            .call(&mut self.encoder, callee, given, written_at);
        for argument in arguments {
            let value = self.steps.arguments[argument];
            if self.registers.next[value as usize] == NEVER {
                self.forget(value);
            }
        }
        for i in 0..results {
            self.called(defines + i, (written.0, written.1 + i));
        }
    }

    /// Records a value that a call has written to a slot.
    fn called(&mut self, value: u32, (base, slot): (Base, u32)) {
        self.homes[value as usize] = Home::Slot(base, slot);
        let result = self.result[value as usize];
        if result != NEVER && base == Base::Frame {
            let register = self.loaded(value, Set::default());
            self.store_to(Base::Results, result, register);
            self.vacated.push(slot);
            self.homes[value as usize] = Home::Slot(Base::Results, result);
        }
        if self.registers.next[value as usize] == NEVER {
            self.forget(value);
        }
    }

    /// Places the arguments of a call side by side and returns their place. Arguments that already stand side by side in memory are not
    /// moved.
    fn arguments(&mut self, arguments: std::ops::Range<usize>) -> (Base, u32) {
        let steps = self.steps;
        let values = &steps.arguments[arguments.clone()];
        if let Some(Home::Slot(base, slot)) =
            values.first().map(|&first| self.homes[first as usize])
        {
            let home = |i: usize| Home::Slot(base, slot + i as u32);
            let mut in_order = values.iter().enumerate();
            if in_order.all(|(i, value)| self.homes[*value as usize] == home(i)) {
                return (base, slot);
            }
        }
        for (slot, value) in steps.arguments[arguments].iter().enumerate() {
            let register = self.loaded(*value, Set::default());
            self.store_to(Base::Frame, slot as u32, register);
        }
        (Base::Frame, 0)
    }
}
