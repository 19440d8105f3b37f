"""Whole runs: 240 frames with PNG by the clock against CPU time over cores; the first frame of a warm start."""
import os
import statistics

MAKES = ['throughput.csv']
MEASURES = True


def first_frame(kit, scene, size):
    """Milliseconds from start to end of a run of one frame, the driver's shader cache warm: the median of five."""
    seconds = []
    for _ in range(6):
        kit.plisse('render', f'assets/{scene}', '--frames', '1', '-o', 'first.png', '--size', size)
        seconds.append(kit.spent[0])
    return f'{1000 * statistics.median(seconds[1:]):.0f}'


def make(kit):
    cores, rows = len(os.sched_getaffinity(0)), []
    for scene, duration in (('sleeve', 71 / 24), ('shirt', 47 / 24), ('zeppelin', 47 / 24), ('curtain', 47 / 24)):
        first = first_frame(kit, f'{scene}.toml', '1280x1024')
        report = kit.plisse('render', f'assets/{scene}.toml', '--fps', f'{239.5 / duration:.4f}', '--frames', '1-240',
                            '-o', f'{scene}/frame_####.png', '--size', '1280x1024', '--samples', '4')
        wall, cpu = kit.spent
        rows.append([scene, report['vertices']['welded'], len(report['frames']), f'{wall:.2f}', f'{cpu:.2f}',
                     f'{wall / (cpu / cores):.3f}', first])
    kit.table('throughput', ['scene', 'vertices', 'frames', 'wall s', 'CPU s', f'wall / (CPU / {cores} cores)',
                             'a run of one frame, ms'], rows, 'benchmarks.md',
              kit.provenance() + f'\nThe bare model sleeve.glb at 320 × 256: {first_frame(kit, "sleeve.glb", "320x256")} ms.')
