#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# source_list.sh ETC_APT CODENAME FOLDER: derives from the apt sources in ETC_APT (/etc/apt) private ones for source
# packages, in FOLDER. Each entry of component main and a suite of the release becomes deb-src; both file styles.
set -eu
etc_apt=$1 codename=$2 folder=$3
suites="($codename|stable|oldstable)([-/](updates|security))?"

# deb822 style: stanzas apart by empty lines; comments go first, so that none is read as a field.
derive_deb822() {
    sed '/^#/d' "$1" | awk -v suites="$suites" '
        BEGIN { RS = ""; FS = "\n" }
        {
            stanza = ""; binary = 0; main = 0; release = 0; enabled = 1
            for (i = 1; i <= NF; i++) {
                name = tolower($i); sub(/:.*/, "", name)
                value = $i; sub(/^[^:]*:/, "", value); value = " " value " "; gsub(/\t/, " ", value)
                if (name == "types") { binary = value ~ / deb /; $i = "Types: deb-src" }
                if (name == "components") { main = value ~ / main /; $i = "Components: main" }
                if (name == "suites") release = value ~ (" " suites " ")
                if (name == "enabled") enabled = tolower(value) !~ / (no|false|0) /
                if (name != "architectures") stanza = stanza $i "\n"
            }
            if (binary && main && release && enabled) print stanza
        }'
}

# One-line style: deb [options] address suite component...
derive_one_line() {
    sed -nE "s/#.*//
        /^[ \t]*deb[ \t]+(\[[^]]*\][ \t]*)?[^ \t]+[ \t]+${suites}[ \t](.*[ \t])?main([ \t]|\$)/ {
            s/^[ \t]*deb/deb-src/
            s/([ \t]${suites})[ \t].*/\1 main/
            p
        }" "$1"
}

mkdir -p "$folder"
for file in "$etc_apt"/sources.list.d/*.sources; do
    [ ! -f "$file" ] || derive_deb822 "$file"
done >"$folder/derived.sources"
for file in "$etc_apt"/sources.list "$etc_apt"/sources.list.d/*.list; do
    [ ! -f "$file" ] || derive_one_line "$file"
done >"$folder/derived.list"
[ -s "$folder/derived.sources" ] || [ -s "$folder/derived.list" ] || {
    echo "setup: error: $etc_apt names no source of $codename with component main" >&2
    exit 1
}
