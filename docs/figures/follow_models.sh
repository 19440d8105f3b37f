# Solved wrinkles of animated models: how many frames converge, and whether folds lie along the tension: follow_models.csv
# (tools/figures follow_models)
ln -s "$PLISSE_MODELS" models
plisse wrinkle assets/sleeve.glb --cache-dir none -o waves_0
plisse wrinkle assets/shirt.glb --cache-dir none -o waves_1
plisse wrinkle models/KayKit_Knight.glb --cache-dir none -o waves_2
plisse wrinkle models/Greenman.glb --cache-dir none -o waves_3
plisse wrinkle models/Fox.glb --clip Run --cache-dir none -o waves_4
plisse wrinkle models/Fox.glb --clip Survey --cache-dir none -o waves_5
plisse wrinkle models/huesitos.fbx --cache-dir none -o waves_6
plisse wrinkle models/bending_cylinder_anim_test.x --cache-dir none -o waves_7
plisse wrinkle models/ufbx_maya_game_sausage_7500_binary_combined.fbx --cache-dir none -o waves_8
