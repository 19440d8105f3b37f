# Solved fields drawn directly and as bias: the angle to the geometry of the same waves, and the error of heights: field_drawing.csv
# (tools/figures field_drawing)
plisse drape --example stretched-sheet -o stretched-sheet_base.ply
plisse wrinkle stretched-sheet_base.ply -o stretched-sheet_field.ply --mesh stretched-sheet_waves.ply
cat > stretched-sheet.toml << 'END'
[model]
path = "stretched-sheet_base.ply"
[bias]
field = "stretched-sheet_field.ply"
use = "direct"
[camera]
eye = [0.3862248723430939, 0.32359735957740327, 0.3332913289397458]
target = [0.1375, 0.05, 0.0]
END
cat > stretched-sheet_mesh.toml << 'END'
[model]
path = "stretched-sheet_waves.ply"
[wrinkles]
strength = 0
[camera]
eye = [0.3862248723430939, 0.32359735957740327, 0.3332913289397458]
target = [0.1375, 0.05, 0.0]
END
plisse render stretched-sheet.toml -o stretched-sheet_shaded.png --size 600x480 --aov normal
plisse render stretched-sheet.toml -o stretched-sheet_displaced.png --size 600x480 --aov normal --displace
plisse render stretched-sheet_mesh.toml -o stretched-sheet_mesh.png --size 600x480 --aov normal
cat > stretched-sheet.paint.toml << 'END'
scene = "stretched-sheet_base.ply"
preview_frame = 0
[[stroke]]
kind = "field"
file = "stretched-sheet_field.ply"
END
plisse paint stretched-sheet.paint.toml -o stretched-sheet_painted
plisse drape --example sheared-rectangle -o sheared-rectangle_base.ply
plisse wrinkle sheared-rectangle_base.ply -o sheared-rectangle_field.ply --mesh sheared-rectangle_waves.ply
cat > sheared-rectangle.toml << 'END'
[model]
path = "sheared-rectangle_base.ply"
[bias]
field = "sheared-rectangle_field.ply"
use = "direct"
[camera]
eye = [0.5347630053580791, 0.441614305893887, 0.459972427179826]
target = [0.19149999999999998, 0.064025, 0.0]
END
cat > sheared-rectangle_mesh.toml << 'END'
[model]
path = "sheared-rectangle_waves.ply"
[wrinkles]
strength = 0
[camera]
eye = [0.5347630053580791, 0.441614305893887, 0.459972427179826]
target = [0.19149999999999998, 0.064025, 0.0]
END
plisse render sheared-rectangle.toml -o sheared-rectangle_shaded.png --size 600x480 --aov normal
plisse render sheared-rectangle.toml -o sheared-rectangle_displaced.png --size 600x480 --aov normal --displace
plisse render sheared-rectangle_mesh.toml -o sheared-rectangle_mesh.png --size 600x480 --aov normal
cat > sheared-rectangle.paint.toml << 'END'
scene = "sheared-rectangle_base.ply"
preview_frame = 0
[[stroke]]
kind = "field"
file = "sheared-rectangle_field.ply"
END
plisse paint sheared-rectangle.paint.toml -o sheared-rectangle_painted
plisse drape --example twisted-cylinder -o twisted-cylinder_base.ply
plisse wrinkle twisted-cylinder_base.ply -o twisted-cylinder_field.ply --mesh twisted-cylinder_waves.ply
cat > twisted-cylinder.toml << 'END'
[model]
path = "twisted-cylinder_base.ply"
[bias]
field = "twisted-cylinder_field.ply"
use = "direct"
[camera]
eye = [4.882723121757202, 7.8700649222080505, 6.540869530186911]
target = [0.0008459197498834614, 2.5, -0.0008459205028961136]
END
cat > twisted-cylinder_mesh.toml << 'END'
[model]
path = "twisted-cylinder_waves.ply"
[wrinkles]
strength = 0
[camera]
eye = [4.882723121757202, 7.8700649222080505, 6.540869530186911]
target = [0.0008459197498834614, 2.5, -0.0008459205028961136]
END
plisse render twisted-cylinder.toml -o twisted-cylinder_shaded.png --size 600x480 --aov normal
plisse render twisted-cylinder.toml -o twisted-cylinder_displaced.png --size 600x480 --aov normal --displace
plisse render twisted-cylinder_mesh.toml -o twisted-cylinder_mesh.png --size 600x480 --aov normal
cat > twisted-cylinder.paint.toml << 'END'
scene = "twisted-cylinder_base.ply"
preview_frame = 0
[[stroke]]
kind = "field"
file = "twisted-cylinder_field.ply"
END
plisse paint twisted-cylinder.paint.toml -o twisted-cylinder_painted
plisse drape --example disk-balloon -o disk-balloon_base.ply
plisse wrinkle disk-balloon_base.ply -o disk-balloon_field.ply --mesh disk-balloon_waves.ply
cat > disk-balloon.toml << 'END'
[model]
path = "disk-balloon_base.ply"
[bias]
field = "disk-balloon_field.ply"
use = "direct"
[camera]
eye = [0.19884331040887457, 0.21981605045350264, 0.2682956258242071]
target = [-0.0009894627306732753, -3.469446951953614e-18, 0.0005197098172129225]
END
cat > disk-balloon_mesh.toml << 'END'
[model]
path = "disk-balloon_waves.ply"
[wrinkles]
strength = 0
[camera]
eye = [0.19884331040887457, 0.21981605045350264, 0.2682956258242071]
target = [-0.0009894627306732753, -3.469446951953614e-18, 0.0005197098172129225]
END
plisse render disk-balloon.toml -o disk-balloon_shaded.png --size 600x480 --aov normal
plisse render disk-balloon.toml -o disk-balloon_displaced.png --size 600x480 --aov normal --displace
plisse render disk-balloon_mesh.toml -o disk-balloon_mesh.png --size 600x480 --aov normal
cat > disk-balloon.paint.toml << 'END'
scene = "disk-balloon_base.ply"
preview_frame = 0
[[stroke]]
kind = "field"
file = "disk-balloon_field.ply"
END
plisse paint disk-balloon.paint.toml -o disk-balloon_painted
plisse drape --example torus -o torus_base.ply
plisse wrinkle torus_base.ply -o torus_field.ply --mesh torus_waves.ply
cat > torus.toml << 'END'
[model]
path = "torus_base.ply"
[bias]
field = "torus_field.ply"
use = "direct"
[camera]
eye = [0.20501065065457744, 0.22581401817180136, 0.2749700948695028]
target = [-0.0002748204106965066, -3.469446951953614e-18, -0.00011243635796432533]
END
cat > torus_mesh.toml << 'END'
[model]
path = "torus_waves.ply"
[wrinkles]
strength = 0
[camera]
eye = [0.20501065065457744, 0.22581401817180136, 0.2749700948695028]
target = [-0.0002748204106965066, -3.469446951953614e-18, -0.00011243635796432533]
END
plisse render torus.toml -o torus_shaded.png --size 600x480 --aov normal
plisse render torus.toml -o torus_displaced.png --size 600x480 --aov normal --displace
plisse render torus_mesh.toml -o torus_mesh.png --size 600x480 --aov normal
cat > torus.paint.toml << 'END'
scene = "torus_base.ply"
preview_frame = 0
[[stroke]]
kind = "field"
file = "torus_field.ply"
END
plisse paint torus.paint.toml -o torus_painted
plisse drape --example teabag -o teabag_base.ply
plisse wrinkle teabag_base.ply -o teabag_field.ply --mesh teabag_waves.ply
cat > teabag.toml << 'END'
[model]
path = "teabag_base.ply"
[bias]
field = "teabag_field.ply"
use = "direct"
[camera]
eye = [1.3117088010040352, 1.4722477890562014, 1.7964089148667803]
target = [-0.026698279956147652, 0.0, 0.0029434263801351723]
END
cat > teabag_mesh.toml << 'END'
[model]
path = "teabag_waves.ply"
[wrinkles]
strength = 0
[camera]
eye = [1.3117088010040352, 1.4722477890562014, 1.7964089148667803]
target = [-0.026698279956147652, 0.0, 0.0029434263801351723]
END
plisse render teabag.toml -o teabag_shaded.png --size 600x480 --aov normal
plisse render teabag.toml -o teabag_displaced.png --size 600x480 --aov normal --displace
plisse render teabag_mesh.toml -o teabag_mesh.png --size 600x480 --aov normal
cat > teabag.paint.toml << 'END'
scene = "teabag_base.ply"
preview_frame = 0
[[stroke]]
kind = "field"
file = "teabag_field.ply"
END
plisse paint teabag.paint.toml -o teabag_painted
plisse drape --example annulus -o annulus_base.ply
plisse wrinkle annulus_base.ply -o annulus_field.ply --mesh annulus_waves.ply
cat > annulus.toml << 'END'
[model]
path = "annulus_base.ply"
[bias]
field = "annulus_field.ply"
use = "direct"
[camera]
eye = [2.399792526999468, 2.6397717796994153, 3.2157219861792874]
target = [0.0, 0.0, 0.0]
END
cat > annulus_mesh.toml << 'END'
[model]
path = "annulus_waves.ply"
[wrinkles]
strength = 0
[camera]
eye = [2.399792526999468, 2.6397717796994153, 3.2157219861792874]
target = [0.0, 0.0, 0.0]
END
plisse render annulus.toml -o annulus_shaded.png --size 600x480 --aov normal
plisse render annulus.toml -o annulus_displaced.png --size 600x480 --aov normal --displace
plisse render annulus_mesh.toml -o annulus_mesh.png --size 600x480 --aov normal
cat > annulus.paint.toml << 'END'
scene = "annulus_base.ply"
preview_frame = 0
[[stroke]]
kind = "field"
file = "annulus_field.ply"
END
plisse paint annulus.paint.toml -o annulus_painted
plisse drape --example sphere-drape -o sphere-drape_base.ply
plisse wrinkle sphere-drape_base.ply -o sphere-drape_field.ply --mesh sphere-drape_waves.ply
cat > sphere-drape.toml << 'END'
[model]
path = "sphere-drape_base.ply"
[bias]
field = "sphere-drape_field.ply"
use = "direct"
[camera]
eye = [0.7062290151310003, 0.4751026959794031, 0.9461968980808256]
target = [0.00010054243012347364, -0.30163862399156155, -1.5255338349423608e-05]
END
cat > sphere-drape_mesh.toml << 'END'
[model]
path = "sphere-drape_waves.ply"
[wrinkles]
strength = 0
[camera]
eye = [0.7062290151310003, 0.4751026959794031, 0.9461968980808256]
target = [0.00010054243012347364, -0.30163862399156155, -1.5255338349423608e-05]
END
plisse render sphere-drape.toml -o sphere-drape_shaded.png --size 600x480 --aov normal
plisse render sphere-drape.toml -o sphere-drape_displaced.png --size 600x480 --aov normal --displace
plisse render sphere-drape_mesh.toml -o sphere-drape_mesh.png --size 600x480 --aov normal
cat > sphere-drape.paint.toml << 'END'
scene = "sphere-drape_base.ply"
preview_frame = 0
[[stroke]]
kind = "field"
file = "sphere-drape_field.ply"
END
plisse paint sphere-drape.paint.toml -o sphere-drape_painted
plisse drape --example curtain -o curtain_base.ply
plisse wrinkle curtain_base.ply -o curtain_field.ply --mesh curtain_waves.ply
cat > curtain.toml << 'END'
[model]
path = "curtain_base.ply"
[bias]
field = "curtain_field.ply"
use = "direct"
[camera]
eye = [2.298169149212984, 2.227212575321066, 2.006328102383708]
target = [0.800909371314694, 0.5802268196329472, -8.93734129690968e-295]
END
cat > curtain_mesh.toml << 'END'
[model]
path = "curtain_waves.ply"
[wrinkles]
strength = 0
[camera]
eye = [2.298169149212984, 2.227212575321066, 2.006328102383708]
target = [0.800909371314694, 0.5802268196329472, -8.93734129690968e-295]
END
plisse render curtain.toml -o curtain_shaded.png --size 600x480 --aov normal
plisse render curtain.toml -o curtain_displaced.png --size 600x480 --aov normal --displace
plisse render curtain_mesh.toml -o curtain_mesh.png --size 600x480 --aov normal
cat > curtain.paint.toml << 'END'
scene = "curtain_base.ply"
preview_frame = 0
[[stroke]]
kind = "field"
file = "curtain_field.ply"
END
plisse paint curtain.paint.toml -o curtain_painted
plisse drape --example skirt -o skirt_base.ply
plisse wrinkle skirt_base.ply -o skirt_field.ply --mesh skirt_waves.ply
cat > skirt.toml << 'END'
[model]
path = "skirt_base.ply"
[bias]
field = "skirt_field.ply"
use = "direct"
[camera]
eye = [0.6030824836267772, 1.3862844069015305, 0.7935736625143258]
target = [-9.226709275972356e-06, 0.722883525531872, -0.014569229335985465]
END
cat > skirt_mesh.toml << 'END'
[model]
path = "skirt_waves.ply"
[wrinkles]
strength = 0
[camera]
eye = [0.6030824836267772, 1.3862844069015305, 0.7935736625143258]
target = [-9.226709275972356e-06, 0.722883525531872, -0.014569229335985465]
END
plisse render skirt.toml -o skirt_shaded.png --size 600x480 --aov normal
plisse render skirt.toml -o skirt_displaced.png --size 600x480 --aov normal --displace
plisse render skirt_mesh.toml -o skirt_mesh.png --size 600x480 --aov normal
cat > skirt.paint.toml << 'END'
scene = "skirt_base.ply"
preview_frame = 0
[[stroke]]
kind = "field"
file = "skirt_field.ply"
END
plisse paint skirt.paint.toml -o skirt_painted
ln -s "$PLISSE_CLOTH_DRAPE" cloth
plisse wrinkle 'cloth/drape_####.obj' -o cloth_waves --frames 48 --mesh 'cloth_mesh_####.ply'
cat > cloth.toml << 'END'
[model]
path = "cloth_waves/base_0048.ply"
[bias]
field = "cloth_waves/field_0048.ply"
use = "direct"
[camera]
eye = [0.7958155363764834, 0.8735438960441888, 0.7784576459893757]
target = [-0.002911102290884593, -0.005055406489915926, -0.29183604982489725]
END
cat > cloth_mesh.toml << 'END'
[model]
path = "cloth_mesh_0048.ply"
[wrinkles]
strength = 0
[camera]
eye = [0.7958155363764834, 0.8735438960441888, 0.7784576459893757]
target = [-0.002911102290884593, -0.005055406489915926, -0.29183604982489725]
END
plisse render cloth.toml -o cloth_shaded.png --size 600x480 --aov normal
plisse render cloth.toml -o cloth_displaced.png --size 600x480 --aov normal --displace
plisse render cloth_mesh.toml -o cloth_mesh.png --size 600x480 --aov normal
cat > cloth.paint.toml << 'END'
scene = "cloth_waves/base_0048.ply"
preview_frame = 0
[[stroke]]
kind = "field"
file = "cloth_waves/field_0048.ply"
END
plisse paint cloth.paint.toml -o cloth_painted
