"""The hard cases of plisse bench hard, and what came out."""
MAKES = ['hard.csv']
MEASURES = True


def make(kit):
    report = kit.plisse('bench', 'hard', '-o', 'hard', codes=(0, 1))
    rows = [[case['area'], case['case'], case['must'], case['found'].replace('|', '/').replace('\n', ' '),
             'yes' if case['holds'] else 'NO'] for case in report['cases']]
    kit.table('hard', ['area', 'case', 'must', 'found', 'holds'], rows, 'benchmarks.md', kit.provenance())
