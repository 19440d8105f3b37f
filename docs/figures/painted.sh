# Wrinkles that were painted: the sleeve at rest and bent, the shirt: sleeve_painted.png, sleeve_painted_bent.png, shirt_painted.png
# (tools/figures painted)
plisse render assets/sleeve_painted.toml -o sleeve_painted.png --frames 1 --size 640x512
plisse render assets/sleeve_painted.toml -o sleeve_painted_bent.png --frames 37 --size 640x512
plisse render assets/shirt_painted.toml -o shirt_painted.png --frames 1 --size 640x512
