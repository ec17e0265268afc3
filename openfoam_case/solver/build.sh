#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Build bedFoam against Debian's OpenFOAM and LIGGGHTS:  sh openfoam_case/solver/build.sh results/bin/bedFoam
# The OpenFOAM headers are put into .openfoam/include by envs/setup.sh. Objects stay in results/bin/bedFoam.objects: they serve
# again where neither their source, nor a header of bedFoam, nor how they are made has changed.
set -eu

output=${1:?usage: sh openfoam_case/solver/build.sh OUTPUT}
sources=$(dirname -- "$0")/bedFoam
headers=${OPENFOAM_HEADERS:-.openfoam/include}
arch=$(g++ -print-multiarch)

if [ ! -e "$headers/finiteVolume/fvCFD.H" ]; then
    echo "error: OpenFOAM's headers are not in $headers: run envs/setup.sh" >&2
    exit 1
fi

set -- -std=c++14 -O3 -march=native -Wall -DWM_DP -DWM_LABEL_SIZE=32 -DOPENFOAM=1912 -DNoRepository -Dlinux64 \
    -DWM_ARCH_OPTION=64 -ftemplate-depth-100 -fPIC
for library in OpenFOAM finiteVolume meshTools OSspecific; do
    set -- "$@" -isystem "$headers/$library"
done
set -- "$@" -isystem /usr/include/liggghts -isystem "/usr/lib/$arch/openmpi/include"

objects=$output.objects
versions=$(g++ --version && dpkg-query -W libopenfoam libliggghts-dev || true)
state=$({ echo "$versions" "$@" && cat "$sources"/*.H; } | sha256sum)
[ "$(cat "$objects/state" 2>/dev/null)" = "$state" ] || {
    rm -rf "$objects"
    mkdir -p "$objects"
    echo "$state" >"$objects/state"
}
for object in "$objects"/*.o; do # of a source that is no more
    [ -e "$sources/$(basename "$object" .o).C" ] || rm -f "$object"
done

# Each file on its own, two at a time; the copy of a source says of what its object was made
# shellcheck disable=SC2016 # for the inner shell
find "$sources" -name '*.C' -print0 | xargs -0 -P 2 -I{} sh -euc '
    source=$1 object=$2/$(basename "$1" .C).o copy=$2/$(basename "$1")
    shift 2
    ! cmp -s "$source" "$copy" || exit 0
    rm -f "$copy"
    g++ "$@" -c "$source" -o "$object"
    cp "$source" "$copy"' build {} "$objects" "$@" "-I$sources"
g++ -o "$output.part" "$objects"/*.o -L/usr/lib/openmpi-system -L"/usr/lib/$arch/openmpi/lib" \
    -lfiniteVolume -lmeshTools -lOpenFOAM -lPstream -lliggghts -lmpi -lmpi_cxx -ldl -lm
mv "$output.part" "$output"
