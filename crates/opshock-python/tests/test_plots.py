"""What the pictures draw: the numbers of the tables."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import opshock
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.container import ErrorbarContainer


@pytest.fixture(autouse=True)
def closed_figures() -> Iterator[None]:
    """Leaves no figure behind."""
    yield
    plt.close("all")


def bars(axes: Axes) -> list[Any]:
    """The lines with error bars of a picture."""
    return [one for one in axes.containers if isinstance(one, ErrorbarContainer)]


def data(line: Any) -> list[tuple[float, float]]:
    """Points of a line."""
    return list(zip(np.asarray(line.get_xdata()).tolist(), np.asarray(line.get_ydata()).tolist(), strict=True))


def test_critical_shocks(store: opshock.Store) -> None:
    """A line for each ramp model, whose points are the rows."""
    axes = store.plot()
    drawn = {bar.get_label(): bar for bar in bars(axes)}
    assert set(drawn) == {"none, +", "rigid, +"}
    for ramp in ("none", "rigid"):
        line = drawn[f"{ramp}, +"].lines[0]
        assert data(line) == [(row.pulse_ms, row.a_crit_g) for row in store.select(ramp=ramp)]
        assert line.get_linestyle() == "-"
    assert (axes.get_xlabel(), axes.get_ylabel(), axes.get_title()) == ("pulse width (ms)", "critical shock (G)", "small")
    assert axes.get_ylim()[0] == 0
    legend = axes.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == ["none, +", "rigid, +"]
    assert [to_hex(drawn[name].lines[0].get_color()) for name in ("none, +", "rigid, +")] == ["#1a1a1a", "#0072b2"]


def test_error_bars_are_the_intervals(uncertain: opshock.Store) -> None:
    """Both ends of every bar; negative shocks are dashed, in the colour of the positive ones."""
    drawn = bars(uncertain.plot())
    assert [bar.get_label() for bar in drawn] == ["none, +", "none, -"]
    for bar in drawn:
        row = uncertain.select(sign=str(bar.get_label())[-1])[0]
        assert row.interval_g is not None
        ends = bar.lines[2][0].get_segments()[0][:, 1]
        assert ends == pytest.approx(row.interval_g, rel=1e-12)
    positive, negative = (bar.lines[0] for bar in drawn)
    assert (positive.get_linestyle(), negative.get_linestyle()) == ("-", "--")
    assert positive.get_color() == negative.get_color()


def test_axes_of_your_own(store: opshock.Store, survived: opshock.Run) -> None:
    """Pictures are drawn into the axes given, which come back; no figure is made."""
    figure, (left, right) = plt.subplots(1, 2)
    assert store.plot(left) is left
    assert survived.history is not None
    assert survived.history.plot(right) is right
    assert plt.get_fignums() == [figure.number]
    assert len(bars(left)) == 2
    assert len(right.lines) == 4


def test_a_history(survived: opshock.Run) -> None:
    """Displacements in µm over ms on the left, clearance in nm on the right."""
    history = survived.history
    assert history is not None
    axes = history.plot()
    names = {
        "disk under the slider": "disk_slider_m",
        "disk at the ramp": "disk_ramp_m",
        "upper arm": "ramp_top_m",
        "lower arm": "ramp_bottom_m",
    }
    assert [line.get_label() for line in axes.lines] == list(names)
    for line in axes.lines:
        column = history[names[str(line.get_label())]]
        assert np.array_equal(np.asarray(line.get_xdata()), 1e3 * history["time_s"])
        assert np.array_equal(np.asarray(line.get_ydata()), 1e6 * column)
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("time (ms)", "displacement (µm)")
    figure = axes.figure
    right = next(one for one in figure.axes if one is not axes)
    assert right.get_ylabel() == "clearance (nm)"
    assert np.array_equal(np.asarray(right.lines[0].get_xdata()), 1e3 * history["time_s"])
    assert np.array_equal(np.asarray(right.lines[0].get_ydata()), 1e9 * history["min_clearance_m"])
    legend = axes.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == [*names, "smallest clearance (right)"]


def test_a_history_without_a_head(study: opshock.Study) -> None:
    """No clearance, no axis on the right."""
    scene = study.scene(ramp="none", pulse_ms=2, settings={"outputs": ["disk_displacement"]})
    history = opshock.simulate(scene, 300, history=True).history
    assert history is not None
    axes = history.plot()
    assert len(axes.figure.axes) == 1
    assert len(axes.lines) == 4


def test_tables_for_notebooks(store: opshock.Store, study: opshock.Study, survived: opshock.Run) -> None:
    """Every row, with its numbers to six digits."""
    html = store._repr_html_()
    assert html.count("<tr>") == 1 + len(store)
    assert all(f">{row.a_crit_g:.6g}<" in html for row in store)
    assert html.count(">ok<") == len(store)
    assert study._repr_html_().count(">rigid<") == 2
    assert ">survives<" in survived._repr_html_()
    assert f">{survived.min_clearance_m:.6g}<" in survived._repr_html_()
    assert f">{store[0].failed_g:.6g}<" in store[0]._repr_html_()
