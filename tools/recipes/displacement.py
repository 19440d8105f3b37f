"""How far shading is from the geometry that it stands for, by wavelength: printed by a test."""
import re

MAKES = ['displacement.csv']
TESTS = ['system']


def make(kit):
    printed = kit.test('system', 'Displaced.TheFinerTheWavesTheLessGeometryDiffersFromShading')
    rows = [[share, f'{float(flip):.3f}', f'{float(degrees):.1f}°']
            for share, flip, degrees in re.findall(r'wavelength (\S+) edges: FLIP (\S+), normals (\S+) degrees', printed)]
    kit.expect(len(rows) == 3, 'the test prints other lines than this recipe reads')
    kit.table('displacement', ['wavelength, mean edges of 26.3 mm', 'mean FLIP', 'normals'], rows, 'passes.md')
