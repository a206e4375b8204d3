"""The command line of a benchmark without questions of its own."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Mapping


def printed(doc: str | None, measure: Callable[[], Mapping[str, object]]) -> int:
    """Measure and print: a line each, or with --json one object."""
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options = parser.parse_args()
    result = measure()
    width = max(map(len, result))
    print(json.dumps(result) if options.json else "\n".join(f"{k:>{width}}: {v}" for k, v in result.items()))
    return 0
