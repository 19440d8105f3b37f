"""The paper's test square (Loviscach 2006, section 8): 1 m × 1 m, 148 irregular triangles, squeezed along x.

One joint scales it: 100 % at 0 s, 98 % at 1 s, 75 % at 2 s, 50 % at 3 s (frames 1, 25, 49, 73), linear between. The
undeformed square is the bind pose. It stands in the plane z = 0 over x = −½ … ½, y = 0 … 1 and faces +z.
"""
from cloth import Cloth, Noise, delaunay
from glb import Model
from linear import length, sub
import textures

SIDE = 8            # edges on each side of the boundary
INSIDE = 59         # triangles = 2·(INSIDE + 4·SIDE) − 2 − 4·SIDE = 148


def scattered():
    """Boundary points uneven along their sides, and inside the best of few darts (Mitchell 1991): irregular, but no
    slivers."""
    noise = Noise(3)
    sides = []
    for corner, along in (((0, 0), (1, 0)), ((1, 0), (0, 1)), ((1, 1), (-1, 0)), ((0, 1), (0, -1))):
        for k in range(SIDE):
            t = (k + (0.28 * noise.signed() if k else 0)) / SIDE
            sides.append((corner[0] + along[0] * t, corner[1] + along[1] * t))
    points = list(sides)
    for _ in range(INSIDE):
        darts = [(0.05 + 0.9 * noise.unit(), 0.05 + 0.9 * noise.unit()) for _ in range(14)]
        points.append(max(darts, key=lambda dart: min(length(sub(dart, point)) for point in points)))
    return points


def build():
    model, cloth = Model('square'), Cloth()
    model.joint('squeeze')
    points = scattered()
    for x, y in points:
        cloth.point((x - 0.5, y, 0.0))
    for triangle in delaunay(points):
        cloth.triangle('square', *[(k, (points[k][0], 1 - points[k][1])) for k in triangle])
    assert len(cloth.parts['square']) == 148

    cloth.emit(model, 'square', model.material('cloth', textures.plain(128, (0.35, 0.35, 0.34), seed=31)))
    model.animate(0, 'scale', [0.0, 1.0, 2.0, 3.0], [(size, 1, 1) for size in (1.0, 0.98, 0.75, 0.5)])
    return model
