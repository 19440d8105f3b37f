"""What a base surface costs, from a thousand vertices to 64 thousand: seconds, and the shares of assembly and factorisation."""
MAKES = ['drape_cost.svg', 'drape_cost.csv']
MEASURES = True


def make(kit):
    report = kit.plisse('drape', '--example', 'stretched-sheet', '--cost', '1000,4000,16000,64000', '-o', 'drape_cost.svg', codes=(0, 1))
    kit.keep('drape_cost.svg')
    rows = []
    for cost in report['costs']:
        share = lambda key: f'{100 * cost[key] / cost["wall_s"]:.0f} %'  # noqa: E731
        rows.append([f'{cost["vertices"]:,}', cost['iterations'] if cost['converged'] else f'{cost["iterations"]}, not converged',
                     f'{cost["cpu_s"]:.3g} s', f'{cost["wall_s"]:.3g} s', share('assembly_s'), share('factor_s')])
    kit.table('drape_cost', ['vertices', 'steps', 'CPU', 'wall', 'assembly', 'factorisation'], rows, 'drape.md', kit.provenance())
