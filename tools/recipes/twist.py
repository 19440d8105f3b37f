"""A tube that is twisted by 10 degrees in 48 frames: fields solved over time, drawn as they are, as bias of the passes, as geometry."""
from recipes.kit import cloth_look

MAKES = ['twist.png']

SCENES = {
    'direct': '[model]\npath = "base_####.ply"\n[bias]\nfield = "field_####.ply"\nuse = "direct"\n',
    # Rest is the twisted tube with its waves: before, it is stretched round, which takes them away, and squeezed along by 1.7 %.
    'bias': '[model]\npath = "base_####.ply"\nrest = "frame:48"\n[wrinkles]\ndead_zone = 0.025\n[bias]\nfield = "field_0048.ply"\n',
    'geometry': '[model]\npath = "waves_####.ply"\n[wrinkles]\nstrength = 0\n',
}


def make(kit):
    kit.plisse('drape', '--example', 'twisted-cylinder', '--steps', 48, '--frames', '1-48', '-o', 'base_####.ply')
    kit.plisse('wrinkle', 'base_####.ply', '-o', 'field_####.ply', '--mesh', 'waves_####.ply')
    frames = (1, 3, 8, 16, 24, 32, 40, 48)
    for name, head in SCENES.items():
        kit.write(f'{name}.toml', head + cloth_look())
        kit.plisse('render', f'{name}.toml', '--frames', '1-48', '-o', f'{name}/####.png', '--size', '400x480')
    kit.keep_sheet([[f'{name}/{n:04}.png' for n in frames] for name in SCENES], 'twist.png')
