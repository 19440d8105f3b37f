# How far shading is from the geometry that it stands for, by wavelength: printed by a test: displacement.csv
# (tools/figures displacement)
tests/test_system --gtest_filter=Displaced.TheFinerTheWavesTheLessGeometryDiffersFromShading
