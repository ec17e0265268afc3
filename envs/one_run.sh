# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=sh
# One ./run or ./test at a time in this folder; sourced, after set-up. The lock goes with its process, however that
# ends: nothing needs to be unlocked. Snakemake's own lock would outlive a kill, so both go without it.

exec 9>.setup/run.lock
if ! flock -n 9; then
    echo "${0##*/}: another ./run or ./test is at work in this folder; wait for it or end it" >&2
    exit 1
fi
