"""The sleeve at its deepest bend: with wrinkles, without, and as the mesh it is made of."""
MAKES = ['sleeve.png', 'sleeve_plain.png', 'sleeve_mesh.png']


def make(kit):
    kit.frame('assets/sleeve.toml', 'sleeve.png', 37)
    kit.frame('assets/sleeve.toml', 'sleeve_plain.png', 37, '--strength', 0)
    scene = (kit.work / 'assets/sleeve.toml').read_text()
    scene = scene.replace('path = "sleeve.glb"', 'path = "assets/sleeve.glb"').replace('[shading]', '[shading]\nwireframe = true')
    kit.write('mesh.toml', scene)
    kit.frame('mesh.toml', 'sleeve_mesh.png', 37, '--strength', 0)
