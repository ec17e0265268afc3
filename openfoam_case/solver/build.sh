#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Build bedFoam against Debian's OpenFOAM and LIGGGHTS:  sh openfoam_case/solver/build.sh results/bin/bedFoam
# The OpenFOAM headers are put into .openfoam/include by envs/setup.sh. Objects stay in results/bin/bedFoam.objects: they serve
# again where neither their sources, nor a header of bedFoam, nor how they are made has changed.
set -eu

# Sources that are compiled as one, a line each: OpenFOAM's templates take most of the time and are made anew for each line.
# ParticleForces and ParticleDrag stand alone: beside others the compiler rounds their sums otherwise, which gives another
# realisation of each bed. LIGGGHTS's headers do not go together with OpenFOAM's.
together='bedFoam UEqn pEqn fields Reconstruction
DemCoupling BedSeries Deposit Guards Inlet RunReport bedState slabs
ParticleForces
ParticleDrag
Liggghts
SlabGrid
BandPreconditioner
dragLaws'

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
versions=$(g++ --version && dpkg-query -W libopenfoam libliggghts-dev libopenblas0-serial || true)
state=$({ echo "$versions" "$together" "$@" && cat "$sources"/*.H; } | sha256sum)
[ "$(cat "$objects/state" 2>/dev/null)" = "$state" ] || {
    rm -rf "$objects"
    mkdir -p "$objects"
    echo "$state" >"$objects/state"
}

# Each line on its own, two at a time; the joined text beside an object says of what it was made
# shellcheck disable=SC2016 # for the inner shell
echo "$together" | xargs -P 2 -I{} sh -euc '
    names=$1 object=$2/${1%% *} sources=$3
    shift 3
    for name in $names; do
        echo "#line 1 \"$name.C\"" # for messages of the compiler
        cat "$sources/$name.C"
    done >"$object.new.C"
    ! cmp -s "$object.new.C" "$object.C" || exit 0
    rm -f "$object.C"
    g++ "$@" "-I$sources" -c "$object.new.C" -o "$object.o"
    mv "$object.new.C" "$object.C"' build {} "$objects" "$sources" "$@"
g++ -o "$output.part" "$objects"/*.o -L/usr/lib/openmpi-system -L"/usr/lib/$arch/openmpi/lib" \
    -L"/usr/lib/$arch/openblas-serial" -lfiniteVolume -lmeshTools -lOpenFOAM -lPstream -lliggghts -l:libopenblas.so.0 \
    -lmpi -lmpi_cxx -ldl -lm
mv "$output.part" "$output"
