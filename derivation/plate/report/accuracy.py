"""Tables of the report on accuracy and run time, from the committed measurement."""

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal

from derivation.engine.report.hard import error as power
from derivation.engine.report.latex import escape, prose
from derivation.plate.benchmark.interface import TIE
from derivation.plate.benchmark.panels import SLOW_CALL
from derivation.plate.report.accuracy_figures import KINDS, TASKS

Data = Mapping[str, Any]

UNITS = ((1.0, "s"), (1e-3, "ms"), (1e-6, r"$\mu$s"), (1e-9, "ns"))
REQUIRED_DIGITS = 12
"""Number of digits required of the direct sum."""


def shown_case(data: Data) -> str:
    """Return the name of the test case shown: the paper's, unless a scene replaces it."""
    return str(data["cases"][1]["name"])


def accuracy_context(data: Data) -> dict[str, Any]:
    """Return the values for the template of this section."""
    return {
        "tasks": [
            {
                "title": title,
                "figures": [f"work_precision_{task}_{kind}" for kind in KINDS],
                "winners": list(winners(data, task)),
            }
            for task, title in TASKS.items()
        ],
        "cases": len(data["cases"]),
        "tie": f"{100 * (TIE - 1):.0f}",
        "case": shown_case(data),
        "errors": list(error_rows(data)),
        "unsplit": list(reasons(data, "unsplit")),
        "remarks": list(reasons(data, "remark")),
        "failures": list(failures(data["rows"])),
        "scaling": [scaling_row(growth) for growth in data["scaling"]],
        "tools": list(tool_rows(data["tools"])),
        "headline": headline(data["headline"]),
        "run": run(data),
    }


def duration(seconds: float | None) -> str:
    """Return a time with two or three digits in a suitable unit."""
    if seconds is None:
        return ""
    size, unit = next(((s, u) for s, u in UNITS if seconds >= 0.9995 * s), UNITS[-1])
    number = seconds / size
    return rf"{number:.2g}\,{unit}" if number < 99.5 else rf"{number:.0f}\,{unit}"


def factor(ratio: float | str) -> str:
    """Return a ratio with three digits, large ones as powers of ten."""
    value = float(ratio)
    if value != value:
        return ""
    return power(value) if value >= 1e3 else f"{value:.3g}"


def winners(data: Data, task: str) -> Iterator[dict[str, Any]]:
    """Yield the tables of fastest methods by test case: digits, arrays, single calls."""
    for case in data["cases"]:
        mine = [w for w in data["pareto"] if (w["task"], w["case"]) == (task, case["name"])]
        rows = []
        for digits in sorted({row["digits"] for row in mine}):
            by_kind = {w["kind"]: w for w in mine if w["digits"] == digits}
            cells = [cell for kind in KINDS for cell in winner_cells(by_kind.get(kind))]
            rows.append(" & ".join([str(digits), *cells]))
        yield {"name": escape(case["name"]), "rows": rows}


def winner_cells(winners: Data | None) -> tuple[str, str, str]:
    """Return the method with its ties, its time, and that time relative to the fastest."""
    if winners is None:
        return "", "", ""
    name = escape(", ".join(part for part in (winners["family"], winners["setting"]) if part))
    near_ties = set(winners["near_ties"])
    name += "?" if winners["family"] in near_ties else ""
    ties = [escape(t) + ("?" if t in near_ties else "") for t in winners["ties"]]
    ties += [escape(t) + "?" for t in winners["near_ties"] if t not in winners["ties"]]
    ties = [tie for tie in ties if tie.rstrip("?") != escape(winners["family"])]
    tied = rf" (tie: {', '.join(ties)})" if ties else ""
    return name + tied, duration(winners["seconds"]), factor(winners["relative"])


def error_rows(data: Data) -> Iterator[str]:
    """Yield the methods of the test case shown: digits by cause, set-up and times."""
    case = shown_case(data)
    for row in data["rows"]:
        if row["case"] != case or row["fails"] or not row["errors"]:
            continue
        errors = [digits(row["errors"][key]) for key in ("total", "truncation", "rounding")]
        times = [duration(row[key]["seconds"] if row[key] else None) for key in KINDS]
        cells = [TASKS[row["task"]], method_name(row), *errors, *times, duration(row["setup"])]
        yield " & ".join(cells)


def reasons(data: Data, key: Literal["unsplit", "remark"]) -> Iterator[str]:
    """Yield reasons why errors are not separated, or remarks, with families and test cases."""
    groups: dict[str, dict[str, dict[str, None]]] = {}
    for row in data["rows"]:
        reason = (row["errors"] or {}).get(key)
        if reason and not row["fails"]:
            places = groups.setdefault(reason, {}).setdefault(row["family"], {})
            places[row["case"]] = None
    for reason, families in groups.items():
        listed = [f"{family} ({', '.join(places)})" for family, places in families.items()]
        yield f"{prose(reason)}: {escape('; '.join(listed))}."


def method_name(row: Data) -> str:
    """Return family, setting and, unless it is double precision, arithmetic."""
    arithmetic = "" if row["arithmetic"] == "float64" else row["arithmetic"]
    parts = [row["family"], row["setting"], arithmetic]
    if row["setting"] and row["setting"] in arithmetic:
        parts.remove(row["setting"])
    return escape(", ".join(part for part in parts if part))


def digits(value: float | str | None) -> str:
    """Return digits to one decimal."""
    return "" if value is None else f"{float(value):.1f}"


def failures(rows: Sequence[Data]) -> Iterator[str]:
    """Yield failing methods: task, family, test case, settings, and the reason of the last."""
    groups: dict[tuple[str, str, str], list[Data]] = {}
    for row in rows:
        if row["fails"]:
            groups.setdefault((row["task"], row["family"], row["case"]), []).append(row)
    for (task, family, case), failed in groups.items():
        settings = "; ".join(dict.fromkeys(row["setting"] for row in failed if row["setting"]))
        cells = [TASKS[task], escape(family), escape(case), escape(settings)]
        yield " & ".join([*cells, prose(failed[-1]["fails"])])


def scaling_row(growth: Data) -> str:
    """Return the cells of a study: size, method, slope, end of the line, reason, memory."""
    deviates_at = "" if growth["deviates_at"] is None else factor(growth["deviates_at"])
    memory = growth["peak_bytes"]
    cells = [
        escape(growth["quantity"]), escape(growth["method"]),
        f"{growth['slope']:z.2f}", deviates_at,
        prose(growth["reason"]), "" if memory is None else rf"{memory / 1e6:.3g}",
    ]  # fmt: skip
    return " & ".join(cells)


def tool_rows(tools: Sequence[Data]) -> Iterator[str]:
    """Yield the rows of other programs; the limitation of each program is stated once."""
    said = ""
    for tool in tools:
        name = escape(f"{tool['name']} {tool['version']}".strip())
        if tool["missing"]:
            reason = tool["missing"].partition(":")[0]
            yield rf"{name} & \multicolumn{{5}}{{l}}{{{escape(reason)}}}"
            continue
        setting = re.sub(r"(?<=\d) \$x\$ (?=\d)", r" $\\times$ ", prose(tool["setting"]))
        cells = [prose(tool["problem"]), setting, power(tool["error"])]
        cells += [
            duration(tool["seconds"]),
            "" if tool["limitation"] == said else prose(tool["limitation"]),
        ]
        yield " & ".join(["" if tool["limitation"] == said else name, *cells])
        said = tool["limitation"]


def headline(winners: Data) -> dict[str, Any]:
    """Return the comparison of the generated law with direct summation as numbers."""
    best = winners["direct_sum"][-1]
    return {
        "radius": f"{1e3 * winners['contact_radius']:.2f}",
        "rows": [
            f"{r['digits']} & {power(r['modes'])} & {duration(r['seconds'])}"
            f" & {digits(r['truncation'])} & {digits(r['rounding'])}"
            for r in winners["direct_sum"]
        ],
        "best": best["digits"],
        "modes": power(best["modes"]),
        "seconds": duration(best["seconds"]),
        "reached": best["digits"] >= REQUIRED_DIGITS,
        "wanted": REQUIRED_DIGITS,
        "setup": duration(winners["setup"]),
        "per_mode": duration(winners["seconds_per_mode"]),
        "digits": digits(winners["digits"]),
        "called": duration(winners["seconds_with_setup"]),
        "prepared": duration(winners["seconds_without_setup"]),
        "ratio": power(best["seconds"] / winners["seconds_with_setup"]),
    }


def run(data: Data) -> dict[str, Any]:
    """Return how the measurement was made, and how much load the machine had."""
    busy = [s for s in data["sessions"] if s["contended"]]
    machine = data["run"]
    return {
        "quick": machine["quick"],
        "rounds": machine["rounds"],
        "slow": duration(SLOW_CALL),
        "sessions": len(data["sessions"]),
        "busy": len(busy),
        "limit": f"{machine['contended']:g}",
        "load": f"{machine['load_before']:.1f} to {machine['load_after']:.1f}",
        "processor": escape(data["machine"]["processor"]),
        "cores": data["machine"]["cores"],
        "digits": data["provenance"]["digits"],
    }
