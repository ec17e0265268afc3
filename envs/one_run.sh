# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=sh
# One ./run at a time of a case, and of the studies without one; none beside ./test, which is alone in its folder. Sourced,
# after set-up. A lock goes with its process, however that ends: nothing needs to be unlocked. Snakemake's own lock would
# outlive a kill, so both go without it.

# busy WHAT: ends with an error, since another one is at work.
busy() {
    echo "${0##*/}: another $1 is at work in this folder; wait for it or end it" >&2
    exit 1
}

# alone: for ./test.
alone() {
    exec 9>.setup/run.lock
    flock -n 9 || busy './run or ./test'
}

# one_run CASES STUDY: for ./run of up to two cases, and of a study of the folder (yes or no).
one_run() {
    exec 9>.setup/run.lock
    flock -ns 9 || busy './test'
    exec 8>".setup/run_${1%% *}.lock"
    flock -n 8 || busy "./run of the case ${1%% *}"
    if [ "${1%% *}" != "${1##* }" ]; then
        exec 7>".setup/run_${1##* }.lock"
        flock -n 7 || busy "./run of the case ${1##* }"
    fi
    if [ "$2" = yes ]; then
        exec 6>.setup/studies.lock
        flock -n 6 || busy './run of a study'
    fi
}
