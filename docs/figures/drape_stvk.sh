# St. Venant-Kirchhoff shells that find their waves by themselves, at three sizes of the stretched sheet and one of the twisted cylinder: drape_stvk_sheet.csv, drape_stvk_tube.csv
# (tools/figures drape_stvk)
plisse drape --example stretched-sheet-quarter --vertices 4000 --steps 1 --model stvk -o base.ply
plisse drape --example stretched-sheet-quarter --vertices 8000 --steps 1 --model stvk -o base.ply
plisse drape --example stretched-sheet-quarter --vertices 16000 --steps 1 --model stvk -o base.ply
plisse drape --example twisted-cylinder --vertices 6000 --steps 1 -o base.ply
plisse drape --example twisted-cylinder --vertices 6000 --steps 1 --model stvk -o base.ply
