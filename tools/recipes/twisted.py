"""A twisted tube: its base surface, and the waves that were solved on it."""
MAKES = ['twisted_base.png', 'twisted.png']

SCENE = '''[model]
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
'''


def make(kit):
    kit.plisse('drape', '--example', 'twisted-cylinder', '-o', 'base.ply')
    kit.plisse('wrinkle', 'base.ply', '-o', 'field.ply')
    kit.write('base.toml', SCENE)
    kit.write('waves.toml', SCENE + '[bias]\nfield = "field.ply"\nuse = "direct"\n')
    kit.frame('base.toml', 'twisted_base.png')
    kit.frame('waves.toml', 'twisted.png')
