"""St. Venant-Kirchhoff shells that find their waves by themselves, at three sizes of the stretched sheet and one of the twisted cylinder."""
import math

from recipes.kit import read_base

MAKES = ['drape_stvk_sheet.csv', 'drape_stvk_tube.csv']
MEASURES = True
SHEET = ['stretched sheet, vertices of the quarter', 'peak', 'waves, mm long', 'steps', 'CPU', 'memory', 'the paper (fig. 7)']
TUBE = ['twisted cylinder, vertices', 'J (tension field)', 'waves at nine heights', 'high in the middle', 'waist', 'steps', 'CPU', 'memory', 'the paper (fig. 21)']


def drape(kit, example, wanted, *more):
    return kit.plisse('drape', '--example', example, '--vertices', wanted, '--steps', 1, *more, '-o', 'base.ply')


def cost(kit, report):
    return [report['iterations'] if report['converged'] else f'{report["iterations"]}, not converged', f'{kit.spent[1]:,.1f} s', f'{report["peak_rss_MiB"]:.0f} MiB']


def sheet(kit, wanted, paper):
    """Waves are troughs across the middle, x = 0, of at least a fifth of the deepest; the sheet is a mirror image of its quarter."""
    report = drape(kit, 'stretched-sheet-quarter', wanted, '--model', 'stvk')
    vertices, _ = read_base(kit.work / 'base.ply')
    line = sorted((y, z) for x, y, z, _ in vertices if abs(x) < 1e-6)
    heights = [z for _, z in line]
    deepest = max(heights, key=abs)
    down = [z / deepest for z in [heights[1], *heights, heights[-1]]]
    troughs = [line[i][0] for i in range(len(line)) if down[i + 1] >= max(down[i], down[i + 2], 0.2)]
    # The first lies on the mirror.
    long = f', {1e3 * troughs[1]:.1f}' if len(troughs) > 1 and troughs[0] < 1e-6 else ''
    count = sum(1 if y < 1e-6 else 2 for y in troughs)
    return [f'{report["vertices"]:,} ({wanted * 4 // 1000}k)', f'{1e3 * report["measures"]["amplitude_m"]:.3f} mm', f'{count}{long}', *cost(kit, report), paper]


def ring(vertices, faces, height):
    """How far the section at this height is from its mean radius, all the way round."""
    found = {}
    for corners, _ in faces:
        for edge in zip(corners, corners[1:] + corners[:1]):
            (x, y, z, _), (to_x, to_y, to_z, _) = (vertices[v] for v in sorted(edge))
            if (y < height) != (to_y < height):
                share = (height - y) / (to_y - y)
                x, z = x + share * (to_x - x), z + share * (to_z - z)
                found[math.atan2(z, x)] = math.hypot(x, z)
    mean = sum(found.values()) / len(found)
    return [found[angle] - mean for angle in sorted(found)]


def waves(heights):
    """Half waves above a tenth of the highest, halved."""
    least = max(map(abs, heights)) / 10
    signs = [height > 0 for height in heights if abs(height) > least]
    return sum(a != b for a, b in zip(signs, signs[1:] + signs[:1])) // 2


def tube(kit, wanted, paper):
    tension_field = drape(kit, 'twisted-cylinder', wanted)
    report = drape(kit, 'twisted-cylinder', wanted, '--model', 'stvk')
    vertices, faces = read_base(kit.work / 'base.ply')
    rings = [ring(vertices, faces, tenth / 2) for tenth in range(1, 10)]  # of 5 m
    counts = sorted({waves(heights) for heights in rings})
    return [f'{report["vertices"]:,}', f'{report["energy_J"]:.4f} ({tension_field["energy_J"]:.3f})', ' … '.join(str(n) for n in counts),
            f'{500 * (max(rings[4]) - min(rings[4])):.0f} mm', f'{report["measures"]["waist_radius_m"]:.3f} m', *cost(kit, report), paper]


def make(kit):
    sheets = [sheet(kit, wanted, paper) for wanted, paper in ((4000, 'none'), (8000, '3 waves, 0.17 mm'), (16000, '3 waves, 0.27 mm'))]
    kit.table('drape_stvk_sheet', SHEET, sheets, 'drape.md', kit.provenance())
    kit.table('drape_stvk_tube', TUBE, [tube(kit, 6000, '10 waves at 6k')], 'drape.md', kit.provenance())
