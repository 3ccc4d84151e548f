"""States in the conventions of other programs.

| | quaternion | velocity of a free base |
|---|---|---|
| bryant | w, x, y, z | linear and angular, in axes of the world |
| Pinocchio | x, y, z, w | linear and angular, in axes of the body |
| MuJoCo | w, x, y, z | linear in axes of the world, angular in those of the body |

`joints` are the names of the joints in the other program's order, without a free base: pin.Model.names[2:] with a free
flyer ([1:] without), or those of the joints of an MjModel. Without them the order of bryant is kept.
"""

import numpy as np


class _Layout:
    """Where the free base and the joints of a model are in q and v."""

    def __init__(self, model, joints):
        coordinates, velocities = list(model.coordinates), list(model.velocities)
        quaternions = [i for i, name in enumerate(coordinates) if name.endswith(".qw")]
        if any(name.endswith(".qw") for name in coordinates[4:]) and quaternions != [3]:
            raise ValueError(f"{model.name} has a ball joint, or a quaternion that is not that of a free base at the root")
        self.free = quaternions == [3]
        first, second = (7, 6) if self.free else (0, 0)
        names = [name.rsplit(".", 1)[-1] for name in coordinates[first:]]
        if len(names) != len(velocities) - second:
            raise ValueError(f"{model.name} has joints that are neither hinges nor sliders")
        wanted = names if joints is None else [_word(name) for name in joints]
        if sorted(wanted) != sorted(names):
            raise ValueError(f"the joints of {model.name} are {', '.join(names)}; those given are {', '.join(wanted)}")
        there = [names.index(name) for name in wanted]
        # of the other program, in the order of bryant
        self.q = np.array([*range(first), *(first + i for i in there)], dtype=int)
        self.v = np.array([*range(second), *(second + i for i in there)], dtype=int)


def _word(name):
    """A name of URDF as an import writes it."""
    word = "".join(c if c.isascii() and c.isalnum() else "_" for c in name.lower())
    while "__" in word:
        word = word.replace("__", "_")
    return word.strip("_")


def _rotation(quaternion):
    """The rotation matrices of quaternions w, x, y, z: vectors in axes of the body become vectors in axes of the world."""
    w, x, y, z = np.moveaxis(quaternion, -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def _turned(model, q, v, joints, there, last, linear):
    """q and v in another convention, or back from it.

    there: to the other program. last: its quaternions have w last. linear: its linear velocity is in axes of the body.
    """
    layout = _Layout(model, joints)
    q, v = np.array(q, dtype=float), np.array(v, dtype=float)

    def placed(values, order):
        if there:
            return values[..., order]
        back = np.empty_like(values)
        back[..., order] = values
        return back

    if layout.free:
        to_last, to_first = [4, 5, 6, 3], [6, 3, 4, 5]
        if last and not there:
            q[..., 3:7] = q[..., to_first]
        turn = _rotation(q[..., 3:7])
        turn = np.swapaxes(turn, -1, -2) if there else turn
        for part in ([slice(0, 3)] if linear else []) + [slice(3, 6)]:
            v[..., part] = np.einsum("...ij,...j->...i", turn, v[..., part])
        if last and there:
            q[..., 3:7] = q[..., to_last]
    return placed(q, layout.q), placed(v, layout.v)


def to_pinocchio(model, q, v, joints=None, continuous=()):
    """q and v of Pinocchio, of one state or of many. Joints that are `continuous` there have two numbers in its q, the
    cosine and the sine of the angle: joints of this type in URDF."""
    q, v = _turned(model, q, v, joints, True, True, True)
    first, joints = _joints(model, joints)
    parts = [q[..., :first]]
    for i, name in enumerate(joints):
        angle = q[..., first + i]
        is_continuous = name in map(_word, continuous)
        parts.append(np.stack([np.cos(angle), np.sin(angle)] if is_continuous else [angle], axis=-1))
    return np.concatenate(parts, axis=-1), v


def from_pinocchio(model, q, v, joints=None, continuous=()):
    """q and v of bryant, of one state or of many of Pinocchio: see `to_pinocchio`."""
    q = np.asarray(q, dtype=float)
    first, joints = _joints(model, joints)
    parts, at = [q[..., :first]], first
    for name in joints:
        if name in map(_word, continuous):
            parts.append(np.arctan2(q[..., at + 1], q[..., at])[..., None])
            at += 2
        else:
            parts.append(q[..., at : at + 1])
            at += 1
    if at != q.shape[-1]:
        raise ValueError(f"q of Pinocchio has {q.shape[-1]} numbers, not {at}: name the joints that are continuous there")
    return _turned(model, np.concatenate(parts, axis=-1), v, joints, False, True, True)


def _joints(model, joints):
    """Where joints begin in q, and their names in the other program's order."""
    layout = _Layout(model, joints)
    first = 7 if layout.free else 0
    names = list(model.coordinates)[first:]
    return first, [name.rsplit(".", 1)[-1] for name in names] if joints is None else [_word(name) for name in joints]


def to_mujoco(model, q, v, joints=None):
    """qpos and qvel of MuJoCo, of one state or of many."""
    return _turned(model, q, v, joints, True, False, False)


def from_mujoco(model, q, v, joints=None):
    """q and v of bryant, of one state or of many of MuJoCo."""
    return _turned(model, q, v, joints, False, False, False)
