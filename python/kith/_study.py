"""Studies, their runs, and what is made of them."""

from __future__ import annotations

import json
import os
import weakref
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, Optional, Union

from . import _core
from ._domain import Domain
from ._kinds import learner_name, strategy_name
from ._progress import Bar, Progress
from ._settings import overrides, toml_text
from ._teach import Transcript, replay

if TYPE_CHECKING:
    import pandas

StudySource = Union[str, os.PathLike[str], Mapping[str, Any]]
"""A built-in study ("paper", "quick"), a file, or a dictionary with the keys of a study file."""


def _scratch(what: str) -> str:
    """A new folder for a while; what makes and removes it is imported when it is needed."""
    import tempfile

    return tempfile.mkdtemp(prefix=f"kith-{what}-")


def _discard(folder: str) -> None:
    import shutil

    shutil.rmtree(folder, ignore_errors=True)


class _Inputs:
    """A study as the module takes it: name, text and overrides; close() removes the files of a domain given as an object."""

    def __init__(self, study: StudySource, settings: Mapping[str, Any], domain: Optional[Domain],
                 strategies: Iterable[Any], learners: Mapping[str, Any]) -> None:
        self._folders: list[str] = []
        keys: dict[str, Any] = dict(settings)
        self.name, self.text = "study", ""
        if isinstance(study, Mapping):
            table: dict[str, Any] = {"schema": "kith.study/1", "id": "study", **study}
            if isinstance(table.get("domain"), Domain):
                table["domain"] = self._saved(table["domain"])
            self.text = toml_text(table)
        else:
            self.name = os.fspath(study)
        if domain is not None:
            keys["domain"] = self._saved(domain)
        names = [strategy_name(one) for one in strategies]
        if names:
            keys["design.strategies"] = names
        for letter, learner in learners.items():
            keys[f"learner.{letter}.kind"] = learner_name(learner)
        self.overrides = list(overrides(keys))

    def _saved(self, domain: Domain) -> str:
        self._folders.append(_scratch("domain"))
        return str(domain.save(self._folders[-1]))

    def close(self) -> None:
        for folder in self._folders:
            _discard(folder)


class Tables(Mapping[str, "pandas.DataFrame"]):
    """The tables of a run by name ("teams"), read when they are asked for.

    Columns of numbers look at kith's memory and cannot be written; frame.copy() can.
    """

    def __init__(self, folder: FilePath) -> None:
        self._folder = folder
        self._native: dict[str, _core.Table] = {}
        self._frames: dict[str, pandas.DataFrame] = {}

    def _names(self) -> list[str]:
        book = json.loads((self._folder / "tables" / "codebook.json").read_text(encoding="utf-8"))
        return [table["file"][: -len(".csv")] for table in book["tables"]]

    def native(self, name: str) -> _core.Table:
        """The table in kith's memory: native(name).column(c) is an array of numbers, or a list."""
        if name not in self._native:
            if name not in self._names():
                raise KeyError(f"the run has no table '{name}', only {', '.join(self._names())}")
            self._native[name] = _core.Table(str(self._folder), name)
        return self._native[name]

    def __getitem__(self, name: str) -> pandas.DataFrame:
        if name not in self._frames:
            import pandas as pd

            table = self.native(name)
            frame = pd.DataFrame({column: table.column(column) for column in table.columns}, copy=False)
            frame.attrs["description"] = table.description
            self._frames[name] = frame
        return self._frames[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._names())

    def __len__(self) -> int:
        return len(self._names())

    def codebook(self, name: str) -> pandas.DataFrame:
        """What every column of a table is."""
        import pandas as pd

        return pd.DataFrame(self.native(name).codebook, columns=["column", "type", "unit", "description"]).set_index("column")

    def __repr__(self) -> str:
        return f"<kith tables {', '.join(self._names())}>"


class Finding:
    """The answer to one question about a study."""

    def __init__(self, document: Mapping[str, Any]) -> None:
        self.document = dict(document)
        self.id: str = document["id"]
        self.title: str = document["title"]
        self.question: str = document["question"]
        self.model: str = document["model"]
        self.sentence: str = document["sentence"]
        self.results: str = document["results"]
        self.warnings: list[str] = document["warnings"]

    @property
    def tables(self) -> list[pandas.DataFrame]:
        """Its tables, with all digits."""
        import pandas as pd

        frames = []
        for table in self.document["tables"]:
            frame = pd.DataFrame(table["rows"], columns=[column["field"] for column in table["columns"]])
            frame.attrs["caption"] = table["caption"]
            frames.append(frame)
        return frames

    def __repr__(self) -> str:
        return f"<kith finding {self.id}: {self.sentence}>"


class Analysis(Sequence[Finding]):
    """What was found, in order; analysis["periods"] is the finding of that id."""

    def __init__(self, document: Mapping[str, Any]) -> None:
        self.document = dict(document)
        self._findings = [Finding(one) for one in document["findings"]]
        self.notes: list[str] = document["notes"]
        self.not_analysed: list[str] = document["not_analysed"]

    def __getitem__(self, which: Any) -> Any:
        if isinstance(which, str):
            for finding in self._findings:
                if finding.id == which:
                    return finding
            raise KeyError(f"there is no finding '{which}', only {', '.join(one.id for one in self._findings)}")
        return self._findings[which]

    def __len__(self) -> int:
        return len(self._findings)

    def __repr__(self) -> str:
        return "\n".join(f"{one.title}: {one.sentence}" for one in self._findings)

    def _repr_html_(self) -> str:
        from ._html import analysis_html

        return analysis_html(self)


class Report:
    """A page with figures, tests and methods; a notebook shows it."""

    def __init__(self, path: FilePath, page: str) -> None:
        self.path = path
        self.page = page

    def __repr__(self) -> str:
        return f"<kith report {self.path}: {len(self.page) // 1000} kB>"

    def _repr_html_(self) -> str:
        from ._html import frame_html

        return frame_html(self.page)


class Run:
    """The results of a study in a folder: kith.Run("results/paper"), or what kith.study() gives."""

    def __init__(self, folder: Union[str, os.PathLike[str]], *, resumed: int = 0,
                 failures: Optional[list[str]] = None) -> None:
        self.folder = FilePath(folder)
        self.resumed = resumed
        """Teams that were finished before kith.study() went on."""
        self.failures = list(failures or [])
        """Teams that could not be taught, with the reason; only with keep_going."""
        self.tables = Tables(self.folder)

    @property
    def manifest(self) -> dict[str, Any]:
        """What the run depended on."""
        manifest: dict[str, Any] = json.loads((self.folder / "manifest.json").read_text(encoding="utf-8"))
        return manifest

    @property
    def status(self) -> dict[str, Any]:
        """How far it is: "done", "total", "failures"; also of a run that was interrupted."""
        return _core.status(str(self.folder))

    def summary(self) -> pandas.DataFrame:
        """Means of every strategy and composition."""
        teams = self.tables["teams"]
        by = [name for name in ("strategy", "composition") if name in teams]
        columns = [name for name in ("periods", "knowledge", "area_sr", "exam_share_right") if name in teams]
        frame: pandas.DataFrame = teams.groupby(by, sort=False)[columns].mean()
        return frame

    def team(self, number: int) -> Transcript:
        """One of its teams, taught again step by step."""
        return replay(self.folder, number)

    def analyze(self, *, alpha: float = 0.05, correction: str = "bonferroni", contrasts: Sequence[str] = (),
                by: Sequence[str] = ()) -> Analysis:
        """The analyses of a study; models of your own are for `kith analyze --model`, which asks R, or statsmodels."""
        return Analysis(json.loads(_core.analyze(str(self.folder), alpha, correction, list(contrasts), list(by))))

    def report(self, path: Union[str, os.PathLike[str], None] = None) -> Report:
        """Writes figures, tables and methods as one page that works offline; default: report.html in the folder."""
        place = FilePath(path) if path is not None else self.folder / "report.html"
        page = _core.report(str(self.folder), True)
        place.write_text(page, encoding="utf-8", newline="")
        return Report(place, page)

    def verify(self, sample: float = 1.0, *, threads: int = 0, progress: Progress = "auto") -> dict[str, Any]:
        """Teaches the teams, or a share of them, again and compares all bytes. kith.Error if any differs."""
        with Bar(progress, "verifying") as bar:
            return _core.verify(str(self.folder), sample, threads, bar.callback)

    def audit(self, team: int = 0, **options: Any) -> dict[str, Any]:
        """Who understands what, by the answers alone; see kith.audit()."""
        return audit(self.folder, team, **options)

    def __repr__(self) -> str:
        return f"<kith.Run {self.folder}>"

    def _repr_html_(self) -> str:
        from ._html import run_html

        return run_html(self)


def study(study: StudySource, out: Union[str, os.PathLike[str], None] = None, *, threads: int = 0,
          resume: str = "auto", replace: bool = False, keep_going: bool = False, progress: Progress = "auto",
          domain: Optional[Domain] = None, strategies: Iterable[Any] = (), learners: Mapping[str, Any] = {},
          **settings: Any) -> Run:
    """Simulates all teams of a study, as `kith study` does, with the same bytes in its tables.

    out         run folder; None: one that goes when the run does
    threads     0: as many as there are cores; never changes a result
    resume      "auto": go on with what the folder holds; "never"; "require"
    replace     whether the folder may hold something else, which is then lost
    keep_going  whether the run goes on after a team that failed
    domain      a robot in place of the study's
    strategies  names and classes of your own, in place of the study's
    learners    classes of your own by letter, in place of the study's kind of learner
    settings    keys of the study file, such as replicates=5, teacher={"particles": 500}

    What is finished is saved all the time: after Ctrl-C, or an exception in a strategy, the same call goes on.
    """
    temporary = _scratch("run") if out is None else None
    folder = os.fspath(out) if out is not None else os.path.join(str(temporary), "run")
    try:
        inputs = _Inputs(study, settings, domain, strategies, learners)
        try:
            with Bar(progress, "teaching") as bar:
                told = _core.study(inputs.name, inputs.text, inputs.overrides, folder, threads, resume, replace, keep_going,
                                   bar.callback)
        finally:
            inputs.close()
    except BaseException:
        if temporary is not None:
            _discard(temporary)
        raise
    run = Run(folder, resumed=told["resumed"], failures=told["failures"])
    if temporary is not None:
        weakref.finalize(run, _discard, temporary)
    return run


def resolve(study: StudySource, *, domain: Optional[Domain] = None, strategies: Iterable[Any] = (),
            learners: Mapping[str, Any] = {}, **settings: Any) -> str:
    """The study as a study file with every key written out; kith.Error if anything in it is wrong."""
    inputs = _Inputs(study, settings, domain, strategies, learners)
    try:
        return _core.resolved(inputs.name, inputs.text, inputs.overrides)
    finally:
        inputs.close()


def fit(*logs: Union[str, os.PathLike[str], Run], answers: str = "path", types: int = 0,
        folds: int = 5, replicates: int = 2, seed: int = 1, threads: int = 0, progress: Progress = "auto") -> dict[str, Any]:
    """How people learn, from what they saw and answered: runs, tables of trials. The document kith.fit/1."""
    names = [str(log.folder) if isinstance(log, Run) else os.fspath(log) for log in logs]
    with Bar(progress, "fitting") as bar:
        document: dict[str, Any] = json.loads(
            _core.fit(names, answers, types, folds, replicates, seed, threads, bar.callback))
    return document


def audit(folder: Union[str, os.PathLike[str], Run], team: int = 0, *, room: str = "", forgetting: float = 0.02,
          threads: int = 0, progress: Progress = "auto") -> dict[str, Any]:
    """Who understands what, by the answers alone: the document kith.audit/1.

    folder  of a run, or of live sessions
    team    number of a team of the run; 0: all
    room    id or code of a room of the live sessions; "": all
    """
    place = str(folder.folder) if isinstance(folder, Run) else os.fspath(folder)
    with Bar(progress, "judging") as bar:
        document: dict[str, Any] = json.loads(_core.audit(place, team, room, forgetting, threads, bar.callback))
    return document


def power(study: StudySource, *effects: str, teams: Sequence[int] = (5, 10, 15, 20, 30, 50, 100), target: float = 0.8,
          alpha: float = 0.05, pool: int = 1000, draws: int = 1000, paired: bool = False, threads: int = 0,
          progress: Progress = "auto", domain: Optional[Domain] = None, strategies: Iterable[Any] = (),
          learners: Mapping[str, Any] = {}, **settings: Any) -> dict[str, Any]:
    """How many teams a study needs to show effects such as "periods: strategy" or "knowledge: joint - common = 0.05"."""
    inputs = _Inputs(study, settings, domain, strategies, learners)
    try:
        with Bar(progress, "simulating") as bar:
            document: dict[str, Any] = json.loads(
                _core.power(inputs.name, inputs.text, inputs.overrides, list(effects), list(teams), target, alpha, pool,
                            draws, paired, threads, bar.callback))
    finally:
        inputs.close()
    return document
