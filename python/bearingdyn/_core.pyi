from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, final

import numpy as np
from numpy.typing import NDArray

_Array = NDArray[np.float64]

ISAS: Final[Mapping[str, int]]
DAMPING_LAWS: Final[Mapping[str, int]]
LOAD_KINDS: Final[Mapping[str, int]]
CHANNEL_KINDS: Final[Mapping[str, int]]
WAVE_KINDS: Final[Mapping[str, int]]
PIT_KINDS: Final[Mapping[str, int]]
SETTLED: Final[Mapping[str, int]]
STATUSES: Final[Mapping[str, int]]
REPORT_FIELDS: Final[Mapping[str, str]]
ENERGIES: Final[tuple[str, ...]]

@final
class Model:
    def __new__(
        cls,
        M: _Array,
        C: _Array,
        G: _Array,
        K: _Array,
        N: _Array,
        layers: Sequence[tuple[_Array, _Array, _Array]],
        bearings: Sequence[tuple[dict[str, object], _Array]],
        loads: Sequence[tuple[int | str, float, _Array, _Array, _Array, _Array]],
        channels: Sequence[tuple[int | str, _Array | None, int, int]],
    ) -> Model: ...
    @property
    def blocks(self) -> int: ...
    @property
    def channels(self) -> int: ...
    @property
    def nbytes(self) -> int: ...
    def state(
        self, t: float, x: _Array, v: _Array, stress: _Array | None = None, films: _Array | None = None, /
    ) -> _Array: ...
    def unpack(
        self, state: _Array, exact: bool = False, /
    ) -> tuple[float, _Array, _Array, _Array, dict[str, float]]: ...
    def march(
        self,
        state: _Array,
        steps: int,
        decimate: int,
        scheme: dict[str, object],
        start: bool,
        progress: Callable[[int, int], object] | None,
        modes: dict[str, _Array] | None = None,
    ) -> tuple[_Array, _Array, dict[str, Any]]: ...
    def harmonic(
        self,
        omega: _Array,
        speed: float,
        modulus: NDArray[np.complex128],
        bearing_K: _Array,
        bearing_C: _Array,
        ball: NDArray[np.complex128],
        across: _Array,
        force: _Array,
        row: _Array,
        progress: Callable[[int, int], object] | None,
        /,
    ) -> NDArray[np.complex128]: ...

def maxwell_stress(
    rate: _Array, dt: _Array, G0: float, eta0: float, modulus: _Array, tau: _Array, /
) -> _Array: ...
def bearing_force(
    bearing: dict[str, object],
    z: _Array,
    z_rate: _Array,
    angle: float,
    cage_speed: float,
    shaft_angle: float,
    shaft_speed: float,
    /,
) -> tuple[_Array, _Array, _Array, _Array]: ...
def bearing_along(
    bearing: dict[str, object],
    z: _Array,
    z_rate: _Array,
    angle: _Array,
    speed: _Array,
    window: float,
    tangents: bool,
    /,
) -> tuple[_Array, _Array, _Array, _Array, _Array, _Array | None, _Array | None, _Array | None]: ...
def bearing_settle(
    bearing: dict[str, object], loads: _Array, radius: _Array, angle: float, shaft_angle: float, /
) -> tuple[_Array, _Array, _Array]: ...
def check_scheme(scheme: dict[str, object], /) -> None: ...
def changed_layers(
    receptance: NDArray[np.complex128],
    which: NDArray[np.intp],
    alone: NDArray[np.complex128],
    change: NDArray[np.complex128],
    slope: NDArray[np.complex128],
    end: NDArray[np.int32],
    isa: str | int,
    /,
) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]: ...
def helmholtz(
    points: _Array, faces: NDArray[np.int32], k: float, floor: float | None, /
) -> tuple[
    NDArray[np.complex128],
    NDArray[np.complex128],
    NDArray[np.complex128],
    NDArray[np.complex128],
    NDArray[np.complex128],
]: ...
def march_abreast(
    calls: Sequence[
        tuple[
            Model,
            _Array,
            int,
            int,
            dict[str, object],
            bool,
            Callable[[int, int], object] | None,
            dict[str, _Array] | None,
        ]
    ],
    /,
) -> list[tuple[_Array, _Array, dict[str, Any]]]: ...
def status_text(status: int, /) -> str: ...
