"""What was computed from what: equal content has one text and hash, different content another."""

from __future__ import annotations

import dataclasses
import functools
import json
import math
import subprocess
import sys

import numpy as np
import pytest
import scipy.sparse

from bearingdyn import fingerprint
from bearingdyn.material import Maxwell
from bearingdyn.parts import Layer, Section, Shaft

RUBBER = Maxwell(1e6, [2e6], [1e-3], K=2e9, density=1200.0)


class Held:
    """An object that is no dataclass."""

    def __init__(self, x):
        self.x = x

    def method(self):
        return self.x


def test_parts_become_json_that_names_every_dimension():
    described = json.loads(fingerprint.text(Layer(0.026, 0.028, 0.016, RUBBER)))
    assert described["class"].endswith("Layer")
    assert (described["r_inner"], described["width"]) == (0.026, 0.016)
    assert described["material"]["G"] == [2e6]


def test_equal_parts_have_one_hash_also_in_another_process():
    one, same = (Shaft([Section(0.1, 0.02)], seats={"a": 0.0}) for _ in range(2))
    assert fingerprint.fingerprint(one) == fingerprint.fingerprint(same)
    code = (
        "from bearingdyn import fingerprint; from bearingdyn.parts import Section, Shaft\n"
        "print(fingerprint.fingerprint(Shaft([Section(0.1, 0.02)], seats={'a': 0.0})))"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == fingerprint.fingerprint(one)


def test_what_a_part_has_computed_does_not_change_its_hash():
    layer = Layer(0.026, 0.028, 0.016, RUBBER)
    before = fingerprint.fingerprint(layer)
    layer.stiffness()
    assert fingerprint.fingerprint(layer) == before


LARGE = np.arange(1000.0)
DIFFERENT = [
    1,
    1.0,
    "1",
    None,
    True,
    1j,
    math.inf,
    -math.inf,
    b"1",
    [1],
    {"a": 1},
    LARGE,
    LARGE + np.eye(1, 1000, 999)[0] * 1e-12,
    LARGE.astype(np.float32),
    np.zeros(100),
    np.zeros(100, dtype=np.int64),
    LARGE.reshape(10, 100),
    scipy.sparse.eye(100),
    scipy.sparse.eye(100) * 2,
    Held(1),
    Held(2),
    Held(1).method,
    Held(2).method,
    math.sin,
    functools.partial(math.pow, 2),
    functools.partial(math.pow, 3),
    RUBBER,
    dataclasses.replace(RUBBER, K=2.1e9, fit=None),
]


def test_different_things_have_different_hashes():
    assert len({fingerprint.fingerprint(thing) for thing in DIFFERENT}) == len(DIFFERENT)


def test_order_of_a_mapping_and_kind_of_a_sequence_do_not_count():
    assert fingerprint.fingerprint({"a": 1, "b": (2, 3)}) == fingerprint.fingerprint({"b": [2, 3], "a": 1})
    assert fingerprint.fingerprint({3, 1, 2}) == fingerprint.fingerprint({2, 3, 1})
    assert fingerprint.fingerprint(np.float64(0.1)) == fingerprint.fingerprint(0.1)


def test_long_entries_are_told_by_their_digest_and_the_text_stays_an_attribute():
    long = {"long": ["part"] * 20_000, "short": 1}
    text = fingerprint.text(long)
    assert len(text) < fingerprint.LONGEST
    assert json.loads(text)["short"] == 1
    assert fingerprint.text(long | {"long": ["Part"] * 20_000}) != text
    assert len(fingerprint.text(["part"] * 20_000)) < 100


def test_what_has_no_content_is_refused():
    with pytest.raises(ValueError, match="cannot be told by its content"):
        fingerprint.fingerprint({"x": object()})


def test_what_has_no_content_stands_by_its_class_in_a_result():
    """A part with an open file or the like can be computed with all the same."""
    part = json.loads(fingerprint.text({"part": Held(object())}))["part"]
    assert part.pop("code")["class"] == f"{__name__}.Held"
    assert part == {"class": f"{__name__}.Held", "x": {"class": "builtins.object"}}


def test_small_entries_stay_readable_beside_many_long_ones():
    """A hundred entries of 2 kB are more than an HDF5 attribute keeps: only they go by hash."""
    content = {f"part {k}": "x" * 1990 + f"{k:010d}" for k in range(100)}
    content |= {"radius": 0.026, "layer": Layer(0.026, 0.028, 0.016, RUBBER), "bearing": "6205"}
    written = fingerprint.text(content)
    assert len(written) <= 64_000
    record = json.loads(written)
    assert record.keys() == content.keys()
    assert (record["radius"], record["bearing"]) == (0.026, "6205")
    digests = {record[f"part {k}"]["sha256"] for k in range(100)}
    assert len(digests) == 100  # each still known from the others


def test_what_is_short_is_written_out_whole():
    content = {f"part {k}": "x" * 100 for k in range(100)}
    assert json.loads(fingerprint.text(content)) == content


def test_what_cannot_be_kept_even_so_is_told_by_one_hash():
    """Ten thousand entries of ten bytes: nothing in it is long, and all of it is."""
    assert json.loads(fingerprint.text({f"{k:08d}": k for k in range(10_000)})).keys() == {"sha256"}


def test_large_frozen_arrays_are_told_once_and_each_by_its_content():
    rng, told = np.random.default_rng(0), []
    for _ in range(20):  # of one size, so that a new one takes the place of a lost one
        array = rng.standard_normal(100)
        frozen = array.copy()
        frozen.setflags(write=False)
        told.append(fingerprint.fingerprint(frozen))
        assert told[-1] == fingerprint.fingerprint(frozen) == fingerprint.fingerprint(array)
        array[0] += 1.0  # one that may be written into is told anew
        assert fingerprint.fingerprint(array) != told[-1]
        del array, frozen
    assert len(set(told)) == 20
