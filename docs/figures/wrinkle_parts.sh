# Wrinkle fields without a part of the model, and on regular meshes of the twisted cylinder: wrinkle_parts.csv, wrinkle_regular.csv
# (tools/figures wrinkle_parts)
plisse drape --example twisted-cylinder -o base.ply
plisse wrinkle base.ply -o field.ply
plisse wrinkle base.ply -o field.ply --without v1
plisse drape --example sphere-drape -o base.ply
plisse wrinkle base.ply -o field.ply
plisse wrinkle base.ply -o field.ply --without relaxation
plisse drape --example stretched-sheet -o base.ply
plisse wrinkle base.ply -o field.ply
plisse wrinkle base.ply -o field.ply --local-law
plisse drape --example sheared-rectangle -o base.ply
plisse wrinkle base.ply -o field.ply
plisse wrinkle base.ply -o field.ply --local-law
plisse drape --example twisted-cylinder-rising --residual 0 -o base.ply
plisse wrinkle base.ply -o field.ply
plisse drape --example twisted-cylinder-falling --residual 0 -o base.ply
plisse wrinkle base.ply -o field.ply
plisse drape --example twisted-cylinder-rising --residual 1e-3 -o base.ply
plisse wrinkle base.ply -o field.ply
plisse drape --example twisted-cylinder-falling --residual 1e-3 -o base.ply
plisse wrinkle base.ply -o field.ply
plisse drape --example twisted-cylinder-rising --residual 1e-2 -o base.ply
plisse wrinkle base.ply -o field.ply
plisse drape --example twisted-cylinder-falling --residual 1e-2 -o base.ply
plisse wrinkle base.ply -o field.ply
