"""Solved wrinkles of two rigs in one command: a sleeve at its deepest bend, a shirt that turns."""
MAKES = ['sleeve_solved.png', 'shirt_solved.png']


def make(kit):
    kit.frame('assets/sleeve.toml', 'sleeve_solved.png', 37, '--solve')
    kit.frame('assets/shirt.toml', 'shirt_solved.png', 30, '--solve')
