#!/usr/bin/env bash
# Makes packages of what is built here: vkvol, vkvol-make-field, scenes, man pages, completions, and the field of `vkvol demo`.
#   tools/package.sh        a Debian package for this release. It needs nothing of what building needs, and a Vulkan driver:
#                           apt-get install ./FILE.deb brings Mesa's
#   tools/package.sh tar    a folder that runs wherever it is unpacked, as bin/vkvol, with all the libraries that it needs but the C
#                           and C++ runtimes and the Vulkan loader and drivers, which are the machine's: on this release of Debian
#                           and later ones
# Installs what is missing, and what packs. Prints where the package is.
set -eu
source "$(dirname "$0")/setup.sh"

kind=${1:-deb}
case $kind in
deb | tar) ;;
*) die "'$kind' is neither deb nor tar" ;;
esac
packages+=(help2man dpkg-dev file patchelf)
install_packages
build release vkvol make_field
cd "$vkvol_root"
cmake --build --preset release --target package_files || die "man pages, completions or the demo's field could not be made"

make_deb() {
    rm -f build/package/*.deb
    (cd build && cpack -G DEB >package.log) || die "cpack failed: $(tail -n 3 build/package.log)"
}

# Of the machine: drivers are loaded into the same process, and want theirs, which may be newer than those here.
is_of_the_machine() {
    case $1 in
    libc.so.* | libm.so.* | libdl.so.* | librt.so.* | libpthread.so.* | libresolv.so.* | ld-linux* | libstdc++.so.* | libgcc_s.so.* | libvulkan.so.*) ;;
    *) return 1 ;;
    esac
}

make_tar() {
    local name file package
    name=vkvol-$(build/vkvol --version | cut -d ' ' -f 2)-$(dpkg --print-architecture)
    folder=$(mktemp -d)
    trap 'rm -rf "$folder"' EXIT
    cmake --install build --prefix "$folder/$name" --component program --strip >/dev/null || die "cmake --install failed"
    mkdir -p "$folder/$name/lib" "$folder/$name/share/doc/libraries"
    ldd "$folder/$name"/bin/* "$folder/$name"/lib/vkvol/* | awk '$2 == "=>" && $3 ~ "^/" { print $3 }' | sort -u | while read -r file; do
        is_of_the_machine "$(basename "$file")" && continue
        cp -L "$file" "$folder/$name/lib/"
        # Whose it is, and on which terms.
        # Debian 12 knows files of /lib by that name, and those of alternatives by where they lead.
        package=$(dpkg-query -S "$file" "$(realpath "$file")" "${file#/usr}" "$(realpath "$file" | sed 's|^/usr||')" 2>/dev/null | head -n 1 | cut -d : -f 1)
        [ -n "$package" ] || die "no package of Debian's has $file, so its licence is not known"
        [ ! -f "/usr/share/doc/$package/copyright" ] || cp -L "/usr/share/doc/$package/copyright" "$folder/$name/share/doc/libraries/$package"
    done
    # RPATH and not RUNPATH, which libraries do not hand on to those that they load in turn.
    for file in "$folder/$name"/bin/* "$folder/$name"/lib/vkvol/*; do
        # shellcheck disable=SC2016
        patchelf --force-rpath --set-rpath '$ORIGIN/../lib/vkvol:$ORIGIN/../lib:$ORIGIN/..' "$file"
    done
    rm -f build/package/*.tar.gz
    tar -C "$folder" --owner 0 --group 0 --sort name -czf "build/package/$name.tar.gz" "$name"
}

"make_$kind"
say "$(find "$vkvol_root/build/package" -maxdepth 1 -name "vkvol*.$kind*")"
