#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Build bedFoam against Debian's OpenFOAM and LIGGGHTS:  sh openfoam_case/solver/build.sh results/bin/bedFoam
# The OpenFOAM headers are put into .openfoam/include by envs/setup.sh.
set -eu

output=${1:?usage: sh openfoam_case/solver/build.sh OUTPUT}
sources=$(dirname -- "$0")/bedFoam
headers=${OPENFOAM_HEADERS:-.openfoam/include}
arch=$(g++ -print-multiarch)

if [ ! -e "$headers/finiteVolume/fvCFD.H" ]; then
    echo "error: OpenFOAM's headers are not in $headers: run envs/setup.sh" >&2
    exit 1
fi

mkdir -p "$(dirname "$output")"
objects=$(mktemp -d)
trap 'rm -rf "$objects"' EXIT

set -- -std=c++14 -O3 -march=native -Wall -DWM_DP -DWM_LABEL_SIZE=32 -DOPENFOAM=1912 -DNoRepository -Dlinux64 \
    -DWM_ARCH_OPTION=64 -ftemplate-depth-100 -fPIC "-I$sources"
for library in OpenFOAM finiteVolume meshTools OSspecific; do
    set -- "$@" -isystem "$headers/$library"
done
set -- "$@" -isystem /usr/include/liggghts -isystem "/usr/lib/$arch/openmpi/include"

# Each file on its own, two at a time
# shellcheck disable=SC2016 # $ is for the inner shell
find "$sources" -name '*.C' -print0 |
    xargs -0 -P 2 -I{} sh -c 'file=$1 objects=$2 && shift 2 && exec g++ "$@" -c "$file" -o "$objects/$(basename "$file" .C).o"' \
        compile {} "$objects" "$@"
g++ -o "$output.part" "$objects"/*.o -L/usr/lib/openmpi-system -L"/usr/lib/$arch/openmpi/lib" \
    -lfiniteVolume -lmeshTools -lOpenFOAM -lPstream -lliggghts -lmpi -lmpi_cxx -ldl -lm
mv "$output.part" "$output"
