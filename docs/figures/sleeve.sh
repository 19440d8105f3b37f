# The sleeve at its deepest bend: with wrinkles, without, and as the mesh it is made of: sleeve.png, sleeve_plain.png, sleeve_mesh.png
# (tools/figures sleeve)
plisse render assets/sleeve.toml -o sleeve.png --frames 37 --size 640x512
plisse render assets/sleeve.toml -o sleeve_plain.png --frames 37 --size 640x512 --strength 0
cat > mesh.toml << 'END'
# The demo: a cotton sleeve that bends from 10° to 100° and back in 72 frames, over and over.
# plisse render assets/sleeve.toml

[model]
path = "assets/sleeve.glb"
loop = true

[wrinkles]
wavelength = 0.025
irregularity = 0.7
exclude = ["seam", "cuff"]        # sewn double: stiff

[camera]                          # three-quarter, from the shoulder's side: it looks into the elbow
focal_length = 75
eye = [-0.591, 0.631, 1.160]
target = [0.01, 0.165, 0.03]

[light]
key_azimuth = -85                 # along the upper arm, so across the folds
key_elevation = 30
key_intensity = 1.5
ambient = 0.2
fill_ratio = 0.25
rim_azimuth = 160
rim_elevation = 35
rim_intensity = 0.6
shadows = true

[shading]
wireframe = true
roughness = 0.75
sheen = 0.15

[output]
path = "frames/sleeve_####.png"
size = "1280x1024"
samples = 4
background = "#cac4bc"
ground = true
END
plisse render mesh.toml -o sleeve_mesh.png --frames 37 --size 640x512 --strength 0
