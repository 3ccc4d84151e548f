//! Vectors and matrices of expressions, in space (3) and in the x–z plane (2).

use super::graph::{Expr, Graph};
use std::array::from_fn;
use std::ops::{Add, Mul, Neg, Sub};

/// A vector in space.
#[derive(Clone, Copy, Debug)]
pub struct Vec3<'g>(pub [Expr<'g>; 3]);

/// A 3×3 matrix, by rows.
#[derive(Clone, Copy, Debug)]
pub struct Mat3<'g>(pub [[Expr<'g>; 3]; 3]);

/// A symmetric 3×3 matrix stored as six numbers, so that it stays symmetric in spite of rounding.
#[derive(Clone, Copy, Debug)]
pub struct Sym3<'g> {
    /// Diagonal: xx, yy, zz.
    pub diagonal: [Expr<'g>; 3],
    /// Off-diagonal entries, by the missing axis x, y, z: yz, xz, xy.
    pub off: [Expr<'g>; 3],
}

/// A vector in the x–z plane.
#[derive(Clone, Copy, Debug)]
pub struct Vec2<'g>(pub [Expr<'g>; 2]);

/// A symmetric 2×2 matrix stored as three numbers.
#[derive(Clone, Copy, Debug)]
pub struct Sym2<'g> {
    /// xx
    pub xx: Expr<'g>,
    /// xz
    pub xz: Expr<'g>,
    /// zz
    pub zz: Expr<'g>,
}

impl<'g> Vec3<'g> {
    /// The zero vector.
    pub fn zero(graph: &'g Graph) -> Self {
        Vec3([graph.constant(0.0); 3])
    }

    /// a · b
    pub fn dot(self, other: Self) -> Expr<'g> {
        self.0[0] * other.0[0] + self.0[1] * other.0[1] + self.0[2] * other.0[2]
    }

    /// a × b
    pub fn cross(self, other: Self) -> Self {
        let ([ax, ay, az], [bx, by, bz]) = (self.0, other.0);
        Vec3([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])
    }

    /// a · a
    pub fn squared(self) -> Expr<'g> {
        self.dot(self)
    }

    /// s a
    pub fn scale(self, factor: Expr<'g>) -> Self {
        Vec3(self.0.map(|a| factor * a))
    }

    /// True where every component is the number 0.
    pub fn is_zero(self) -> bool {
        self.0.iter().all(|a| a.is_zero())
    }

    /// Names the components `name_x`, `name_y`, `name_z`.
    pub fn named(self, name: &str) -> Self {
        for (a, axis) in self.0.iter().zip(["x", "y", "z"]) {
            a.graph().name(*a, format!("{name}_{axis}"));
        }
        self
    }
}

impl<'g> Mat3<'g> {
    /// The matrix with these columns.
    pub fn from_columns(columns: [Vec3<'g>; 3]) -> Self {
        Mat3(from_fn(|i| from_fn(|j| columns[j].0[i])))
    }

    /// Column j.
    pub fn column(&self, j: usize) -> Vec3<'g> {
        Vec3(from_fn(|i| self.0[i][j]))
    }

    /// The transpose.
    pub fn transposed(&self) -> Self {
        Mat3(from_fn(|i| from_fn(|j| self.0[j][i])))
    }

    /// M v
    pub fn times(&self, v: Vec3<'g>) -> Vec3<'g> {
        Vec3(self.0.map(|row| Vec3(row).dot(v)))
    }

    /// Mᵀ v
    pub fn transposed_times(&self, v: Vec3<'g>) -> Vec3<'g> {
        Vec3(from_fn(|j| self.column(j).dot(v)))
    }

    /// M N
    pub fn product(&self, other: &Mat3<'g>) -> Mat3<'g> {
        Mat3(from_fn(|i| {
            from_fn(|j| Vec3(self.0[i]).dot(other.column(j)))
        }))
    }
}

impl<'g> Sym3<'g> {
    /// The zero matrix.
    pub fn zero(graph: &'g Graph) -> Self {
        let zero = graph.constant(0.0);
        Sym3 {
            diagonal: [zero; 3],
            off: [zero; 3],
        }
    }

    /// Entry (i, j).
    pub fn entry(&self, i: usize, j: usize) -> Expr<'g> {
        if i == j {
            self.diagonal[i]
        } else {
            self.off[3 - i - j]
        }
    }

    /// The matrix with these entries. `entry` is called once for each of the six.
    pub fn from_fn(mut entry: impl FnMut(usize, usize) -> Expr<'g>) -> Self {
        Sym3 {
            diagonal: from_fn(|i| entry(i, i)),
            off: [entry(1, 2), entry(0, 2), entry(0, 1)],
        }
    }

    /// M v
    pub fn times(&self, v: Vec3<'g>) -> Vec3<'g> {
        Vec3(from_fn(|i| Vec3(from_fn(|j| self.entry(i, j))).dot(v)))
    }

    /// True where every entry is the number 0.
    pub fn is_zero(&self) -> bool {
        self.diagonal.iter().chain(&self.off).all(|a| a.is_zero())
    }

    /// Names the entries `name_xx` … `name_xy`.
    pub fn named(self, name: &str) -> Self {
        for (a, axes) in self
            .diagonal
            .iter()
            .chain(&self.off)
            .zip(["xx", "yy", "zz", "yz", "xz", "xy"])
        {
            a.graph().name(*a, format!("{name}_{axes}"));
        }
        self
    }
}

impl<'g> Vec2<'g> {
    /// The zero vector.
    pub fn zero(graph: &'g Graph) -> Self {
        Vec2([graph.constant(0.0); 2])
    }

    /// a · b
    pub fn dot(self, other: Self) -> Expr<'g> {
        self.0[0] * other.0[0] + self.0[1] * other.0[1]
    }

    /// e_y × a = (a_z, −a_x): the change of a by a unit rotation about +y.
    pub fn turned(self) -> Self {
        Vec2([self.0[1], -self.0[0]])
    }

    /// s a
    pub fn scale(self, factor: Expr<'g>) -> Self {
        Vec2(self.0.map(|a| factor * a))
    }

    /// True where both components are the number 0.
    pub fn is_zero(self) -> bool {
        self.0.iter().all(|a| a.is_zero())
    }

    /// Names the components `name_x`, `name_z`.
    pub fn named(self, name: &str) -> Self {
        for (a, axis) in self.0.iter().zip(["x", "z"]) {
            a.graph().name(*a, format!("{name}_{axis}"));
        }
        self
    }
}

impl<'g> Sym2<'g> {
    /// The zero matrix.
    pub fn zero(graph: &'g Graph) -> Self {
        let zero = graph.constant(0.0);
        Sym2 {
            xx: zero,
            xz: zero,
            zz: zero,
        }
    }

    /// M v
    pub fn times(&self, v: Vec2<'g>) -> Vec2<'g> {
        let [x, z] = v.0;
        Vec2([self.xx * x + self.xz * z, self.xz * x + self.zz * z])
    }

    /// Names the entries.
    pub fn named(self, name: &str) -> Self {
        for (a, axes) in [(self.xx, "xx"), (self.xz, "xz"), (self.zz, "zz")] {
            a.graph().name(a, format!("{name}_{axes}"));
        }
        self
    }
}

macro_rules! componentwise {
    ($($vector:ident),*) => {$(
        impl<'g> Add for $vector<'g> {
            type Output = Self;
            fn add(self, other: Self) -> Self {
                $vector(from_fn(|i| self.0[i] + other.0[i]))
            }
        }
        impl<'g> Sub for $vector<'g> {
            type Output = Self;
            fn sub(self, other: Self) -> Self {
                $vector(from_fn(|i| self.0[i] - other.0[i]))
            }
        }
        impl<'g> Neg for $vector<'g> {
            type Output = Self;
            fn neg(self) -> Self {
                $vector(self.0.map(|a| -a))
            }
        }
        impl<'g> Mul<$vector<'g>> for Expr<'g> {
            type Output = $vector<'g>;
            fn mul(self, v: $vector<'g>) -> $vector<'g> {
                v.scale(self)
            }
        }
    )*};
}
componentwise!(Vec2, Vec3);

impl<'g> Mul<Vec3<'g>> for f64 {
    type Output = Vec3<'g>;
    fn mul(self, v: Vec3<'g>) -> Vec3<'g> {
        v.0[0].graph().constant(self) * v
    }
}

impl<'g> Add for Sym3<'g> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Sym3 {
            diagonal: from_fn(|i| self.diagonal[i] + other.diagonal[i]),
            off: from_fn(|i| self.off[i] + other.off[i]),
        }
    }
}

impl<'g> Sub for Sym3<'g> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Sym3 {
            diagonal: from_fn(|i| self.diagonal[i] - other.diagonal[i]),
            off: from_fn(|i| self.off[i] - other.off[i]),
        }
    }
}

impl<'g> Add for Sym2<'g> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Sym2 {
            xx: self.xx + other.xx,
            xz: self.xz + other.xz,
            zz: self.zz + other.zz,
        }
    }
}

impl<'g> Sub for Sym2<'g> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Sym2 {
            xx: self.xx - other.xx,
            xz: self.xz - other.xz,
            zz: self.zz - other.zz,
        }
    }
}
