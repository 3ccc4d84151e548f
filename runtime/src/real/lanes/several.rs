//! Lanes as the time loop of a batch needs them: what is in one, and how to put something there.

use super::{Lanes, MOST_LANES, Register};
use crate::Dual;
use crate::real::Real;

/// Scalars of several scenarios side by side.
pub trait Several: Real {
    /// The scalar of one scenario.
    type One: Real;
    /// How many there are.
    const LANES: usize;
    /// What 1 and the next number differ by.
    const EPSILON: f64;
    /// That of a lane.
    fn lane(self, index: usize) -> Self::One;
    /// The same, with another one in a lane.
    fn with_lane(self, index: usize, value: Self::One) -> Self;

    /// Those of all lanes, followed by anything.
    fn lanes(self) -> [Self::One; MOST_LANES];
    /// The first of these, one in each lane.
    fn of_lanes(lanes: &[Self::One; MOST_LANES]) -> Self;

    /// Which lane goes where.
    type Order: Copy;
    /// The order that puts into each lane what is in the lane named there; of fewer lanes the first count.
    fn order(lanes: &[u8; MOST_LANES]) -> Self::Order;
    /// The same scalars in other lanes.
    fn ordered(self, order: Self::Order) -> Self;

    /// What a value or a derivative of them is.
    type Part: Real<Mask = Self::Mask>;
    /// A value alone, or a value and its derivative.
    const PARTS: usize;
    /// The value, which is the first, or its derivative.
    fn part(self, index: usize) -> Self::Part;
    /// A value that depends on no parameter.
    fn of_part(value: Self::Part) -> Self;
}

impl<R: Register> Several for Lanes<R> {
    type One = R::One;
    const LANES: usize = R::LANES;
    const EPSILON: f64 = R::EPSILON;

    #[inline(always)]
    fn lane(self, index: usize) -> R::One {
        self.0.lane(index)
    }

    #[inline(always)]
    fn with_lane(self, index: usize, value: R::One) -> Self {
        Lanes(self.0.with_lane(index, value))
    }

    #[inline(always)]
    fn lanes(self) -> [R::One; MOST_LANES] {
        self.0.lanes()
    }

    #[inline(always)]
    fn of_lanes(lanes: &[R::One; MOST_LANES]) -> Self {
        Lanes(R::load(lanes))
    }

    type Order = R::Order;

    #[inline(always)]
    fn order(lanes: &[u8; MOST_LANES]) -> R::Order {
        R::order(lanes)
    }

    #[inline(always)]
    fn ordered(self, order: R::Order) -> Self {
        Lanes(self.0.ordered(order))
    }

    type Part = Self;
    const PARTS: usize = 1;

    #[inline(always)]
    fn part(self, _: usize) -> Self {
        self
    }

    #[inline(always)]
    fn of_part(value: Self) -> Self {
        value
    }
}

/// A derivative in another direction in each lane.
impl<T: Several> Several for Dual<T> {
    type One = Dual<T::One>;
    const LANES: usize = T::LANES;
    const EPSILON: f64 = T::EPSILON;

    #[inline(always)]
    fn lane(self, index: usize) -> Dual<T::One> {
        Dual {
            value: self.value.lane(index),
            slope: self.slope.lane(index),
        }
    }

    #[inline(always)]
    fn with_lane(self, index: usize, value: Dual<T::One>) -> Self {
        Dual {
            value: self.value.with_lane(index, value.value),
            slope: self.slope.with_lane(index, value.slope),
        }
    }

    #[inline(always)]
    fn lanes(self) -> [Dual<T::One>; MOST_LANES] {
        let (values, slopes) = (self.value.lanes(), self.slope.lanes());
        core::array::from_fn(|i| Dual {
            value: values[i],
            slope: slopes[i],
        })
    }

    #[inline(always)]
    fn of_lanes(lanes: &[Dual<T::One>; MOST_LANES]) -> Self {
        Dual {
            value: T::of_lanes(&lanes.map(|lane| lane.value)),
            slope: T::of_lanes(&lanes.map(|lane| lane.slope)),
        }
    }

    type Order = T::Order;

    #[inline(always)]
    fn order(lanes: &[u8; MOST_LANES]) -> T::Order {
        T::order(lanes)
    }

    #[inline(always)]
    fn ordered(self, order: T::Order) -> Self {
        Dual {
            value: self.value.ordered(order),
            slope: self.slope.ordered(order),
        }
    }

    type Part = T;
    const PARTS: usize = 2;

    #[inline(always)]
    fn part(self, index: usize) -> T {
        match index {
            0 => self.value,
            _ => self.slope,
        }
    }

    #[inline(always)]
    fn of_part(value: T) -> Self {
        Dual::constant(value)
    }
}
