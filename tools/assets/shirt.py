"""A short-sleeved shirt of 455 points on an unseen dancer: arms up and down, the chest turns against the hips.

The trunk is a tube up to the armpits; above them a front and a back panel meet in the shoulder seams and leave neck
and armholes open. A sleeve starts with the points of its armhole.
"""
import math

from cloth import Cloth, Noise, eased
from glb import Model
from linear import add, axis_angle, cross, curve, dot, mix, mul, normalize, quaternion_product, smoothstep, sub
import textures

FRAMES, RATE = 48, 24
POINTS = 455
HALF = 14                       # columns on the front, as on the back; column 0 is the right side (−x), 7 mid-front
SIDE = 2                        # columns 0…SIDE beside the seam belong to the armhole
NECK = 4                        # the neck is open between columns NECK and HALF − NECK
PANEL_ROWS, SLEEVE_ROWS = 3, 4
TRUNK = [0.06, 0.115, 0.17, 0.225, 0.28, 0.335, 0.39, 0.44, 0.485]      # heights of the rows, hem to armpit
TILE = 0.09
DROOP, SLEEVE = 32.0, 0.205     # degrees that a sleeve hangs at rest, metres
HIPS, SPINE, CHEST, LEFT, RIGHT = range(5)


def trunk_point(column, y):
    angle = math.pi * column / HALF
    wide = curve([(0.05, 0.265), (0.25, 0.240), (0.50, 0.268)], y)
    deep = curve([(0.05, 0.150), (0.25, 0.132), (0.48, 0.150)], y)
    return (-wide * math.cos(angle), y, deep * math.sin(angle) * (1.0 if column <= HALF else 0.85))


def top_point(column):
    """Shoulder seam and neckline."""
    front = column <= HALF
    across = column if front else 2 * HALF - column
    x = curve([(2, -0.205), (7, 0.0), (12, 0.205)], across) if NECK < across < HALF - NECK else \
        {2: -0.205, 3: -0.155, 4: -0.100}.get(across) or {12: 0.205, 11: 0.155, 10: 0.100}[across]
    if NECK < across < HALF - NECK:
        x = -0.100 + 0.2 * (across - NECK) / (HALF - 2 * NECK)
        dip = 1 - (x / 0.100) ** 2
        return (x, 0.735 - (0.115 if front else 0.025) * dip ** 0.8, (0.085 if front else -0.075) * dip ** 0.5)
    return (x, 0.735 - 0.060 * smoothstep(0.08, 0.22, abs(x)), -0.005)


def trunk_influences(point):
    x, y, _ = point
    spine, chest = smoothstep(0.06, 0.24, y), smoothstep(0.26, 0.46, y)
    arm = 0.7 * smoothstep(0.13, 0.27, abs(x)) * smoothstep(0.36, 0.62, y)
    return [(HIPS, (1 - spine) * (1 - arm)), (SPINE, (spine - chest) * (1 - arm)), (CHEST, chest * (1 - arm)),
            (LEFT if x > 0 else RIGHT, arm)]


def trunk(cloth, noise):
    """Returns the point of (row, column) for the rows of the tube, then of the panels."""
    at, around = {}, {}
    for i, y in enumerate(TRUNK):
        for column in range(2 * HALF):
            loose = 0 < i < len(TRUNK) - 1 and column not in (0, HALF)
            height = y + (0.2 * 0.05 * noise.signed() if loose else 0)
            around[i, column] = column + (0.2 * noise.signed() if loose else 0)
            place = trunk_point(around[i, column], height)
            at[i, column] = cloth.point(place, trunk_influences(place))
    armpit, top = len(TRUNK) - 1, len(TRUNK) + PANEL_ROWS
    panel = list(range(SIDE, HALF - SIDE + 1))
    for column in panel + [2 * HALF - c for c in panel]:
        across = column if column <= HALF else 2 * HALF - column
        low, high = cloth.points[at[armpit, column]], top_point(column)
        for k in range(1, PANEL_ROWS + 1):
            t = k / (PANEL_ROWS + 1)
            place = mix(low, high, t)
            bulge = 0.030 * math.sin(math.pi * t) * math.sin(math.pi * column / HALF)
            inward = 0.020 * math.sin(math.pi * t) * ((across == HALF - SIDE) - (across == SIDE))
            place = add(place, (-inward, 0, bulge))
            at[armpit + k, column] = cloth.point(place, trunk_influences(place))
        shoulder = not NECK < across < HALF - NECK
        if shoulder and column > HALF:
            at[top, column] = at[top, across]
        else:
            at[top, column] = cloth.point(high, trunk_influences(high))

    def corner(row, column):
        point = at[row, column % (2 * HALF)]
        turn = around.get((row, column), column)
        return point, (turn * 0.058 / TILE, (0.8 - cloth.points[point][1]) / TILE)

    cloth.grid('trunk', [[corner(i, column) for column in range(2 * HALF + 1)] for i in range(len(TRUNK))])
    rows = range(armpit, top + 1)
    cloth.grid('trunk', [[corner(i, column) for column in panel] for i in rows])
    cloth.grid('trunk', [[corner(i, 2 * HALF - column) for column in reversed(panel)] for i in rows])
    return at


def armhole(at, side):
    """Its points in order; `side` is −1 for the right sleeve (−x), which is seen counter-clockwise from outside."""
    armpit, top = len(TRUNK) - 1, len(TRUNK) + PANEL_ROWS
    front, back = (SIDE, 2 * HALF - SIDE) if side < 0 else (HALF - SIDE, HALF + SIDE)
    bottom = [c % (2 * HALF) for c in range(-SIDE, SIDE + 1)] if side < 0 else list(range(back, front - 1, -1))
    loop = [at[armpit, c] for c in bottom]
    loop += [at[armpit + k, front] for k in range(1, PANEL_ROWS + 1)] + [at[top, front]]
    loop += [at[armpit + k, back] for k in range(PANEL_ROWS, 0, -1)]
    return loop if side < 0 else loop[::-1]


def shoulder_joint(side):
    return (0.185 * side, 0.625, 0.0)


def sleeve(cloth, loop, side):
    droop = math.radians(DROOP)
    out = (side * math.cos(droop), -math.sin(droop), 0.0)
    middle = mul((sum(cloth.points[p][0] for p in loop), sum(cloth.points[p][1] for p in loop),
                  sum(cloth.points[p][2] for p in loop)), 1 / len(loop))
    up = normalize(sub((0, 1, 0), mul(out, dot((0, 1, 0), out))))
    fore = cross(out, up)
    joint = LEFT if side > 0 else RIGHT
    rows = [loop]
    for k in range(1, SLEEVE_ROWS + 1):
        t, row = k / SLEEVE_ROWS, []
        for point in loop:
            start = cloth.points[point]
            arm = sub(start, middle)
            angle = math.atan2(dot(arm, fore), dot(arm, up))
            reach = mul(out, 0.05 + SLEEVE * t)
            ring = add(add(middle, reach), add(mul(up, 0.098 * math.cos(angle)), mul(fore, 0.088 * math.sin(angle))))
            place = mix(add(start, mul(out, SLEEVE * t)), ring, smoothstep(-0.2, 0.9, t))
            held = [(j, w * (1 - smoothstep(-0.1, 0.7, t))) for j, w in cloth.influences[point]]
            row.append(cloth.point(place, merged(held + [(joint, smoothstep(-0.1, 0.7, t))])))
        rows.append(row)

    def corner(k, i):
        return rows[k][i % len(loop)], (i * 0.05 / TILE, k * SLEEVE / SLEEVE_ROWS / TILE)

    cloth.grid('trunk', [[corner(k, i) for i in range(len(loop) + 1)] for k in range(SLEEVE_ROWS + 1)])


def merged(influences):
    total = {}
    for joint, weight in influences:
        total[joint] = total.get(joint, 0) + weight
    return list(total.items())


def build():
    model, cloth, noise = Model('shirt'), Cloth(), Noise(61)
    model.joint('hips', None, (0, 0.05, 0))
    model.joint('spine', HIPS, (0, 0.14, 0))
    model.joint('chest', SPINE, (0, 0.19, 0))
    for name, side in (('arm_left', 1), ('arm_right', -1)):
        model.joint(name, CHEST, sub(shoulder_joint(side), (0, 0.38, 0)))

    at = trunk(cloth, noise)
    for side in (1, -1):
        sleeve(cloth, armhole(at, side), side)
    cloth.split_longest('trunk', POINTS - len(cloth.points))
    cloth.parts['shirt'] = cloth.parts.pop('trunk')
    stripes = textures.stripes(256, 4, (0.46, 0.47, 0.47), (0.10, 0.17, 0.30), 0.72, seed=62)
    cloth.emit(model, 'shirt', model.material('cloth', stripes))

    times = [f / RATE for f in range(FRAMES)]
    wave = [2 * math.pi * f / FRAMES for f in range(FRAMES)]
    lift = [eased(f, FRAMES) for f in range(FRAMES)]
    model.animate(HIPS, 'rotation', times, [axis_angle((0, 1, 0), -8 * math.sin(w)) for w in wave])
    model.animate(SPINE, 'rotation', times, [quaternion_product(
        axis_angle((0, 1, 0), 13 * math.sin(w)), axis_angle((0, 0, 1), 5 * math.sin(w))) for w in wave])
    model.animate(CHEST, 'rotation', times, [quaternion_product(
        axis_angle((0, 1, 0), 15 * math.sin(w)), axis_angle((0, 0, 1), 5 * math.sin(w))) for w in wave])
    model.animate(CHEST, 'translation', times, [(0, 0.19 - 0.014 * (1 - up), 0) for up in lift])
    for joint, side in ((LEFT, 1), (RIGHT, -1)):
        turns = [axis_angle((0, 0, 1), side * (-22 + 62 * up)) for up in lift]
        model.animate(joint, 'rotation', times, turns)
    return model
