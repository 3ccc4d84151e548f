"""Judges accelerations: the moments that remain in the equations of Newton and Euler, in 80 bits.

The joints transmit no moment, and a free reference joint no force. So, summed over all elements that a joint carries,

    sum of  n_i + (c_i - p) x m_i (a_i - g)  =  0,      n = I dw/dt + w x I w,    p the joint,

and over all of a free tree sum of m_i (a_i - g) = 0. What is left over is given as a share of the largest term. It knows no algorithm
of any engine, and it stays small for accelerations that are exact solutions of nearly the same problem, however badly conditioned.
"""

import numpy as np

import states

EXACT = np.longdouble


def residual(tree, state, accelerations):
    """The largest remaining moment or force, as a share of the largest term of its kind; infinity if it is not finite."""
    if not np.isfinite(accelerations).all():
        return np.inf
    state, accelerations = state.astype(EXACT), accelerations.astype(EXACT)
    _, orientation, velocity, rates = states.split(tree, state)
    axes, elements = len(velocity), tree["elements"]
    gravity = np.array(tree["gravity"], dtype=EXACT)
    root = np.zeros(3, dtype=EXACT)
    if axes:
        root[[0, 2] if tree["plane"] else [0, 1, 2]] = accelerations[:axes]
    if tree["plane"]:
        about_y = np.array([0, 1, 0], dtype=EXACT)
        orientation = [[np.cos(a / 2), 0, np.sin(a / 2), 0] for a in orientation]
        rates = [w * about_y for w in rates]
        angular = [w * about_y for w in accelerations[axes:]]
    else:
        angular = accelerations[axes:].reshape(-1, 3)

    # from the root outwards: accelerations of joints, and the load of each element alone on its joint
    joints, forces, moments, arms, terms = [], [], [], [], []
    for i, element in enumerate(elements):
        rotation = states.matrix(np.array(orientation[i], dtype=EXACT))
        parent = element["parent"]
        w, dw = rates[i], angular[i]
        if parent is None:
            arms.append(np.zeros(3, dtype=EXACT))
            joints.append(root)
        else:
            on = states.matrix(np.array(orientation[parent], dtype=EXACT))
            arms.append(on @ np.array(element["at"], dtype=EXACT))
            joints.append(joints[parent] + _swing(rates[parent], angular[parent], arms[i]))
        cg = rotation @ np.array(element["cg"], dtype=EXACT)
        inertia = rotation @ np.diag(np.array(element["inertia"], dtype=EXACT)) @ rotation.T
        force = EXACT(element["mass"]) * (joints[i] + _swing(w, dw, cg) - gravity)
        parts = [inertia @ dw, np.cross(w, inertia @ w), np.cross(cg, force)]
        forces.append(force)
        moments.append(sum(parts))
        terms += [np.abs(part).max() for part in parts]
    largest_force = max(np.abs(force).max() for force in forces)

    # from the leaves inwards: sums
    for i in reversed(range(len(elements))):
        parent = elements[i]["parent"]
        if parent is not None:
            carried = np.cross(arms[i], forces[i])
            terms.append(np.abs(carried).max())
            forces[parent] = forces[parent] + forces[i]
            moments[parent] = moments[parent] + moments[i] + carried
    left = max(np.abs(moment[1] if tree["plane"] else moment).max() for moment in moments) / max(terms)
    if tree["free"]:
        left = max(left, np.abs(forces[0]).max() / largest_force)
    return float(left)


def _swing(w, dw, arm):
    """Acceleration of the end of an arm relative to its beginning."""
    return np.cross(dw, arm) + np.cross(w, np.cross(w, arm))
