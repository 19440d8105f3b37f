"""Waves of the TFW authors' disk beside the ones that they ship."""
import math

MAKES = ['wrinkle_disk.csv']
NEEDS = 'PLISSE_TFW_DISK'


def numbers(file):
    return [float(word) for word in file.read_text().split()]


def apart(found, theirs):
    """Of two lists the difference over theirs, in L2, whichever way round the phases run."""
    return 100 * min(math.hypot(*(a - sign * b for a, b in zip(found, theirs))) for sign in (1, -1)) / math.hypot(*theirs)


def make(kit):
    kit.folder_of(NEEDS, 'disk')

    def solved(*options):
        report = kit.plisse('wrinkle', 'disk/disk_TFW.json', *options, '-o', 'field_amplitude_found.txt')
        return report, f'{report["energy_whole_periods_J"]:.7f} J; {1e3 * report["max_amplitude_m"]:.3f} mm, {report["waves"]:.0f} waves'

    files = [f'disk/disk_{name}_simulated.txt' for name in ('amplitude', 'dphi')]
    theirs = kit.plisse('wrinkle', 'disk/disk_TFW.json', '--wrinkle-free', 'authors', '--evaluate', *files)
    _, by_authors = solved('--wrinkle-free', 'authors')
    papers, by_paper = solved()
    _, by_factor = solved('--wrinkle-free', 'authors', '--curvature-factor', 1.44)

    # An edge has a difference of phase; edges are in the order of their vertices, the lower before the higher.
    edges = set()
    for line in (kit.work / 'disk/disk_simulated.obj').read_text().splitlines():
        if line.startswith('f '):
            face = [int(word.split('/')[0]) - 1 for word in line.split()[1:]]
            edges |= {(min(pair), max(pair)) for pair in zip(face, face[1:] + face[:1])}
    amplitude, turned = (numbers(kit.work / file) for file in files)
    waving = [all(amplitude[v] > 1e-5 for v in edge) for edge in sorted(edges)]
    of_edges = [[value for value, counts in zip(values, waving) if counts] for values in (numbers(kit.work / 'field_dphi_found.txt'), turned)]
    rows = [
        ['their faces', f'≤ {theirs["energy_J"]:.7f} J (their field, this energy); about 1.15 mm, 78 waves', by_authors],
        [f'the paper\'s faces ({papers["wrinkle_free_faces"]})', '', by_paper],
        ['their faces and curvature term (`--curvature-factor 1.44`)', '84.9 waves, independently', by_factor],
        ['… against their field, L2 where a > 1e-5', '≤ 1 %',
         f'{apart(*of_edges):.2f} % (dφ), {apart(numbers(kit.work / "field_amplitude_found.txt"), amplitude):.2f} % (a)'],
    ]
    kit.table('wrinkle_disk', ['the authors\' disk', 'expected', 'here'], rows, 'wrinkle.md')
