# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=sh
# Shell functions shared by the set-up scripts; sourced, never run.

say() { printf 'setup: %s\n' "$*" >&2; }

fail() {
    printf 'setup: error: %s\n' "$*" >&2
    exit 1
}

# need_space FOLDER MEGABYTES WHAT: ends with an error unless FOLDER's file system has that much room.
need_space() {
    free_mb=$(df -Pm "$1" | awk 'NR == 2 { print $4 }')
    [ "$free_mb" -ge "$2" ] ||
        fail "no disk space for $3: $2 MB needed, $free_mb MB free in $(cd "$1" && pwd); free some and run again"
}

# logged LOG WHAT COMMAND...: runs COMMAND with its output in LOG; shows LOG's end and stops if it fails.
logged() {
    log_file=$1 what=$2
    shift 2
    "$@" >"$log_file" 2>&1 && return
    tail -n 20 "$log_file" >&2
    fail "$what failed (above: the last lines of $log_file)"
}

# digest FILE...: one short hash of the files' contents.
digest() { cat "$@" | sha256sum | cut -c 1-16; }

# step FOLDER KEY WHAT COMMAND...: makes FOLDER by COMMAND unless its stamp holds KEY already.
step() {
    folder=$1 key=$2 what=$3
    shift 3
    [ "$key" != "$(cat "$folder/.stamp" 2>/dev/null)" ] || return 0
    say "$what"
    started=$(date +%s)
    rm -f "$folder/.stamp"
    "$@"
    echo "$key" >"$folder/.stamp"
    say "$folder is ready ($(($(date +%s) - started)) s)"
}

# check_source_package FOLDER: the Debian source package there against the hashes in its own description (.dsc).
check_source_package() {
    cd "$1" || fail "no folder $1"
    sed -n '/^Checksums-Sha256:/,/^[^ ]/ s/^ \([0-9a-f]*\) [0-9]* \(.*\)$/\1  \2/p' ./*.dsc >sha256
    [ -s sha256 ] || fail "$1: the .dsc file names no checksums; run again"
    sha256sum --quiet -c sha256 >&2 ||
        fail "$1: the source package does not match its own checksums (broken download); run again"
    cd "$OLDPWD" || fail "no folder $OLDPWD"
}
