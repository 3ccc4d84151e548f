"""The compiled part of the package."""

from typing import Any, Self

from numpy.typing import ArrayLike, NDArray

VERSION: str

class Error(Exception):
    """What is wrong, where, and what to do: the text that the command prints."""

    code: int
    output: str
    run: Any

class Model:
    def __new__(cls, path: str) -> Self: ...
    name: str
    digest: str
    arithmetic: str
    state: tuple[list[tuple[str, str]], list[tuple[str, str]], list[tuple[str, str]], list[tuple[str, str]]]
    outputs_named: list[tuple[str, str]]
    parameters_named: list[tuple[str, str, float, float, float, bool]]
    values: list[float]
    def begin(self) -> tuple[list[float], list[float], list[float], list[float]]: ...
    def derived(self, functions: list[str]) -> bytes: ...
    def accelerations(
        self,
        q: ArrayLike,
        v: ArrayLike,
        u: ArrayLike | None = None,
        states: ArrayLike | None = None,
        t: float = 0.0,
        vary: list[str] | None = None,
        out: NDArray[Any] | None = None,
        threads: int = 1,
    ) -> NDArray[Any]: ...
    def evaluate(
        self,
        what: str,
        q: ArrayLike,
        v: ArrayLike | None,
        u: ArrayLike | None = None,
        states: ArrayLike | None = None,
        t: float = 0.0,
        vary: list[str] | None = None,
        out: NDArray[Any] | None = None,
        threads: int = 1,
        a: ArrayLike | None = None,
    ) -> NDArray[Any]: ...
    def names_of(self, what: str) -> tuple[list[str], list[str]]: ...
    def march(
        self,
        q: ArrayLike,
        v: ArrayLike,
        dt: float,
        steps: int,
        u: ArrayLike | None = None,
        states: ArrayLike | None = None,
        t: float = 0.0,
        parts: int = 1,
        linear: bool = False,
        outputs: bool = False,
        vary: list[str] | None = None,
        out: NDArray[Any] | None = None,
        threads: int = 1,
    ) -> NDArray[Any]: ...

class Simulation:
    def __new__(cls, model: Model, state: ArrayLike | None = None, t: float = 0.0, tolerance: float = 1e-7) -> Self: ...
    def advance(self, t: float, u: ArrayLike | None = None) -> tuple[float, NDArray[Any], NDArray[Any], int]: ...
    def finish(self) -> list[str]: ...

def command(line: list[str]) -> tuple[int, str, str]: ...
