"""Time against error, setting by setting: the plots of plisse bench, and the rows that no other beats."""
import csv

MAKES = ['bench.csv', 'bench_front.csv', 'bench_relaxation.svg', 'bench_shading.svg', 'bench_mesh.svg', 'bench_method.svg',
         'bench_output.svg']
MEASURES = True
PLOTS = {'relaxation': ('sleeve', 'picture'), 'shading': ('sleeve', 'picture'), 'mesh': ('stretched-sheet', 'amplitude'),
         'method': ('stretched-sheet', 'wavelength'), 'output': ('sleeve', 'file')}


def make(kit):
    kit.plisse('bench', 'quick' if kit.quick else 'full', '-o', 'bench')
    kit.keep('bench/rows.csv', 'bench.csv')
    for suite, (scene, error) in PLOTS.items():
        plots = sorted((kit.work / 'bench').glob(f'plot_{suite}_{scene}_{error}_*.svg'))
        kit.keep(plots[0].relative_to(kit.work), f'bench_{suite}.svg')
    with open(kit.work / 'bench/rows.csv', newline='') as file:
        rows = list(csv.DictReader(file))
    front = []
    for row in rows:
        if row['on_front'] != '1':
            continue
        seconds = float(row['seconds'])
        time = f'{seconds:.3g} s' if seconds >= 1 else f'{1e3 * seconds:.3g} ms' if seconds >= 1e-3 else f'{1e6 * seconds:.3g} µs'
        front.append([row['suite'], row['scene'], row['setting'], f'{time}, {row["clock"]}', row['seconds_of'],
                      f'{float(row["error"]):.3g}', row['error_unit']])
    kit.table('bench_front', ['suite', 'scene', 'setting', 'time', 'of', 'error', 'unit'], front, 'benchmarks.md', kit.provenance())
