# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=sh
# Shell functions shared by the set-up scripts; sourced, never run.

SCRATCH_MB=50 # temporary files of compiler and solvers [MB]

say() { printf 'setup: %s\n' "$*" >&2; }

fail() {
    printf 'setup: error: %s\n' "$*" >&2
    exit 1
}

# check_place: ends with an error where the project's folder or the temporary one cannot serve; takes no time.
check_place() {
    place=$(pwd -P && echo /) # the slash keeps a line end of the name
    case ${place%??} in
    *[:\"\$\`\\{}]* | *[[:cntrl:]]*)
        fail "the name of this folder holds a character that the programs under bedchain cannot take" \
            "(one of : \" \$ \` \\ { } or a control character): $(pwd -P); rename it, or clone into another" ;;
    esac
    [ -w . ] || fail "no permission to write in $(pwd -P), where packages and results go; clone bedchain into a folder of yours"
    temporary=${TMPDIR:-/tmp}
    [ -d "$temporary" ] && [ -w "$temporary" ] ||
        fail "the temporary folder $temporary (TMPDIR) is missing or not yours to write in; make it, or unset TMPDIR"
    need_space "$temporary" "$SCRATCH_MB" 'temporary files (TMPDIR)'
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

# clear_ours FOLDER: empties FOLDER, or makes it, if it holds the mark of `step`: bedchain made it. Of a link only
# the link goes. Anything else stays, with an error.
clear_ours() {
    if [ -L "$1" ]; then
        rm "$1"
    elif [ -f "$1/.stamp" ] || [ -f "$1/.unfinished" ]; then
        rm -rf "$1"
    elif [ -e "$1" ]; then
        rmdir "$1" 2>/dev/null || fail "the set-up needs the place of $1, which was not made by bedchain" \
            "(no .stamp in it): it stays as it is; move it away and run again"
    fi
    mkdir -p "$1"
    : >"$1/.unfinished"
}

# digest FILE...: one short hash of the files' contents.
digest() { cat "$@" | sha256sum | cut -c 1-16; }

# step FOLDER KEY WHAT COMMAND...: makes FOLDER by COMMAND unless its stamp holds KEY already. Until COMMAND is done the
# mark is .unfinished.
step() {
    folder=$1 key=$2 what=$3
    shift 3
    [ "$key" != "$(cat "$folder/.stamp" 2>/dev/null)" ] || return 0
    say "$what"
    started=$(date +%s)
    [ ! -f "$folder/.stamp" ] || mv "$folder/.stamp" "$folder/.unfinished"
    "$@"
    echo "$key" >"$folder/.stamp"
    rm -f "$folder/.unfinished"
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
