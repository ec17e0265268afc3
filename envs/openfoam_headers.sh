#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# openfoam_headers.sh WORK TARGET: puts OpenFOAM's headers, flat, into TARGET/include/<library>, unless those of the installed
# version are there. Debian ships the libraries without them: they come from its source package. WORK holds what is needed
# meanwhile.
set -eu
cd -- "$(dirname -- "$(readlink -f -- "$0")")/.."
. envs/common.sh
LIBRARIES='OpenFOAM finiteVolume meshTools OSspecific/POSIX' # folders of src/ whose headers the solver includes
ROOM_MB=200                                                  # download, package lists and headers [MB]

# apt-get with the derived sources and lists of its own; as root it would drop to a user who may not write here.
private_apt() {
    apt-get -q -o Dir::Etc::sourcelist=/dev/null -o Dir::Etc::sourceparts="$work/sources" \
        -o Dir::State::lists="$work/lists" -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache= \
        -o APT::Sandbox::User=root -o Acquire::Languages=none "$@"
}

download() {
    version=$(dpkg-query -W -f '${source:Version}' libopenfoam)
    mkdir -p "$work/lists/partial" "$work/package"
    # shellcheck source=/dev/null # a file of the system
    sh envs/source_list.sh /etc/apt "$(. /etc/os-release && echo "$VERSION_CODENAME")" "$work/sources"
    private_apt update >"$work/update.log" 2>&1 || say "reading the source lists met errors (see $work/update.log)"
    cd "$work/package"
    logged "$work/download.log" "downloading the source package openfoam $version" \
        private_apt source --download-only --only-source "openfoam=$version"
    cd "$OLDPWD"
}

# Unpacks headers, and the templates they include, each library into one flat folder as wmakeLnInclude would link them.
unpack() {
    set --
    for library in $LIBRARIES; do set -- "$@" "*/src/$library/*.[CH]"; done
    mkdir "$work/include"
    logged "$work/unpack.log" "unpacking OpenFOAM's headers" \
        tar -xf "$work"/package/*.orig.tar.* -C "$work/include" --no-same-owner --wildcards \
        --transform 's,^[^/]*/src/,,;s,^\([^/]*\)/.*/,\1/,' "$@"
}

headers() {
    need_space "$work" "$ROOM_MB" "OpenFOAM's headers"
    rm -rf "${work:?}/lists" "$work/package" "$work/sources" "$work/include"
    clear_ours "$target"
    download
    check_source_package "$work/package"
    unpack
    mv "$work/include" "$target/include"
    rm -rf "$work/lists" "$work/package" "$work/sources"
}

mkdir -p "$1"
work=$(cd "$1" && pwd) target=$2
step "$target" "$(digest envs/openfoam_headers.sh) $(dpkg-query -W -f '${Version}' libopenfoam)" \
    "fetching OpenFOAM's headers into $target (45 MB to download)" headers
