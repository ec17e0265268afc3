# SPDX-License-Identifier: GPL-3.0-or-later
"""Child processes: their output in the log, their last words in the error, progress read from their lines."""

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from bedchain.dem.processes import (
    LAUNCHER,
    SILENCE_S,
    Progress,
    error_lines,
    longest_silence,
    on_ranks,
    run_deck,
    run_logged,
    solver_environment,
)
from bedchain.errors import UserError
from made import ROOT
from made.processes import wait_until


def test_output_goes_to_the_log_line_by_line_and_is_appended(tmp_path):
    log, lines = tmp_path / "log", []
    for word in ("one", "two"):
        run_logged(["sh", "-c", f"echo {word}; echo to stderr >&2"], log, lines.append)
    assert log.read_text().split("\n") == ["one", "to stderr", "two", "to stderr", ""]
    assert lines == ["one\n", "to stderr\n", "two\n", "to stderr\n"]


def test_a_failure_shows_the_program_s_own_error_and_where_its_log_is(tmp_path):
    command = "for i in $(seq 40); do echo step $i; done; echo ERROR: lost atoms; echo after; exit 3"
    with pytest.raises(UserError) as caught:
        run_logged(["sh", "-c", command], tmp_path / "log")
    message = str(caught.value)
    assert message.startswith("sh ended with code 3:\n  ERROR: lost atoms\n  after\n")
    assert message.endswith(f"its whole log: {tmp_path / 'log'}") and "step" not in message


def test_a_program_that_is_not_there_is_named(tmp_path):
    with pytest.raises(UserError, match="the program no-such-program is not installed: run ./run"):
        run_logged(["no-such-program"], tmp_path / "log")


def test_a_child_ends_when_its_reader_fails(tmp_path):
    numbers = []

    def reader(line):
        numbers.append(line.strip())
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_logged(["sh", "-c", "echo $$; exec sleep 600"], tmp_path / "log", reader)
    assert len(numbers) == 1 and not Path(f"/proc/{numbers[0]}").exists()


def test_a_program_that_says_nothing_is_ended_with_its_place_and_log(tmp_path):
    log, began = tmp_path / "log", time.monotonic()
    with pytest.raises(UserError) as caught:
        run_logged(["sh", "-c", "echo progress time 0.3 s; exec sleep 600"], log, silence_s=0.5)
    assert time.monotonic() - began < 10
    message = str(caught.value)
    assert "no line of output for 0.5 s" in message and "progress time 0.3 s" in message
    assert message.endswith(f"its whole log: {log}")


def test_a_program_that_goes_on_speaking_is_left_alone(tmp_path):
    run_logged(["sh", "-c", "for i in 1 2 3 4; do sleep 0.3; echo $i; done"], tmp_path / "log", silence_s=1)
    assert (tmp_path / "log").read_text().split() == ["1", "2", "3", "4"]


def test_time_spent_waiting_for_a_core_is_no_silence(tmp_path):
    """Four children on one core: each works for 0.6 s, which takes 2.4 s by the clock."""
    core = str(min(os.sched_getaffinity(0)))
    busy = "import time\nwhile time.process_time() < 0.6: pass"
    command = ["taskset", "-c", core, sys.executable, "-c", busy]
    rivals = [subprocess.Popen(command) for _ in range(3)]
    try:
        began = time.monotonic()
        run_logged(command, tmp_path / "log", silence_s=1.5)
        assert time.monotonic() - began > 1.6, "the child did not wait: nothing was tested"
    finally:
        for rival in rivals:
            rival.wait()


def test_the_silence_allowed_grows_with_the_work_between_two_lines():
    assert longest_silence(100) == SILENCE_S
    assert longest_silence(81_000 * 5000) == pytest.approx(2025)


def test_a_child_ends_with_the_process_that_runs_it(tmp_path):
    code = (
        "import sys; from pathlib import Path; from bedchain.dem.processes import run_logged;"
        "run_logged(['sh', '-c', 'echo $$; exec sleep 600'], Path(sys.argv[1]), print)"
    )
    command = [sys.executable, "-uc", code, str(tmp_path / "log")]
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "scripts")}
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as runner:
        child = Path("/proc", runner.stdout.readline().strip())
        assert child.exists()
        runner.kill()
    wait_until(lambda: not child.exists())


def test_without_an_error_line_the_last_lines_are_shown(tmp_path):
    (tmp_path / "log").write_text("\n\n".join(map(str, range(30))))
    assert error_lines(tmp_path / "log").split() == [str(line) for line in range(18, 30)]


def test_decks_get_their_variables_and_ranks(tmp_path, monkeypatch):
    commands = []
    monkeypatch.setattr(
        "bedchain.dem.processes.run_logged", lambda command, log, silence_s: commands.append(command)
    )
    run_deck(tmp_path / "in.x", {"steps": 5}, tmp_path / "log", ranks=2)
    liggghts = ["liggghts", "-in", str(tmp_path / "in.x"), "-log", "none", "-var", "steps", "5"]
    assert commands == [["mpirun", "-np", "2", "setpriv", "--pdeathsig", "KILL", *liggghts]]
    assert on_ranks(liggghts, 1) == liggghts


def test_what_the_user_has_set_stays(monkeypatch):
    monkeypatch.setenv("FOAM_SIGFPE", "true")
    monkeypatch.delenv("WM_PROJECT_DIR", raising=False)
    environment = solver_environment()
    assert environment["FOAM_SIGFPE"] == "true" and environment["WM_PROJECT_DIR"].startswith("/")


def test_a_job_s_slurm_is_hidden_from_the_solvers_unless_it_starts_their_ranks(monkeypatch):
    monkeypatch.setenv("SLURM_STEPID", "0")
    monkeypatch.delenv(LAUNCHER, raising=False)
    assert "SLURM_STEPID" not in solver_environment()
    monkeypatch.setenv(LAUNCHER, "srun --mpi=pmix")
    assert solver_environment()["SLURM_STEPID"] == "0"
    assert on_ranks(["liggghts"], 16) == ["srun", "--mpi=pmix", "-n", "16", "liggghts"]


def test_progress_says_what_is_left_now_and_then_and_keeps_the_totals(capsys):
    progress = Progress(end_s=5.0, every_s=1000.0)
    progress.last = -1e9  # long ago
    line = "progress time 1 s, 900 s per simulated second, 3 s left, gas 8 %\n"
    progress(line)
    progress(line)
    # 4 s at 900 s each
    assert capsys.readouterr().err == (
        "run_dem: 1.000 of 5 s simulated, 900 s per simulated second, 1:00:00 left (gas 8 %)\n"
    )
    progress("totals simulated 0.5 wall 10 dem 7 exchange 1 gas 2")
    assert progress.totals == {"simulated": 0.5, "wall": 10, "dem": 7, "exchange": 1, "gas": 2}
