"""Writes the mesh of schemas/examples/valley.json: a valley of 600 m with an embankment that has a breach.

Usage: valley_mesh.py FILE.stl          writes it
       valley_mesh.py --check FILE.stl  exit status 1 when the file is another

The surface lies over a grid of 15 m; below are sides and a level base, so that the whole is closed. All of it is made
up: a floor that falls by 20 m, a stream bed that winds, banks that rise as squares.
"""

import math
import struct
import sys

STEP = 15.0  # m
COLUMNS, ROWS = 41, 15  # nodes along x and z
DAM = 8  # the column of the embankment's crest
CREST = 56.0  # m
BREACH = 23.0  # m to either side of the stream


def stream(x):
    """z of the stream, m."""
    return 105.0 + 20.0 * math.sin(2 * math.pi * (x - 120.0) / 360.0)


def ground(column, row):
    """y of the valley at a node, m, to the millimetre: digits that every machine agrees on."""
    x, z = STEP * column, STEP * row
    aside = abs(z - stream(x))
    height = 26.0 - x / 30.0 + min(0.012 * aside**2, 42.0)
    if column == DAM and aside > BREACH:
        height = max(height, CREST)
    return round(height, 3)


def triangles():
    """Three corners each, anticlockwise as seen from outside."""
    def top(i, j):
        return (STEP * i, ground(i, j), STEP * j)

    def base(i, j):
        return (STEP * i, 0.0, STEP * j)

    for j in range(ROWS - 1):
        for i in range(COLUMNS - 1):
            yield top(i, j), top(i + 1, j + 1), top(i + 1, j)
            yield top(i, j), top(i, j + 1), top(i + 1, j + 1)
    around = [(0, j) for j in range(ROWS - 1)] + [(i, ROWS - 1) for i in range(COLUMNS - 1)]
    around += [(COLUMNS - 1 - i, ROWS - 1 - j) for i, j in around]
    middle = (STEP * (COLUMNS - 1) / 2, 0.0, STEP * (ROWS - 1) / 2)
    for one, other in zip(around, around[1:] + around[:1]):
        yield base(*one), base(*other), top(*other)
        yield base(*one), top(*other), top(*one)
        yield middle, base(*other), base(*one)


def stl():
    body = [struct.pack("<12fH", *(0.0,) * 3, *a, *b, *c, 0) for a, b, c in triangles()]
    head = b"A valley, made up for Sluice. Units: m, y up.".ljust(80)
    return head + struct.pack("<I", len(body)) + b"".join(body)


def main():
    if sys.argv[1] == "--check":
        with open(sys.argv[2], "rb") as stream_:
            same = stream_.read() == stl()
        print("the same" if same else f"{sys.argv[2]} is not what this script writes")
        return 0 if same else 1
    with open(sys.argv[1], "wb") as stream_:
        stream_.write(stl())
    return 0


sys.exit(main())
