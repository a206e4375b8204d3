from collections.abc import Callable, Sequence
from typing import final

import numpy as np
from numpy.typing import NDArray

_Array = NDArray[np.float64]

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
        bearings: Sequence[tuple[tuple[object, ...], _Array]],
        loads: Sequence[tuple[int, float, _Array, _Array, _Array, _Array]],
        channels: Sequence[tuple[int, _Array | None, int, int]],
    ) -> Model: ...
    @property
    def blocks(self) -> int: ...
    @property
    def channels(self) -> int: ...
    @property
    def nbytes(self) -> int: ...
    def state(self, t: float, x: _Array, v: _Array, /) -> _Array: ...
    def unpack(self, state: _Array, /) -> tuple[float, _Array, _Array, _Array, _Array]: ...
    def march(
        self,
        state: _Array,
        steps: int,
        decimate: int,
        dt: float,
        beta: float,
        gamma: float,
        times: _Array,
        speeds: _Array,
        tolerance: float,
        max_iterations: int,
        audit: bool,
        isa: int,
        start: bool,
        progress: Callable[[int, int], object] | None,
        /,
    ) -> tuple[_Array, _Array, tuple[int, int, int, int, int, int, float, float, int]]: ...
    def harmonic(
        self,
        omega: _Array,
        speed: float,
        modulus: NDArray[np.complex128],
        bearing_K: _Array,
        bearing_C: _Array,
        force: _Array,
        row: _Array,
        progress: Callable[[int, int], object] | None,
        /,
    ) -> NDArray[np.complex128]: ...

def maxwell_stress(
    rate: _Array, dt: _Array, G0: float, eta0: float, modulus: _Array, tau: _Array, /
) -> _Array: ...
def bearing_force(
    bearing: tuple[object, ...],
    z: _Array,
    z_rate: _Array,
    angle: float,
    cage_speed: float,
    shaft_angle: float,
    shaft_speed: float,
    /,
) -> tuple[_Array, _Array, _Array, _Array]: ...
def status_text(status: int, /) -> str: ...
