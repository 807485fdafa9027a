#!/usr/bin/env bash
# The program under faults: devices lost, memory and disks full, signals, kills, damaged files. Prints a table, a fault
# a row: how often it was tried, with which exit codes the program ended, and how often something was lost (a half file, an
# old file gone, a checkpoint that does not resume to the same bits, an exit code or message that is not what README.md
# says). Fails if anything was lost. Takes some ten minutes on two cores.
#   tools/faults.sh            tools/results/faults.txt is what it printed
#   tools/faults.sh --quick    fewer runs of each
#   tools/faults.sh ... --only WORD --seed N    rows that contain the word; other random moments
#   tools/faults.sh ... --build-directory DIR   what is built there, instead of the release build
# Full disks are small file systems in memory, mounted where nobody else sees them. That takes root or a kernel that lets
# anybody have a name space of their own; where neither is so, these rows are skipped, and the table says so.
set -eu
source "$(dirname "$0")/setup.sh"

directory=$vkvol_root/build
arguments=()
own_build=yes
while [ $# -gt 0 ]; do
    case $1 in
    --build-directory)
        directory=$2
        own_build=no
        shift
        ;;
    *) arguments+=("$1") ;;
    esac
    shift
done
if [ $own_build = yes ]; then
    install_packages
    build release vkvol make_field VkLayer_vkvol_fault
fi

if [ "$(id -u)" -eq 0 ]; then
    private=(unshare --mount)
else
    private=(unshare --map-root-user --mount)
fi
if ! "${private[@]}" sh -c 'mount -t tmpfs none /mnt' 2>/dev/null; then
    private=()
    arguments+=(--no-mounts)
fi
exec "${private[@]}" python3 "$vkvol_root/tools/faults.py" "$directory" "${arguments[@]}"
