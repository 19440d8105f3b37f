# What the resolution paper measured, by plisse bench sizing: waves of a stretched sheet, sag of a cantilever, a curtain's transition: sizing_stretch.svg, sizing_sag.svg, sizing_curtain.svg, sizing_stretch.csv, sizing_sag.csv, sizing_curtain.csv
# (tools/figures sizing)
plisse bench full sizing -o sizing
