# SPDX-License-Identifier: GPL-3.0-or-later
"""The form of a file by its content, and what a file of no known form looks like."""

from pathlib import Path
from typing import Literal

from bedchain.errors import DataError
from bedchain.trajectory.forms import vtk
from bedchain.trajectory.forms.lammps_binary import MAGIC_WORDS, MOST_COLUMNS
from bedchain.trajectory.forms.raw import ALIASES
from bedchain.trajectory.forms.streams import compression, opened

Form = Literal["text", "binary", "vtk", "pvd", "table", "npz"]
FORMS: tuple[Form, ...] = ("text", "binary", "vtk", "pvd", "table", "npz")
HEAD_BYTES = 4096
LOOKS = {
    b"\x89HDF": "HDF5",
    b"CDF": "NetCDF",
    b"\xff\xfe": "text in UTF-16",
    b"\xfe\xff": "text in UTF-16",
    b"\x93NUMPY": "a single array of numpy (.npy; save an .npz)",
    b"%PDF": "PDF",
    b"\x89PNG": "a picture (PNG)",
    b"\x7fELF": "a program",
    b"{": "JSON",
    b"SQLite": "SQLite",
}


def head_of(path: Path) -> tuple[bytes, str | None]:
    """First bytes of a file's content, unpacked, and the name of the compression.

    Raises
    ------
    DataError
        It is a special file, cannot be read, or its compressed content is damaged.
    """
    if path.is_dir() or not path.is_file():
        raise DataError(
            f"{path} is no file"
            + (f" but a folder: name its files, such as {path}/*" if path.is_dir() else "")
        )
    with path.open("rb") as file:
        packed = compression(file.read(8))
    with opened(path) as stream:
        head = stream.read(HEAD_BYTES)
    return head, packed


def form_of(head: bytes) -> Form | None:
    """Form of a file by the first bytes of its content; None where it is no frame, such as VTK's box.

    Raises
    ------
    DataError
        No form that is known; the message says what it looks like.
    """
    if not head:
        return None
    if head.lstrip().startswith(b"ITEM:"):
        return "text"
    if kind := vtk.kind_of(head):
        if kind.dataset == "Collection":
            return "pvd"
        return "vtk" if kind.dataset in vtk.PARTICLES else None
    if head.startswith(b"PK\x03\x04"):
        return "npz"
    if look := next((look for magic, look in LOOKS.items() if head.startswith(magic)), None):
        raise DataError(f"looks like {look}: {KNOWN}")
    if packed := compression(head):
        raise DataError(
            f"looks like {packed} inside a compressed file, or of a kind that is not unpacked: unpack it"
        )
    if _is_binary_dump(head):
        return "binary"
    if b"\0" in head:
        raise DataError(f"looks like binary data of another program, {head[:8]!r}...: {KNOWN}")
    if any(byte in b"0123456789" for byte in head) or any(name.encode() in head.lower() for name in ALIASES):
        return "table"
    raise DataError(f"looks like text without numbers, {head[:40]!r}...: {KNOWN}")


KNOWN = (
    "frames are read from dumps of LIGGGHTS and LAMMPS (text, binary), VTK (vtk, vtp, vtu, pvd), tables "
    "and npz, "
    "and gz, xz or zst of them"
)


def _is_binary_dump(head: bytes) -> bool:
    """Whether numbers stand where a binary dump has them (see `lammps_binary`)."""
    if any(head[8:].startswith(word) for word in MAGIC_WORDS):
        return True
    if len(head) < 100 or b"\0" not in head:
        return False
    step, number = (int.from_bytes(head[at : at + 8], "little", signed=True) for at in (0, 8))
    triclinic, columns, chunks = (
        int.from_bytes(head[at : at + 4], "little", signed=True) for at in (16, 92, 96)
    )
    if triclinic == 1:
        return step >= 0 and number >= 0
    plausible = step >= 0 and 0 <= number < 2**31 and triclinic == 0
    return plausible and 0 < columns <= MOST_COLUMNS and chunks > 0
