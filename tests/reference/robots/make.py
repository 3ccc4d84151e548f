"""Makes robots.json and the URDF files beside it, with Pinocchio: `python make.py FOLDER`, with the packages of benches/peers.

FOLDER has what `benches/peers/robots.py prepare` writes. All numbers are of absolute axes: a free base has the velocities of its origin
and its angular velocity, and quaternions are (w, x, y, z). A frame is at the origin of its link.
"""

import json
import pathlib
import shutil
import sys

import numpy as np
import pinocchio as pin

ROBOTS = {"panda": (False, "panda_hand_tcp"), "ur5": (False, "tool0"), "anymal": (True, "LF_FOOT")}
STATES = 20


def main():
    here, folder = pathlib.Path(__file__).parent, pathlib.Path(sys.argv[1])
    robots = {}
    for name, (free, frame) in ROBOTS.items():
        shutil.copy(folder / f"{name}.urdf", here / f"{name}.urdf")
        base = [pin.JointModelFreeFlyer()] if free else []
        model = pin.buildModelFromUrdf(str(folder / f"{name}.urdf"), *base)
        robots[name] = robot(model, free, frame)
    text = json.dumps({"source": f"Pinocchio {pin.__version__}, example-robot-data", "robots": robots}, separators=(",", ":"))
    (here / "robots.json").write_text(text + "\n")


def robot(model, free, frame):
    data, random = model.createData(), np.random.default_rng(7)
    names = [model.names[j] for j in range(2 if free else 1, model.njoints)]
    states = []
    for _ in range(STATES):
        angles = random.uniform(-3, 3, len(names))
        q = np.concatenate([[c for c in angle] for angle in zip(np.cos(angles), np.sin(angles))])
        v, a = random.normal(size=(2, model.nv))
        turn, rate = np.eye(model.nv), a.copy()
        start = {}
        if free:
            place, quaternion = random.normal(size=3), random.normal(size=4)
            quaternion /= np.linalg.norm(quaternion)
            w, x, y, z = quaternion
            q = np.concatenate([place, [x, y, z, w], q])
            rotation = pin.Quaternion(w, x, y, z).matrix()
            turn[:3, :3] = turn[3:6, 3:6] = rotation.T
            local = turn @ v
            rate = turn @ a
            rate[:3] -= np.cross(local[3:6], local[:3])
            start = {"place": list(place), "quaternion": list(quaternion)}
        else:
            rate = a
        local = turn @ v
        tau = turn.T @ pin.rnea(model, data, q, local, rate)
        index = model.getFrameId(frame)
        jacobian = pin.computeFrameJacobian(model, data, q, index, pin.LOCAL_WORLD_ALIGNED) @ turn
        pin.forwardKinematics(model, data, q, local, rate)
        pin.updateFramePlacements(model, data)
        acceleration = pin.getFrameClassicalAcceleration(model, data, index, pin.LOCAL_WORLD_ALIGNED)
        momentum = pin.computeCentroidalMomentum(model, data, q, local).np.copy()
        states.append(start | {
            "q": list(angles), "v": list(v), "a": list(a), "inverse_dynamics": list(tau),
            "pose": list(data.oMf[index].homogeneous[:3].flatten()), "jacobian": list(jacobian.flatten()),
            "acceleration": list(acceleration.np), "center_of_mass": list(pin.centerOfMass(model, data, q)),
            "centroidal_momentum": list(momentum),
            "kinetic_energy": [pin.computeKineticEnergy(model, data, q, local)],
            "potential_energy": [pin.computePotentialEnergy(model, data, q)],
        })
    return {"free": free, "frame": frame, "joints": names, "states": states}


main()
