# plisse against F3D, Blender's Workbench and Blender's cloth, in one run: compare.csv, compare_plisse.png, compare_f3d.png, compare_blender.png, compare_cloth50.png, compare_cloth200.png
# (tools/figures compare)
tools/compare -o compare
# compare_plisse.png: compare/plisse/frame_0037.png at half its size
# compare_f3d.png: compare/f3d/f3d_0037.png at half its size
# compare_blender.png: compare/blender/blender_0036.png at half its size
# compare_cloth50.png: compare/wrinkled/frame_0048.png at half its size
# compare_cloth200.png: compare/fine/frame_0048.png at half its size
