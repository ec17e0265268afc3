# SPDX-License-Identifier: GPL-3.0-or-later
"""The build of bedFoam, over a stand-in of the compiler: what has changed is compiled, and nothing else."""

import os
import shutil
import subprocess

import pytest

from made import ROOT

COMPILER = r"""#!/bin/sh
case $* in
-print-multiarch) echo x86_64-linux-gnu && exit ;;
--version) echo compiler 1 && exit ;;
*" -c "*) file=${*##* -c } && sed -n 's/^#line 1 "\(.*\)"$/\1/p' "${file%% *}" >"${file%% *}.names" ;;
*) echo "$*" >linked ;;
esac
if [ -n "$file" ]; then
    cat "${file%% *}.names" >>compiled
    ! grep -q "^$BROKEN\$" "${file%% *}.names" || exit 1
fi
while [ "$1" != -o ]; do shift; done
: >"$2"
"""


@pytest.fixture
def build(tmp_path):
    """Function that builds the sources of a folder, and gives the names of those that were compiled."""
    (tmp_path / "bin").mkdir()
    for name, text in (("g++", COMPILER), ("dpkg-query", "#!/bin/sh\n")):
        (tmp_path / "bin" / name).write_text(text)
        (tmp_path / "bin" / name).chmod(0o755)
    shutil.copytree(ROOT / "openfoam_case/solver", tmp_path / "solver")
    (tmp_path / "headers/finiteVolume").mkdir(parents=True)
    (tmp_path / "headers/finiteVolume/fvCFD.H").touch()
    search = {"PATH": f"{tmp_path / 'bin'}:{os.environ['PATH']}", "OPENFOAM_HEADERS": "headers"}

    def run(broken="none"):
        (tmp_path / "compiled").write_text("")
        command = ["sh", "solver/build.sh", "out/bedFoam"]
        subprocess.run(command, cwd=tmp_path, env=os.environ | search | {"BROKEN": broken}, check=True)
        return sorted((tmp_path / "compiled").read_text().split())

    return run


def test_only_what_has_changed_is_compiled_again(build, tmp_path):
    sources = tmp_path / "solver/bedFoam"
    every = sorted(file.name for file in sources.glob("*.C"))
    assert build() == every and (tmp_path / "out/bedFoam").exists()
    assert build() == []
    with (sources / "pEqn.C").open("a") as stream:
        stream.write("// edited\n")
    assert build() == ["Reconstruction.C", "UEqn.C", "bedFoam.C", "fields.C", "pEqn.C"]
    with (sources / "dragLaws.C").open("a") as stream:
        stream.write("// edited\n")
    assert build() == ["dragLaws.C"]
    with (sources / "fields.H").open("a") as stream:
        stream.write("// edited\n")
    assert build() == every


def test_a_line_that_is_gone_is_not_linked(build, tmp_path):
    build()
    assert "dragLaws.o" in (tmp_path / "linked").read_text()
    script = tmp_path / "solver/build.sh"
    script.write_text(script.read_text().replace("\ndragLaws'", "'"))
    assert "dragLaws.C" not in build() and "dragLaws.o" not in (tmp_path / "linked").read_text()


def test_a_source_that_is_gone_stops_the_build(build, tmp_path):
    (tmp_path / "solver/bedFoam/slabs.C").unlink()
    with pytest.raises(subprocess.CalledProcessError):
        build()
    assert not (tmp_path / "out/bedFoam").exists()


def test_a_source_that_does_not_compile_is_compiled_again(build, tmp_path):
    with pytest.raises(subprocess.CalledProcessError):
        build(broken="pEqn.C")
    assert not (tmp_path / "out/bedFoam").exists()
    assert "pEqn.C" in build()
