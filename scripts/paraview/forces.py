"""Draws the forces of contacts as arrows: the force on the block of the higher id, normal and shear together.

The longest arrow is as long as a fifth of the model. Select the contacts of a run (run_contacts.vtk.series), then Macros, forces.
"""
from paraview.simple import Calculator, ColorBy, GetActiveSource, GetActiveViewOrCreate, Glyph, Render, Show


def draw(contacts, view):
    force = Calculator(registrationName="force", Input=contacts)
    force.AttributeType = "Point Data"
    force.ResultArrayName = "force"
    force.Function = "normal_force*normal+shear_force"
    force.UpdatePipeline()
    largest = force.PointData["force"].GetRange(-1)[1] if force.PointData["force"] else 0.0
    bounds = force.GetDataInformation().GetBounds()
    size = max(bounds[2 * k + 1] - bounds[2 * k] for k in range(3))
    arrows = Glyph(registrationName="forces", Input=force, GlyphType="Arrow")
    arrows.OrientationArray = ["POINTS", "force"]
    arrows.ScaleArray = ["POINTS", "force"]
    arrows.GlyphMode = "All Points"
    arrows.ScaleFactor = 0.2 * size / max(largest, 1e-300)
    shown = Show(arrows, view)
    ColorBy(shown, ("POINTS", "force", "Magnitude"))
    shown.RescaleTransferFunctionToDataRange(True, False)
    shown.SetScalarBarVisibility(view, True)
    return arrows


if __name__ == "__main__" or __name__ == "__vtkconsole__":
    view = GetActiveViewOrCreate("RenderView")
    draw(GetActiveSource(), view)
    Render(view)
