# A tube that is twisted by 10 degrees in 48 frames: fields solved over time, drawn as they are, as bias of the passes, as geometry: twist.png
# (tools/figures twist)
plisse drape --example twisted-cylinder --steps 48 --frames 1-48 -o 'base_####.ply'
plisse wrinkle 'base_####.ply' -o 'field_####.ply' --mesh 'waves_####.ply'
cat > direct.toml << 'END'
[model]
path = "base_####.ply"
[bias]
field = "field_####.ply"
use = "direct"
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
[output]
ground = true
END
plisse render direct.toml --frames 1-48 -o 'direct/####.png' --size 400x480
cat > bias.toml << 'END'
[model]
path = "base_####.ply"
rest = "frame:48"
[wrinkles]
dead_zone = 0.025
[bias]
field = "field_0048.ply"
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
[output]
ground = true
END
plisse render bias.toml --frames 1-48 -o 'bias/####.png' --size 400x480
cat > geometry.toml << 'END'
[model]
path = "waves_####.ply"
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
[output]
ground = true
END
plisse render geometry.toml --frames 1-48 -o 'geometry/####.png' --size 400x480
# twist.png: direct/0001.png direct/0003.png direct/0008.png direct/0016.png direct/0024.png direct/0032.png direct/0040.png direct/0048.png; bias/0001.png bias/0003.png bias/0008.png bias/0016.png bias/0024.png bias/0032.png bias/0040.png bias/0048.png; geometry/0001.png geometry/0003.png geometry/0008.png geometry/0016.png geometry/0024.png geometry/0032.png geometry/0040.png geometry/0048.png, side by side at half their size
