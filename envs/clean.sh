# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=sh
# Takes settings of another Python, OpenFOAM or Open MPI, and libraries that would take the place of Debian's, out of
# the environment; sourced, never run.

bedchain_foreign='PYTHON[A-Z]*|LD_[A-Z_]*|(FOAM|WM|OMPI|PMIX)_[A-Za-z0-9_]*|MPI_BUFFER_SIZE|BASH_ENV|CONDA_PREFIX|VIRTUAL_ENV'
for bedchain_name in $(env | sed -nE "s/^($bedchain_foreign)=.*/\1/p"); do
    unset "$bedchain_name"
done
unset bedchain_foreign bedchain_name
