"""Wrinkles that were painted: the sleeve at rest and bent, the shirt."""
MAKES = ['sleeve_painted.png', 'sleeve_painted_bent.png', 'shirt_painted.png']


def make(kit):
    kit.frame('assets/sleeve_painted.toml', 'sleeve_painted.png', 1)
    kit.frame('assets/sleeve_painted.toml', 'sleeve_painted_bent.png', 37)
    kit.frame('assets/shirt_painted.toml', 'shirt_painted.png', 1)
