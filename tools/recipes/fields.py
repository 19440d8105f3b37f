"""The published scenes, each draped and wrinkled by one command: a picture of every one, and their numbers beside the papers'."""
from recipes.kit import cloth_look

MAKES = ['fields.png', 'fields.csv', 'fields_meshes.csv']
MEASURES = True

# What the paper has, how the camera looks, and what of it a person saw in the picture.
SCENES = (
    ('stretched-sheet', '5 periods, .42 mm (Wang et al. .35)', 'azimuth = 20\nelevation = 40', 'five furrows in the middle, none at the clamps'),
    ('sheared-rectangle', '25 (experiment 19, ARCSim 26)', 'azimuth = 0\nelevation = 5', 'parallel at 45 degrees, fans in two corners, bare triangles in the others'),
    ('twisted-cylinder', '47', 'elevation = 18', 'even, along the tension lines'),
    ('torus', 'fine, outer equator', 'elevation = 45', 'highest outside, low inside'),
    ('disk-balloon', 'fine, equator', 'elevation = 35', 'rays from the equator, poles smooth; neighbouring waves vary in height'),
    ('teabag', 'fine, boundary', 'elevation = 45', 'across all four sides, middle smooth'),
    ('sphere-drape', 'round the ball', 'elevation = 20', 'folds from the ball to the hem, top smooth'),
    ('skirt', 'their dress of 1,333: 17 s in the solver', 'elevation = 8', 'a fold for each gather, from waist to hem; steep at the sides, where the base surface is all but collapsed'),
)


def make(kit):
    rows, pictures = [], []
    for name, paper, camera, looks in SCENES:
        vertices = ('--vertices', 1300) if name == 'skirt' else ()
        kit.plisse('drape', '--example', name, *vertices, '-o', f'{name}.ply')
        report = kit.plisse('wrinkle', f'{name}.ply', '-o', f'{name}_field.ply', '--mesh', f'{name}_waves.ply')
        rows.append([' '.join(str(word) for word in (name, *vertices)), paper, f'{report["waves"]:.3g}, {1e3 * report["max_amplitude_m"]:.3g} mm',
                     f'{report["waves_above_tenth"]:.3g}', f'{1e3 * report["wavelength_m"]:.3g}', f'{report["vertices"]:,}',
                     f'{report["energy_whole_periods_J"]:.4g}', f'{report["solve_s"]:.2g}', f'{kit.spent[1]:.2g}', looks])
        kit.write(f'{name}.toml', f'[model]\npath = "{name}_waves.ply"\n[wrinkles]\nstrength = 0\n' + cloth_look(camera, ground=False))
        kit.plisse('render', f'{name}.toml', '-o', f'{name}.png', '--size', '800x640')
        pictures.append(f'{name}.png')
    kit.keep_sheet([pictures[:4], pictures[4:]], 'fields.png')
    kit.table('fields', ['scene', 'paper', 'here', 'above a tenth', 'λ at the highest crest, mm', 'vertices', 'J', 'solver s', 'CPU s', 'looks'], rows, 'wrinkle.md', kit.provenance())

    rows = []
    for wanted in (180, 344, 688, 1309, 2543):
        found = []
        for seed in (1, 2, 3):
            kit.plisse('drape', '--example', 'twisted-cylinder', '--vertices', wanted, '--seed', seed, '-o', 'tube.ply')
            found.append(kit.plisse('wrinkle', 'tube.ply', '-o', 'tube_field.ply'))
        rows.append([f'{wanted:,}', ', '.join(str(report['vertices']) for report in found), ', '.join(f'{report["waves"]:.3g}' for report in found),
                     ', '.join(f'{report["energy_whole_periods_J"]:.3g}' for report in found)])
    kit.table('fields_meshes', ['paper\'s vertices', 'seeds 1, 2, 3: vertices', 'waves', 'J'], rows, 'wrinkle.md', kit.provenance())
