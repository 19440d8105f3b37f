"""Welded points with triangles that carry uv per corner, and what the models do with them.

A seam in uv is where two corners of one point disagree; `emit` splits the point there, as a file must.
"""
import math

from linear import add, cross, dot, length, mix, mul, normalize, sub, transform


class Noise:
    """Numbers that are the same everywhere and always: xorshift32 (Marsaglia 2003)."""

    def __init__(self, seed):
        self.state = seed * 2654435761 % 2**32 or 1

    def unit(self):
        x = self.state
        x ^= x << 13 & 0xffffffff
        x ^= x >> 17
        x ^= x << 5 & 0xffffffff
        self.state = x
        return x / 2**32

    def signed(self):
        return 2 * self.unit() - 1


class Cloth:
    def __init__(self):
        self.points = []
        self.influences = []   # per point: (joint, weight) pairs
        self.parts = {}        # name → triangles of three corners (point, (u, v))

    def point(self, position, influences=((0, 1.0),)):
        self.points.append(tuple(position))
        self.influences.append(strongest(influences))
        return len(self.points) - 1

    def triangle(self, part, a, b, c):
        self.parts.setdefault(part, []).append((a, b, c))

    def quad(self, part, a, b, c, d):
        """Corners counter-clockwise; cut along the shorter diagonal, which follows the jitter of the points."""
        p = [self.points[corner[0]] for corner in (a, b, c, d)]
        if length(sub(p[0], p[2])) <= length(sub(p[1], p[3])):
            self.triangle(part, a, b, c)
            self.triangle(part, a, c, d)
        else:
            self.triangle(part, a, b, d)
            self.triangle(part, b, c, d)

    def grid(self, part, rows):
        """Quads between neighbouring rows of corners; left to right, bottom to top, seen from outside."""
        for low, high in zip(rows, rows[1:]):
            for a, b, c, d in zip(low, low[1:], high[1:], high):
                self.quad(part, a, b, c, d)

    def split_longest(self, part, count):
        """Adds `count` points, each in the middle of the longest edge there is: uneven on purpose, exact in number."""
        for _ in range(count):
            triangles = self.parts[part]
            a, b = max(((corner[i][0], corner[i - 1][0]) for corner in triangles for i in range(3)),
                       key=lambda edge: (round(length(sub(self.points[edge[0]], self.points[edge[1]])), 7), edge))
            blend = {}
            for joint, weight in self.influences[a] + self.influences[b]:
                blend[joint] = blend.get(joint, 0) + weight / 2
            middle = self.point(mix(self.points[a], self.points[b], 0.5), blend.items())
            kept = []
            for triangle in triangles:
                corners = {corner[0] for corner in triangle}
                if not {a, b} <= corners:
                    kept.append(triangle)
                    continue
                while triangle[2][0] in (a, b):  # turn until the third corner is the one off the edge
                    triangle = (triangle[1], triangle[2], triangle[0])
                first, second, third = triangle
                new = (middle, mix(first[1], second[1], 0.5))
                kept += [(first, new, third), (new, second, third)]
            self.parts[part] = kept

    def normals(self, part):
        sums = {}
        for triangle in self.parts[part]:
            p, q, r = (self.points[corner[0]] for corner in triangle)
            area = cross(sub(q, p), sub(r, p))
            for corner in triangle:
                sums[corner[0]] = add(sums.get(corner[0], (0, 0, 0)), area)
        return {point: normalize(total) for point, total in sums.items()}

    def emit(self, model, part, material):
        normals = self.normals(part)
        index, order, triangles = {}, [], []
        for triangle in self.parts[part]:
            ids = []
            for point, uv in triangle:
                key = (point, tuple(round(value, 7) for value in uv))
                if key not in index:
                    index[key] = len(order)
                    order.append(key)
                ids.append(index[key])
            triangles.append(ids)
        model.mesh(part, material, [self.points[point] for point, _ in order], [normals[point] for point, _ in order],
                   [uv for _, uv in order], triangles, [self.influences[point] for point, _ in order])

    def posed(self, matrices):
        """Linear blend skinning with one matrix per joint (posed world · inverse bind)."""
        result = []
        for point, influences in zip(self.points, self.influences):
            total = (0.0, 0.0, 0.0)
            for joint, weight in influences:
                total = add(total, mul(transform(matrices[joint], point), weight))
            result.append(total)
        return result


def strongest(influences, most=4):
    """The heaviest four, summing to one."""
    kept = sorted(((joint, weight) for joint, weight in influences if weight > 1e-4), key=lambda e: (-e[1], e[0]))[:most]
    total = sum(weight for _, weight in kept)
    return [(joint, weight / total) for joint, weight in kept]


def chain_weights(steps):
    """Weights along a chain of joints: `steps[k]` is how far joint k has taken over from joint k − 1 (0…1, not
    growing with k); the first is 1."""
    return [(k, step - (steps[k + 1] if k + 1 < len(steps) else 0.0)) for k, step in enumerate(steps)]


def delaunay(points):
    """Triangles (counter-clockwise) of points in the plane in general position, by wrapping: each open edge takes the
    point that sees it under the widest angle, whose circumcircle is therefore empty. Points on one straight side
    of the hull are no trouble, for none of them lies strictly beyond it."""
    def left(a, b, c):
        return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])

    def best(i, j):
        found, widest = None, 2.0
        for k, p in enumerate(points):
            if left(points[i], points[j], p) > 1e-9:
                u, v = sub(points[i], p), sub(points[j], p)
                cosine = dot(u, v) / (length(u) * length(v))
                if cosine < widest:
                    found, widest = k, cosine
        return found

    start = min(range(len(points)), key=lambda k: points[k])
    nearest = min((k for k in range(len(points)) if k != start), key=lambda k: length(sub(points[k], points[start])))
    open_edges, done, triangles = [(start, nearest), (nearest, start)], set(), []
    while open_edges:
        edge = open_edges.pop()
        if edge in done:
            continue
        done.add(edge)
        third = best(*edge)
        if third is None:
            continue
        i, j = edge
        triangles.append((i, j, third))
        done.update([(j, third), (third, i)])
        open_edges += [(third, j), (i, third)]
    return triangles


def eased(frame, frames, delay=0.0):
    """0 → 1 → 0 over one loop of `frames`, cosine; `delay` in frames."""
    return 0.5 - 0.5 * math.cos(2 * math.pi * (frame - delay) / frames)
