# Where searches from other frequencies end on the published scenes: the energy of each start, and of what is kept: wrinkle_starts.csv
# (tools/figures wrinkle_starts)
plisse drape --example stretched-sheet -o base.ply
plisse wrinkle base.ply --starts -o field.ply
plisse drape --example sheared-rectangle -o base.ply
plisse wrinkle base.ply --starts -o field.ply
plisse drape --example twisted-cylinder -o base.ply
plisse wrinkle base.ply --starts -o field.ply
plisse drape --example torus -o base.ply
plisse wrinkle base.ply --starts -o field.ply
plisse drape --example disk-balloon -o base.ply
plisse wrinkle base.ply --starts -o field.ply
plisse drape --example teabag -o base.ply
plisse wrinkle base.ply --starts -o field.ply
plisse drape --example sphere-drape -o base.ply
plisse wrinkle base.ply --starts -o field.ply
plisse drape --example skirt --vertices 1300 -o base.ply
plisse wrinkle base.ply --starts -o field.ply
