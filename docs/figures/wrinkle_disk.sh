# Waves of the TFW authors' disk beside the ones that they ship: wrinkle_disk.csv
# (tools/figures wrinkle_disk)
ln -s "$PLISSE_TFW_DISK" disk
plisse wrinkle disk/disk_TFW.json --wrinkle-free authors --evaluate disk/disk_amplitude_simulated.txt disk/disk_dphi_simulated.txt
plisse wrinkle disk/disk_TFW.json --wrinkle-free authors -o field_amplitude_found.txt
plisse wrinkle disk/disk_TFW.json -o field_amplitude_found.txt
plisse wrinkle disk/disk_TFW.json --wrinkle-free authors --curvature-factor 1.44 -o field_amplitude_found.txt
