"""A zeppelin of 508 points that crumples: 462 in the hull, nine in each of four fins, ten in the gondola.

A chain of joints runs along the hull (x, nose at +x). They are pushed together and bend against each other, so that
the hull buckles along its length, most in the middle.
"""
import math

from cloth import Cloth, Noise, chain_weights, eased
from glb import Model
from linear import add, axis_angle, mix, smoothstep
import textures

FRAMES, RATE = 48, 24
AROUND, RINGS = 20, 23
LENGTH, RADIUS, HEIGHT = 2.4, 0.36, 0.75
JOINTS = [-1.2, -0.62, -0.31, 0.0, 0.31, 0.62]      # x of the joints; the first is the tail
REACH = 0.24
SQUEEZE = [0.0, 0.05, 0.08, 0.10, 0.08, 0.05]       # metres that a joint comes closer to the one before
BUCKLE = [0.0, -4.0, 3.0, 8.0, 3.0, -4.0]          # degrees up


def influences(x):
    return chain_weights([1.0] + [smoothstep(at - REACH, at + REACH, x) for at in JOINTS[1:]])


def radius(t):
    """t from the tail (0) to the nose (1): blunt in front, slender behind."""
    return RADIUS * math.sin(math.pi * t ** 0.85) ** 0.72


def hull(cloth):
    noise, rings = Noise(51), []
    for i in range(1, RINGS + 1):
        ring = []
        for j in range(AROUND):
            t, turn = i / (RINGS + 1), j / AROUND
            t = mix(t, 0.5 - 0.5 * math.cos(math.pi * t), 0.6)      # closer rings where nose and tail curve
            if 2 < i < RINGS - 1:
                t += 0.2 * noise.signed() / (RINGS + 1)
                turn += 0.2 * noise.signed() / AROUND if j else 0
            x, angle = LENGTH * (t - 0.5), 2 * math.pi * turn
            r = radius(t)
            point = cloth.point((x, HEIGHT - r * math.cos(angle), r * math.sin(angle)), influences(x))
            ring.append((point, (4 * turn, 6 * (1 - t))))
        rings.append(ring + [(ring[0][0], (4.0, ring[0][1][1]))])
    # From below the hull by its +z side to the top: seen from outside, the tail on the left, that is upward.
    cloth.grid('hull', list(zip(*rings)))
    tail = cloth.point((-LENGTH / 2, HEIGHT, 0), influences(-LENGTH / 2))
    nose = cloth.point((LENGTH / 2, HEIGHT, 0), influences(LENGTH / 2))
    for a, b in zip(rings[0], rings[0][1:]):
        cloth.triangle('hull', (tail, ((a[1][0] + b[1][0]) / 2, 6.0)), a, b)
    for a, b in zip(rings[-1], rings[-1][1:]):
        cloth.triangle('hull', (nose, ((a[1][0] + b[1][0]) / 2, 0.0)), b, a)


def fins(cloth):
    """Three by three points each: root on the hull, swept back."""
    for k in range(4):
        angle = math.pi * (0.25 + 0.5 * k)
        out = (0.0, math.cos(angle), math.sin(angle))
        rows = []
        for i in range(3):
            row = []
            for j in range(3):
                s, t = j / 2, i / 2                        # along, and outward
                x = -1.08 - 0.10 * t + s * (0.36 - 0.17 * t)
                root = radius(x / LENGTH + 0.5) * 0.96
                reach = root + t * (0.34 - root * 0.6)
                place = add((x, HEIGHT, 0), (0, out[1] * reach, out[2] * reach))
                row.append((cloth.point(place, influences(x)), (s, t)))
            rows.append(row)
        cloth.grid('fins', rows)


def gondola(cloth):
    """A hull of eight corners with a pointed bow and stern."""
    def corner(x, y, z):
        return cloth.point((x, HEIGHT - RADIUS + y, z), influences(x)), (x * 2, z * 4 + y * 4)
    top = [corner(x, 0.03, z) for x, z in ((-0.17, -0.07), (-0.17, 0.07), (0.19, 0.07), (0.19, -0.07))]
    low = [corner(x, -0.10, z) for x, z in ((-0.14, -0.05), (-0.14, 0.05), (0.15, 0.05), (0.15, -0.05))]
    stern, bow = corner(-0.24, -0.01, 0), corner(0.29, -0.01, 0)
    for a, b, c, d in ((low[1], low[2], top[2], top[1]), (low[3], low[0], top[0], top[3]),
                       (low[0], low[3], low[2], low[1])):
        cloth.quad('gondola', a, b, c, d)
    for a, b in ((low[0], low[1]), (low[1], top[1]), (top[1], top[0]), (top[0], low[0])):
        cloth.triangle('gondola', stern, a, b)
    for a, b in ((low[3], top[3]), (top[3], top[2]), (top[2], low[2]), (low[2], low[3])):
        cloth.triangle('gondola', bow, a, b)


def build():
    model, cloth = Model('zeppelin'), Cloth()
    for k, x in enumerate(JOINTS):
        if k:
            model.joint(f'frame_{k}', k - 1, (x - JOINTS[k - 1], 0, 0))
        else:
            model.joint('tail', None, (x, HEIGHT, 0))
    hull(cloth)
    fins(cloth)
    gondola(cloth)
    assert len(cloth.points) == 508

    canvas = textures.stripes(256, 5, (0.52, 0.50, 0.45), (0.34, 0.33, 0.30), 0.88, seed=52)
    for part, picture in (('hull', canvas), ('fins', textures.plain(64, (0.30, 0.08, 0.06), seed=53)),
                          ('gondola', textures.plain(64, (0.10, 0.07, 0.05), seed=54))):
        cloth.emit(model, part, model.material({'hull': 'canvas'}.get(part, part), picture))

    times = [f / RATE for f in range(FRAMES)]
    for k, (_, _, translation, _) in enumerate(model.joints):
        if k == 0:
            turns = [axis_angle((0, 0, 1), -5 * eased(f, FRAMES)) for f in range(FRAMES)]
            shift = 0.5 * sum(SQUEEZE)                     # about its middle
            places = [add(translation, (shift * eased(f, FRAMES), 0.10 * eased(f, FRAMES), 0)) for f in range(FRAMES)]
        else:
            turns = [axis_angle((0, 0, 1), BUCKLE[k] * eased(f, FRAMES, 1)) for f in range(FRAMES)]
            places = [add(translation, (-SQUEEZE[k] * eased(f, FRAMES), 0, 0)) for f in range(FRAMES)]
        model.animate(k, 'translation', times, places)
        model.animate(k, 'rotation', times, turns)
    return model
