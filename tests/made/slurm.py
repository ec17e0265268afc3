# SPDX-License-Identifier: GPL-3.0-or-later
"""A SLURM whose one node is this machine, with its own ports, key, socket and folder, while a test runs."""

import os
import pwd
import shutil
import signal
import socket
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from bedchain.lifetime import RUN, child_ends_with_parent
from bedchain.meter import physical_memory_bytes
from made.processes import wait_until

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "srun", "sinfo")
PACKAGES = "munge slurmctld slurmd slurm-client"  # of Debian, envs/apt_slurm.txt
PATH = os.pathsep.join([os.environ.get("PATH", ""), "/usr/sbin", "/sbin"])
START_S = 120.0  # until a daemon answers, on a machine that is busy
GRACE_S = 10.0  # between SIGTERM and SIGKILL to a daemon
# no accounting, no cgroups: what a job started is known by its processes
CONFIGURATION = """\
ClusterName=bedchain_test
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0,bf_interval=5
ReturnToService=2
MinJobAge=100000
MailProg=/bin/true
NodeName={host} NodeAddr=127.0.0.1 CPUs={cores} RealMemory={memory_mb} State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def missing_programs() -> list[str]:
    """Programs of SLURM that are not installed."""
    return [program for program in PROGRAMS if shutil.which(program, path=PATH) is None]


@dataclass
class Slurm:
    """A SLURM that runs.

    Attributes
    ----------
    folder : Path
        State, logs, key and socket.
    variables : dict of str to str
        Environment of a process that submits jobs to it.
    daemons : list of Popen
        In the order of their start.
    """

    folder: Path
    variables: dict[str, str]
    daemons: list[subprocess.Popen[bytes]] = field(default_factory=list)

    def ask(self, *command: str) -> str:
        """Output of a command of SLURM, empty where it fails."""
        done = subprocess.run(command, env=self.variables, capture_output=True, text=True, check=False)
        return "" if done.returncode else done.stdout.strip()

    def jobs(self, *states: str) -> dict[int, tuple[str, str]]:
        """Comment, which names the rule, and state of the jobs by their ids; of all states without a word."""
        asked = self.ask("squeue", "--noheader", f"--states={','.join(states) or 'all'}", "--format=%i|%k|%T")
        lines = (line.split("|") for line in asked.splitlines())
        return dict(sorted((int(number), (comment, state)) for number, comment, state in lines))

    def logs(self) -> str:
        """The last lines of the daemons."""
        files = sorted(self.folder.glob("*.log"))
        return "\n".join(f"{file.name}:\n{file.read_text(errors='replace')[-2000:]}" for file in files)


@contextmanager
def slurm(folder: Path) -> Iterator[Slurm]:
    """A SLURM of this machine; with the end of the body its jobs and daemons end.

    Parameters
    ----------
    folder : Path
        Made here. Its path must be short: a socket's name has at most 107 letters.

    Raises
    ------
    AssertionError
        The node does not come up; with the daemons' last lines.
    """
    cluster = Slurm(folder, _written(folder))
    conf, munge = cluster.variables["SLURM_CONF"], ["munged", "--foreground", "--force"]
    files = {"key": "key", "socket": "socket", "pid": "pid", "log": "log", "seed": "seed"}
    munge += [
        f"--{name}{'' if name == 'socket' else '-file'}={folder}/munge.{end}" for name, end in files.items()
    ]
    try:
        _start(cluster, munge)
        wait_until((folder / "munge.socket").exists, START_S)
        _start(cluster, ["slurmctld", "-D", "-c", "-f", conf])
        _start(cluster, ["slurmd", "-D", "-c", "-f", conf])
        try:
            wait_until(lambda: cluster.ask("sinfo", "--noheader", "--format=%T") == "idle", START_S)
        except AssertionError as error:
            raise AssertionError(f"the node does not come up:\n{cluster.logs()}") from error
        yield cluster
    finally:
        _stop(cluster)


def _written(folder: Path) -> dict[str, str]:
    """Configuration, key and folders; returns the environment in which they count."""
    for part in ("state", "spool", "bin"):
        (folder / part).mkdir(parents=True)
    text = CONFIGURATION.format(
        host=socket.gethostname().split(".")[0],
        user=pwd.getpwuid(os.geteuid()).pw_name,
        folder=folder,
        ports=_free_ports(2),
        cores=len(os.sched_getaffinity(0)),
        memory_mb=physical_memory_bytes() // 2**20,
    )
    (folder / "slurm.conf").write_text(text)
    (folder / "munge.key").write_bytes(os.urandom(1024))
    (folder / "munge.key").chmod(0o600)
    # the executor takes SLURM_CONF out of the environment of its srun
    srun = folder / "bin" / "srun"
    srun.write_text(
        f'#!/bin/sh\nSLURM_CONF={folder}/slurm.conf exec {shutil.which("srun", path=PATH)} "$@"\n'
    )
    srun.chmod(0o755)
    variables = {name: value for name, value in os.environ.items() if name != RUN and "SLURM" not in name}
    return variables | {"SLURM_CONF": str(folder / "slurm.conf"), "PATH": f"{folder}/bin:{PATH}"}


def _start(cluster: Slurm, command: list[str]) -> None:
    with (cluster.folder / f"{command[0]}.out.log").open("wb") as log:
        daemon = subprocess.Popen(
            command, env=cluster.variables, stdout=log, stderr=log, stdin=subprocess.DEVNULL,
            preexec_fn=child_ends_with_parent(),  # also where this process is killed
        )  # fmt: skip
    cluster.daemons.append(daemon)


def _stop(cluster: Slurm) -> None:
    """End all jobs, then the daemons, the last one first."""
    if jobs := cluster.jobs("pending", "running", "completing"):
        cluster.ask("scancel", *map(str, jobs))
        wait_until(lambda: not cluster.jobs("pending", "running", "completing"), START_S)
    for daemon in reversed(cluster.daemons):
        daemon.send_signal(signal.SIGTERM)
        try:
            daemon.wait(GRACE_S)
        except subprocess.TimeoutExpired:
            daemon.kill()
            daemon.wait()


def _free_ports(number: int) -> list[int]:
    """Ports of this machine that nobody listens on."""
    sockets = [socket.socket() for _ in range(number)]
    for each in sockets:
        each.bind(("127.0.0.1", 0))
    ports = [int(each.getsockname()[1]) for each in sockets]
    for each in sockets:
        each.close()
    return ports
