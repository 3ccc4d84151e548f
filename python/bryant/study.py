"""The result of a study: many runs of one model."""

import csv
import json
import os
import tempfile

import numpy as np

from ._command import call


class Study:
    """The result of a study: an array for each parameter and response, by the heading of its column.

    `status` says of each run how it ended ("done" for one that can be used; numbers of others are NaN), `errors` how
    far it may be off; `summary` has means, quantiles, correlations and sensitivities.
    """

    def __init__(self, names, columns, status, errors, summary, folder):
        self.names, self._columns = names, columns
        self.status, self.errors, self.summary = status, errors, summary
        self._folder = folder

    @classmethod
    def _of(cls, model, parameters, responses, runs, design, seed, fixed, run, options):
        study = {
            "model": os.path.abspath(model.path) if os.path.exists(model.path) else model.path,
            "design": design,
            "runs": runs,
            "seed": seed,
            "parameters": {name: cls._parameter(of) for name, of in parameters.items()},
            "fixed": fixed or None,
            "run": {key: value for key, value in run.items() if value is not None} or None,
            "responses": [cls._response(of) for of in responses],
            "tables": ["csv"],
        }
        study = {key: value for key, value in study.items() if value is not None}
        folder = tempfile.TemporaryDirectory(prefix="bryant-")
        path, out = os.path.join(folder.name, "study.yaml"), os.path.join(folder.name, "results")
        with open(path, "w", encoding="utf-8") as file:
            # JSON is YAML
            json.dump(study, file, ensure_ascii=False)
        output, _ = call("sweep", path, out=out, json=True, **options)
        with open(os.path.join(out, "results.csv"), newline="", encoding="utf-8") as file:
            heading, *rows = list(csv.reader(file))
        at = {name: index for index, name in enumerate(heading)}
        names = heading[1 : at["status"]]
        column = lambda name: np.array([float(row[at[name]] or "nan") for row in rows])
        columns = {cls._bare(name): column(name) for name in names}
        status = np.array([row[at["status"]] for row in rows])
        errors = column("error estimate") if "error estimate" in at else None
        return cls(names, columns, status, errors, json.loads(output), folder)

    @staticmethod
    def _bare(heading):
        """The name in a heading, without its unit."""
        return heading.rsplit(" [", 1)[0] if heading.endswith("]") else heading

    @staticmethod
    def _parameter(of):
        if isinstance(of, tuple):
            low, high = of
            return {"from": low, "to": high}
        return {"values": list(of)} if isinstance(of, (list, np.ndarray)) else of

    @staticmethod
    def _response(of):
        if not isinstance(of, str):
            return of
        # "time of peak of x" has the word twice
        timed = next((begin for begin in ("time of peak", "time of minimum") if of.startswith(begin)), "")
        what, found, output = of.removeprefix(timed).partition(" of ")
        what = timed + what
        if not found:
            raise ValueError(f"a response is WHAT of OUTPUT, such as 'peak of belt force'; {of!r} is not")
        if what.startswith("value at "):
            return {"of": output, "what": "value", "at": what.removeprefix("value at ")}
        if "clip" in what.split():
            # "3 ms clip", "clip 3 ms", "contiguous clip 3 ms"
            kind = "contiguous clip" if "contiguous" in what.split() else "clip"
            duration = " ".join(word for word in what.split() if word not in ("contiguous", "clip"))
            return {"of": output, "what": kind, "duration": duration}
        return {"of": output, "what": what}

    def __getitem__(self, name):
        try:
            return self._columns[name]
        except KeyError:
            raise KeyError(f"there is no column {name}; there are {', '.join(self._columns)}") from None

    def __len__(self):
        return len(self.status)

    def table(self):
        """{parameter or response: array}"""
        return dict(self._columns)

    def to_pandas(self):
        """A data frame with a row for each run."""
        import pandas

        return pandas.DataFrame({**self._columns, "status": self.status})

    def __repr__(self):
        done = int((self.status == "done").sum())
        return f"<bryant study: {len(self)} runs, {done} of them done; {', '.join(self._columns)}>"
