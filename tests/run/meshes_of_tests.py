"""A mesh, and a scene with it, for the tests of runs and of the service."""

import struct

from run_binary import scene_in_space

# The corners of a box by their bits (x, y, z), and its triangles as seen from outside.
BOX = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4),
       (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)]


def ramp(high):
    """A wedge that rises along x, as a binary STL: 0.2 m long and wide, from 0.06 m to `high`."""
    def corner(bits):
        x, y, z = bits & 1, bits >> 1 & 1, bits >> 2 & 1
        return 0.2 * x, y * (high if x else 0.06), 0.2 * z

    body = b"".join(struct.pack("<12fH", 0, 0, 0, *(value for bits in triangle for value in corner(bits)), 0)
                    for triangle in BOX)
    return bytes(80) + struct.pack("<I", len(BOX)) + body


def scene_with_mesh(**changes):
    """A column of some 1 500 particles, packed beside a ramp that is a mesh, over a bed of heights."""
    content = scene_in_space(**changes)
    content["obstacles"] = [
        {"shape": "mesh", "file": "ramp.stl", "place": [0.36, 0, 0]},
        {"shape": "heights", "corner": [0, 0, 0], "step": [0.18, 0.1],
         "heights": [[0.06, 0.05, 0.06], [0.06, 0.045, 0.06], [0.06, 0.05, 0.06]]}]
    content["fluid"] = [{"shape": "box", "corner": [0, 0, 0], "size": [0.24, 0.28, 0.2]}]
    content["sensors"] = [{"name": "H", "kind": "surface_height", "x": 0.2, "z": 0.1, "interval": 0.01}]
    return content
