"""Model A of the paper's Table 2, by its numbers: 100 points that fill the picture. A cloth of 10 × 10 points, crumpled
by nine joints in its plane."""
import math

from cloth import Cloth, Noise, eased
from glb import Model
from linear import add
import textures

FRAMES, RATE = 48, 24
SIDE, WIDTH, HEIGHT, FLOOR = 10, 1.25, 1.0, 0.05
GRID = 3


def place(u, v):
    return (WIDTH * (u - 0.5), FLOOR + HEIGHT * v, 0.06 * math.sin(math.pi * u) * math.sin(math.pi * v))


def build():
    model, cloth, noise = Model('model_a'), Cloth(), Noise(71)
    root = model.joint('root')
    joints = {(i, j): model.joint(f'pin_{i}{j}', root, place(j / (GRID - 1), i / (GRID - 1)))
              for i in range(GRID) for j in range(GRID)}

    def hats(t):
        k = min(int(t * (GRID - 1)), GRID - 2)
        share = t * (GRID - 1) - k
        share = share * share * (3 - 2 * share)
        return ((k, 1 - share), (k + 1, share))

    rows = []
    for i in range(SIDE):
        row = []
        for j in range(SIDE):
            u, v = j / (SIDE - 1), i / (SIDE - 1)
            if 0 < j < SIDE - 1:
                u += 0.25 * noise.signed() / (SIDE - 1)
            if 0 < i < SIDE - 1:
                v += 0.25 * noise.signed() / (SIDE - 1)
            influences = [(joints[p, q], a * b) for p, a in hats(v) for q, b in hats(u)]
            row.append((cloth.point(place(u, v), influences), (u * WIDTH / 0.25, (1 - v) * HEIGHT / 0.25)))
        rows.append(row)
    cloth.grid('cloth', rows)
    picture = textures.gingham(256, 4, (0.45, 0.44, 0.41), (0.34, 0.20, 0.17), seed=72)
    cloth.emit(model, 'cloth', model.material('cloth', picture))

    times = [f / RATE for f in range(FRAMES)]
    for (i, j), joint in joints.items():
        u, v = j / (GRID - 1) - 0.5, i / (GRID - 1) - 0.5
        rest, moves = place(u + 0.5, v + 0.5), []
        for f in range(FRAMES):
            push, turn = eased(f, FRAMES), eased(f, FRAMES, 6)
            # Corners and edges come in, and the whole shears; the middle comes to the front.
            inward = (-0.11 * WIDTH * u * 2 * push, -0.06 * HEIGHT * v * 2 * turn)
            shear = 0.07 * v * 2 * turn
            depth = 0.09 * push * (1 - 2 * abs(u)) * (1 - 2 * abs(v)) - 0.06 * turn * (abs(u) + abs(v))
            moves.append(add(rest, (inward[0] + shear, inward[1], depth)))
        model.animate(joint, 'translation', times, moves)
    return model
