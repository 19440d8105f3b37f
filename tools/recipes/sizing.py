"""What the resolution paper measured, by plisse bench sizing: waves of a stretched sheet, sag of a cantilever, a curtain's transition."""
MAKES = ['sizing_stretch.svg', 'sizing_sag.svg', 'sizing_curtain.svg']
MEASURES = True


def make(kit):
    kit.plisse('bench', 'quick' if kit.quick else 'full', 'sizing', '-o', 'sizing')
    for name in MAKES:
        kit.keep(f'sizing/pictures/{name}', name)
