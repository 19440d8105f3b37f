# Panels: the sizing map of a square with a shirring line, the mesh of a collar with a fold: size_square_map.png, size_collar_mesh.png
# (tools/figures size)
plisse size assets/panels.toml -o panels
cp panels/square_map.png size_square_map.png
cp panels/collar_mesh.png size_collar_mesh.png
