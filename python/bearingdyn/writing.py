"""Files written whole or not at all: a full disk, a signal or a power cut leaves what was there before."""

from __future__ import annotations

import errno
import os
import secrets
import stat
from pathlib import Path

from bearingdyn.checks import require

KINDS = (
    (stat.S_ISDIR, "folder"),
    (stat.S_ISCHR, "device"),
    (stat.S_ISBLK, "device"),
    (stat.S_ISFIFO, "pipe"),
    (stat.S_ISSOCK, "socket"),
)


def write_whole(path: str | os.PathLike[str], data: bytes | memoryview) -> None:
    """Write a file whole or not at all: under another name, wait for the disk, and move it into place.

    A link keeps pointing where it does: the file behind it is replaced. A file that was there keeps its
    permissions.

    Raises
    ------
    OSError
        Naming the file and what is wrong: no such folder, no room, no permission, or something at that place
        that is not a file (a folder, a device, a pipe). What was there before is unchanged.
    """
    mode = check_target(path)
    target = Path(os.path.realpath(path))
    scratch = target.with_name(f".{secrets.token_hex(8)}.part")  # short: a long name beside it may not fit
    try:
        try:
            _write(scratch, data, mode)
            scratch.replace(target)
        finally:
            scratch.unlink(missing_ok=True)
        _settle(target.parent)
    except OSError as error:
        raise _named(
            error.errno,
            f"could not be written ({error.strerror}); what was there before is unchanged",
            path,
        ) from None


def check_target(path: str | os.PathLike[str]) -> int | None:
    """Check that a file can be written: its permissions, None where there is none yet; OSError otherwise.

    Raises
    ------
    ValueError
        For what is no path.
    """
    good = isinstance(path, str | os.PathLike) and "\0" not in os.fsdecode(path)
    require(good, "the path to write to", path, "give a text or a Path, without a NUL")
    target = Path(os.path.realpath(path))
    if not target.parent.is_dir():
        raise _named(
            errno.ENOENT, f"cannot be written: there is no folder {target.parent}; make it first", path
        )
    try:
        mode = target.stat().st_mode
    except FileNotFoundError:
        return None
    kind = next((word for is_kind, word in KINDS if is_kind(mode)), "")
    if kind:
        number = errno.EISDIR if kind == "folder" else errno.EINVAL
        raise _named(number, f"is a {kind}, not a file; give the name of a file", path)
    if not os.access(target, os.W_OK):
        raise _named(errno.EACCES, "may not be written; change its permissions or give another name", path)
    return stat.S_IMODE(mode)


def _named(number: int | None, text: str, path: str | os.PathLike[str]) -> OSError:
    return OSError(number or errno.EIO, text, os.fspath(path))


def _write(scratch: Path, data: bytes | memoryview, mode: int | None) -> None:
    descriptor = os.open(scratch, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), 0o666)
    try:
        left = memoryview(data).cast("B")
        while left:
            left = left[os.write(descriptor, left[: 1 << 26]) :]
        if mode is not None and hasattr(os, "fchmod"):
            os.fchmod(descriptor, mode)
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _settle(folder: Path) -> None:
    """The new name on the disk too, where the system can."""
    if os.name != "posix":
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    except OSError:  # some file systems cannot; the file itself is safe
        return
    finally:
        os.close(descriptor)
