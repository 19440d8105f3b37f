# What plisse drape finds of shapes that are known, or computed another way: drape_answers.csv
# (tools/figures drape_answers)
plisse drape --example strip -o base.ply
plisse drape --example disk-balloon -o base.ply
plisse drape --example annulus --vertices 1000 -o base.ply
plisse drape --example annulus --vertices 8000 -o base.ply
plisse drape --example twisted-cylinder --vertices 688 -o base.ply
plisse drape --example twisted-cylinder --vertices 2543 -o base.ply
plisse drape --example twisted-cylinder --vertices 5000 -o base.ply
plisse drape --example twisted-cylinder --vertices 7000 -o base.ply
plisse drape --example cantilever -o base.ply
