"""Vectors, quaternions and rigid frames as plain tuples: the little linear algebra that the models need.

Vectors are (x, y, z), quaternions (x, y, z, w) as glTF stores them, matrices four rows of four numbers acting on columns.
"""
import math


def add(a, b):
    return tuple(p + q for p, q in zip(a, b))


def sub(a, b):
    return tuple(p - q for p, q in zip(a, b))


def mul(a, scale):
    return tuple(p * scale for p in a)


def dot(a, b):
    return sum(p * q for p, q in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a):
    return math.sqrt(dot(a, a))


def normalize(a):
    size = length(a)
    return mul(a, 1 / size) if size > 0 else a


def mix(a, b, t):
    """Between numbers or vectors."""
    if isinstance(a, (int, float)):
        return a + (b - a) * t
    return tuple(p + (q - p) * t for p, q in zip(a, b))


def smoothstep(low, high, x):
    t = min(max((x - low) / (high - low), 0.0), 1.0)
    return t * t * (3 - 2 * t)


def curve(points, x):
    """Through (x, value) points with smoothstep between them; constant outside."""
    if x <= points[0][0]:
        return points[0][1]
    for (x0, v0), (x1, v1) in zip(points, points[1:]):
        if x <= x1:
            return mix(v0, v1, smoothstep(x0, x1, x))
    return points[-1][1]


def axis_angle(axis, degrees):
    half = math.radians(degrees) / 2
    return (*mul(normalize(axis), math.sin(half)), math.cos(half))


def quaternion_product(a, b):
    """Rotates by b first, then by a."""
    vector = add(add(mul(b[:3], a[3]), mul(a[:3], b[3])), cross(a[:3], b[:3]))
    return (*vector, a[3] * b[3] - dot(a[:3], b[:3]))


def rotate(q, v):
    t = mul(cross(q[:3], v), 2)
    return add(add(v, mul(t, q[3])), cross(q[:3], t))


def matrix(translation=(0, 0, 0), rotation=(0, 0, 0, 1), scale=(1, 1, 1)):
    columns = [mul(rotate(rotation, axis), s) for axis, s in zip(((1, 0, 0), (0, 1, 0), (0, 0, 1)), scale)]
    return tuple((columns[0][i], columns[1][i], columns[2][i], translation[i]) for i in range(3)) + ((0, 0, 0, 1),)


def product(a, b):
    return tuple(tuple(sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)) for i in range(4))


def inverse(m):
    """Of an affine matrix: cofactors of the 3×3 part."""
    c = [tuple(m[i][j] for i in range(3)) for j in range(3)]
    rows = [cross(c[1], c[2]), cross(c[2], c[0]), cross(c[0], c[1])]
    determinant = dot(rows[0], c[0])
    rows = [mul(row, 1 / determinant) for row in rows]
    t = (m[0][3], m[1][3], m[2][3])
    return tuple((*row, -dot(row, t)) for row in rows) + ((0, 0, 0, 1),)


def transform(m, v):
    return tuple(m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2] + m[i][3] for i in range(3))
