# The same shells at four times the vertices: twenty minutes of one core for the cylinder: drape_stvk_fine_sheet.csv, drape_stvk_fine_tube.csv
# (tools/figures drape_stvk_fine)
plisse drape --example stretched-sheet-quarter --vertices 32000 --steps 1 --model stvk -o base.ply
plisse drape --example twisted-cylinder --vertices 24000 --steps 1 -o base.ply
plisse drape --example twisted-cylinder --vertices 24000 --steps 1 --model stvk -o base.ply
