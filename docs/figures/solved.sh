# Solved wrinkles of two rigs in one command: a sleeve at its deepest bend, a shirt that turns: sleeve_solved.png, shirt_solved.png
# (tools/figures solved)
plisse render assets/sleeve.toml -o sleeve_solved.png --frames 37 --size 640x512 --solve
plisse render assets/shirt.toml -o shirt_solved.png --frames 30 --size 640x512 --solve
