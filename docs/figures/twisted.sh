# A twisted tube: its base surface, and the waves that were solved on it: twisted_base.png, twisted.png
# (tools/figures twisted)
plisse drape --example twisted-cylinder -o base.ply
plisse wrinkle base.ply -o field.ply
cat > base.toml << 'END'
[model]
path = "base.ply"
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
cat > waves.toml << 'END'
[model]
path = "base.ply"
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
[bias]
field = "field.ply"
use = "direct"
END
plisse render base.toml -o twisted_base.png --frames 1 --size 640x512
plisse render waves.toml -o twisted.png --frames 1 --size 640x512
