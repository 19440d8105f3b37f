"""The same shells at four times the vertices: twenty minutes of one core for the cylinder."""
from recipes.drape_stvk import SHEET, TUBE, sheet, tube

MAKES = ['drape_stvk_fine_sheet.csv', 'drape_stvk_fine_tube.csv']
MEASURES = True
LONG = True


def make(kit):
    kit.table('drape_stvk_fine_sheet', SHEET, [sheet(kit, 32000, '3 waves, 0.31 mm (260k: 0.33)')], 'drape.md', kit.provenance())
    kit.table('drape_stvk_fine_tube', TUBE, [tube(kit, 24000, '14 waves at 24k (19 at 96k)')], 'drape.md', kit.provenance())
