"""What a wrinkle field costs on base surfaces of 250 to 16,000 vertices: the twisted tube, and a sheet with fewer waves."""
MAKES = ['wrinkle_cost.svg', 'wrinkle_cost.csv']
MEASURES = True


def make(kit):
    rows = []
    for example, sizes, plot in (('twisted-cylinder', '250,1000,4000,16000', 'wrinkle_cost.svg'), ('stretched-sheet', '250,1000,4000', 'sheet.svg')):
        report = kit.plisse('wrinkle', '--example', example, '--cost', sizes, '-o', plot, codes=(0, 1))
        for cost in report['costs']:
            rows.append([example, f'{cost["vertices"]:,}', f'{cost["waves"]:.3g}', f'{1e3 * cost["max_amplitude_m"]:.3g} mm',
                         cost['iterations'] if cost['converged'] else f'{cost["iterations"]}, not converged',
                         f'{cost["solve_s"]:.3g} s', f'{cost["phase_s"]:.3g} s', f'{cost["wall_s"]:.3g} s', f'{cost["cpu_s"]:.3g} s'])
    kit.keep('wrinkle_cost.svg')
    kit.table('wrinkle_cost', ['scene', 'vertices', 'waves', 'highest', 'steps', 'solver', 'phases', 'all, wall', 'all, CPU'], rows,
              'wrinkle.md', kit.provenance())
