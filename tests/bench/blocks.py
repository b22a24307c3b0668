"""Blocks of a block model (docs/block_model.md) as other programs want them: mass, inertia, edges, points.

    blocks.py MODEL.json POINTS.txt      writes their corners as text, for box3d_blocks.c

The number of blocks; then three lines a block: "fixed" or "free", density (kg/m3), mass (kg) and number of corners; the corners
(m), three numbers each, from the block's centre; that centre."""

import itertools
import json
import math
import sys


def subtract(a, b):
    return [p - q for p, q in zip(a, b)]


def dot(a, b):
    return sum(p * q for p, q in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    length = math.sqrt(dot(a, a))
    return [p / length for p in a]


class Block:
    """A convex block: `vertices`, m; `faces`, the numbers of their vertices, counterclockwise from outside; `density`,
    kg/m3; `fixed`; `volume`, m3; `centre`, m; `inertia`, 3 x 3, m2: of a unit mass about the centre, axes of the space."""

    def __init__(self, described):
        self.vertices = [list(map(float, vertex)) for vertex in described["vertices"]]
        self.faces = [face["vertices"] for face in described["faces"]]
        self.density = described["density"]
        self.fixed = bool(described.get("fixed"))
        self._measure()

    def triangles(self):
        for face in self.faces:
            for second, third in zip(face[1:], face[2:]):
                yield [self.vertices[face[0]], self.vertices[second], self.vertices[third]]

    def _measure(self):
        """Sums over tetrahedra from the first vertex to the triangles of the surface."""
        origin = self.vertices[0]
        volume, first = 0.0, [0.0] * 3
        second = [[0.0] * 3 for _ in range(3)]
        for triangle in self.triangles():
            corners = [subtract(corner, origin) for corner in triangle]
            part = dot(corners[0], cross(corners[1], corners[2])) / 6
            total = [sum(column) for column in zip(*corners)]
            volume += part
            for i in range(3):
                first[i] += part * total[i] / 4
                for j in range(3):
                    second[i][j] += part * (total[i] * total[j] + sum(c[i] * c[j] for c in corners)) / 20
        centre = [part / volume for part in first]
        spread = [[second[i][j] / volume - centre[i] * centre[j] for j in range(3)] for i in range(3)]
        trace = sum(spread[i][i] for i in range(3))
        self.volume = volume
        self.centre = [p + q for p, q in zip(origin, centre)]
        self.inertia = [[(trace if i == j else 0.0) - spread[i][j] for j in range(3)] for i in range(3)]

    def edges(self):
        """Pairs of vertex numbers, the lower first."""
        return sorted({tuple(sorted(pair)) for face in self.faces for pair in zip(face, face[1:] + face[:1])})

    def normal(self, face):
        """Outer unit normal, by Newell's sum, which a face with corners in one line does not disturb."""
        points = [self.vertices[i] for i in face]
        total = [0.0] * 3
        for a, b in zip(points, points[1:] + points[:1]):
            total = [p + q for p, q in zip(total, cross(subtract(a, points[0]), subtract(b, points[0])))]
        return unit(total)


def read(path):
    """The blocks of a file: fixed ones first, which some programs want."""
    with open(path) as file:
        found = [Block(described) for described in json.load(file)["blocks"]]
    return sorted(found, key=lambda block: not block.fixed)


def principal(tensor):
    """Moments of a symmetric 3 x 3 tensor and its axes (rows, right-handed), by Jacobi's rotations."""
    a = [row[:] for row in tensor]
    axes = [[float(i == j) for j in range(3)] for i in range(3)]
    scale = max(abs(x) for row in a for x in row)
    for _ in range(30):
        if all(abs(a[i][j]) < 1e-15 * scale for i, j in ((0, 1), (0, 2), (1, 2))):
            break
        for p, q in ((0, 1), (0, 2), (1, 2)):
            if abs(a[p][q]) < 1e-300:
                continue
            theta = (a[q][q] - a[p][p]) / (2 * a[p][q])
            t = math.copysign(1, theta) / (abs(theta) + math.hypot(theta, 1))
            c = 1 / math.hypot(t, 1)
            s = t * c
            for row in a:
                row[p], row[q] = c * row[p] - s * row[q], s * row[p] + c * row[q]
            for rows in (a, axes):
                rows[p], rows[q] = ([c * x - s * y for x, y in zip(rows[p], rows[q])],
                                    [s * x + c * y for x, y in zip(rows[p], rows[q])])
    return [a[i][i] for i in range(3)], axes


def quaternion(axes):
    """w, x, y, z of the rotation that takes the axes of the space to these (rows)."""
    m = [list(column) for column in zip(*axes)]
    squares = [1 + m[0][0] + m[1][1] + m[2][2], 1 + m[0][0] - m[1][1] - m[2][2],
               1 - m[0][0] + m[1][1] - m[2][2], 1 - m[0][0] - m[1][1] + m[2][2]]
    sums = {(0, 1): m[2][1] - m[1][2], (0, 2): m[0][2] - m[2][0], (0, 3): m[1][0] - m[0][1],
            (1, 2): m[1][0] + m[0][1], (1, 3): m[0][2] + m[2][0], (2, 3): m[2][1] + m[1][2]}
    largest = max(range(4), key=lambda i: squares[i])
    four = 2 * math.sqrt(squares[largest])
    return [four / 4 if i == largest else sums[min(i, largest), max(i, largest)] / four for i in range(4)]


def write_points(found, path):
    with open(path, "w") as file:
        file.write(f"{len(found)}\n")
        for block in found:
            file.write(f"{'fixed' if block.fixed else 'free'} {block.density:.17g} {block.density * block.volume:.17g} "
                       f"{len(block.vertices)}\n")
            corners = itertools.chain.from_iterable(subtract(vertex, block.centre) for vertex in block.vertices)
            file.write(" ".join(f"{x:.17g}" for x in corners) + "\n")
            file.write(" ".join(f"{x:.17g}" for x in block.centre) + "\n")


if __name__ == "__main__":
    write_points(read(sys.argv[1]), sys.argv[2])
