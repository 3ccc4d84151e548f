"""Reads an animation by two other programs: python3 read-glb.py FILE.glb

pygltflib reads the keyframes: nodes rest in the first of them, a camera moves, and the names of nodes are there. trimesh, which plays nothing, sees the scene where
it begins: no larger than a room, and with the head where the first keyframe has it.
"""

import struct
import sys

import numpy
import trimesh
from pygltflib import GLTF2

path = sys.argv[1]
file = GLTF2().load(path)
binary = file.binary_blob()


def numbers(index):
    accessor = file.accessors[index]
    view = file.bufferViews[accessor.bufferView]
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor.type]
    count = accessor.count * width
    values = struct.unpack_from(f"<{count}f", binary, view.byteOffset + (accessor.byteOffset or 0))
    return numpy.array(values).reshape(accessor.count, width)


(animation,) = file.animations
heads = []
for channel in animation.channels:
    sampler = animation.samplers[channel.sampler]
    times, values = numbers(sampler.input), numbers(sampler.output)
    assert times[0] == 0 and (numpy.diff(times[:, 0]) > 0).all(), channel
    node = file.nodes[channel.target.node]
    rest = getattr(node, channel.target.path)
    assert numpy.allclose(rest, values[0], atol=1e-6), (node.name, channel.target.path)
    if channel.target.path == "translation" and (node.name or "").endswith("/head"):
        heads.append((node.name, values))
cameras = [node for node in file.nodes if node.camera is not None]
assert len(cameras) == 1 and cameras[0].name == "camera", cameras
assert heads, "no head"

scene = trimesh.load(path)
low, high = scene.bounds
assert (high - low < 10).all() and (high - low > 0.3).all(), scene.bounds
for name, values in heads:
    # z of the model is y here
    x, y, z = values[0]
    place = scene.graph.get(name)[0][:3, 3]
    assert numpy.allclose(place, [x, z, -y], atol=1e-5), (name, place, values[0])
print(f"pygltflib and trimesh read {len(file.nodes)} nodes and {len(animation.channels)} channels")
