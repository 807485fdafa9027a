# Sourced by the other scripts: brings a Debian 12 machine to where vkvol can be built, and builds it.
# Every function is quick when there is nothing left to do.

vkvol_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

packages=(
    build-essential cmake ninja-build python3
    libvulkan-dev mesa-vulkan-drivers vulkan-validationlayers glslang-tools spirv-tools
    libglm-dev libnanovdb-dev libopenvdb-dev libboost-iostreams-dev libtbb-dev libblosc-dev zlib1g-dev libimath-dev
    libopenimageio-dev libpugixml-dev libcli11-dev libspdlog-dev libfmt-dev nlohmann-json3-dev catch2 libxml2-utils
    python3-matplotlib
)

say() { printf '\n== %s\n' "$*"; }

die() {
    printf '%s: %s\n' "$(basename "$0")" "$*" >&2
    exit 1
}

# Installs what is missing of `packages`. Needs root or sudo, and the network, only if something is.
install_packages() {
    command -v dpkg-query >/dev/null || die "this script knows Debian 12 only; elsewhere, install the packages listed in tools/setup.sh and run: cmake --preset release && cmake --build --preset release"
    local missing=() package
    for package in "${packages[@]}"; do
        [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
    done
    if [ ${#missing[@]} -eq 0 ]; then
        return
    fi
    say "Installing ${#missing[@]} packages: ${missing[*]}"
    local as_root=()
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || die "packages are missing (${missing[*]}); run this script as root, or install them yourself"
        as_root=(sudo)
    fi
    "${as_root[@]}" apt-get update -qq || die "apt-get update failed: is there a network? Missing: ${missing[*]}"
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" \
        >/dev/null || die "apt-get could not install: ${missing[*]}"
}

# build PRESET [TARGET...]: configures once, then builds what has changed.
build() {
    local preset=$1
    shift
    say "Building ($preset)"
    cd "$vkvol_root" || exit 1
    cmake --preset "$preset" >/dev/null || die "cmake --preset $preset failed"
    cmake --build --preset "$preset" ${1:+--target "$@"} || die "the build failed"
}

# Density fields that are not there yet.
make_fields() {
    say "Density fields"
    "$vkvol_root/build/make_field" "$@" || die "a density field could not be made"
}
