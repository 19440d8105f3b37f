# The published scenes, each draped and wrinkled by one command: a picture of every one, and their numbers beside the papers': fields.png, fields.csv, fields_meshes.csv
# (tools/figures fields)
plisse drape --example stretched-sheet -o stretched-sheet.ply
plisse wrinkle stretched-sheet.ply -o stretched-sheet_field.ply --mesh stretched-sheet_waves.ply
cat > stretched-sheet.toml << 'END'
[model]
path = "stretched-sheet_waves.ply"
[wrinkles]
strength = 0
[camera]
azimuth = 20
elevation = 40
focal_length = 85
[light]
key_azimuth = -65
key_elevation = 25
shadows = true
[shading]
colour = "#c9a66b"
roughness = 0.45
END
plisse render stretched-sheet.toml -o stretched-sheet.png --size 800x640
plisse drape --example sheared-rectangle -o sheared-rectangle.ply
plisse wrinkle sheared-rectangle.ply -o sheared-rectangle_field.ply --mesh sheared-rectangle_waves.ply
cat > sheared-rectangle.toml << 'END'
[model]
path = "sheared-rectangle_waves.ply"
[wrinkles]
strength = 0
[camera]
azimuth = 0
elevation = 5
focal_length = 85
[light]
key_azimuth = -65
key_elevation = 25
shadows = true
[shading]
colour = "#c9a66b"
roughness = 0.45
END
plisse render sheared-rectangle.toml -o sheared-rectangle.png --size 800x640
plisse drape --example twisted-cylinder -o twisted-cylinder.ply
plisse wrinkle twisted-cylinder.ply -o twisted-cylinder_field.ply --mesh twisted-cylinder_waves.ply
cat > twisted-cylinder.toml << 'END'
[model]
path = "twisted-cylinder_waves.ply"
[wrinkles]
strength = 0
[camera]
elevation = 18
focal_length = 85
[light]
key_azimuth = -65
key_elevation = 25
shadows = true
[shading]
colour = "#c9a66b"
roughness = 0.45
END
plisse render twisted-cylinder.toml -o twisted-cylinder.png --size 800x640
plisse drape --example torus -o torus.ply
plisse wrinkle torus.ply -o torus_field.ply --mesh torus_waves.ply
cat > torus.toml << 'END'
[model]
path = "torus_waves.ply"
[wrinkles]
strength = 0
[camera]
elevation = 45
focal_length = 85
[light]
key_azimuth = -65
key_elevation = 25
shadows = true
[shading]
colour = "#c9a66b"
roughness = 0.45
END
plisse render torus.toml -o torus.png --size 800x640
plisse drape --example disk-balloon -o disk-balloon.ply
plisse wrinkle disk-balloon.ply -o disk-balloon_field.ply --mesh disk-balloon_waves.ply
cat > disk-balloon.toml << 'END'
[model]
path = "disk-balloon_waves.ply"
[wrinkles]
strength = 0
[camera]
elevation = 35
focal_length = 85
[light]
key_azimuth = -65
key_elevation = 25
shadows = true
[shading]
colour = "#c9a66b"
roughness = 0.45
END
plisse render disk-balloon.toml -o disk-balloon.png --size 800x640
plisse drape --example teabag -o teabag.ply
plisse wrinkle teabag.ply -o teabag_field.ply --mesh teabag_waves.ply
cat > teabag.toml << 'END'
[model]
path = "teabag_waves.ply"
[wrinkles]
strength = 0
[camera]
elevation = 45
focal_length = 85
[light]
key_azimuth = -65
key_elevation = 25
shadows = true
[shading]
colour = "#c9a66b"
roughness = 0.45
END
plisse render teabag.toml -o teabag.png --size 800x640
plisse drape --example sphere-drape -o sphere-drape.ply
plisse wrinkle sphere-drape.ply -o sphere-drape_field.ply --mesh sphere-drape_waves.ply
cat > sphere-drape.toml << 'END'
[model]
path = "sphere-drape_waves.ply"
[wrinkles]
strength = 0
[camera]
elevation = 20
focal_length = 85
[light]
key_azimuth = -65
key_elevation = 25
shadows = true
[shading]
colour = "#c9a66b"
roughness = 0.45
END
plisse render sphere-drape.toml -o sphere-drape.png --size 800x640
plisse drape --example skirt --vertices 1300 -o skirt.ply
plisse wrinkle skirt.ply -o skirt_field.ply --mesh skirt_waves.ply
cat > skirt.toml << 'END'
[model]
path = "skirt_waves.ply"
[wrinkles]
strength = 0
[camera]
elevation = 8
focal_length = 85
[light]
key_azimuth = -65
key_elevation = 25
shadows = true
[shading]
colour = "#c9a66b"
roughness = 0.45
END
plisse render skirt.toml -o skirt.png --size 800x640
# fields.png: stretched-sheet.png sheared-rectangle.png twisted-cylinder.png torus.png; disk-balloon.png teabag.png sphere-drape.png skirt.png, side by side at half their size
plisse drape --example twisted-cylinder --vertices 180 --seed 1 -o tube.ply
plisse wrinkle tube.ply -o tube_field.ply
plisse drape --example twisted-cylinder --vertices 180 --seed 2 -o tube.ply
plisse wrinkle tube.ply -o tube_field.ply
plisse drape --example twisted-cylinder --vertices 180 --seed 3 -o tube.ply
plisse wrinkle tube.ply -o tube_field.ply
plisse drape --example twisted-cylinder --vertices 344 --seed 1 -o tube.ply
plisse wrinkle tube.ply -o tube_field.ply
plisse drape --example twisted-cylinder --vertices 344 --seed 2 -o tube.ply
plisse wrinkle tube.ply -o tube_field.ply
plisse drape --example twisted-cylinder --vertices 344 --seed 3 -o tube.ply
plisse wrinkle tube.ply -o tube_field.ply
plisse drape --example twisted-cylinder --vertices 688 --seed 1 -o tube.ply
plisse wrinkle tube.ply -o tube_field.ply
plisse drape --example twisted-cylinder --vertices 688 --seed 2 -o tube.ply
plisse wrinkle tube.ply -o tube_field.ply
plisse drape --example twisted-cylinder --vertices 688 --seed 3 -o tube.ply
plisse wrinkle tube.ply -o tube_field.ply
plisse drape --example twisted-cylinder --vertices 1309 --seed 1 -o tube.ply
plisse wrinkle tube.ply -o tube_field.ply
plisse drape --example twisted-cylinder --vertices 1309 --seed 2 -o tube.ply
plisse wrinkle tube.ply -o tube_field.ply
plisse drape --example twisted-cylinder --vertices 1309 --seed 3 -o tube.ply
plisse wrinkle tube.ply -o tube_field.ply
plisse drape --example twisted-cylinder --vertices 2543 --seed 1 -o tube.ply
plisse wrinkle tube.ply -o tube_field.ply
plisse drape --example twisted-cylinder --vertices 2543 --seed 2 -o tube.ply
plisse wrinkle tube.ply -o tube_field.ply
plisse drape --example twisted-cylinder --vertices 2543 --seed 3 -o tube.ply
plisse wrinkle tube.ply -o tube_field.ply
