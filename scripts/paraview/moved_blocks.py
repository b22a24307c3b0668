"""Shows only the blocks that have moved, and the others as a faint outline.

A block counts as moved from a thousandth of a usual block's size on. Select the blocks of a run, then Macros, moved_blocks; the limit
can be changed afterwards in the filter's properties.
"""
from paraview.simple import (Calculator, ColorBy, FetchData, GetActiveSource, GetActiveViewOrCreate, GetDisplayProperties, Render,
                             SetActiveSource, Show, Threshold)


def limit_of(blocks):
    volume = FetchData(blocks)[0].GetCellData().GetArray("volume")
    volumes = sorted(volume.GetValue(i) for i in range(volume.GetNumberOfTuples()))
    return volumes[len(volumes) // 2] ** (1 / 3) / 1000 if volumes else 0.0


def show_moved(blocks, view):
    length = Calculator(registrationName="length of displacement", Input=blocks)
    length.AttributeType = "Cell Data"
    length.ResultArrayName = "moved"
    length.Function = "mag(displacement)"
    moved = Threshold(registrationName="moved blocks", Input=length)
    moved.Scalars = ["CELLS", "moved"]
    moved.ThresholdMethod = "Above Upper Threshold"
    moved.UpperThreshold = limit_of(blocks)
    ColorBy(Show(moved, view), ("POINTS", "displacement", "Magnitude"))
    still = GetDisplayProperties(blocks, view=view)
    still.Representation = "Surface"
    still.Opacity = 0.12
    SetActiveSource(moved)
    return moved


if __name__ == "__main__" or __name__ == "__vtkconsole__":
    view = GetActiveViewOrCreate("RenderView")
    show_moved(GetActiveSource(), view)
    Render(view)
