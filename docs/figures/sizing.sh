# What the resolution paper measured, by plisse bench sizing: waves of a stretched sheet, sag of a cantilever, a curtain's transition: sizing_stretch.svg, sizing_sag.svg, sizing_curtain.svg
# (tools/figures sizing)
plisse bench full sizing -o sizing
