"""Solved wrinkles of animated models: how many frames converge, and whether folds lie along the tension."""
import os

MAKES = ['follow_models.csv']
MEASURES = True
NEEDS = 'PLISSE_MODELS'  # a folder with the models below
# Files and options of their clip; assets/ is the project's own.
MODELS = [('assets/sleeve.glb', []), ('assets/shirt.glb', []), ('KayKit_Knight.glb', []), ('Greenman.glb', []), ('Fox.glb', ['--clip', 'Run']),
          ('Fox.glb', ['--clip', 'Survey']), ('huesitos.fbx', []), ('bending_cylinder_anim_test.x', []),
          ('ufbx_maya_game_sausage_7500_binary_combined.fbx', [])]


def median(values):
    values = sorted(values)
    return values[len(values) // 2] if values else 0


def make(kit):
    kit.folder_of(NEEDS, 'models')
    rows = []
    for number, (file, clip) in enumerate(MODELS):
        path = file if file.startswith('assets/') else 'models/' + file
        report = kit.plisse('wrinkle', path, *clip, '--cache-dir', 'none', '-o', f'waves_{number}', codes=(0, 1))
        frames = report['frames']
        wavy = [f for f in frames if f['max_amplitude_m'] > 0]
        name = os.path.basename(file) + (f' ({clip[1]})' if clip else '')
        rows.append([name, report['vertices'], len(frames), sum(f['converged'] and f['follow_converged'] for f in frames), len(wavy),
                     f'{median([f["crest_angle_deg"] for f in wavy]):.1f}' if wavy else '–',
                     f'{100 * min(f["where_compressed"] for f in wavy):.0f}' if wavy else '–',
                     f'{100 * median([f["untaken"] for f in wavy]):.0f}' if wavy else '–',
                     f'{sum(f["follow_s"] for f in frames) / len(frames):.3f}', f'{report["wall_s"] / len(frames):.3f}'])
    kit.table('follow_models', ['model', 'vertices', 'frames', 'converged', 'with waves', 'crests off tension, degrees',
                                'least of ∫a² in compression, %', 'untaken, %', 'base, s a frame', 'fields, s a frame'], rows,
              'wrinkle.md', kit.provenance())
