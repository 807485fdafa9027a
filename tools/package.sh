#!/usr/bin/env bash
# Makes a Debian package of what is built here: vkvol, vkvol-make-field, scenes, man pages, completions, and the field of
# `vkvol demo`. It needs nothing of what building needs, and a Vulkan driver: apt-get install ./FILE.deb brings Mesa's.
# Installs what is missing, and help2man. Prints where the package is.
set -eu
source "$(dirname "$0")/setup.sh"

packages+=(help2man dpkg-dev)
install_packages
build release vkvol make_field
cmake --build --preset release --target package_files || die "man pages, completions or the demo's field could not be made"
rm -f build/package/*.deb
(cd build && cpack -G DEB >package.log) || die "cpack failed: $(tail -n 3 build/package.log)"
say "$(find "$vkvol_root/build/package" -maxdepth 1 -name '*.deb')"
