"""Colours joints by what happens on them: elastic, slipping, open, failed, or without contact.

Select the joints of a run (run_joints.vtk.series), then Macros, joints_by_state. The colours can be told apart by colour-blind people.
"""
from paraview.simple import ColorBy, GetActiveSource, GetActiveViewOrCreate, GetColorTransferFunction, GetDisplayProperties, Render

# Number in the array `state`, its name, and its colour (Okabe and Ito).
STATES = (
    (0, "elastic", (0.80, 0.80, 0.80)),
    (1, "slipping", (0.84, 0.37, 0.00)),
    (2, "open", (0.34, 0.71, 0.91)),
    (3, "failed", (0.80, 0.47, 0.65)),
    (4, "no contact", (0.95, 0.90, 0.60)),
)


def colour(joints, view):
    shown = GetDisplayProperties(joints, view=view)
    ColorBy(shown, ("CELLS", "state"))
    table = GetColorTransferFunction("state")
    table.InterpretValuesAsCategories = 1
    table.Annotations = [text for number, name, _ in STATES for text in (str(number), name)]
    table.IndexedColors = [part for _, _, colour in STATES for part in colour]
    shown.SetScalarBarVisibility(view, True)
    shown.Representation = "Surface With Edges"


if __name__ == "__main__" or __name__ == "__vtkconsole__":
    view = GetActiveViewOrCreate("RenderView")
    colour(GetActiveSource(), view)
    Render(view)
