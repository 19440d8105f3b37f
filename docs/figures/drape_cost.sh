# What a base surface costs, from a thousand vertices to 64 thousand: seconds, and the shares of assembly and factorisation: drape_cost.svg, drape_cost.csv
# (tools/figures drape_cost)
plisse drape --example stretched-sheet --cost 1000,4000,16000,64000 -o drape_cost.svg
