# SPDX-License-Identifier: GPL-3.0-or-later
# What a user's line asks for, checked once all rules are there, and the last words of its run.
import atexit
from contextlib import redirect_stderr
from io import StringIO

from snakemake.cli import parse_args

from bedchain.command_line.failures import failure_report
from bedchain.lifetime import end_all_at_sigterm
from bedchain.workflow import slurm_or_exit, targets_or_exit, time_limits_or_exit

# A word that nothing reads ends here, before anything is planned. Snakemake itself gets the targets later.
if TYPED and WORDS.get("studies", True):
    with redirect_stderr(StringIO()):  # it names the profile again
        TYPED_LINE = parse_args(sys.argv[1:])[1]
    targets_or_exit(
        TYPED_LINE.targets,
        WORDS,
        [rule.name for rule in workflow.rules],
        {NAME, FOLDER, *(["paper"] if WITH_PAPER else [])},
        CASE,
    )
    if TYPED_LINE.executor == "slurm" and not TYPED_LINE.dryrun:
        slurm_or_exit()
    if TYPED_LINE.executor not in (None, "local") and KIND == "bed" and not (REFERENCE or FRAMES):
        first_try = dict(wildcards={"repeat": "1"}, input=[], attempt=1)
        limits_min = {
            name: workflow.get_rule(name).expand_resources(**first_try)["runtime"]
            for name in ("run_dem", "repeat_dem")
        }
        time_limits_or_exit(CASE, limits_min)


# kill or the end of a terminal ends all jobs within seconds, as Ctrl-C does. Jobs of this machine have no limit of so many
# a second: with one, snakemake goes through all that wait once a second for each job so far, a tenth of a core in the end.
if TYPED:

    onstart:
        end_all_at_sigterm()
        if not workflow.resource_settings.nodes:
            workflow.scheduler.job_rate_limiter = None


# The last line of a run that made the report says where it is.
if TYPED and WORDS.get("studies", True):

    onsuccess:
        if Path(REPORT).exists():
            print(f"Look at {REPORT}: figures, films and tables on one page; it opens in any browser.")


# The cause of a failure stands in the last lines, below snakemake's own.
if workflow.is_main_process:

    onerror:
        atexit.register(print, failure_report(map(Path, log)), file=sys.stderr)
