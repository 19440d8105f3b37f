"""Wrinkle fields without a part of the model, and on regular meshes of the twisted cylinder."""
MAKES = ['wrinkle_parts.csv', 'wrinkle_regular.csv']


def make(kit):
    def solved(*without):
        report = kit.plisse('wrinkle', 'base.ply', '-o', 'field.ply', *without)
        return f'{report["waves"]:.3g} waves, {report["energy_whole_periods_J"]:.5g} J, {1e3 * report["max_amplitude_m"]:.3g} mm'

    rows = []
    for example, what, option in (
            ('twisted-cylinder', 'v₁, twisted cylinder (fig. 4: over 180)', ('--without', 'v1')),
            ('sphere-drape', 'relaxation, sphere-drape (fig. 5)', ('--without', 'relaxation')),
            ('stretched-sheet', 'the solve: Vandeparre\'s law, stretched-sheet (fig. 8)', ('--local-law',)),
            ('sheared-rectangle', 'the same, sheared-rectangle (fig. 10)', ('--local-law',))):
        kit.plisse('drape', '--example', example, '-o', 'base.ply')
        rows.append([what, solved(), solved(*option)])
    kit.table('wrinkle_parts', ['', 'with', 'without'], rows, 'wrinkle.md')

    rows = []
    for share in ('0', '1e-3', '1e-2'):
        reports = []
        for diagonals in ('rising', 'falling'):
            kit.plisse('drape', '--example', f'twisted-cylinder-{diagonals}', '--residual', share, '-o', 'base.ply')
            reports.append(kit.plisse('wrinkle', 'base.ply', '-o', 'field.ply'))
        rows.append([share, ', '.join(f'{report["waves"]:.3g}' for report in reports),
                     ', '.join(f'{report["energy_whole_periods_J"]:.3f}' for report in reports)])
    kit.table('wrinkle_regular', [f'`drape --residual`, {reports[0]["vertices"]} vertices, diagonals rising, falling', 'waves', 'J'], rows, 'wrinkle.md')
