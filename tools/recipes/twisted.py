"""A twisted tube: its base surface, and the waves that were solved on it."""
from recipes.kit import cloth_look

MAKES = ['twisted_base.png', 'twisted.png']

SCENE = '[model]\npath = "base.ply"\n' + cloth_look()


def make(kit):
    kit.plisse('drape', '--example', 'twisted-cylinder', '-o', 'base.ply')
    kit.plisse('wrinkle', 'base.ply', '-o', 'field.ply')
    kit.write('base.toml', SCENE)
    kit.write('waves.toml', SCENE + '[bias]\nfield = "field.ply"\nuse = "direct"\n')
    kit.frame('base.toml', 'twisted_base.png')
    kit.frame('waves.toml', 'twisted.png')
