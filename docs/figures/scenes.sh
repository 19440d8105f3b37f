# Scenes of assets/ in the README, each in its most wrinkled frame: shirt.png, zeppelin.png, square.png
# (tools/figures scenes)
plisse render assets/shirt.toml -o shirt.png --frames 25 --size 640x512
plisse render assets/zeppelin.toml -o zeppelin.png --frames 25 --size 640x512
plisse render assets/square.toml -o square.png --frames 73 --size 640x512
