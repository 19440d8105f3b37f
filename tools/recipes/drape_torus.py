"""What a little stiffness of slack cloth does to a torus: kinks or a round seam, and how compression spreads."""
import math

from recipes.kit import read_base

MAKES = ['drape_torus.csv']


def compression(vertices, corners, rest):
    """λ₂ of a face, and its area at rest."""
    first, second = ([vertices[corners[n]][i] - vertices[corners[0]][i] for i in range(3)] for n in (1, 2))
    (u1, v1), (u2, v2) = ((rest[2 * n] - rest[0], rest[2 * n + 1] - rest[1]) for n in (1, 2))
    twice_area = u1 * v2 - v1 * u2
    by_u = [(v2 * a - v1 * b) / twice_area for a, b in zip(first, second)]
    by_v = [(u1 * b - u2 * a) / twice_area for a, b in zip(first, second)]
    uu, uv, vv = (sum(a * b for a, b in zip(*pair)) for pair in ((by_u, by_u), (by_u, by_v), (by_v, by_v)))
    return (uu + vv) / 2 - math.hypot((uu - vv) / 2, uv) - 1, twice_area / 2


def outer_seam(vertices, faces):
    """How far its vertices are from the axis. Seams stay in the plane y = 0; the outer one begins where the torus ends."""
    beside = {}
    for corners, _ in faces:
        for a, b in zip(corners, corners[1:] + corners[:1]):
            if vertices[a][1] == vertices[b][1] == 0:
                beside.setdefault(a, set()).add(b)
                beside.setdefault(b, set()).add(a)
    radius = {v: math.hypot(vertices[v][0], vertices[v][2]) for v in beside}
    found, wanted = set(), [max(radius, key=radius.get)]
    while wanted:
        v = wanted.pop()
        if v not in found:
            found.add(v)
            wanted.extend(beside[v])
    return [radius[v] for v in found]


def make(kit):
    rows = []
    for share in ('0', '1e-5', '1e-4', '1e-3'):
        report = kit.plisse('drape', '--example', 'torus', '--vertices', 600, '--residual', share, '-o', 'torus.ply')
        vertices, faces = read_base(kit.work / 'torus.ply')
        radii, found = outer_seam(vertices, faces), [compression(vertices, *face) for face in faces]
        area = sum(a for _, a in found)
        mean = sum(strain * a for strain, a in found) / area
        spread = math.sqrt(sum((strain - mean) ** 2 * a for strain, a in found) / area)
        rows.append([share, f'{report["energy_J"]:.5f}'.replace('-', '−'), report['iterations'], f'{min(radii):.4f} … {max(radii):.4f}', f'{mean:.3f}, {spread:.3f}'.replace('-', '−')])
    kit.table('drape_torus', [f'torus, {report["vertices"]} vertices, η', 'J', 'steps', 'outer seam, m from the axis', 'λ₂: mean, standard deviation'], rows,
              'drape.md')
