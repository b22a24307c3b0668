"""Takes the blocks apart: each moves away from the model's centre by a fifth of its distance, without being deformed.

Select the blocks of a run, then Macros, exploded_view; the filter's Scale Factor says how far.
"""
from paraview.simple import GetActiveSource, GetActiveViewOrCreate, Hide, Render, Show, WarpByVector


def explode(blocks, view):
    apart = WarpByVector(registrationName="exploded", Input=blocks)
    apart.Vectors = ["POINTS", "explode"]
    apart.ScaleFactor = 0.2
    Hide(blocks, view)
    Show(apart, view).Representation = "Surface With Edges"
    return apart


if __name__ == "__main__" or __name__ == "__vtkconsole__":
    view = GetActiveViewOrCreate("RenderView")
    explode(GetActiveSource(), view)
    Render(view)
