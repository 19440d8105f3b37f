"""Scenes of assets/ in the README, each in its most wrinkled frame."""
MAKES = ['shirt.png', 'zeppelin.png', 'square.png']


def make(kit):
    kit.frame('assets/shirt.toml', 'shirt.png', 25)
    kit.frame('assets/zeppelin.toml', 'zeppelin.png', 25)
    kit.frame('assets/square.toml', 'square.png', 73)
