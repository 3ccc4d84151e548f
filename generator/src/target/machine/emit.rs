//! Emits steps as instructions, and decides which values are in registers and which in memory.
//!
//! Steps are emitted in their order. A value stays in its register until it is no longer needed or another value needs
//! the register. In the latter case it is stored in the frame, unless it is already in memory. The `Processor`
//! decides which instructions a step takes, and whether they read operands from memory.

use super::Code;
use super::base::Base;
use super::operation::{CodePosition, Jump, Vector};
use super::rare_branches::Rare;
use super::registers::{NEVER, Registers, Set};
use super::shape::{Length, Precision, Shape, Values};
use super::slots::Slots;
use super::steps::{Origin, Step, StepKind, Steps};
use crate::program::{Input, List};

/// The place of a value in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Home {
    Nowhere,
    /// A constant: its offset in bytes from the beginning of the constants.
    Constant(u32),
    /// A slot of a region.
    Slot(Base, u32),
}

/// A place in a region: its offset in bytes.
pub(crate) type At = (Base, u32);

/// Facts about the steps of a function that a [`Processor`] must know before it writes code.
pub(crate) struct Needs {
    /// Roughly how often each region is used.
    pub uses: [u32; Base::ALL.len()],
    /// True if other functions are called.
    pub calls: bool,
    /// Number of steps.
    pub steps: usize,
}

/// The code that was written for a processor so far: moves, calls and jumps.
pub trait Writer: Sized {
    /// register = a slot of memory
    fn load(&mut self, shape: Shape, register: Vector, from: At);
    /// register = a constant, in every lane. `offset` is its distance in bytes from the beginning of the constants.
    fn load_constant(&mut self, shape: Shape, register: Vector, offset: u32, constants: &[u8]);
    /// A slot of memory = register
    fn store(&mut self, shape: Shape, to: At, register: Vector);
    /// Calls the function with this index in the table.
    fn call(&mut self, shape: Shape, index: u32, arguments: At, results: At);
    /// Ends the function; its values have this shape.
    fn leave(&mut self, shape: Shape);
    /// Like [`call`](Self::call), within a part that is itself called by [`call_place`](Self::call_place).
    fn call_from_part(&mut self, shape: Shape, index: u32, arguments: At, results: At);
    /// Ends a part that is called by [`call_place`](Self::call_place).
    fn leave_part(&mut self);
    /// True if the code so far may have changed a register.
    fn changed(&self, register: Vector) -> bool;
    /// The place of the next instruction.
    fn here(&self) -> CodePosition;
    /// Makes a jump go to the next instruction.
    fn land(&mut self, jump: Jump);
    /// Jumps to a place.
    fn jump_to(&mut self, place: CodePosition);
    /// Calls the part of the code that begins at a place.
    fn call_place(&mut self, place: CodePosition);
    /// The code, followed by the constants from the next multiple of 64 bytes on.
    fn finish(self, constants: Vec<u8>) -> Vec<u8>;
}

/// A processor, as the writer of its code.
pub(crate) trait Processor: Writer {
    /// A bit for each vector register that is used before the others.
    const TAKEN_FIRST: u32;
    /// Emits a step of arithmetic, neither a call nor a branch.
    fn step(emitter: &mut Emitter<'_, Self>, step: &Step);
    /// Emits a jump that is taken unless the number in the register `size` is below the constant `limit` in all lanes.
    /// The registers in `keep` are not changed.
    fn jump_if_rare(emitter: &mut Emitter<'_, Self>, size: Vector, limit: u32, keep: Set) -> Jump;
}

/// Emits the function for these steps, which must be the steps of `list`. `registers` is the number of vector registers
/// of the processor.
pub(crate) fn emit<P: Processor>(
    steps: &Steps,
    list: &List,
    values: &Values,
    registers: u32,
    processor: impl FnOnce(&Needs) -> P,
) -> Code {
    let mut emitter = Emitter::new(steps, values, registers, processor);
    for (index, step) in steps.steps.iter().enumerate() {
        emitter.now = index as u32;
        emitter.step(step);
    }
    emitter.remaining_results();
    emitter.processor.leave(values.shape);
    emitter.rare_ways();
    let mut slots = inputs(list);
    slots[Base::Results as usize] = list.results.len() as u32;
    slots[Base::Frame as usize] = emitter.slots.count().div_ceil(1 + u32::from(values.slopes));
    slots[Base::Functions as usize] = steps.callees.len() as u32;
    Code {
        bytes: emitter.processor.finish(emitter.constants),
        slots,
        callees: steps.callees.clone(),
    }
}

/// The region and slot of an input.
fn place(input: Input) -> (Base, u32) {
    match input {
        Input::Time => (Base::Time, 0),
        Input::State(index) => (Base::State, index),
        Input::Acceleration(_) | Input::EventFunction(_) => {
            unreachable!("a combined list computes them")
        }
        Input::Parameter(index) => (Base::Parameters, index),
        Input::Derived(index) => (Base::Derived, index),
    }
}

/// The number of slots that the inputs of a list take in each region.
fn inputs(list: &List) -> [u32; Base::ALL.len()] {
    let mut slots = [0; Base::ALL.len()];
    for (base, slot) in list.inputs.iter().map(|input| place(*input)) {
        let slots: &mut u32 = &mut slots[base as usize];
        *slots = (*slots).max(slot + 1);
    }
    slots
}

/// The constants as bytes, and the home of each value that is in memory from the start.
fn homes(steps: &Steps, values: &Values) -> (Vec<u8>, Vec<Home>) {
    let mut constants = Vec::new();
    let homes = steps.origins.iter().map(|origin| match origin {
        Origin::Constant(number) => {
            Home::Constant(add_constant(&mut constants, *number, values.shape))
        }
        Origin::Input { input, slope } => {
            let (base, slot) = place(*input);
            match values.slopes {
                true => Home::Slot(base, 2 * slot + u32::from(*slope)),
                false => Home::Slot(base, slot),
            }
        }
        Origin::Step => Home::Nowhere,
    });
    let homes = homes.collect();
    (constants, homes)
}

/// Appends a constant, in as many copies as an instruction reads at once, and returns its offset.
fn add_constant(constants: &mut Vec<u8>, number: f64, shape: Shape) -> u32 {
    let at = constants.len() as u32;
    // an instruction on 64 bytes broadcasts one number
    let copies = match shape.length {
        Length::ThirtyTwo => 32 / shape.precision.bytes(),
        Length::Sixteen => 16 / shape.precision.bytes(),
        Length::Scalar | Length::SixtyFour => 1,
    };
    for _ in 0..copies {
        match shape.precision {
            Precision::Double => constants.extend(number.to_le_bytes()),
            Precision::Single => constants.extend((number as f32).to_le_bytes()),
        }
    }
    at
}

/// The steps that use a value: for each value its first use; for each operand of a step, and each argument of a call,
/// the next use of its value after that step.
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

/// Roughly how often each region is used.
fn uses_of_bases(steps: &Steps, homes: &[Home]) -> [u32; Base::ALL.len()] {
    let mut uses = [0; Base::ALL.len()];
    let operands = steps.steps.iter().flat_map(Step::operands);
    for value in operands.chain(&steps.arguments).chain(&steps.results) {
        if let Home::Slot(base, _) = homes[*value as usize] {
            uses[base as usize] += 1;
        }
    }
    uses[Base::Results as usize] = steps.results.len() as u32;
    // most loads and stores are of values that have no register
    uses[Base::Frame as usize] = u32::MAX;
    for step in &steps.steps {
        if let StepKind::Call { .. } | StepKind::Rare { .. } = step.kind {
            uses[Base::Functions as usize] += 1;
        }
    }
    uses
}

/// The state of the translation of one function: where its values are, and the code so far.
pub(crate) struct Emitter<'a, P> {
    pub steps: &'a Steps,
    pub shape: Shape,
    pub processor: P,
    pub registers: Registers,
    homes: Vec<Home>,
    constants: Vec<u8>,
    slots: Slots,
    /// The branches for rare numbers; `None` if there are none.
    pub rare: Option<Rare>,
    /// Slots of the frame that become free after this step.
    vacated: Vec<u32>,
    uses: Uses,
    /// The index of the first result that is this value, or `NEVER`.
    result: Vec<u32>,
    /// Results that no step defines, with their values: inputs, constants, and repeated results.
    remaining: Vec<(u32, u32)>,
    pub now: u32,
}

impl<'a, P: Processor> Emitter<'a, P> {
    fn new(
        steps: &'a Steps,
        values: &Values,
        registers: u32,
        processor: impl FnOnce(&Needs) -> P,
    ) -> Self {
        let (constants, homes) = homes(steps, values);
        let mut uses = uses(steps);
        let calls = steps.steps.iter().filter_map(|step| match step.kind {
            StepKind::Call { arguments, .. } => Some(arguments),
            _ => None,
        });
        let most_arguments = calls.max();
        let mut slots = Slots::default();
        if let Some(most) = most_arguments {
            // the slots from 0 on are for arguments
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
        let rare = Rare::new(steps, registers, &mut slots);
        let processor = processor(&Needs {
            uses: uses_of_bases(steps, &homes),
            calls: most_arguments.is_some() || rare.is_some(),
            steps: steps.steps.len(),
        });
        Emitter {
            steps,
            shape: values.shape,
            processor,
            registers: Registers::new(
                registers as usize,
                P::TAKEN_FIRST,
                std::mem::take(&mut uses.first),
            ),
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
        match step.kind {
            StepKind::Rare { .. } => self.rare(step),
            StepKind::Call {
                callee, results, ..
            } => self.call(callee, step.arguments(), step.defines, results),
            _ => P::step(self, step),
        }
        self.free_vacated_slots();
    }

    /// The next step after this one that uses an operand of this step.
    pub(crate) fn after(&self, operand: usize) -> u32 {
        self.uses.of_operands[self.now as usize][operand]
    }

    /// The register of a value. A value that is in no register is loaded into one; a register in `keep` is not evicted
    /// for it.
    pub(crate) fn loaded(&mut self, value: u32, keep: Set) -> Vector {
        if let Some(register) = self.registers.of(value) {
            return register;
        }
        let register = self.make_room(keep);
        self.load(register, value);
        self.registers.put(value, register);
        register
    }

    /// Counts the uses of this step, and drops values that are no longer needed.
    pub(crate) fn used(&mut self) {
        let steps = self.steps;
        let step = &steps.steps[self.now as usize];
        for (index, value) in step.operands().iter().enumerate() {
            let after = self.after(index);
            self.use_up(*value, after);
        }
    }

    /// The next step after this one that uses an argument of this step.
    pub(crate) fn after_argument(&self, argument: usize) -> u32 {
        self.uses.of_arguments[argument]
    }

    pub(crate) fn use_up(&mut self, value: u32, after: u32) {
        self.registers.next[value as usize] = after;
        if after == NEVER {
            self.forget(value);
        }
    }

    /// Drops a value that is no longer needed. Its slot becomes free only after this step, as the next instruction may
    /// still read it.
    fn forget(&mut self, value: u32) {
        self.registers.remove(value);
        if let Home::Slot(Base::Frame, slot) = self.homes[value as usize] {
            self.vacated.push(slot);
            self.homes[value as usize] = Home::Nowhere;
        }
    }

    /// Frees the slots of dropped values.
    fn free_vacated_slots(&mut self) {
        for slot in self.vacated.drain(..) {
            self.slots.give_back(slot);
        }
    }

    /// A register for a result; it may be the register of an operand that is no longer needed.
    pub(crate) fn destination(&mut self) -> Vector {
        self.make_room(Set::default())
    }

    /// A free register; if there is none, a value whose register is not in `keep` is evicted.
    pub(crate) fn make_room(&mut self, keep: Set) -> Vector {
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

    pub(crate) fn store_to(&mut self, base: Base, slot: u32, register: Vector) {
        let at = (base, self.offset(slot));
        self.processor.store(self.shape, at, register);
    }

    pub(crate) fn load_from(&mut self, base: Base, slot: u32, register: Vector) {
        let at = (base, self.offset(slot));
        self.processor.load(self.shape, register, at);
    }

    pub(crate) fn load(&mut self, register: Vector, value: u32) {
        self.load_home(register, self.homes[value as usize]);
    }

    pub(crate) fn load_home(&mut self, register: Vector, home: Home) {
        match home {
            Home::Constant(at) => {
                self.processor
                    .load_constant(self.shape, register, at, &self.constants);
            }
            Home::Slot(base, slot) => self.load_from(base, slot, register),
            Home::Nowhere => unreachable!("a value that is neither in a register nor in memory"),
        }
    }

    /// The place of a value in memory.
    pub(crate) fn home(&self, value: u32) -> Home {
        self.homes[value as usize]
    }

    /// The offset of a constant in bytes from the beginning of the constants.
    pub(crate) fn constant(&self, value: u32) -> u32 {
        match self.homes[value as usize] {
            Home::Constant(at) => at,
            _ => unreachable!("a constant stays where it is"),
        }
    }

    /// The offset of a slot in bytes.
    pub(crate) fn offset(&self, slot: u32) -> u32 {
        slot * self.shape.bytes()
    }

    /// Records that a value is now in a register, and writes it if it is a result.
    pub(crate) fn define(&mut self, value: u32, register: Vector) {
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

    /// Emits a call. All values in registers are stored before the call, because the function may change every vector
    /// register.
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
        let [given, written_at] = [given, written].map(|(base, slot)| (base, self.offset(slot)));
        self.processor.call(self.shape, callee, given, written_at);
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

    /// Places the arguments of a call side by side and returns the place of the first. Arguments that already lie side
    /// by side in memory are not moved.
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
