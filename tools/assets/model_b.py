"""Model B of the paper's Table 2, by its numbers: 5,977 points that are small in the picture. A dress of 43 rows and 139
columns, open above and below; the waist turns, the skirt swings and the wearer bobs."""
import math

from cloth import Cloth, Noise, eased
from glb import Model
from linear import add, axis_angle, curve, quaternion_product, smoothstep
import textures

FRAMES, RATE = 48, 24
ROWS, COLUMNS = 43, 139
HEIGHT, FLOOR = 1.05, 0.04
HIPS, SPINE, CHEST, FIRST_SKIRT, SKIRTS = 0, 1, 2, 3, 6
WIDE = [(0.0, 0.43), (0.30, 0.33), (0.56, 0.205), (0.72, 0.132), (0.92, 0.172), (1.05, 0.180)]
DEEP = [(0.0, 0.39), (0.30, 0.29), (0.56, 0.175), (0.72, 0.105), (0.92, 0.138), (1.05, 0.128)]
PITCH = 0.06


def surface_point(turn, y):
    angle = 2 * math.pi * turn
    skirt = 1 - smoothstep(0.15, 0.62, y)
    folds = 1 + skirt * (0.07 * math.cos(11 * angle + 0.6 * math.sin(3 * angle)) + 0.02 * math.cos(5 * angle))
    neckline = -0.035 * math.cos(angle) ** 3 * smoothstep(0.90, 1.05, y)
    return (curve(WIDE, y) * folds * math.sin(angle), FLOOR + y + neckline, curve(DEEP, y) * folds * math.cos(angle))


def influences(turn, y):
    spine, chest = smoothstep(0.60, 0.82, y), smoothstep(0.78, 0.98, y)
    swing = 1 - smoothstep(0.10, 0.60, y)
    at = turn * SKIRTS % SKIRTS
    k, share = int(at) % SKIRTS, at - int(at)
    if swing > 0:  # the spine begins above
        return [(HIPS, 1 - swing), (FIRST_SKIRT + k, swing * (1 - share)),
                (FIRST_SKIRT + (k + 1) % SKIRTS, swing * share)]
    return [(HIPS, 1 - spine), (SPINE, spine - chest), (CHEST, chest)]


def build():
    model, cloth, noise = Model('model_b'), Cloth(), Noise(81)
    model.joint('hips', None, (0, FLOOR + 0.62, 0))
    model.joint('spine', HIPS, (0, 0.10, 0))
    model.joint('chest', SPINE, (0, 0.18, 0))
    for k in range(SKIRTS):
        model.joint(f'skirt_{k}', HIPS, (0, 0, 0))

    rows = []
    for i in range(ROWS):
        row = []
        for j in range(COLUMNS):
            turn, y = j / COLUMNS, HEIGHT * i / (ROWS - 1)
            if 0 < i < ROWS - 1:
                y += 0.2 * noise.signed() * HEIGHT / ROWS
                turn += 0.2 * noise.signed() / COLUMNS if j else 0
            point = cloth.point(surface_point(turn, y), influences(turn, y))
            row.append((point, (turn * 24, (HEIGHT - y) / PITCH)))
        rows.append(row + [(row[0][0], (24.0, row[0][1][1]))])
    cloth.grid('dress', rows)
    assert len(cloth.points) == 5977
    cloth.emit(model, 'dress', model.material('cloth', textures.gingham(128, 2, (0.44, 0.36, 0.36), (0.30, 0.10, 0.13),
                                                                       seed=82)))

    times = [f / RATE for f in range(FRAMES)]
    wave = [2 * math.pi * f / FRAMES for f in range(FRAMES)]
    model.animate(HIPS, 'translation', times, [(0, FLOOR + 0.62 - 0.02 * eased(f, FRAMES / 2), 0)
                                               for f in range(FRAMES)])
    model.animate(HIPS, 'rotation', times, [axis_angle((0, 1, 0), 14 * math.sin(w)) for w in wave])
    model.animate(SPINE, 'rotation', times, [quaternion_product(
        axis_angle((0, 1, 0), -20 * math.sin(w)), axis_angle((0, 0, 1), 8 * math.sin(w))) for w in wave])
    model.animate(SPINE, 'translation', times, [(0, 0.10 - 0.015 * eased(f, FRAMES / 2), 0) for f in range(FRAMES)])
    model.animate(CHEST, 'rotation', times, [axis_angle((0, 1, 0), -16 * math.sin(w)) for w in wave])
    for k in range(SKIRTS):
        angle = 2 * math.pi * k / SKIRTS
        outward = (math.cos(angle), 0.0, -math.sin(angle))      # turning about it swings this part out
        turns = [quaternion_product(axis_angle((0, 1, 0), 9 * math.sin(w - 0.9)),
                                    axis_angle(outward, -4 - 5 * math.sin(2 * w - angle))) for w in wave]
        model.animate(FIRST_SKIRT + k, 'rotation', times, turns)
    return model
