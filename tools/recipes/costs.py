"""What each pass costs, and how that compares: tools/benchmark, into the tables of docs/benchmarks.md."""
MAKES = ['costs.json']
MEASURES = True


def make(kit):
    kit.run('tools/benchmark', *(['--write-docs'] if kit.pages else []), '--json', 'costs.json')
    kit.keep('costs.json')
