# What a little stiffness of slack cloth does to a torus: kinks or a round seam, and how compression spreads: drape_torus.csv
# (tools/figures drape_torus)
plisse drape --example torus --vertices 600 --residual 0 -o torus.ply
plisse drape --example torus --vertices 600 --residual 1e-5 -o torus.ply
plisse drape --example torus --vertices 600 --residual 1e-4 -o torus.ply
plisse drape --example torus --vertices 600 --residual 1e-3 -o torus.ply
