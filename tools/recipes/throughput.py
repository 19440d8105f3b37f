"""Whole runs: 240 frames with PNG by the clock against CPU time over cores; the first frame of a warm start."""
import os
import statistics

MAKES = ['throughput.csv']
MEASURES = True


def make(kit):
    cores, rows = len(os.sched_getaffinity(0)), []
    for scene, duration in (('sleeve', 71 / 24), ('shirt', 47 / 24), ('zeppelin', 47 / 24), ('curtain', 47 / 24)):
        frames = kit.plisse('render', f'assets/{scene}.toml', '--frames', '1', '-o', 'warm.png', '--size', '1280x1024')
        firsts = []
        for _ in range(5):
            kit.plisse('render', f'assets/{scene}.toml', '--frames', '1', '-o', 'first.png', '--size', '1280x1024')
            firsts.append(kit.spent[0])
        report = kit.plisse('render', f'assets/{scene}.toml', '--fps', f'{239.5 / duration:.4f}', '--frames', '1-240',
                            '-o', f'{scene}/frame_####.png', '--size', '1280x1024', '--samples', '4')
        wall, cpu = kit.spent
        rows.append([scene, frames['vertices']['welded'], len(report['frames']), f'{wall:.2f}', f'{cpu:.2f}',
                     f'{wall / (cpu / cores):.3f}', f'{1000 * statistics.median(firsts):.0f}'])
    kit.table('throughput', ['scene', 'vertices', 'frames', 'wall s', 'CPU s', f'wall / (CPU / {cores} cores)',
                             'a run of one frame, ms'], rows, 'benchmarks.md', kit.provenance())
