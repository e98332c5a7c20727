"""Pictures in the style of the report, with matplotlib."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._run import Array
    from ._store import Store

# Okabe and Ito's colours, in the report's order: told apart by colour-blind readers and in grey print.
COLOURS = ("#1a1a1a", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00")


def _axes(axes: Axes | None) -> Axes:
    if axes is None:
        import matplotlib.pyplot as plt

        axes = plt.subplots(figsize=(6.4, 4.0), layout="constrained")[1]
    axes.grid(color="#e4e4e4", linewidth=0.8)
    axes.set_axisbelow(True)
    return axes


def plot_critical_shocks(store: Store, axes: Axes | None) -> Axes:
    """Critical shocks over the pulse width: a colour for each ramp model and further axis, dashed for negative shocks."""
    axes = _axes(axes)
    lines: dict[str, dict[str, list[tuple[float, float, float]]]] = {}
    for row in store:
        if row.a_crit_g is not None:
            name = ", ".join([row.ramp, *(f"{key} = {value}" for key, value in row.axes.items())])
            marks = lines.setdefault(name, {}).setdefault(row.sign, [])
            marks.append((row.pulse_ms, row.a_crit_g, row.uncertainty_g or 0.0))
    for number, (name, signs) in enumerate(lines.items()):
        colour = COLOURS[number % len(COLOURS)]
        for sign, marks in sorted(signs.items()):
            x, y, half = zip(*sorted(marks), strict=True)
            drawn = axes.errorbar(x, y, yerr=half, capsize=3, color=colour, marker="o", label=f"{name}, {sign}")
            if sign == "-" and drawn.lines[0] is not None:
                drawn.lines[0].set(linestyle="--", marker="s", markerfacecolor="white")
    axes.set(xlabel="pulse width (ms)", ylabel="critical shock (G)", title=store.name)
    axes.set_ylim(bottom=0)
    if lines:
        axes.legend(frameon=False)
    return axes


def plot_history(history: Mapping[str, Array], axes: Axes | None) -> Axes:
    """Displacements of disk and ramp on the left, clearance of the slider on the right."""
    axes = _axes(axes)
    time_ms = 1e3 * history["time_s"]
    names = {
        "disk_slider_m": "disk under the slider",
        "disk_ramp_m": "disk at the ramp",
        "ramp_top_m": "upper arm",
        "ramp_bottom_m": "lower arm",
    }
    for number, (name, words) in enumerate(names.items()):
        axes.plot(time_ms, 1e6 * history[name], color=COLOURS[number], label=words)
    axes.set(xlabel="time (ms)", ylabel="displacement (µm)")
    handles, labels = axes.get_legend_handles_labels()
    if "min_clearance_m" in history:
        right = axes.twinx()
        handles += right.plot(time_ms, 1e9 * history["min_clearance_m"], color=COLOURS[6], linestyle=":")
        labels.append("smallest clearance (right)")
        right.set_ylabel("clearance (nm)")
    axes.legend(handles, labels, frameon=False)
    return axes
