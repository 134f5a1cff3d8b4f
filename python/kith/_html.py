"""What notebooks show."""

from __future__ import annotations

import html
import re
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._domain import Domain
    from ._study import Analysis, Run
    from ._teach import Transcript


def _inline(svg: str, width: int) -> str:
    """An SVG file as a part of a page."""
    body = re.sub(r"^.*?(?=<svg)", "", svg, flags=re.DOTALL)
    return f'<div style="max-width:{width}px">{body}</div>' if body else ""


def _rows(rows: list[list[str]]) -> str:
    return "".join("<tr>" + "".join(f"<td style='text-align:left'>{cell}</td>" for cell in row) + "</tr>" for row in rows)


def _table(head: list[str], rows: list[list[str]]) -> str:
    cells = "".join(f"<th style='text-align:left'>{html.escape(one)}</th>" for one in head)
    return f"<table><thead><tr>{cells}</tr></thead><tbody>{_rows(rows)}</tbody></table>"


def _escaped(values: Any) -> list[str]:
    return [html.escape(str(value)) for value in values]


def domain_html(domain: Domain) -> str:
    world = domain.worlds[-1]
    rows = [[html.escape(part.name), "; ".join(_escaped(domain.words(part.half_spaces))) or "-", f"{part.area_sr:.3g}"]
            for part in domain.components]
    weights = ", ".join(f"{html.escape(name)} {value:g}" for name, value in zip(domain.feature_names, domain.weights))
    return (f"<h4>{html.escape(domain.title or domain.id)}</h4>"
            f"<p>{len(domain.worlds)} worlds, {len(domain.starts)} starts. Reward: {weights}.</p>"
            + _inline(domain.board(world.initial), 420)
            + _table(["what there is to understand", "in words", "area left (sr)"], rows)
            + _inline(domain.region_picture(), 640))


def _start(domain: Domain, start: Any) -> tuple[int, int]:
    return start.mdp, domain._native.state_number(start.mdp, start.start)


def transcript_html(transcript: Transcript) -> str:
    domain = transcript.__dict__.get("domain_object")
    parts = [f"<h4>{html.escape(transcript.composition)} taught by {html.escape(transcript.strategy)}</h4>"
             f"<p>{transcript.periods} periods, {transcript.demonstrations} demonstrations, {transcript.tests} tests, "
             f"knowledge {transcript.knowledge:.2f}: {html.escape(transcript.status)}.</p>"]
    for session in transcript.sessions:
        for period in session.periods:
            right = sum(answer.correct for test in period.tests for answer in test.answers)
            asked = sum(len(test.answers) for test in period.tests)
            parts.append(f"<details><summary>Period {period.period}: {html.escape(period.kc_name)}, chosen for "
                         f"{html.escape(period.source)}; {right} of {asked} answers right</summary>")
            for shown in period.demonstrations:
                words = domain.words(shown.conveys) if domain is not None else []
                board = _inline(domain.board(_start(domain, shown.start)), 300) if domain is not None else ""
                text = html.escape(", ".join(shown.actions))
                parts.append(f"{board}<p>{text}<br>{'; '.join(_escaped(words))}</p>")
            parts.append("</details>")
    return "".join(parts)


def analysis_html(analysis: Analysis) -> str:
    parts = [f"<p>{html.escape(note)}.</p>" for note in analysis.notes]
    for finding in analysis:
        parts.append(f"<details><summary><b>{html.escape(finding.title)}</b>: {html.escape(finding.sentence)}</summary>")
        for frame in finding.tables:
            parts.append(f"<p>{html.escape(str(frame.attrs['caption']))}</p>{frame.to_html(index=False, border=0)}")
        parts.append("</details>")
    return "".join(parts)


def frame_html(page: str) -> str:
    return (f'<iframe srcdoc="{html.escape(page, quote=True)}" style="width:100%;height:640px;border:1px solid #ccc">'
            "</iframe>")


def run_html(run: Run) -> str:
    summary: str = run.summary().to_html(border=0, float_format=lambda value: f"{value:.3g}")
    return f"<p>{html.escape(str(run.folder))}: {len(run.tables['teams'])} teams</p>{summary}"
