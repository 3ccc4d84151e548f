//! The motion of one element, or of another body.

use crate::expression::vector::{Mat3, Vec3};
use crate::expression::{Expr, Graph};

/// The motion of one element, in absolute axes.
#[derive(Clone)]
pub struct ElementMotion<'g> {
    /// A, the rotation from the local frame to the absolute frame.
    pub rotation: Mat3<'g>,
    /// φ in the plane, 0 in space \[rad\].
    pub angle: Expr<'g>,
    /// The axes e_j about which its velocities v_j turn it. On a ball joint ω = Σ e_j v_j; on any other joint ω of the
    /// carrier is added.
    pub axes: Vec<Vec3<'g>>,
    /// The vectors s_j by which its velocities v_j move its origin relative to the carrier; empty on a ball joint.
    pub slides: Vec<Vec3<'g>>,
    /// q and q̇ of the freedoms of its joint; empty on a ball joint.
    pub freedoms: Vec<(Expr<'g>, Expr<'g>)>,
    /// Whether it turns with its carrier.
    pub turns_with_carrier: bool,
    /// ω \[rad/s\]
    pub omega: Vec3<'g>,
    /// ω · ω
    pub(super) omega_squared: Expr<'g>,
    /// ε, the angular acceleration when v̇ = 0 \[rad/s²\]. On a ball joint it is Σ ė_j v_j, which is zero except for
    /// Bryant angles.
    pub bias: Vec3<'g>,
    /// The acceleration of the origin minus that of the carrier's origin, when v̇ = 0 \[m/s²\]; for the root, minus
    /// that of the reference joint. It is zero on ball joints, where [`ElementMotion::gamma`] of the carrier gives it.
    pub slide_bias: Vec3<'g>,
    /// Position of the joint, in absolute axes \[m\].
    pub position: Vec3<'g>,
    /// Velocity of the joint, in absolute axes \[m/s\].
    pub velocity: Vec3<'g>,
    /// Position of the origin relative to that of the carrier, u = A_carrier s on a ball joint; for the root, relative
    /// to the reference joint \[m\].
    pub offset: Vec3<'g>,
}

impl<'g> ElementMotion<'g> {
    /// The motion of a body at rest in the absolute frame.
    pub(crate) fn frame(graph: &'g Graph) -> Self {
        let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
        let none = Vec3::zero(graph);
        ElementMotion {
            rotation: Mat3([[one, zero, zero], [zero, one, zero], [zero, zero, one]]),
            angle: zero,
            axes: Vec::new(),
            slides: Vec::new(),
            freedoms: Vec::new(),
            turns_with_carrier: false,
            omega: none,
            omega_squared: zero,
            bias: none,
            slide_bias: none,
            position: none,
            velocity: none,
            offset: none,
        }
    }

    /// Sets the angular velocity ω.
    pub(crate) fn turns(&mut self, omega: Vec3<'g>) {
        self.omega = omega;
        self.omega_squared = omega.squared();
    }

    /// ω × (ω × v) = (ω·v) ω − (ω·ω) v
    pub fn centripetal(&self, v: Vec3<'g>) -> Vec3<'g> {
        self.omega.dot(v) * self.omega - self.omega_squared * v
    }

    /// ω · ω
    pub fn omega_squared(&self) -> Expr<'g> {
        self.omega_squared
    }

    /// γ(v): the acceleration of the tip of v, a vector fixed in the element, when v̇ = 0.
    pub fn gamma(&self, v: Vec3<'g>) -> Vec3<'g> {
        self.centripetal(v) + self.bias.cross(v)
    }

    /// D(v): the columns e_j × v.
    pub fn turned(&self, v: Vec3<'g>) -> Vec<Vec3<'g>> {
        self.axes.iter().map(|e| e.cross(v)).collect()
    }

    /// Velocity of a point at the offset ρ from the joint.
    pub fn velocity_at(&self, offset: Vec3<'g>) -> Vec3<'g> {
        self.velocity + self.omega.cross(offset)
    }
}
