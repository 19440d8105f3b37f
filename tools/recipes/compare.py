"""plisse against F3D, Blender's Workbench and Blender's cloth, in one run.

Needs all of them (Debian: f3d, blender, xvfb). Blender's cloth at 200 x 200 takes minutes.
"""
import csv

MAKES = ['compare.csv', 'compare_plisse.png', 'compare_f3d.png', 'compare_blender.png', 'compare_cloth50.png', 'compare_cloth200.png']
MEASURES = True


def make(kit):
    kit.run('tools/compare', '-o', 'compare')
    with open(kit.work / 'compare/table.csv', newline='') as file:
        header, *rows = list(csv.reader(file))
    notes = (kit.work / 'compare/notes.txt').read_text().strip()
    for name, picture in (('plisse', 'plisse/frame_0037.png'), ('f3d', 'f3d/f3d_0037.png'), ('blender', 'blender/blender_0036.png'),
                          ('cloth50', 'wrinkled/frame_0048.png'), ('cloth200', 'fine/frame_0048.png')):
        kit.keep_small(f'compare/{picture}', f'compare_{name}.png')
    kit.table('compare', header, rows, 'benchmarks.md', kit.provenance() + '\n' + notes + PICTURES)


PICTURES = '''

| plisse, with wrinkles | F3D | Blender Workbench |
|---|---|---|
| ![plisse](figures/compare_plisse.png) | ![F3D](figures/compare_f3d.png) | ![Workbench](figures/compare_blender.png) |

| Blender's cloth at 50 × 50, wrinkled by plisse | Blender's cloth at 200 × 200, no waves added |
|---|---|
| ![50](figures/compare_cloth50.png) | ![200](figures/compare_cloth200.png) |'''
