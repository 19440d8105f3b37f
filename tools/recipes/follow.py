"""Base surfaces that follow a coarse cloth simulation: what the length Λ below which folds go to waves does."""
import math

MAKES = ['follow.csv']
MEASURES = True
NEEDS = 'PLISSE_CLOTH_DRAPE'  # a square of cloth in quads with uv, 1 m, rest pose = frame 1: drape_####.obj
FRAMES = '25,33,41,48'


def lines(path, cells):
    """The length of each line of constant u, then of constant v, over its length at rest."""
    places, uv, of_vertex = [], [], {}
    for line in open(path):
        words = line.split()
        if not words:
            continue
        if words[0] == 'v':
            places.append(tuple(map(float, words[1:4])))
        elif words[0] == 'vt':
            uv.append(tuple(map(float, words[1:3])))
        elif words[0] == 'f':
            for corner in words[1:]:
                v, vt = corner.split('/')[:2]
                of_vertex[int(v) - 1] = uv[int(vt) - 1]
    lengths = []
    for axis in (0, 1):
        found = {}
        for vertex, at in of_vertex.items():
            number = at[axis] * cells
            if abs(number - round(number)) < 1e-4:
                found.setdefault(round(number), []).append((at[1 - axis], places[vertex]))
        for points in found.values():
            points.sort()
            lengths.append(sum(math.dist(a[1], b[1]) for a, b in zip(points, points[1:])))
    return sorted(lengths)


def make(kit):
    kit.folder_of(NEEDS, 'drape')
    edge = (2 + math.sqrt(2)) / 3 / 36  # the mean over the quads' sides and diagonals, m
    rows = []
    for edges in (0, 4, 6, 8, 12):
        report = kit.plisse('export', 'drape/drape_####.obj', '--solve', '--cache-dir', 'none', '--follow',
                            f'{edges * edge:.4f}', '--frames', FRAMES, '--levels', 3, '-o', f'waves_{edges}_####.obj', codes=(0, 1))
        frames = [f for f in report['solve']['frames'] if str(f['frame']) in FRAMES.split(',')]
        lengths = sorted(x for f in frames for x in lines(kit.work / f'waves_{edges}_{f["frame"]:04}.obj', 36))
        every = report['solve']['frames']
        mean = lambda key, of=frames: sum(f[key] for f in of) / len(of)
        rows.append([edges, f'{1e3 * mean("moved_rms_m"):.1f}', f'{1e3 * mean("wavelength_m"):.0f}',
                     f'{100 * mean("untaken"):.0f}', f'{lengths[len(lengths) // 2]:.3f}',
                     f'{lengths[len(lengths) // 20]:.3f}', f'{lengths[-1]:.3f}',
                     f'{mean("follow_s", every):.3f}', f'{mean("solve_s", every):.3f}',
                     '' if report['solve']['converged'] else 'not converged'])
    kit.table('follow', ['Λ, edges', 'moved, mm', 'waves, mm', 'untaken, %', 'length kept', '5th percentile', 'longest',
                         'base, s a frame', 'fields, s a frame', ''], rows, 'wrinkle.md', kit.provenance())
