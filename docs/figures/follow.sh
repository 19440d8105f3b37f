# Base surfaces that follow a coarse cloth simulation: what the length Λ below which folds go to waves does: follow.csv
# (tools/figures follow)
ln -s "$PLISSE_CLOTH_DRAPE" drape
plisse export 'drape/drape_####.obj' --solve --cache-dir none --follow 0.0000 --frames 25,33,41,48 --levels 3 -o 'waves_0_####.obj'
plisse export 'drape/drape_####.obj' --solve --cache-dir none --follow 0.1265 --frames 25,33,41,48 --levels 3 -o 'waves_4_####.obj'
plisse export 'drape/drape_####.obj' --solve --cache-dir none --follow 0.1897 --frames 25,33,41,48 --levels 3 -o 'waves_6_####.obj'
plisse export 'drape/drape_####.obj' --solve --cache-dir none --follow 0.2529 --frames 25,33,41,48 --levels 3 -o 'waves_8_####.obj'
plisse export 'drape/drape_####.obj' --solve --cache-dir none --follow 0.3794 --frames 25,33,41,48 --levels 3 -o 'waves_12_####.obj'
