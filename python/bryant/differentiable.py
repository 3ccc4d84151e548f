"""Accelerations as functions of JAX and PyTorch, with the exact derivatives of the engine.

The derivatives are those of `Model.linearise`. Its columns for positions are along the motion of each velocity, and are
turned into columns for the coordinates here. A quaternion is scaled to length 1 first, so its four numbers may be any
but zeros, and the derivative along it is 0.
"""

import numpy as np


class _Accelerations:
    """v̇ and its derivatives by q, v and u, arrays of one shape but for the last dimension. A u of no columns means the
    inputs among the parameters."""

    def __init__(self, model):
        self.model = model
        self.n, self.m = len(model.velocities), len(model.inputs)
        self.quaternions = [slice(i, i + 4) for i, name in enumerate(model.coordinates) if name.endswith(".qw")]

    def rows(self, q, v, u):
        """Rows of states, the lengths of the quaternions beside the places of their numbers, and the dimensions before the last."""
        q, v, u = (np.array(part, dtype=float) for part in (q, v, u))
        for part, width, name in [(q, [len(self.model.coordinates)], "q"), (v, [self.n], "v"), (u, [0, self.m], "u")]:
            if part.shape[-1] not in width or part.shape[:-1] != q.shape[:-1]:
                raise ValueError(f"{name} must have the shape (…, {width[-1]}), as many states as q, and has {part.shape}")
        before = q.shape[:-1]
        q, v, u = (part.reshape(int(np.prod(before)), part.shape[-1]) for part in (q, v, u))
        length = np.ones_like(q)
        for part in self.quaternions:
            length[:, part] = np.linalg.norm(q[:, part], axis=1, keepdims=True)
        return q / length, v, u if u.shape[1] else None, length, before

    def value(self, q, v, u):
        q, v, u, _, before = self.rows(q, v, u)
        return self.model.accelerations(q, v, u).reshape(*before, self.n)

    def derivatives(self, q, v, u):
        """∂v̇/∂q, ∂v̇/∂v, ∂v̇/∂u."""
        columns = np.shape(u)[-1]
        q, v, u, length, before = self.rows(q, v, u)
        n, (a, b, _, _) = self.n, self.model.linearise(q, v, u)
        by_q, by_v, by_u = a[:, n : 2 * n, :n], a[:, n : 2 * n, n : 2 * n], b[:, n : 2 * n, :columns]
        if self.quaternions:
            # q̇ = N v: the motion of each velocity is a column of N, and N⁺ gives the motions of coordinates
            each = np.tile(np.eye(n), (len(q), 1))
            moved = self.model.rates(np.repeat(q, n, axis=0), each)[:, : q.shape[1]]
            moved = np.swapaxes(moved.reshape(len(q), n, q.shape[1]), 1, 2)
            by_q = by_q @ np.linalg.pinv(moved) / length[:, None, :]
        return tuple(part.reshape(*before, n, part.shape[-1]) for part in (by_q, by_v, by_u))


def of_jax(model):
    """See `Model.jax`."""
    try:
        import jax
        import jax.numpy as jnp
    except ImportError as error:
        raise ImportError("m.jax() needs JAX: pip install jax") from error
    host = _Accelerations(model)

    def call(function, widths, q, v, u):
        kind = jnp.result_type(q, v, u)
        shapes = [jax.ShapeDtypeStruct((*q.shape[:-1], *width), kind) for width in widths]
        cast = lambda *given: [np.asarray(part, dtype=kind) for part in function(*given)]
        return jax.pure_callback(cast, shapes, q, v, u, vmap_method="broadcast_all")

    @jax.custom_jvp
    def accelerations(q, v, u):
        return call(lambda *given: [host.value(*given)], [(host.n,)], q, v, u)[0]

    @accelerations.defjvp
    def tangent(given, changes):
        widths = [(host.n, part.shape[-1]) for part in given]
        parts = call(host.derivatives, widths, *given)
        change = sum(jnp.einsum("...ij,...j->...i", by, by_which) for by, by_which in zip(parts, changes))
        return accelerations(*given), change

    def function(q, v, u=None):
        q, v = jnp.asarray(q), jnp.asarray(v)
        return accelerations(q, v, jnp.zeros((*q.shape[:-1], 0), q.dtype) if u is None else jnp.asarray(u))

    return function


def of_torch(model):
    """See `Model.torch`."""
    try:
        import torch
    except ImportError as error:
        raise ImportError("m.torch() needs PyTorch: pip install torch") from error
    host = _Accelerations(model)

    def on_host(*given):
        return [part.detach().cpu().double().numpy() for part in given]

    class Accelerations(torch.autograd.Function):
        @staticmethod
        def forward(context, q, v, u):
            context.save_for_backward(q, v, u)
            return torch.from_numpy(host.value(*on_host(q, v, u))).to(q)

        @staticmethod
        @torch.autograd.function.once_differentiable
        def backward(context, change):
            parts = host.derivatives(*on_host(*context.saved_tensors))
            return tuple(torch.einsum("...i,...ij->...j", change, torch.from_numpy(part).to(change)) for part in parts)

    def function(q, v, u=None):
        return Accelerations.apply(q, v, q.new_zeros((*q.shape[:-1], 0)) if u is None else u)

    return function
