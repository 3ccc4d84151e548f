"""States and accelerations, between the variables of this project and those of the other engines.

Here v holds the velocity of the reference joint and the angular velocity w of each element, in absolute axes; q its position and
the orientation (w, x, y, z) of each element, absolute too, or in the plane its angle. The others count from the parent:

    R_c = R_p R,    w_c = w_p + R_c u,    dw_c/dt = dw_p/dt + R_c du/dt + w_c x (R_c u)

with u the relative angular velocity in the axes of the child. MuJoCo's free joint has the absolute velocity of its origin,
Pinocchio's that in the axes of the body, V = R^T v, so that dv/dt = R (dV/dt + u x V).
"""

import numpy as np


def random(tree, count, seed):
    """Random states: uniform orientations, velocities normal with a deviation of 2 rad/s and 1 m/s."""
    generator = np.random.default_rng(seed)
    n = len(tree["elements"])
    axes = 2 if tree["plane"] else 3
    states = []
    for _ in range(count):
        position = generator.normal(size=axes) if tree["free"] else []
        velocity = generator.normal(size=axes) if tree["free"] else []
        if tree["plane"]:
            orientation = generator.uniform(-np.pi, np.pi, size=n)
            rates = 2 * generator.normal(size=n)
        else:
            orientation = generator.normal(size=(n, 4))
            orientation /= np.linalg.norm(orientation, axis=1, keepdims=True)
            rates = 2 * generator.normal(size=(n, 3))
        states.append(np.concatenate([position, np.ravel(orientation), velocity, np.ravel(rates)]))
    return np.array(states)


def split(tree, state):
    """Position, orientations, velocity, angular velocities of a state of this project; shape (n, 4) and (n, 3), or (n,)."""
    n = len(tree["elements"])
    axes = (2 if tree["plane"] else 3) if tree["free"] else 0
    shapes = ((n,), (n,)) if tree["plane"] else ((n, 4), (n, 3))
    sizes = [int(np.prod(shape)) for shape in shapes]
    parts = np.split(state, np.cumsum([axes, sizes[0], axes]))
    return parts[0], parts[1].reshape(shapes[0]), parts[2], parts[3].reshape(shapes[1])


def join(*parts):
    return np.concatenate([np.ravel(part) for part in parts])


def product(a, b):
    """Of quaternions (w, x, y, z)."""
    return np.concatenate([[a[0] * b[0] - a[1:] @ b[1:]], a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:])])


def conjugate(q):
    return q * np.array([1, -1, -1, -1])


def matrix(q):
    """The rotation of a unit quaternion, in its own precision."""
    w, x, y, z = q
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])


class Relative:
    """The variables of the other engines.

    `scalar_last` and `body_velocity` are Pinocchio's: quaternions (x, y, z, w) and the velocity of a free joint in the axes of its
    body. MuJoCo has neither. The order is q then v, each from the root outwards.
    """

    def __init__(self, scalar_last, body_velocity):
        self.scalar_last = scalar_last
        self.body_velocity = body_velocity

    def state(self, tree, state):
        """Of a state of this project."""
        position, orientation, velocity, rates = split(tree, state)
        orientations, relative_rates = [], []
        for i, element in enumerate(tree["elements"]):
            parent = element["parent"]
            if tree["plane"]:
                orientations.append(orientation[i] - (0 if parent is None else orientation[parent]))
                relative_rates.append(rates[i] - (0 if parent is None else rates[parent]))
                continue
            q = orientation[i] if parent is None else product(conjugate(orientation[parent]), orientation[i])
            w = rates[i] if parent is None else rates[i] - rates[parent]
            orientations.append(np.roll(q, -1) if self.scalar_last else q)
            relative_rates.append(matrix(orientation[i]).T @ w)
        if self.body_velocity and tree["free"] and not tree["plane"]:
            velocity = matrix(orientation[0]).T @ velocity
        return join(position, orientations, velocity, relative_rates)

    def accelerations(self, tree, state, theirs):
        """dv/dt of this project, from theirs at a state of this project."""
        _, orientation, velocity, rates = split(tree, state)
        axes = len(velocity)
        linear, angular = theirs[:axes], theirs[axes:]
        if tree["plane"]:
            result = np.zeros(len(rates))
            for i, element in enumerate(tree["elements"]):
                result[i] = angular[i] + (0 if element["parent"] is None else result[element["parent"]])
            return join(linear, result)
        angular = angular.reshape(-1, 3)
        result = np.zeros_like(rates)
        for i, element in enumerate(tree["elements"]):
            parent = element["parent"]
            rotation = matrix(orientation[i])
            from_parent, before = (0, np.zeros(3)) if parent is None else (result[parent], rates[parent])
            result[i] = from_parent + rotation @ angular[i] + np.cross(rates[i], rates[i] - before)
        if self.body_velocity and tree["free"]:
            rotation = matrix(orientation[0])
            linear = rotation @ (linear + np.cross(rotation.T @ rates[0], rotation.T @ velocity))
        return join(linear, result)

    def absolute(self, tree, theirs):
        """A state of this project, from one of theirs; in space."""
        n = len(tree["elements"])
        axes = 3 if tree["free"] else 0
        position, orientations, velocity, rates = np.split(theirs, np.cumsum([axes, 4 * n, axes]))
        orientations, rates = orientations.reshape(n, 4), rates.reshape(n, 3)
        q, w = np.zeros((n, 4)), np.zeros((n, 3))
        for i, element in enumerate(tree["elements"]):
            parent = element["parent"]
            relative = np.roll(orientations[i], 1) if self.scalar_last else orientations[i]
            q[i] = relative if parent is None else product(q[parent], relative)
            w[i] = matrix(q[i]) @ rates[i] + (0 if parent is None else w[parent])
        if self.body_velocity and tree["free"]:
            velocity = matrix(q[0]) @ velocity
        return join(position, q, velocity, w)
