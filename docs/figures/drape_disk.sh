# The TFW authors' disk, its base surface solved from the flat mesh, beside the one they ship: drape_disk.csv
# (tools/figures drape_disk)
ln -s "$PLISSE_TFW_DISK" disk
plisse drape disk/elastic/disk_elastic.json --start disk/disk_simulated.obj -o from_theirs.ply
for i in $(seq 3); do plisse drape disk/elastic/disk_elastic.json -o base.ply; done
