#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# debian_packages.sh LOG PACKAGE...: installs those of the Debian packages that are missing (as root, or by sudo).
set -eu
umask 022 # what root installs is for all users
here=$(dirname -- "$0")
# shellcheck source=envs/common.sh
. "$here/common.sh"

missing_packages() {
    installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "$@" 2>/dev/null | sed -n 's/^installed //p')
    printf '%s\n' "$@" | grep -vxF "$installed" || true
}

# Prints the command that gives root's rights: nothing for root, sudo if it asks for no password.
root_command() { # packages...
    [ "$(id -u)" -ne 0 ] || return 0
    sudo -n true 2>/dev/null || fail "Debian packages are missing, and installing them takes root. Run, then try again:
  sudo apt-get update && sudo apt-get install -y --no-install-recommends $*"
    echo 'sudo -n'
}

# room_needed PACKAGE...: what apt says it will download and unpack [MB], by its own words, such as
# "Need to get 12.3 MB/240 MB of archives." and "After this operation, 1,234 MB of additional disk space will be used."
room_needed() {
    LC_ALL=C apt-get install --assume-no --no-install-recommends "$@" 2>/dev/null | awk '
        /^Need to get / { sub(/\/.*/, " "); room += in_mb($4, substr($0, index($0, $4))) }
        /^After this operation, .* will be used/ { room += in_mb($4, $0) }
        function in_mb(number, text) {
            gsub(/,/, "", number)
            return number * (text ~ / GB/ ? 1000 : text ~ / MB/ ? 1 : text ~ / kB/ ? 0.001 : 1e-6)
        }
        END { printf "%d\n", room + 50 }'
}

install_packages() { # log packages...
    log=$1
    shift
    as_root=$(root_command "$@")
    say "installing $# Debian packages: $*"
    started=$(date +%s)
    # A foreign source that is out of reach must not stop us: what is really missing shows at the next step.
    $as_root apt-get update -q >"$log" 2>&1 || say "apt-get update met errors (see $log); going on"
    need_space /usr "$(room_needed "$@")" 'Debian packages'
    # shellcheck disable=SC2086 # two words, or none
    logged "$log" "installing $*" $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y \
        --no-install-recommends -o DPkg::Lock::Timeout=300 -o Dpkg::Use-Pty=0 "$@"
    say "the Debian packages are installed ($(($(date +%s) - started)) s)"
}

log_file=$1
shift
for tool in dpkg-query apt-get; do
    command -v "$tool" >/dev/null 2>&1 ||
        fail "no $tool here: the set-up knows Debian 12 only; install by hand what these packages of it hold: $*"
done
missing=$(missing_packages "$@")
# shellcheck disable=SC2086 # package names hold no blanks
[ -z "$missing" ] || install_packages "$log_file" $missing
