"""A curtain of 23 × 4 = 92 points, drawn to one side until half its width is left, with a slight sway."""
import math

from cloth import Cloth, Noise, eased
from glb import Model
from linear import add, mix
import textures

FRAMES, RATE = 48, 24
COLUMNS, ROWS = 23, 4
WIDTH, HEIGHT, FLOOR = 2.2, 2.0, 0.03
HANGERS = 5
LEFT_OVER = 0.5      # of the width, when drawn


def hanger(k, drawn):
    """Where hanger k stands on the rail; the left one stays."""
    share = mix(1.0, LEFT_OVER, drawn)
    return (-WIDTH / 2 + WIDTH * k / (HANGERS - 1) * share, FLOOR + HEIGHT, 0.0)


def build():
    model, cloth, noise = Model('curtain'), Cloth(), Noise(41)
    rail = model.joint('rail')
    tops = [model.joint(f'hanger_{k}', rail, hanger(k, 0)) for k in range(HANGERS)]
    hems = [model.joint(f'hem_{k}', tops[k], (0, -HEIGHT, 0)) for k in range(HANGERS)]

    rows = []
    for i in range(ROWS):
        row = []
        for j in range(COLUMNS):
            u, v = j / (COLUMNS - 1), i / (ROWS - 1)      # v from the hem up
            if 0 < j < COLUMNS - 1:
                u += 0.22 * noise.signed() / (COLUMNS - 1)
            if 0 < i < ROWS - 1:
                v += 0.15 * noise.signed() / (ROWS - 1)
            place = u * (HANGERS - 1)
            k = min(int(place), HANGERS - 2)
            across = ((k, 1 - (place - k)), (k + 1, place - k))
            influences = [(joints[h], w * share) for h, w in across for joints, share in ((hems, 1 - v), (tops, v))]
            fall = 0.05 * math.sin(2.5 * math.pi * u + 0.5) * (1 - 0.6 * v)
            point = cloth.point((WIDTH * (u - 0.5), FLOOR + HEIGHT * v, fall), influences)
            row.append((point, (u * WIDTH / 0.4, (1 - v) * HEIGHT / 0.4)))
        rows.append(row)
    cloth.grid('curtain', rows)

    picture = textures.stripes(256, 4, (0.36, 0.20, 0.15), (0.42, 0.33, 0.26), 0.6, seed=42)
    cloth.emit(model, 'curtain', model.material('cloth', picture))

    times = [frame / RATE for frame in range(FRAMES)]
    for k in range(HANGERS):
        model.animate(tops[k], 'translation', times, [hanger(k, eased(f, FRAMES)) for f in range(FRAMES)])
        sway = []
        for f in range(FRAMES):
            angle = 2 * math.pi * f / FRAMES - 0.9 * k
            lag = 0.10 * (eased(f, FRAMES, 2) - eased(f, FRAMES)) * k   # the hem follows the rail
            sway.append(add((0, -HEIGHT, 0), (-3 * lag / HANGERS, 0.0, 0.05 * math.sin(angle))))
        model.animate(hems[k], 'translation', times, sway)
    return model
