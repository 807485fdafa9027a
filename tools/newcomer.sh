#!/usr/bin/env bash
# The README's two commands on a new machine: in a bare Debian (debootstrap's minbase), on what HEAD holds, as root and as a
# user with sudo. Prints how each ended and what it took, and keeps that in tools/results/newcomer.txt, a row each.
#   tools/newcomer.sh                      all: on two cores about an hour and a half
#   tools/newcomer.sh trixie user demo     words choose: bookworm or trixie, root or user, demo, test, package, tar, python or schedules
#     package: that which tools/package.sh has made on this machine is installed in a bare system of the same release, tried by
#     `vkvol demo`, and removed without a trace; not among what is done without words
#     tar: what `tools/package.sh tar` has made is unpacked in one of any release, and tried; likewise
#     python: `pip install .` in an environment of its own, and a picture from Python; likewise. PyPI has to be there
#     schedules: `tools/validate.sh schedules` on that release's driver; likewise. The table is in the output
#   tools/newcomer.sh --cache DIR          where bare systems are kept; default: ~/.cache/vkvol-newcomer
#   tools/newcomer.sh --mirror URL         default: http://deb.debian.org/debian
# Each has a system of its own; but of demo, test and schedules, one after the other, the next finds what the one before left.
# Needs root, the network and the package debootstrap. What it mounts is in a name space of its own and goes with it.
set -eu
source "$(dirname "$0")/setup.sh"

releases=()
users=()
commands=()
cache=${XDG_CACHE_HOME:-$HOME/.cache}/vkvol-newcomer
mirror=http://deb.debian.org/debian
while [ $# -gt 0 ]; do
    case $1 in
    bookworm | trixie) releases+=("$1") ;;
    root | user) users+=("$1") ;;
    demo | test | package | tar | python | schedules) commands+=("$1") ;;
    --cache | --mirror)
        [ $# -gt 1 ] || die "$1 needs a value"
        [ "$1" = --cache ] && cache=$2 || mirror=$2
        shift
        ;;
    *) die "'$1' is neither a release (bookworm, trixie), a user (root, user), a command (demo, test, package, tar, python, schedules), --cache DIR nor --mirror URL" ;;
    esac
    shift
done
[ ${#releases[@]} -gt 0 ] || releases=(bookworm trixie)
[ ${#users[@]} -gt 0 ] || users=(root user)
[ ${#commands[@]} -gt 0 ] || commands=(demo test)

[ "$(id -u)" -eq 0 ] || die "debootstrap and chroot need root"
command -v debootstrap >/dev/null || die "debootstrap is missing: apt-get install debootstrap"
git -C "$vkvol_root" rev-parse HEAD >/dev/null || die "$vkvol_root is no clone, whose HEAD could be tried"
git -C "$vkvol_root" diff --quiet HEAD || say "What is not committed is not tried"
mkdir -p "$cache" "$vkvol_root/out"
results=$vkvol_root/tools/results/newcomer.txt
system=$(mktemp -d "$cache/system.XXXXXX")
trap 'rm -rf --one-file-system "$system"' EXIT

# bare RELEASE: its archive, made once.
bare() {
    local archive=$cache/$1.tar
    if [ ! -f "$archive" ]; then
        say "A bare $1, from $mirror"
        rm -rf --one-file-system "$system"
        debootstrap --variant=minbase "$1" "$system" "$mirror" >"$cache/debootstrap.log" ||
            die "debootstrap $1 failed: $(tail -n 3 "$cache/debootstrap.log")"
        tar -C "$system" --numeric-owner -cf "$archive.partial" .
        mv "$archive.partial" "$archive"
    fi
}

# inside COMMAND: by the shell of the new system, where nothing of this one's environment is left but the way to the network.
inside() {
    local proxies=() name
    for name in http_proxy https_proxy no_proxy; do
        [ -z "${!name:-}" ] || proxies+=("$name=${!name}")
    done
    # shellcheck disable=SC2016
    unshare --mount --pid --fork --kill-child sh -c '
        mount -t proc proc "$0/proc" && mount --rbind /dev "$0/dev" && mount -t sysfs sysfs "$0/sys" && mount -t tmpfs tmpfs "$0/tmp" &&
            exec chroot "$0" "$@"' \
        "$system" env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin "${proxies[@]}" bash -c "$1" </dev/null
}

# new_system RELEASE USER: with the sources, and the user if that is not root.
new_system() {
    rm -rf --one-file-system "$system"
    mkdir "$system"
    tar -C "$system" -xf "$cache/$1.tar"
    cp --remove-destination -L /etc/resolv.conf "$system/etc/resolv.conf"
    echo "127.0.0.1 localhost $(uname -n)" >"$system/etc/hosts"
    mkdir -p "$system/home/vkvol"
    git -C "$vkvol_root" archive "${commit#commit }" | tar -C "$system/home/vkvol" -x
    if [ "$2" = user ]; then
        inside 'apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends sudo && useradd -d /home newcomer &&
            echo "newcomer ALL=(ALL) NOPASSWD: ALL" >/etc/sudoers.d/newcomer && chown -R newcomer: /home' >"$cache/sudo.log" 2>&1 ||
            die "sudo could not be installed: $(tail -n 3 "$cache/sudo.log")"
    fi
}

# What a run of it was on and led to, for its row.
circumstances() {
    inside 'g++ -dumpfullversion; dpkg-query -W -f "\${Version}" mesa-vulkan-drivers' 2>/dev/null | paste -sd ' ' |
        sed -E 's/^(\S+) (\S+)$/g++ \1, Mesa \2/'
    sed -nE 's/.* out of ([0-9]+)$/\1 tests/p' "$1"
    echo "$(nproc) cores with load $load"
    echo "$commit"
}

# What is done there: the README's command, or what a user of the package does.
steps() {
    case $1 in
    package) package_steps ;;
    tar) tar_steps ;;
    python) python_steps | sed "s/AS_USER/$2/" ;;
    schedules) echo "cd /home/vkvol && ${2:+$2 }tools/validate.sh schedules" ;;
    *) echo "cd /home/vkvol && ${2:+$2 }tools/$1.sh" ;;
    esac
}

tar_steps() {
    cat <<'END'
set -e
rm -rf /home/vkvol
apt-get update -qq
DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends mesa-vulkan-drivers libvulkan1
mkdir "/opt/some where" && tar -C "/opt/some where" -xf /vkvol.tar.gz
cd /tmp
"/opt/some where"/vkvol*/bin/vkvol demo --width 160 --spp 16
[ -s cumulus.png ] && [ -s cumulus.exr ]
"/opt/some where"/vkvol*/bin/vkvol-make-field sphere && "/opt/some where"/vkvol*/bin/vkvol sphere.nvdb --width 64 --spp 4 -q
END
}

# A proxy that signs for PyPI has this machine's trust.
python_steps() {
    cat <<'END'
set -e
export DEBIAN_FRONTEND=noninteractive PIP_CERT=/certificates.crt
cd /home/vkvol
AS_USER tools/setup.sh
apt-get install -y -qq --no-install-recommends python3-venv
AS_USER python3 -m venv /tmp/venv
AS_USER env PIP_CERT=/certificates.crt /tmp/venv/bin/pip install -q . numpy
cd /tmp
AS_USER /tmp/venv/bin/python - <<'PYTHON'
import numpy, vkvol

smoke = vkvol.Grids(density=numpy.random.rand(32, 32, 32), voxel_size=1 / 32)
scene = vkvol.Scene.from_dict({"densityField": smoke, "sigma_s": {"unit": "world", "text": 20},
                               "light": {"x": 1, "y": 2, "z": 1, "r": 1, "g": 1, "b": 1}})
picture = vkvol.render(scene, spp=4)
assert picture.mean.max() > 0
picture.write("smoke.exr")
PYTHON
[ -s smoke.exr ]
END
}

package_steps() {
    cat <<'END'
set -e
rm -rf /home/vkvol
find / -xdev -name '*vkvol*' >/before
apt-get update -qq
DEBIAN_FRONTEND=noninteractive apt-get install -y -qq /package.deb
cd /tmp
vkvol demo --width 160 --spp 16
[ -s cumulus.png ] && [ -s cumulus.exr ] && [ -s /usr/share/man/man1/vkvol-bench.1.gz ]
vkvol-make-field sphere && vkvol sphere.nvdb --width 64 --spp 4 -q
rm -rf /tmp/* ~/.cache
dpkg --purge vkvol
find / -xdev -name '*vkvol*' | diff /before - && echo "nothing is left"
END
}

# attempt RELEASE USER COMMAND: one row.
attempt() {
    local start=$SECONDS result=ok log=$vkvol_root/out/newcomer-$1-$2-$3.log load row what=tools/$3.sh
    [ "$3" != tar ] || what="package.sh tar"
    [ "$3" != python ] || what="pip install ."
    [ "$3" != schedules ] || what=schedules
    load=$(cut -d ' ' -f 1 /proc/loadavg)
    say "$1, $2: $what (output in $log)"
    local as=
    [ "$2" = root ] || as="runuser -u newcomer --"
    if [ "$3" = package ]; then
        grep -q "VERSION_CODENAME=$1" /etc/os-release || die "a package made here is for this machine's release, not for $1"
        cp "$(find "$vkvol_root/build/package" -maxdepth 1 -name '*.deb')" "$system/package.deb" ||
            die "there is no package; tools/package.sh makes one"
    elif [ "$3" = tar ]; then
        cp "$(find "$vkvol_root/build/package" -maxdepth 1 -name '*.tar.gz')" "$system/vkvol.tar.gz" ||
            die "there is no such package; tools/package.sh tar makes one"
    elif [ "$3" = python ]; then
        cp /etc/ssl/certs/ca-certificates.crt "$system/certificates.crt"
    fi
    inside "$(steps "$3" "$as")" >"$log" 2>&1 || result=FAILED
    row=$(printf '%-9s %-5s %-14s %-7s %5s  %s' "$1" "$2" "$what" $result $((SECONDS - start)) "$(circumstances "$log" | paste -sd ';' | sed 's/;/, /g')")
    echo "$row"
    [ $result = ok ] || {
        failed=1
        tail -n 30 "$log"
    }
    keep "$row"
}

# keep ROW: in place of the one of the same release, user and command.
keep() {
    local key=${1:0:29}
    touch "$results"
    {
        echo "The README's two commands on a new machine: a bare Debian, nothing but debootstrap's minbase installed."
        echo "Made by tools/newcomer.sh, which keeps the last row of each. A test.sh after a demo.sh finds the packages installed."
        echo
        printf '%-9s %-5s %-14s %-7s %5s  %s\n' release user command result secs on
        { grep -E '^(bookworm|trixie) ' "$results" | grep -vF -- "$key" || true; echo "$1"; } | sort
    } >"$results.partial"
    mv "$results.partial" "$results"
}

failed=0
commit=$(git -C "$vkvol_root" log -1 --format='commit %h')
for release in "${releases[@]}"; do
    bare "$release"
    for user in "${users[@]}"; do
        built=
        for command in "${commands[@]}"; do
            [ -n "$built" ] && [[ $command = demo || $command = test || $command = schedules ]] || new_system "$release" "$user"
            built=
            [[ $command != demo && $command != test && $command != schedules ]] || built=yes
            attempt "$release" "$user" "$command"
        done
    done
done
exit $failed
