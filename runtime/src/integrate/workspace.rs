//! Memory of a run.
//!
//! A run takes all of its memory from one slice, which is cut into parts when the run is set up. So the core needs
//! neither an allocator nor arrays of a length that is known at compile time.

use core::ops::{Deref, DerefMut};

/// A slice that is handed out part by part, from the front.
pub(crate) struct Workspace<'w, T> {
    rest: &'w mut [T],
}

impl<'w, T> Workspace<'w, T> {
    /// A workspace of the whole slice.
    pub fn new(memory: &'w mut [T]) -> Self {
        Workspace { rest: memory }
    }

    /// The next part of this length. Its content is whatever was there before.
    ///
    /// # Panics
    /// If less than this length is left.
    pub fn part(&mut self, length: usize) -> &'w mut [T] {
        let rest = core::mem::take(&mut self.rest);
        let (part, rest) = rest.split_at_mut(length);
        self.rest = rest;
        part
    }

    /// The length that is left.
    pub fn left(&self) -> usize {
        self.rest.len()
    }
}

/// Memory that is either lent or, with the feature `std`, owned.
#[derive(Debug)]
pub enum Buffer<'a, T> {
    /// A part of memory that somebody else owns.
    Lent(&'a mut [T]),
    /// Memory of its own.
    #[cfg(feature = "std")]
    Owned(std::vec::Vec<T>),
}

impl<T> Deref for Buffer<'_, T> {
    type Target = [T];
    fn deref(&self) -> &[T] {
        match self {
            Buffer::Lent(slice) => slice,
            #[cfg(feature = "std")]
            Buffer::Owned(vector) => vector,
        }
    }
}

impl<T> DerefMut for Buffer<'_, T> {
    fn deref_mut(&mut self) -> &mut [T] {
        match self {
            Buffer::Lent(slice) => slice,
            #[cfg(feature = "std")]
            Buffer::Owned(vector) => vector,
        }
    }
}

impl<T: PartialEq> PartialEq for Buffer<'_, T> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

#[cfg(test)]
mod tests {
    use super::Workspace;

    #[test]
    fn parts_follow_one_another() {
        let mut memory = [1, 2, 3, 4, 5];
        let mut workspace = Workspace::new(&mut memory);
        let (first, second) = (workspace.part(2), workspace.part(0));
        let third = workspace.part(1);
        assert_eq!(
            (&*first, &*second, &*third),
            (&[1, 2][..], &[][..], &[3][..])
        );
        assert_eq!(workspace.left(), 2);
    }

    #[test]
    #[should_panic(expected = "mid > len")]
    fn more_than_is_left_is_refused() {
        Workspace::new(&mut [0; 3]).part(4);
    }
}
