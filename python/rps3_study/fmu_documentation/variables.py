"""The variables of a model description in groups, equal ones of the three limbs or axes in one row."""

from __future__ import annotations

import html
import re
from collections.abc import Iterable, Sequence

from fmpy.model_description import ScalarVariable

GROUPS: dict[str, list[tuple[str, str, str]]] = {
    "Rps3Plant": [
        ("Inputs: motors", "input", r"v_"),
        ("Inputs: external load", "input", r"[fm]_ext_"),
        ("Outputs: generalized coordinates", "output", r"(heave|tilt)"),
        ("Outputs: limbs", "output", r"(d|theta)\d"),
        ("Outputs: motor currents", "output", r"i_"),
        ("Outputs: platform, base frame", "output", r"[pvawq]_[wxyz]$"),
        ("Outputs: joint forces", "output", r"f_"),
        ("Outputs: singularity and energy", "output", r"(sigma_min|det_a|power_electric|energy)"),
        ("Derivatives of the states", "local", r""),
    ],
    "Rps3Controller": [
        ("Inputs: measurements", "input", r"(d\d|theta|i_|a_)"),
        ("Inputs: external reference", "input", r"ref_"),
        ("Outputs: motor voltages", "output", r"v_"),
        ("Outputs: damping and stability", "output", r"(rho|delta_hd|lambda_f|sigma_min|lyapunov)"),
        ("Outputs: estimate, reference, errors", "output", r"(heave|tilt|err)_"),
        ("Outputs: diagnostics", "output", r"(mpso|saturated|in_singular|sensor_fault)"),
        (
            "Parameters: control law",
            "parameter",
            r"(control_mode|sample_time|k_|computation_delay|filter_time|.*_fixed$)",
        ),
        (
            "Parameters: swarm and fitness",
            "parameter",
            r"(swarm|max_iter|stall_iter|c\d$|inertia_m|decay|regulating|velocity_l|seed|(rho|delta_hd|lambda_f)_max|horizon|weight)",
        ),
        ("Parameters: reference", "parameter", r"(reference_mode|profile|move_time|(start|via|end)_)"),
        ("Parameters: sensors", "parameter", r"sensor_"),
    ],
}
"""Title, causality and beginning of the names of each group; a variable belongs to the first that fits."""
SHARED = [
    ("Parameters: geometry", "parameter", r"(base_radius|joint_spacing|plate_radius)"),
    ("Parameters: masses and inertias", "parameter", r"(plate|lower|upper)_|gravity"),
    ("Parameters: motors and drives", "parameter", r"(screw|gear|motor|v_max|revolute_motors)"),
    ("Parameters: end stops", "parameter", r"(d|theta)_m|stop_"),
    ("Parameters: start", "parameter", r".*_start$"),
    ("Parameters: solver", "parameter", r"(relative_tolerance|max_step)"),
    ("Time", "independent", r""),
]
"""Groups of either FMU."""


def grouped(identifier: str, variables: Iterable[ScalarVariable]) -> dict[str, list[ScalarVariable]]:
    """All variables by the titles of their groups.

    Raises:
        LookupError: a variable fits none.
    """
    rules = GROUPS[identifier] + SHARED
    groups: dict[str, list[ScalarVariable]] = {title: [] for title, _, _ in rules}
    for variable in variables:
        fits = (
            title
            for title, causality, names in rules
            if variable.causality == causality and re.match(names, variable.name)
        )
        title = next(fits, None)
        if title is None:
            raise LookupError(f"{variable.name} of {identifier} belongs to no group of its documentation")
        groups[title].append(variable)
    return {title: members for title, members in groups.items() if members}


def tables(identifier: str, variables: Iterable[ScalarVariable]) -> str:
    """The groups as HTML tables."""
    groups = grouped(identifier, variables)
    return "\n".join(f"<h3>{title}</h3>\n{_table(members)}" for title, members in groups.items())


def _table(variables: Sequence[ScalarVariable]) -> str:
    families: dict[tuple[str, ...], list[str]] = {}
    for variable in variables:
        families.setdefault(_family(variable), []).append(variable.name)
    rows = []
    for (_, unit, start, limits, kind, text), names in families.items():
        cells = ", ".join(f"<code>{html.escape(name)}</code>" for name in names)
        others = "".join(f"<td>{html.escape(cell)}</td>" for cell in (unit, start, limits, kind, text))
        rows.append(f"<tr><td>{cells}</td>{others}</tr>")
    head = "".join(f"<th>{cell}</th>" for cell in ("name", "unit", "start", "range", "type", "meaning"))
    return f"<table><thead><tr>{head}</tr></thead><tbody>\n" + "\n".join(rows) + "\n</tbody></table>"


def _family(variable: ScalarVariable) -> tuple[str, ...]:
    """What the variables of one row have in common: the name without limb and axis, and all other columns."""
    unit = variable.unit or ("" if variable.type != "Real" else "1")
    text = variable.description or ""
    low, high = variable.min, variable.max
    limits = "" if low is None and high is None else f"{low or '-∞'} … {high or '∞'}"
    kind = (
        variable.type if variable.variability in ("continuous", "fixed") else f"{variable.type}, {variable.variability}"
    )
    text = re.sub(r"\blimb [123]\b", "limb i", text)
    text = re.sub(r", [wxyz] component\b", "", text)
    name = re.sub(r"_[wxyz]$", "", re.sub(r"\d", "", variable.name))
    return name, unit, variable.start or "", limits, kind, text
