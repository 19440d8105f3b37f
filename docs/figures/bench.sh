# Time against error, setting by setting: the plots of plisse bench, and the rows that no other beats: bench.csv, bench_front.csv, bench_relaxation.svg, bench_shading.svg, bench_mesh.svg, bench_method.svg, bench_output.svg
# (tools/figures bench)
plisse bench full -o bench
cp bench/rows.csv bench.csv
cp bench/plot_relaxation_sleeve_picture_2.svg bench_relaxation.svg
cp bench/plot_shading_sleeve_picture_1.svg bench_shading.svg
cp bench/plot_mesh_stretched-sheet_amplitude_1.svg bench_mesh.svg
cp bench/plot_method_stretched-sheet_wavelength_1.svg bench_method.svg
cp bench/plot_output_sleeve_file_2.svg bench_output.svg
