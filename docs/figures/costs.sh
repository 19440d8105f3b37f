# What each pass costs, and how that compares: tools/benchmark, into the tables of docs/benchmarks.md: costs.json
# (tools/figures costs)
tools/benchmark --write-docs --json costs.json
