"""Solved fields drawn directly and as bias: the angle to the geometry of the same waves, and the error of heights."""
import math
import os
import struct

from recipes.kit import read_png

MAKES = ['field_drawing.csv']
SCENES = ['stretched-sheet', 'sheared-rectangle', 'twisted-cylinder', 'disk-balloon', 'torus', 'teabag', 'annulus', 'sphere-drape',
          'curtain', 'skirt']


def normals(file):
    """Of each pixel, not of unit length; None where there is nothing."""
    rows = read_png(file.read_bytes())
    return [[None if max(row[i:i + 3]) == 0 else [v / 127.5 - 1 for v in row[i:i + 3]] for i in range(0, len(row), 3)] for row in rows]


def mean_angle(one, other):
    """In degrees, over the pixels that both cover."""
    total, count = 0, 0
    for mine, theirs in zip(one, other):
        for a, b in zip(mine, theirs):
            if a is None or b is None:
                continue
            cosine = sum(x * y for x, y in zip(a, b)) / math.sqrt(sum(x * x for x in a) * sum(x * x for x in b))
            total, count = total + math.degrees(math.acos(max(-1, min(1, cosine)))), count + 1
    return total / count


def places(file):
    """The x, y and z of a binary PLY's vertices, which begin with three doubles or floats."""
    head, _, body = file.read_bytes().partition(b'end_header\n')
    lines = head.decode().splitlines()
    size = {'double': 8, 'float64': 8, 'float': 4, 'float32': 4, 'uchar': 1, 'uint8': 1, 'int': 4, 'uint': 4, 'int32': 4, 'uint32': 4}
    count, of, inside = 0, [], False
    for words in (line.split() for line in lines):
        if words[0] == 'element':
            inside = words[1] == 'vertex'
            count = int(words[2]) if inside else count
        elif words[0] == 'property' and inside:
            of.append(words[1])
    stride, kind = sum(size[t] for t in of), '<ddd' if size[of[0]] == 8 else '<fff'
    return [struct.unpack_from(kind, body, stride * i) for i in range(count)]


def compare(kit, name, base, field, mesh):
    points = places(kit.work / base)
    low, high = [min(axis) for axis in zip(*points)], [max(axis) for axis in zip(*points)]
    middle, size = [(a + b) / 2 for a, b in zip(low, high)], math.dist(low, high)
    eye = [m + 1.7 * size * d for m, d in zip(middle, (0.5, 0.55, 0.67))]
    camera = f'[camera]\neye = {eye}\ntarget = {middle}\n'
    kit.write(f'{name}.toml', f'[model]\npath = "{base}"\n[bias]\nfield = "{field}"\nuse = "direct"\n{camera}')
    kit.write(f'{name}_mesh.toml', f'[model]\npath = "{mesh}"\n[wrinkles]\nstrength = 0\n{camera}')
    pictures = {}
    for kind, scene, options in [('shaded', name, []), ('displaced', name, ['--displace']), ('mesh', f'{name}_mesh', [])]:
        kit.plisse('render', f'{scene}.toml', '-o', f'{name}_{kind}.png', '--size', '600x480', '--aov', 'normal', *options)
        pictures[kind] = normals(kit.work / f'{name}_{kind}.normal.png')
    return [f'{mean_angle(pictures[kind], pictures["mesh"]):.2f}°' for kind in ('shaded', 'displaced')]


def as_bias(kit, name, base, field):
    kit.write(f'{name}.paint.toml', f'scene = "{base}"\npreview_frame = 0\n[[stroke]]\nkind = "field"\nfile = "{field}"\n')
    error = kit.plisse('paint', f'{name}.paint.toml', '-o', f'{name}_painted')['field_error']
    return [f'{100 * error[step]:.1f} %' if step in error else '–' for step in ('vertices', 'texture')]


def edges_a_wave(kit, field, wavelength):
    """The median wavelength over the mean edge of a field's file: four doubles a vertex, lists of three, edges."""
    head, _, body = (kit.work / field).read_bytes().partition(b'end_header\n')
    counts = [int(line.split()[2]) for line in head.decode().splitlines() if line.startswith('element')]
    at = [struct.unpack_from('<ddd', body, 32 * i) for i in range(counts[0])]
    ends = [struct.unpack_from('<II', body, 32 * counts[0] + 38 * counts[1] + 16 * i) for i in range(counts[2])]
    return f'{wavelength * len(ends) / sum(math.dist(at[a], at[b]) for a, b in ends):.1f}'


def make(kit):
    rows = []
    for name in SCENES:
        base, field, mesh = (f'{name}_{kind}.ply' for kind in ('base', 'field', 'waves'))
        kit.plisse('drape', '--example', name, '-o', base, codes=(0, 1))
        report = kit.plisse('wrinkle', base, '-o', field, '--mesh', mesh, codes=(0, 1))
        rows.append([name, report['vertices'], edges_a_wave(kit, field, report['wavelength_m']), *compare(kit, name, base, field, mesh), *as_bias(kit, name, base, field)])
    if 'PLISSE_CLOTH_DRAPE' in os.environ:
        kit.folder_of('PLISSE_CLOTH_DRAPE', 'cloth')
        report = kit.plisse('wrinkle', 'cloth/drape_####.obj', '-o', 'cloth_waves', '--frames', '48', '--mesh', 'cloth_mesh_####.ply', codes=(0, 1))
        rows.append(['cloth-drape, frame 48', report['vertices'], edges_a_wave(kit, 'cloth_waves/field_0048.ply', report['frames'][0]['wavelength_m']),
                     *compare(kit, 'cloth', 'cloth_waves/base_0048.ply', 'cloth_waves/field_0048.ply', 'cloth_mesh_0048.ply'),
                     *as_bias(kit, 'cloth', 'cloth_waves/base_0048.ply', 'cloth_waves/field_0048.ply')])
    kit.table('field_drawing', ['scene', 'vertices', 'edges a wave', 'shaded, to the geometry', 'displaced, to the geometry', 'as bias of vertices',
                                'as texture'], rows, 'paint.md', kit.provenance())
