# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=sh
# The settings that bedchain's programs need. Source it in the project's root: . envs/activate.sh

bedchain_root=$(pwd -P)
if [ ! -f "$bedchain_root/envs/activate.sh" ]; then
    echo 'activate.sh: source it in the root folder of bedchain' >&2
    return 1
fi
. envs/clean.sh
export PATH="$bedchain_root/.venv/bin:/usr/bin:/bin:$PATH"
export LC_ALL=C.UTF-8

# OpenFOAM of Debian finds its etc folder by this.
export WM_PROJECT_DIR=/usr/share/openfoam

# Open MPI inside one machine: shared memory only, no remote shell, no SLURM allocation, ranks free to move between cores
# (two jobs side by side would otherwise be bound to the same one). Not where another launcher starts ranks on several nodes.
if [ -z "${BEDCHAIN_LAUNCHER-}" ]; then
    export OMPI_MCA_pml=ob1 OMPI_MCA_btl=vader,self OMPI_MCA_btl_vader_single_copy_mechanism=none
    export OMPI_MCA_plm=isolated OMPI_MCA_ras=^slurm OMPI_MCA_oob_tcp_if_include=lo
    export OMPI_MCA_hwloc_base_binding_policy=none OMPI_MCA_rmaps_base_oversubscribe=1
fi
if [ "$(id -u)" -eq 0 ]; then
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
fi

# One thread for a process's linear algebra, as snakemake gives its jobs: on a busy machine two that wait for each other
# took 17 times the processor time of one.
export OPENBLAS_NUM_THREADS="${OPENBLAS_NUM_THREADS:-1}"

# Pictures without a screen; caches inside the project.
export MPLBACKEND=Agg PYVISTA_OFF_SCREEN=true VTK_DEFAULT_OPENGL_WINDOW=vtkEGLRenderWindow
export XDG_CACHE_HOME="$bedchain_root/.setup/cache" NUMBA_CACHE_DIR="$bedchain_root/.setup/cache/numba"
export MPLCONFIGDIR="$bedchain_root/.setup/cache/matplotlib"
