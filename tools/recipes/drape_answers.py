"""What plisse drape finds of shapes that are known, or computed another way."""
MAKES = ['drape_answers.csv']


def make(kit):
    def drape(*words):
        report = kit.plisse('drape', '--example', *words, '-o', 'base.ply')
        return report, report['measures']

    strip, _ = drape('strip')
    balloon, of_balloon = drape('disk-balloon')
    rings = [drape('annulus', '--vertices', wanted) for wanted in (1000, 8000)]
    tubes = [drape('twisted-cylinder', '--vertices', wanted) for wanted in (688, 2543, 5000, 7000)]
    _, cantilever = drape('cantilever')
    sizes = ', '.join(f'{tube["vertices"]:,}' for tube, _ in tubes)
    rows = [
        ['strip by 10 %', '0.01378 J, whatever ν', f'{strip["energy_J"]:.6g} J'],
        [f'mylar balloon, {balloon["vertices"]:,} vertices: radius, thickness, volume', '76.28 mm, 91.39 mm, 1.2185e-3 m³',
         f'{1e3 * of_balloon["radius_m"]:.2f}, {1e3 * of_balloon["thickness_m"]:.2f}, {1e3 * of_balloon["volume_m3"]:.4f}e-3'],
        ['annulus, tensions 3 : 1, wrinkled to', '1.535',
         ', '.join(f'{measures["wrinkled_radius_ratio"]:.3f} with {ring["vertices"]:,} vertices' for ring, measures in rings)],
        [f'twisted cylinder, {sizes} vertices: waist', '0.8733 m', ', '.join(f'{measures["waist_radius_m"]:.4f}' for _, measures in tubes)],
        ['… its energy', '0.3378 J', ', '.join(f'{tube["energy_J"]:.4f}' for tube, _ in tubes)],
        ['heavy cantilever, G = 5, tip drop', '0.495905 L', f'{cantilever["tip_drop_m"]:.6f} L'],
    ]
    kit.table('drape_answers', ['what', 'known', 'here'], rows, 'drape.md')
