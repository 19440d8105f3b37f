# The hard cases of plisse bench hard, and what came out: hard.csv
# (tools/figures hard)
plisse bench hard -o hard
