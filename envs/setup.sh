#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# setup.sh [checks]: installs what is missing, and only that: Debian packages (system), .venv (Python packages), .openfoam
# (headers); with `checks` also what ./test needs, into the same .venv.
# A folder is finished when its stamp names the state of its inputs; the stamp is written last. The headers are fetched
# beside the Python packages; what they say comes at the end.
set -eu
cd -- "$(dirname -- "$(readlink -f -- "$0")")/.."
. envs/common.sh
. envs/clean.sh
PYTHON=/usr/bin/python3
VENV_MB=2100 # Python packages, downloaded and unpacked [MB]
TEMP_MB=500  # of that in the temporary folder
CHECKS_MB=500 # the checks' packages [MB]

# lock_entry NAME: the lock's lines on that package (version and hashes).
lock_entry() { awk -v name="$1==" 'index($0, name) == 1, !/\\$/' envs/requirements.txt; }

# The lock is complete: what it does not name is not looked for; a user's own target is not ours. Python compiles what it
# imports; pip would compile everything, 34 s of processor time.
pip_install() {
    logged .setup/pip.log 'pip install' env -u PIP_TARGET -u PIP_PREFIX -u PIP_ROOT PIP_USER=0 \
        .venv/bin/python -m pip install --quiet --no-input \
        --disable-pip-version-check --no-compile --no-deps --require-hashes "$@"
}

python_packages() {
    "$PYTHON" -c 'import sys; sys.exit(sys.version_info < (3, 11))' ||
        fail "$PYTHON is $("$PYTHON" -V): Python 3.11 or newer is needed (Debian 12 has it)"
    need_space . "$VENV_MB" 'Python packages'
    need_space "${TMPDIR:-/tmp}" "$TEMP_MB" "pip's downloads"
    clear_ours .venv
    "$PYTHON" -m venv .venv
    lock_entry setuptools >.setup/build_tools.txt # for the one package that comes as source only
    pip_install -r .setup/build_tools.txt
    # shellcheck disable=SC2086 # no word, or two
    pip_install --no-build-isolation --use-pep517 -r envs/requirements.txt $checks
}

check_packages() { # of a new .venv they are there
    need_space . "$CHECKS_MB" "the checks' Python packages"
    pip_install -r envs/requirements-checks.txt
    mkdir -p .venv/checks
}

[ $# -le 1 ] || fail "setup.sh takes one word at most, not '$*'"
case ${1-} in
'' | checks) ;;
*) fail "setup.sh knows the word 'checks' only, not '$1'" ;;
esac
check_place
mkdir -p .setup
exec 9>.setup/lock
flock -n 9 || { say 'waiting for another set-up to finish' && flock 9; }

# shellcheck disable=SC2046 # one word a package
sh envs/debian_packages.sh .setup/apt.log $(sed 's/#.*//' envs/apt.txt)

setsid sh envs/openfoam_headers.sh .setup/openfoam .openfoam >.setup/headers.log 2>&1 & # its own group: it ends as one
headers=$!
trap 'kill -s TERM -- "-$headers" 2>/dev/null || true' EXIT
trap 'exit 129' HUP
trap 'exit 130' INT
trap 'exit 143' TERM

checks=${1:+-r envs/requirements-checks.txt}
step .venv "$(digest envs/requirements.txt) $("$PYTHON" -V) $(pwd -P)" \
    'installing Python packages into .venv (about 1 GB, a minute or two)' python_packages
[ -z "$checks" ] || step .venv/checks "$(digest envs/requirements-checks.txt)" \
    "installing the checks' Python packages into .venv" check_packages

wait "$headers" && outcome=0 || outcome=$?
trap - EXIT
cat .setup/headers.log >&2
[ "$outcome" -eq 0 ]
