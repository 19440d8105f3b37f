"""The demo: a cotton sleeve that bends at the elbow, 450 welded points.

The arm runs along s, from the shoulder (0) to the wrist (0.62 m); phi goes round it, 0 at the inner elbow, and the uv
seam is at phi = π. It is bound half bent, as sleeves are cut, so that neither end of the motion is extreme: four joints
share the bend, and their weights overlap until the inner elbow is shortened by 8 to 20 % over a hand's breadth.
"""
import math

from cloth import Cloth, Noise, chain_weights, eased
from glb import Model
from linear import add, axis_angle, curve, inverse, matrix, mix, mul, product, quaternion_product, smoothstep
import textures

FRAMES, RATE = 72, 24
AROUND = 18
BOUND_BEND = 40.0                       # degrees; where the cloth is at rest
STRAIGHT, BENT, TWIST = 10.0, 100.0, 20.0
ELBOW = 0.300
SPACING = 0.070                         # between the four joints of the bend
BEND_AT = [ELBOW + SPACING * (k - 1.5) for k in range(4)]
BEND_REACH = 0.066                      # half the width of one joint's blend
TWIST_AT, TWIST_REACH = [0.455, 0.515], 0.055
SLIDE, PUSH = 0.006, 0.006              # metres: forearm toward the elbow, cuff up the arm, when fully bent
LEAN, ROLL, SHOULDER_LIFT = 4.0, 22.0, 10.0   # degrees

PITCH = 0.009                           # of the print
TILE = 4 * PITCH


def bend_share(s):
    """0…1: the part of the elbow's angle that has been turned through at s."""
    return sum(smoothstep(at - BEND_REACH, at + BEND_REACH, s) for at in BEND_AT) / 4


def centre_line(step=0.001, end=0.66):
    """Points and angles along the bound arm's middle, every `step`."""
    position, line, s = (0.0, 0.0, 0.0), [], 0.0
    while s <= end:
        angle = math.radians(BOUND_BEND) * bend_share(s)
        line.append((position, angle))
        middle = math.radians(BOUND_BEND) * bend_share(s + step / 2)
        position = add(position, (step * math.cos(middle), step * math.sin(middle), 0.0))
        s += step
    return line


LINE = centre_line()


def on_line(s):
    """Position and angle at s; straight on before the shoulder."""
    if s < 0:
        return (s, 0.0, 0.0), 0.0
    index = min(int(s / 0.001), len(LINE) - 2)
    t = s / 0.001 - index
    return mix(LINE[index][0], LINE[index + 1][0], t), mix(LINE[index][1], LINE[index + 1][1], t)


def half_widths(s):
    """In the plane of the bend, and across it: a sleeve without much arm in it is flat, and fuller at the shoulder."""
    inner = curve([(0.0, 0.068), (0.14, 0.060), (0.30, 0.045), (0.42, 0.048), (0.515, 0.048), (0.553, 0.039)], s)
    across = curve([(0.0, 0.076), (0.14, 0.069), (0.31, 0.062), (0.42, 0.058), (0.515, 0.054), (0.553, 0.045)], s)
    return inner, across


def skew(s, phi):
    """How much further along the arm the cloth is cut: the shoulder end runs up to a cap on the top and the front."""
    return -0.028 * math.cos(phi - 0.5) * (1 - smoothstep(0.0, 0.18, s))


def place(s, phi, thicker=0.0, plain=False):
    """A point of the bound sleeve."""
    centre, angle = on_line(s + skew(s, phi))
    inner, across = half_widths(s)
    # Broad, shallow dents: cloth that has been worn.
    worn = 0.0 if plain else 0.028 * math.sin(2 * phi + 9 * s + 0.6) + 0.020 * math.sin(3 * phi - 21 * s)
    worn *= smoothstep(0.02, 0.08, s) * (1 - smoothstep(0.48, 0.55, s))
    up = (inner * (1 + worn) + thicker) * math.cos(phi)
    side = (across * (1 + worn) + thicker) * math.sin(phi)
    return add(centre, (-up * math.sin(angle), up * math.cos(angle), side))


def influences(s):
    steps = [1.0] + [smoothstep(at - BEND_REACH, at + BEND_REACH, s) for at in BEND_AT]
    steps += [smoothstep(at - TWIST_REACH, at + TWIST_REACH, s) for at in TWIST_AT]
    return chain_weights(steps)


def skeleton(model):
    """upper_arm, elbow_1, elbow_2, elbow_3, forearm, forearm_twist, wrist; x along each bone."""
    names = ['upper_arm', 'elbow_1', 'elbow_2', 'elbow_3', 'forearm', 'forearm_twist', 'wrist']
    worlds = [matrix()]
    for k, at in enumerate(BEND_AT + TWIST_AT):
        turn = BOUND_BEND * min(k + 1, 4) / 4
        worlds.append(matrix(on_line(at)[0], axis_angle((0, 0, 1), turn)))
    for k, name in enumerate(names):
        if k == 0:
            model.joint(name, None, (0, 0, 0), root_rotation(0))
            continue
        local = product(inverse(worlds[k - 1]), worlds[k])
        bend = BOUND_BEND / 4 if k <= 4 else 0
        model.joint(name, k - 1, (local[0][3], local[1][3], local[2][3]), axis_angle((0, 0, 1), bend))


def root_rotation(bend):
    """The whole arm: rolled so that the inner elbow looks up and to the front; the shoulder rises as the elbow bends."""
    lift = axis_angle((0, 0, 1), LEAN - SHOULDER_LIFT * bend)
    return quaternion_product(axis_angle((1, 0, 0), ROLL), lift)


def pose(model, frame):
    """Local translation and rotation of every joint."""
    bend, twist = eased(frame, FRAMES), eased(frame, FRAMES, 3)
    angle = STRAIGHT + (BENT - STRAIGHT) * bend
    result = []
    for k, (_, _, translation, _) in enumerate(model.joints):
        slide = 0.0
        if 1 <= k <= 4:
            rotation = axis_angle((0, 0, 1), angle / 4)
            slide = SLIDE * bend / 4
        elif k == 0:
            rotation = root_rotation(bend)
        else:
            rotation = axis_angle((1, 0, 0), TWIST / 2 * twist)
            slide = PUSH * bend / 2
        result.append((add(translation, (-slide, 0, 0)), rotation))
    return result


def surface():
    noise, cloth = Noise(7), Cloth()
    shoulder = [(0.000, 0.0005), (0.003, 0.0030), (0.019, 0.0030)]
    body = [0.022, 0.055, 0.095, 0.135, 0.170, 0.200, 0.227, 0.252, 0.276, 0.300, 0.324, 0.348, 0.373, 0.400, 0.430,
            0.462, 0.495, 0.530, 0.553]
    cuff = [(0.5545, 0.0035), (0.6185, 0.0045), (0.6195, 0.0010)]
    rows = [(s, thicker, False) for s, thicker in shoulder] + [(s, 0.0, 1 < i < len(body) - 2)
                                                               for i, s in enumerate(body)]
    rows += [(s, thicker, False) for s, thicker in cuff]

    points = []
    for i, (s, thicker, loose) in enumerate(rows):
        row = []
        for j in range(AROUND):
            along, round_ = s, (j - AROUND / 2) / AROUND
            if loose:
                along += 0.20 * noise.signed() * min(rows[i + 1][0] - s, s - rows[i - 1][0])
                if j > 0:  # the seam stays straight
                    round_ += 0.20 * noise.signed() / AROUND
            phi = 2 * math.pi * round_
            plain = not loose
            row.append((cloth.point(place(along, phi, thicker, plain), influences(along)), along, round_))
        points.append(row)

    def corners(row, scale, askew):
        """One more than points: the seam's twice. uv in tiles of cloth, measured from the inner line."""
        s = sum(along for _, along, _ in row) / len(row)
        inner, across = half_widths(s)
        girth = 2 * math.pi * math.sqrt((inner * inner + across * across) / 2)
        closed = row + [(row[0][0], row[0][1], row[0][2] + 1)]
        cut = [skew(along, 2 * math.pi * round_) if askew else 0.0 for _, along, round_ in closed]
        return [(point, (girth * round_ * scale[0], (along + more) * scale[1]))
                for (point, along, round_), more in zip(closed, cut)]

    first, last = len(shoulder), len(shoulder) + len(body) - 1
    whole = (1 / TILE, 1 / TILE)
    band = (1 / 0.02, 0.5 / 0.022)
    parts = [('shoulder', points[:first + 1], band, False), ('sleeve', points[first:last + 1], whole, True),
             ('cuff', points[last:], whole, True)]
    for name, part, scale, askew in parts:
        cloth.grid(name, [corners(row, scale, askew) for row in part])
    return cloth


def build():
    model, cloth = Model('sleeve'), surface()
    skeleton(model)
    # Joints are bound in a frame of their own; the root's bound pose turns it, and the points with it.
    bound = model.globals()[0]
    poses = [pose(model, frame) for frame in range(FRAMES)]
    offsets = [product(inverse(m), bound) for m in model.globals()]
    lowest = 1.0
    for locals_ in poses[::3]:
        worlds = model.globals([matrix(*local) for local in locals_])
        lowest = min(lowest, min(p[1] for p in cloth.posed([product(w, o) for w, o in zip(worlds, offsets)])))
    lift = (-0.26, 0.0015 - lowest, 0.0)
    name, parent, _, rotation = model.joints[0]
    model.joints[0] = (name, parent, lift, rotation)
    bound = model.globals()[0]
    cloth.points = cloth.posed([bound] * len(model.joints))

    light, dark = (0.45, 0.455, 0.455), (0.23, 0.27, 0.32)
    check = textures.gingham(512, 4, light, dark, pitch=4, seed=11)
    solid = textures.plain(128, (0.10, 0.125, 0.16), pitch=4, seed=12)
    seam = textures.stitched(128, (0.085, 0.105, 0.135), (0.24, 0.245, 0.24), seed=13)
    for part, material, picture in (('shoulder', 'seam', seam), ('sleeve', 'cloth', check), ('cuff', 'cuff', solid)):
        cloth.emit(model, part, model.material(material, picture))

    times = [frame / RATE for frame in range(FRAMES)]
    for joint in range(len(model.joints)):
        if joint > 0:
            model.animate(joint, 'translation', times, [locals_[joint][0] for locals_ in poses])
        model.animate(joint, 'rotation', times, [locals_[joint][1] for locals_ in poses])
    return model
