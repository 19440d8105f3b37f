"""Panels: the sizing map of a square with a shirring line, the mesh of a collar with a fold."""
MAKES = ['size_square_map.png', 'size_collar_mesh.png']


def make(kit):
    kit.plisse('size', 'assets/panels.toml', '-o', 'panels')
    kit.keep('panels/square_map.png', 'size_square_map.png')
    kit.keep('panels/collar_mesh.png', 'size_collar_mesh.png')
