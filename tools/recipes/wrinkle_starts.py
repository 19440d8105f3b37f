"""Where searches from other frequencies end on the published scenes: the energy of each start, and of what is kept."""
from recipes.fields import SCENES

MAKES = ['wrinkle_starts.csv']


def make(kit):
    rows = []
    for name, *_ in SCENES:
        vertices = ('--vertices', 1300) if name == 'skirt' else ()
        kit.plisse('drape', '--example', name, *vertices, '-o', 'base.ply')
        report = kit.plisse('wrinkle', 'base.ply', '--starts', '-o', 'field.ply')
        energies = {round(start['frequency'], 2): start['energy_J'] for start in report['starts']}
        rows.append([' '.join(str(word) for word in (name, *vertices))] + [f'{energies[f]:.7g}' for f in (0.5, 0.71, 1, 1.41, 2)] + [f'{report["energy_J"]:.7g}'])
    kit.table('wrinkle_starts', ['scene, J', '× ½', '× .71', '× 1', '× 1.41', '× 2', 'lowest by patch, released, polished'], rows, 'wrinkle.md', kit.provenance())
