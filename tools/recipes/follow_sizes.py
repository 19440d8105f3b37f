"""Solved wrinkles of a moving mesh at three sizes of its mesh: seconds of base surfaces and fields."""
import math

MAKES = ['follow_sizes.csv']
MEASURES = True
FRAMES = 16


def sheet(path, cells, share):
    """A square of 1 m in quads, pushed together along x by a tenth of `share`: two broad folds, zigzags of its own mesh."""
    rows = []
    zigzag = 0.15 / cells * math.sqrt(share)
    for j in range(cells + 1):
        for i in range(cells + 1):
            u, v = i / cells, j / cells
            z = 0.08 * share * math.sin(4 * math.pi * u) * math.cos(math.pi * (v - 0.5)) + (zigzag if (i + j) % 2 else -zigzag)
            rows.append(f'v {(1 - 0.1 * share) * u:.9f} {v:.9f} {z:.9f}')
    for j in range(cells):
        for i in range(cells):
            a = j * (cells + 1) + i + 1
            rows.append(f'f {a} {a + 1} {a + cells + 2} {a + cells + 1}')
    path.write_text('\n'.join(rows) + '\n')


def make(kit):
    rows = []
    for cells in (32, 64, 128):
        (kit.work / str(cells)).mkdir()
        for n in range(FRAMES):
            sheet(kit.work / f'{cells}/sheet_{n + 1:04}.obj', cells, n / (FRAMES - 1))
        report = kit.plisse('wrinkle', f'{cells}/sheet_####.obj', '--follow', '0.25', '--wavelength', '0.1', '--cache-dir', 'none',
                            '-o', f'waves_{cells}', codes=(0, 1))
        frames = report['frames']
        mean = lambda key: sum(f[key] for f in frames) / len(frames)
        rows.append([report['vertices'], f'{mean("follow_iterations"):.0f}', f'{mean("follow_s"):.3f}', f'{report["wall_s"] / FRAMES:.2f}',
                     f'{1e3 * frames[-1]["wavelength_m"]:.0f}', f'{100 * frames[-1]["untaken"]:.1f}',
                     sum(not f['converged'] or not f['follow_converged'] for f in frames)])
    kit.table('follow_sizes', ['vertices', 'steps a base', 'base, s a frame', 'fields, s a frame', 'waves of the last, mm',
                               'untaken there, %', 'not converged'], rows, 'wrinkle.md', kit.provenance())
