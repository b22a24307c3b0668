"""Colours blocks by displacement, on one scale for all times.

ParaView fixes a scale where it first sees an array: at the first frame, where every displacement is 0. All that moves by a micrometre
is then as dark as what falls. This macro takes the scale from all times, from 0 to the largest displacement, at least a thousandth of a
usual block's size, so that what settles stays pale.

Select the blocks of a run (run_blocks.vtk.series), then Macros, displacement.
"""
from paraview.simple import (ColorBy, FetchData, GetActiveSource, GetActiveViewOrCreate, GetColorTransferFunction, GetDisplayProperties,
                             Render, UpdatePipeline)


def largest(blocks, time):
    """Length of the longest displacement, and the third power of the median volume's root, at a time."""
    UpdatePipeline(time=time, proxy=blocks)
    cells = FetchData(blocks)[0].GetCellData()
    moved, volume = cells.GetArray("displacement"), cells.GetArray("volume")
    count = moved.GetNumberOfTuples()
    lengths = [sum(x * x for x in moved.GetTuple(i)) ** 0.5 for i in range(count)]
    volumes = sorted(volume.GetValue(i) for i in range(count))
    return max(lengths, default=0.0), volumes[count // 2] ** (1 / 3) if count else 0.0


def colour(blocks, view):
    times = getattr(blocks, "TimestepValues", None) or [0.0]
    times = list(times) if hasattr(times, "__iter__") else [times]
    found = [largest(blocks, time) for time in times]
    high = max(max(move, size / 1000) for move, size in found) or 1.0
    shown = GetDisplayProperties(blocks, view=view)
    ColorBy(shown, ("POINTS", "displacement", "Magnitude"))
    table = GetColorTransferFunction("displacement")
    table.AutomaticRescaleRangeMode = "Never"
    table.RGBPoints = [0.0, 0.85, 0.85, 0.85, 0.4 * high, 0.89, 0.62, 0.25, 0.75 * high, 0.79, 0.24, 0.16, high, 0.42, 0.0, 0.11]
    table.ColorSpace = "Lab"
    shown.SetScalarBarVisibility(view, True)
    shown.Representation = "Surface With Edges"
    return high


if __name__ == "__main__" or __name__ == "__vtkconsole__":
    view = GetActiveViewOrCreate("RenderView")
    time = view.ViewTime
    colour(GetActiveSource(), view)
    view.ViewTime = time
    Render(view)
