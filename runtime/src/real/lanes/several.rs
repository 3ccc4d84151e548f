//! The operations on lanes that the time loop of a batch needs: reading and writing single lanes.

use super::{Lanes, MOST_LANES, Register};
use crate::Dual;
use crate::real::{Real, by_index, mapped};

/// A scalar that holds several scenarios side by side.
pub trait Several: Real {
    /// The scalar of one scenario.
    type One: Real;
    /// Number of lanes.
    const LANES: usize;
    /// The distance from 1 to the next number.
    const EPSILON: f64;
    /// The scalar of one lane.
    fn lane(self, index: usize) -> Self::One;
    /// These scalars with another one in one lane.
    fn with_lane(self, index: usize, value: Self::One) -> Self;

    /// The scalars of all lanes; the entries behind them are arbitrary.
    fn lanes(self) -> [Self::One; MOST_LANES];
    /// The first of `lanes`, one in each lane.
    fn of_lanes(lanes: &[Self::One; MOST_LANES]) -> Self;

    /// A permutation of lanes.
    type Order: Copy;
    /// The permutation that moves into each lane i the scalar of the lane `lanes[i]`. With fewer lanes the first
    /// entries count.
    fn order(lanes: &[u8; MOST_LANES]) -> Self::Order;
    /// The scalars, permuted.
    fn ordered(self, order: Self::Order) -> Self;

    /// The type of the value, and of its derivative.
    type Part: Real<Mask = Self::Mask>;
    /// The number of parts: 1 for a value alone, 2 for a value and its derivative.
    const PARTS: usize;
    /// Part 0 is the value, part 1 its derivative.
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

/// Each lane has a derivative in a direction of its own.
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
        by_index(
            Dual {
                value: values[0],
                slope: slopes[0],
            },
            |i| Dual {
                value: values[i],
                slope: slopes[i],
            },
        )
    }

    #[inline(always)]
    fn of_lanes(lanes: &[Dual<T::One>; MOST_LANES]) -> Self {
        Dual {
            value: T::of_lanes(&mapped(*lanes, |lane| lane.value)),
            slope: T::of_lanes(&mapped(*lanes, |lane| lane.slope)),
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
