# A skirt over a body that moves, twenty-four frames: steps, times, and how near the cloth comes to the body: drape_skirt.csv
# (tools/figures drape_skirt)
plisse drape --example skirt --frames 1 -o skirt.ply
plisse drape --example skirt --frames 1-24 -o skirt.ply
