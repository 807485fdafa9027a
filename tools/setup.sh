#!/usr/bin/env bash
# Sourced by the other scripts: brings a machine with Debian 12 or 13 to where vkvol can be built, and builds it.
# Every function is quick when there is nothing left to do. Run by itself, it installs what a build needs.

# What the script that begins with this says of itself.
case ${1:-} in
-h | --help)
    sed -n '2,/^set \|^$/s/^# \?//p' "$0"
    exit
    ;;
esac

vkvol_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

packages=(
    build-essential cmake ninja-build python3
    libvulkan-dev mesa-vulkan-drivers vulkan-validationlayers glslang-tools spirv-tools
    libglm-dev libtinyobjloader-dev libnanovdb-dev libopenvdb-dev libboost-iostreams-dev libtbb-dev libblosc-dev zlib1g-dev libimath-dev
    libopenimageio-dev libpugixml-dev libcli11-dev libfmt-dev libcpp-httplib-dev pkg-config libxxhash-dev libjemalloc-dev nlohmann-json3-dev catch2 libxml2-utils
    python3-numpy python3-pil python3-matplotlib python3-dev pybind11-dev
)

say() { printf '\n== %s\n' "$*"; }

die() {
    printf '%s: %s\n' "$(basename "$0")" "$*" >&2
    exit 1
}

# As /etc/os-release has it: "system ID" is "debian 12".
system() {
    (. /etc/os-release 2>/dev/null && case $1 in
    ID) echo "$ID ${VERSION_ID:-}" ;;
    NAME) echo "$PRETTY_NAME" ;;
    esac) || echo "this system"
}

# Names all packages, as those of other systems have other names.
die_unsupported() {
    die "$1
vkvol is tested on Debian 12 and 13, where it needs these packages:
$(fmt -w 110 <<<"${packages[*]}" | sed 's/^/    /')
Elsewhere install what corresponds to them (C++20, CMake 3.25, OpenVDB and NanoVDB 10), and run
    cmake --preset release && cmake --build --preset release"
}

# Installs what is missing of `packages`. Needs root or sudo, and the network, only if something is.
install_packages() {
    command -v dpkg-query >/dev/null || die_unsupported "$(system NAME) is not Debian: packages cannot be installed"
    local missing=() package
    for package in "${packages[@]}"; do
        # Of several architectures, each has a line.
        dpkg-query -W -f='${Architecture} ${db:Status-Status}\n' "$package" 2>/dev/null |
            grep -qxE "(all|$(dpkg --print-architecture)) installed" || missing+=("$package")
    done
    if [ ${#missing[@]} -eq 0 ]; then
        return
    fi
    case $(system ID) in
    "debian 12" | "debian 13") ;;
    *) say "$(system NAME) is not tested: packages may be missing, or too old or new" ;;
    esac
    say "Installing ${#missing[@]} packages: ${missing[*]}"
    local as_root=()
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || die "packages are missing (${missing[*]}); run this script as root, or install them yourself"
        as_root=(sudo)
    fi
    # A new system may be updating itself, and the lock of the lists is not waited for.
    local try
    for try in 1 2 3 4 5 last; do
        "${as_root[@]}" apt-get update -qq && break
        [ "$try" != last ] || die "apt-get update failed: is there a network? Missing: ${missing[*]}"
        sleep 10
    done
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 install -y -qq --no-install-recommends "${missing[@]}" \
        >/dev/null || die_unsupported "apt-get could not install: ${missing[*]}"
}

# build PRESET [-DNAME=VALUE] [TARGET...]: configures, then builds what has changed.
build() {
    local preset=$1 setting=
    shift
    if [[ "${1:-}" == -D* ]]; then
        setting=$1
        shift
    elif [ -z "${CXX:-}" ]; then
        # As tools/test.sh has it, or that would compile anew what another script has. Elsewhere no new compiler's warning
        # shall keep anybody from a picture.
        case $(system ID) in
        "debian 12" | "debian 13") setting=-DVKVOL_WERROR=ON ;;
        esac
    fi
    say "Building ($preset)"
    # Files that were named on the command line are where they were.
    (cd "$vkvol_root" && cmake --preset "$preset" ${setting:+"$setting"} >/dev/null) || die "cmake --preset $preset failed"
    (cd "$vkvol_root" && cmake --build --preset "$preset" ${1:+--target "$@"}) || die "the build failed"
}

# Density fields that are not there yet.
make_fields() {
    say "Density fields"
    "$vkvol_root/build/make_field" "$@" || die "a density field could not be made"
}

# use_driver NAME: what this script runs from here on sees that Vulkan driver alone.
#   lavapipe      Mesa's
#   swiftshader   Google's, of Debian's package chromium-common: its library is unpacked once, into build/, not installed
use_driver() {
    local manifest
    case $1 in
    lavapipe)
        manifest=$(compgen -G "/usr/share/vulkan/icd.d/lvp_icd*$(uname -m).json" ||
            compgen -G "/usr/share/vulkan/icd.d/lvp_icd*.json" | head -n 1)
        [ -n "$manifest" ] || die "lavapipe is not installed; apt-get install mesa-vulkan-drivers brings it" ;;
    swiftshader)
        manifest=$vkvol_root/build/swiftshader/vk_swiftshader_icd.json
        [ -f "$manifest" ] || unpack_swiftshader "$(dirname "$manifest")"
        ;;
    *) die "there is no driver $1; known are lavapipe and swiftshader" ;;
    esac
    [ -f "$manifest" ] || die "the driver $1 could not be made ready: $manifest is missing"
    export VK_DRIVER_FILES=$manifest VK_ICD_FILENAMES=$manifest # the latter for Vulkan loaders before 1.3.207
}

# A subshell; its directory appears only once all is well.
unpack_swiftshader() (
    say "SwiftShader, from the package chromium-common"
    temporary=$1.unpacking
    rm -rf "$temporary"
    mkdir -p "$temporary"
    cd "$temporary"
    apt-get -o APT::Sandbox::User=root download -qq chromium-common ||
        die "chromium-common could not be downloaded: is there a network, and does apt-get update know Debian's security updates?"
    dpkg-deb --fsys-tarfile chromium-common_*.deb | tar -x --strip-components=4 \
        ./usr/lib/chromium/libvk_swiftshader.so ./usr/lib/chromium/vk_swiftshader_icd.json ||
        die "this chromium-common has no SwiftShader at usr/lib/chromium: $(ls chromium-common_*.deb)"
    rm chromium-common_*.deb
    mv "$temporary" "$1"
)

if [ "${BASH_SOURCE[0]}" = "$0" ]; then
    set -eu
    install_packages
fi
