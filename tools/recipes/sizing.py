"""What the resolution paper measured, by plisse bench sizing: waves of a stretched sheet, sag of a cantilever, a curtain's transition."""
import csv
import re

PLOTS = ['sizing_stretch.svg', 'sizing_sag.svg', 'sizing_curtain.svg']
MAKES = [*PLOTS, 'sizing_stretch.csv', 'sizing_sag.csv', 'sizing_curtain.csv']
MEASURES = True


def stretch(rows):
    """Two lines a solver; its row's setting: '…, 5 mm: 3.5 waves of 0.259 mm, 1071 vertices' and ', not converged'."""
    edges, lines = {}, {}
    for row in rows:
        kind, edge, waves, high, vertices, problem = re.fullmatch(r'(.*), (\S+) mm: (\S+) waves of (\S+) mm, (\d+) vertices(?:, (.*))?', row['setting']).groups()
        edges[edge] = True
        found, costs = lines.setdefault(kind, ([], []))
        found.append(f'{waves}, {high}' + (f' ({problem})' if problem else ''))
        costs.append(f'{int(vertices):,}, {float(row["seconds"]):.1f}')
    return ['edges, mm', *edges], [line for kind, (found, costs) in lines.items()
                                   for line in ([f'{kind}: waves, mm high', *found], ['… vertices, CPU s', *costs])]


def sag(rows):
    edges, lines = {}, {}
    for row in rows:
        kind, edge, found = re.fullmatch(r'(.*), (\S+) mm: (\S+) mm.*', row['setting']).groups()
        edges[edge] = True
        lines.setdefault(kind, []).append(found)
    return ['edges, mm', *edges], [[kind, *found] for kind, found in lines.items()]


def curtain(rows):
    stiffness, lines = {}, {}
    for row in rows:
        weight, bending, half, most, compression, tension = re.fullmatch(
            r'(.*), B (\S+): (\S+) mm half, (\S+) mm nine tenths; L_w (\S+) mm of compression, (\S+) of tension.*', row['setting']).groups()
        # What weight has no part in stands there once.
        law = lines.setdefault('L_w of compression, prefactor 1, mm', [])
        if bending not in stiffness:
            law.append(compression)
        stiffness[bending] = True
        for name, value in (('half', half), ('nine tenths', most), ('L_w of tension, prefactor 1', tension)):
            lines.setdefault(f'{weight}: {name}, mm', []).append(value)
    return ['B, N·m', *(bending.replace('e-0', 'e-') for bending in stiffness)], [[name, *values] for name, values in lines.items()]


def make(kit):
    kit.plisse('bench', 'quick' if kit.quick else 'full', 'sizing', '-o', 'sizing')
    for name in PLOTS:
        kit.keep(f'sizing/pictures/{name}', name)
    with open(kit.work / 'sizing/rows.csv', newline='') as file:
        rows = list(csv.DictReader(file))
    for scene, table in (('stretched sheet', stretch), ('strip', sag), ('curtain', curtain)):
        kit.table(f'sizing_{table.__name__}', *table([row for row in rows if row['scene'] == scene]), 'sizing.md',
                  kit.provenance())
