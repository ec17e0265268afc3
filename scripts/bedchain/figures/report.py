# SPDX-License-Identifier: GPL-3.0-or-later
"""The report of a run: one page of html that needs no other file and no network."""

import base64
import json
import re
from pathlib import Path
from typing import Any

import pandas as pd
from jinja2 import Environment, FileSystemLoader, select_autoescape

from bedchain.case.particle_free import particle_free

TEMPLATE = "report.html"
KINDS = {".png": "image/png", ".mp4": "video/mp4"}
# rows of metrics.csv for the first page, where a bed has no claims to be compared with
OUTCOME = re.compile(
    r"error_rms_(left|right|low|up)|noise_floor_(left|right|low|up)|pressure_drop_over_weight"
)
WORDS = {
    "error_rms": "rms error of the share on its side",
    "noise_floor": "noise floor: spread of the DEM runs",
    "pressure_drop_over_weight": "pressure drop over weight of the bed",
}


def report_page(beds: list[dict[str, Any]]) -> str:
    """Html of the report.

    Parameters
    ----------
    beds : list of dict
        Of `bed_section`.
    """
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent), autoescape=select_autoescape(), trim_blocks=True
    )
    return environment.get_template(TEMPLATE).render(beds=beds)


def bed_section(folder: Path, captions: dict[str, Path], figures: list[Path]) -> dict[str, Any]:
    """What the report says of a bed.

    Parameters
    ----------
    folder : Path
        ``results/<case>``.
    captions : dict of str to Path
        Caption by a regular expression of the figure's name.
    figures : list of Path
        Figures (png) and film (mp4), in the order of the report.

    Returns
    -------
    dict
        name, title, machine, commit, what it is where it has no particles, outcome and table (html), figures
        (name, caption, kind, data).
    """
    record = json.loads((folder / "provenance.json").read_text(encoding="utf-8"))
    claims = folder / "agreement.csv"
    if written := particle_free(record["case"]["values"]):
        outcome, table = network_table(folder / "metrics.csv"), ""
    else:
        outcome = claims_table(claims) if claims.exists() else outcome_of(folder)
        table = (folder / "table1.html").read_text(encoding="utf-8")
    return {
        "name": folder.name,
        "title": record["case"]["values"]["title"],
        "machine": f"{record['machine']['processor']}, {record['machine']['cores']} cores",
        "commit": (record["git"]["commit"] or "no commit")[:12],
        "claimed": claims.exists(),
        "written": written,
        "outcome": outcome,
        "table": table,
        "figures": [embedded(figure, captions) for figure in figures],
    }


def claims_table(file: Path) -> str:
    """The paper's claims and ours, of agreement.csv, as html."""
    claims = pd.read_csv(file)
    shown = pd.DataFrame(
        {
            "the paper": claims["claim"],
            "where": claims["where"],
            "paper's number": [_number(*pair) for pair in zip(claims["paper"], claims["unit"], strict=True)],
            "ours": [_number(*pair) for pair in zip(claims["ours"], claims["unit"], strict=True)],
            "agrees": claims["within"],
            "why": claims["why"],
        }
    )
    return shown.to_html(index=False, border=0)


def outcome_of(folder: Path) -> str:
    """`outcome_table` of a bed or, of an open bed and of tracers, what is left out, as html."""
    if (file := folder / "left_out.csv").exists():
        left_out = pd.read_csv(file)
        if left_out["product"].str.contains("metrics.csv,").any():
            return left_out.rename(columns={"product": "left out"}).to_html(index=False, border=0)
    return outcome_table(folder / "metrics.csv")


def outcome_table(file: Path) -> str:
    """Errors of the chains beside the noise floor, of metrics.csv, as html: a column a group."""
    metrics = pd.read_csv(file)
    metrics = metrics[metrics["quantity"].str.fullmatch(OUTCOME)]
    parts = metrics["quantity"].str.extract(r"(?P<what>.*?)(?:_(?P<group>left|right|low|up))?$")
    metrics = metrics.assign(what=parts["what"].map(WORDS), group=parts["group"].fillna("whole bed"))
    metrics["source"] = metrics["source"].str.replace("_", " ")
    metrics["value"] = metrics["value"].map("{:.3g}".format)
    wide = metrics.pivot(index=["what", "source"], columns="group", values="value").fillna("")
    return wide.reset_index().rename_axis(None, axis=1).to_html(index=False, border=0)


def network_table(file: Path) -> str:
    """Numbers of a network, of metrics.csv, as html: a column a chain, without single revolutions."""
    metrics = pd.read_csv(file)
    metrics = metrics[~metrics["quantity"].str.contains(r"(?:variance|index)_\d+$")]
    metrics["value"] = metrics["value"].map("{:.6g}".format)
    wide = metrics.pivot(index=["quantity", "unit"], columns="source", values="value").fillna("")
    wide = wide.reindex(columns=list(dict.fromkeys(metrics["source"])))
    return wide.reset_index().rename_axis(None, axis=1).to_html(index=False, border=0)


def embedded(file: Path, captions: dict[str, Path]) -> dict[str, str]:
    """A figure or film with its caption, as the page holds it.

    Raises
    ------
    KeyError
        No caption fits its name: a rule without one.
    """
    try:
        caption = next(text for name, text in captions.items() if re.fullmatch(name, file.stem))
    except StopIteration:
        raise KeyError(f"{file.stem} has no caption") from None
    data = base64.b64encode(file.read_bytes()).decode("ascii")
    words = caption.read_text(encoding="utf-8").strip()
    return {"name": file.stem, "caption": words, "kind": KINDS[file.suffix], "data": data}


def _number(value: float, unit: str) -> str:
    text = f"{value:.0f}" if abs(value) >= 1000 else f"{value:.3g}"
    return text if unit == "1" else f"{text} {unit}"
