# Solved wrinkles of a moving mesh at three sizes of its mesh: seconds of base surfaces and fields: follow_sizes.csv
# (tools/figures follow_sizes)
plisse wrinkle '32/sheet_####.obj' --follow 0.25 --wavelength 0.1 --cache-dir none -o waves_32
plisse wrinkle '64/sheet_####.obj' --follow 0.25 --wavelength 0.1 --cache-dir none -o waves_64
plisse wrinkle '128/sheet_####.obj' --follow 0.25 --wavelength 0.1 --cache-dir none -o waves_128
