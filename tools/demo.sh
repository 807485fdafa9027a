#!/usr/bin/env bash
# From a bare Debian 12 or 13 to a picture of a cloud: installs what is missing, builds, makes the density field, renders.
# Run it again and only the render is left to do. Arguments go to vkvol: tools/demo.sh --spp 16
set -eu
source "$(dirname "$0")/setup.sh"

start=$SECONDS
install_packages
build release vkvol make_field
make_fields cumulus --output "$vkvol_root/density_fields/cumulus.nvdb" --if-missing

case " $* " in
*" --tonemap"*) ;;
*) set -- --tonemap aces "$@" ;;
esac
say "Rendering scenes/cumulus.xml"
mkdir -p "$vkvol_root/out"
"$vkvol_root/build/vkvol" "$vkvol_root/scenes/cumulus.xml" -o "$vkvol_root/out/cumulus.png" -o "$vkvol_root/out/cumulus.exr" "$@"
say "The picture is $vkvol_root/out/cumulus.png ($((SECONDS - start)) s in all)"
