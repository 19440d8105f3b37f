"""How far the passes' waves are from a field that is their bias: printed by a test."""
import re

MAKES = ['field_bias.csv']
TESTS = ['paint']


def make(kit):
    printed = kit.test('paint', 'Field.ConstantBentAndSpreadingWavesAsBias')
    errors = {}
    for kind, edges, error in re.findall(r'(\w+) waves of (\S+) edges as bias: (\S+) % RMS', printed):
        errors.setdefault(edges, {})[kind] = f'{error} %'
    rows = [[edges, *(of[kind] for kind in ('constant', 'bent', 'spreading'))] for edges, of in errors.items()]
    kit.expect(len(rows) == 3, 'the test prints other lines than this recipe reads')
    kit.table('field_bias', ['edges a wave', 'constant', 'bent', 'spreading'], rows, 'paint.md')
