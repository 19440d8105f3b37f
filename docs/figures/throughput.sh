# Whole runs: 240 frames with PNG by the clock against CPU time over cores; the first frame of a warm start: throughput.csv
# (tools/figures throughput)
for i in $(seq 6); do plisse render assets/sleeve.toml --frames 1 -o first.png --size 1280x1024; done
plisse render assets/sleeve.toml --fps 80.9577 --frames 1-240 -o 'sleeve/frame_####.png' --size 1280x1024 --samples 4
for i in $(seq 6); do plisse render assets/shirt.toml --frames 1 -o first.png --size 1280x1024; done
plisse render assets/shirt.toml --fps 122.2979 --frames 1-240 -o 'shirt/frame_####.png' --size 1280x1024 --samples 4
for i in $(seq 6); do plisse render assets/zeppelin.toml --frames 1 -o first.png --size 1280x1024; done
plisse render assets/zeppelin.toml --fps 122.2979 --frames 1-240 -o 'zeppelin/frame_####.png' --size 1280x1024 --samples 4
for i in $(seq 6); do plisse render assets/curtain.toml --frames 1 -o first.png --size 1280x1024; done
plisse render assets/curtain.toml --fps 122.2979 --frames 1-240 -o 'curtain/frame_####.png' --size 1280x1024 --samples 4
for i in $(seq 6); do plisse render assets/sleeve.glb --frames 1 -o first.png --size 320x256; done
