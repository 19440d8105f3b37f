# How far the passes' waves are from a field that is their bias: printed by a test: field_bias.csv
# (tools/figures field_bias)
tests/test_paint --gtest_filter=Field.ConstantBentAndSpreadingWavesAsBias
