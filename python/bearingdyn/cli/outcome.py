"""What a command is, and what it ends with."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import TypeAlias

GOOD, FAILED, UNUSABLE, INTERRUPTED = 0, 1, 2, 130

Command: TypeAlias = Callable[[argparse.Namespace], tuple[str, int]]
"""a command's text for standard output, and its exit code"""
