# What a wrinkle field costs on base surfaces of 250 to 16,000 vertices: the twisted tube, and a sheet with fewer waves: wrinkle_cost.svg, wrinkle_cost.csv
# (tools/figures wrinkle_cost)
plisse wrinkle --example twisted-cylinder --cost 250,1000,4000,16000 -o wrinkle_cost.svg
plisse wrinkle --example stretched-sheet --cost 250,1000,4000 -o sheet.svg
