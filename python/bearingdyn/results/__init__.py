"""Results: Datasets with units, inputs and versions, in one file each; and their export."""

from bearingdyn.results.datasets import check_dataset, dataset
from bearingdyn.results.march_record import march_dataset, recorded, sampling_time, signal_of, unit_of
from bearingdyn.results.provenance import inputs_of, stamp, versions
from bearingdyn.results.result_file import groups, open_result, save
from bearingdyn.results.uff import write_uff

__all__ = [
    "check_dataset",
    "dataset",
    "groups",
    "inputs_of",
    "march_dataset",
    "open_result",
    "recorded",
    "sampling_time",
    "save",
    "signal_of",
    "stamp",
    "unit_of",
    "versions",
    "write_uff",
]
