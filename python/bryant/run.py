"""The result of a run."""

import json
import os
import tempfile
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _bryant
from ._command import call, clean


class Run(Mapping):
    """The result of a run: an array for each output, by name.

    time [s]; `units`, `peaks`, `responses`, `criteria`, `energy`, `parameters`, `accuracy`, `doubts`, `notes` as the
    command prints them in JSON; `messages`, what it says beside.
    """

    def __init__(self, model, options, found, messages):
        self._model, self._options = model, options
        self.messages = messages.strip()
        self._facts = found
        columns = found["columns"]
        rows = np.array(found["rows"], dtype=float).reshape(-1, len(columns))
        self.time = rows[:, 0]
        self._columns = {column["name"]: rows[:, i] for i, column in enumerate(columns) if i}
        self.units = {column["name"]: column["unit"] for column in columns}
        self.peaks, self.energy, self.parameters = found["peaks"], found["energy"], found["parameters"]
        self.accuracy, self.doubts, self.notes = found["accuracy"], found["doubts"], found["notes"]
        self.responses = {one["response"]: one["value"] for one in found["responses"]}
        self.criteria = (found.get("criteria") or {}).get("criteria")
        self.statistics = found["report"]

    @classmethod
    def _of(cls, model, options):
        try:
            output, messages = call("run", model.path, json=True, no_files=True, **options)
        except _bryant.Error as error:
            try:
                error.run = cls(model, options, json.loads(error.output), str(error))
            except (AttributeError, ValueError):
                error.run = None
            raise
        return cls(model, options, json.loads(output), messages)

    def __getitem__(self, name: str) -> NDArray:
        try:
            return self._columns[name]
        except KeyError:
            raise KeyError(f"there is no output {name}; there are {', '.join(self._columns)}") from None

    def __iter__(self):
        return iter(self._columns)

    def __len__(self):
        return len(self._columns)

    def table(self) -> dict[str, NDArray]:
        """{"time": array, output: array, …}"""
        return {"time": self.time, **self._columns}

    def to_pandas(self) -> Any:
        """A data frame with the time as its index."""
        import pandas

        return pandas.DataFrame(self._columns, index=pandas.Index(self.time, name="time"))

    def report(self, path: str | os.PathLike[str], **options: Any) -> None:
        """Writes the report of this run: a page of HTML. The run is computed again, with the same result."""
        self._files(report=os.fspath(path), **options)

    def animation(self, path: str | os.PathLike[str]) -> None:
        """Writes the motion as glTF (.glb)."""
        self._files(animation=os.fspath(path))

    def picture(self) -> str:
        """The motion as SVG."""
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "motion.svg")
            self._files(picture=path)
            with open(path, encoding="utf-8") as file:
                return file.read()

    def _files(self, **files):
        call("run", self._model.path, no_files=True, force=True, **self._options, **files)

    def _repr_svg_(self):
        return self.picture()

    def __repr__(self):
        lines = [f"<bryant run of {self._facts['model']}: {len(self.time)} rows to {self.time[-1]:g} s"]
        for peak in self.peaks:
            lines.append(f"  {peak['output']}: {peak['value']:.4g} {peak['unit']} at {peak['time_s']:.4g} s")
        return "\n".join(lines) + ">"
