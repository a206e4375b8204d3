"""What stands on a report's page: its text, and the numbers of its charts."""

from __future__ import annotations

import base64
import json
import re
from html import unescape
from pathlib import Path

import numpy as np


def text_of(page: Path) -> str:
    """What a reader sees, without marks."""
    body = re.sub(
        r"<script.*?</script>|<style.*?</style>|<svg.*?</svg>", " ", page.read_text("utf-8"), flags=re.S
    )
    return " ".join(unescape(re.sub(r"<[^>]+>", " ", body)).split())


def curves(page: Path, title: str) -> list[tuple[str, np.ndarray, np.ndarray]]:
    """Names and numbers of a chart's curves."""
    found = re.search(
        rf"<figcaption>{re.escape(title)}</figcaption>.*?<script type=application/json>(.*?)</script>",
        page.read_text("utf-8"),
        re.S,
    )
    assert found is not None
    held = json.loads(found[1])
    grids = [np.frombuffer(base64.b64decode(x), "<f4") for x in held["grids"]]
    return [
        (
            c["name"],
            grids[c["x"]],
            np.frombuffer(base64.b64decode(c["y"]), "<f4").astype(float) + c.get("base", 0.0),
        )
        for c in held["curves"]
    ]
