//! Scalars as plain numbers, lane by lane: the arguments and results of functions that are compiled apart.
//!
//! All words are doubles; a single is passed as the double of its value. A dual number is the words of its value, then
//! those of its slope. The lanes of a register are passed one by one.

/// The kind of one number: one lane, without derivatives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum Base {
    /// `f64`
    Double = 0,
    /// `f32`
    Single = 1,
    /// [`Fast`](super::Fast)
    Fast = 2,
    /// [`DoubleDouble`](super::DoubleDouble)
    DoubleDouble = 3,
    /// A lane of a register of doubles: products and sums are fused.
    Lane = 4,
    /// A lane of a register of singles, as [`Base::Lane`].
    SingleLane = 5,
}

impl Base {
    /// All of them, by their number.
    pub const ALL: [Base; 6] = [
        Base::Double,
        Base::Single,
        Base::Fast,
        Base::DoubleDouble,
        Base::Lane,
        Base::SingleLane,
    ];

    const fn words(self) -> usize {
        match self {
            Base::DoubleDouble => 2,
            _ => 1,
        }
    }
}

/// The parts of a scalar: [`Real::FORM`](super::Real::FORM).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Form {
    /// The kind of number of each part of each lane.
    pub base: Base,
    /// Order of derivatives: 0 for a value alone, 1 for a value with its slope, 2 for a dual number of dual numbers,
    /// and so on.
    pub order: u32,
    /// Number of lanes.
    pub lanes: usize,
}

impl Form {
    /// One lane without derivatives.
    pub const fn of(base: Base) -> Self {
        Form {
            base,
            order: 0,
            lanes: 1,
        }
    }

    /// This form with another number of lanes.
    pub const fn times(self, lanes: usize) -> Self {
        Form { lanes, ..self }
    }

    /// This form with a slope beside each value.
    pub const fn dual(self) -> Self {
        Form {
            order: self.order + 1,
            ..self
        }
    }

    /// Number of words of one lane.
    pub const fn words(self) -> usize {
        self.base.words() << self.order
    }
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use super::Base;
    use crate::real::Real;
    use crate::real::lanes::{OfAnyWidth, Several, with_width, with_width_of_singles};
    use crate::{DoubleDouble, Dual, Fast, Width};

    /// Writes several scalars into one array, with each lane apart, and reads them back.
    fn there_and_back<T: Real>(of: impl Fn(usize) -> T) {
        let form = T::FORM.expect("a form");
        let words = form.words();
        let stride = 3 * words;
        let mut place = vec![0.0; stride * form.lanes];
        for k in 0..3 {
            of(k).put(stride, &mut place[k * words..]);
        }
        for k in 0..3 {
            assert_eq!(T::of_words(stride, &place[k * words..]), of(k), "{form:?}");
        }
    }

    fn dual<T: Real>(value: T) -> Dual<T> {
        Dual {
            value,
            slope: value * value,
        }
    }

    struct Each(Base);

    impl<F: Real> OfAnyWidth<F> for Each {
        type Output = ();
        fn run<T: Several<One = F>>(self) {
            assert_eq!(T::FORM.map(|form| form.base), Some(self.0));
            assert_eq!(T::FORM.map(|form| form.lanes), Some(T::LANES));
            let of = |k: usize| {
                (0..T::LANES).fold(T::from_f64(0.0), |all, lane| {
                    all.with_lane(lane, F::from_f64((10 * k + lane) as f64 / 3.0))
                })
            };
            there_and_back::<T>(of);
            there_and_back::<Dual<T>>(|k| dual(of(k)));
        }
    }

    #[test]
    fn what_is_put_is_found_again() {
        let third = |k: usize| (k as f64 + 1.0) / 3.0;
        there_and_back::<f64>(third);
        there_and_back::<f32>(|k| third(k) as f32);
        there_and_back::<Fast>(|k| Fast(third(k)));
        there_and_back::<DoubleDouble>(|k| DoubleDouble::new(third(k), 1e-20));
        there_and_back(|k| dual(third(k) as f32));
        there_and_back(|k| dual(DoubleDouble::new(third(k), 1e-20)));
        there_and_back(|k| dual(dual(third(k))));
        for width in Width::ALL {
            with_width(width, Each(Base::Lane));
            with_width_of_singles(width, Each(Base::SingleLane));
        }
    }

    #[test]
    fn bases_have_their_numbers() {
        for (number, base) in Base::ALL.into_iter().enumerate() {
            assert_eq!(base as usize, number);
        }
    }
}
