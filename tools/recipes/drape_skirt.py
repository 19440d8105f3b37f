"""A skirt over a body that moves, twenty-four frames: steps, times, and how near the cloth comes to the body."""
MAKES = ['drape_skirt.csv']
MEASURES = True


def make(kit):
    rows = []
    for frames in (1, '1-24'):
        report = kit.plisse('drape', '--example', 'skirt', '--frames', frames, '-o', 'skirt.ply')
        steps = [frame['iterations'] for frame in report['frames']]
        rows.append([frames, f'{min(steps)} … {max(steps)}' if len(steps) > 1 else steps[0], sum(steps),
                     'all' if all(frame['converged'] for frame in report['frames']) else 'not all',
                     max(frame['inside'] for frame in report['frames']),
                     f'{1e3 * min(frame["nearest_m"] for frame in report["frames"]):.2f} mm',
                     f'{kit.spent[1]:.1f} s', f'{kit.spent[0]:.1f} s', f'{report["peak_rss_MiB"]:.0f} MiB'])
    kit.table('drape_skirt', ['frames', 'steps a frame', 'steps', 'converged', 'vertices inside, at most', 'nearest', 'CPU', 'wall', 'memory'], rows,
              'drape.md', kit.provenance())
