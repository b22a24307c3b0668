"""Renders the pictures of docs/examples.md with ParaView from the files the examples write.

    build/release/talus scripts/examples/tunnel.lua
    xvfb-run -a pvpython scripts/tools/render.py tunnel [folder]

The first word is the example (fig2, tunnel or slope), read from out/EXAMPLE; the pictures go to
the folder, docs/pictures unless given. Each shows the last frame of the run. In tunnel and slope,
blocks that have moved by more than MOVED are red and the others coloured by body; fig2, where most
blocks move, is coloured by displacement. An arrow of a section leads from where the middle of a
moved block was to where it is. Needs ParaView 5.11 or later, which nothing else does; xvfb-run
stands in for a screen.
"""
import sys

from paraview import simple

WIDTH = 1000  # pixels
MOVED = 0.05   # m, the displacement that identifies a failure in the examples
RED = [0.84, 0.22, 0.16]
PALE_RED = [0.96, 0.66, 0.58]
BLUE = [0.1, 0.1, 0.45]
EDGE = [0.15, 0.15, 0.15]
# Light colours for the rock, so that edges, arrows and red stand out. Ids count through them.
ROCK = [
    (0.80, 0.82, 0.85), (0.70, 0.78, 0.86), (0.86, 0.82, 0.72), (0.74, 0.83, 0.75),
    (0.88, 0.77, 0.72), (0.78, 0.74, 0.84), (0.69, 0.81, 0.82), (0.84, 0.84, 0.78),
]

# Lengths in m. `eye`, `look`: the camera of the blocks and the point it looks at; `angle`: how much
# of the view it takes in, in degrees; `front`: the rock at smaller y is left away, to see what lies
# behind; `scale`: the displacement from which on a block is fully red, for a colouring by
# displacement; `section`: lowest and highest x and z in the picture of the section, if any.
EXAMPLES = {
    "fig2": {"eye": (-5.2, -4.6, 3.4), "look": (0.05, -0.1, -0.2), "angle": 27.5, "scale": 0.5},
    "tunnel": {"eye": (-3.5, -20, -3.5), "look": (0, 0, -0.5), "angle": 53, "front": -2.5,
               "section": (-8.5, 8.5, -8.5, 8.5)},
    "slope": {"eye": (-50, -40, 62), "look": (28, 19.5, 9), "angle": 33,
              "section": (-1, 61, -1, 30)},
}


def last_frame(example, kind):
    """The last frame of a series, with the length of the displacement on cells as `moved`."""
    with open(f"out/{example}/{example}_{kind}.vtk.series", encoding="ascii") as series:
        name = series.read().rsplit('"name"', 1)[1].split('"')[1]
    source = simple.LegacyVTKReader(FileNames=[f"out/{example}/{name}"])
    if kind == "blocks":
        source = simple.PointDatatoCellData(Input=source, ProcessAllArrays=1, PassPointData=1)
    return simple.Calculator(Input=source, AttributeType="Cell Data", ResultArrayName="moved",
                             Function="mag(displacement)")


def part(source, moved):
    """The cells that have moved, or those that have not."""
    return simple.Threshold(Input=source, Scalars=["CELLS", "moved"],
                            ThresholdMethod="Above Upper Threshold" if moved
                            else "Below Lower Threshold",
                            LowerThreshold=MOVED, UpperThreshold=MOVED)


def show(source, view):
    """Shows faces with edges, with enough light on those turned away."""
    shown = simple.Show(source, view)
    shown.SetRepresentationType("Surface With Edges")
    shown.EdgeColor = EDGE
    shown.LineWidth = 1.5
    shown.Ambient, shown.Diffuse = 0.5, 0.55
    return shown


def in_one_colour(shown, colour):
    simple.ColorBy(shown, None)
    shown.DiffuseColor = shown.AmbientColor = colour


def by_body(shown, source, view):
    """Colours the bodies in the order of their ids, so that few share a colour."""
    simple.ColorBy(shown, ("CELLS", "body"))
    ids = simple.servermanager.Fetch(source).GetCellData().GetArray("body")
    bodies = sorted({int(ids.GetTuple1(i)) for i in range(ids.GetNumberOfTuples())})
    table = simple.GetColorTransferFunction("body")
    table.InterpretValuesAsCategories = 1
    table.Annotations = [text for body in bodies for text in (str(body), str(body))]
    table.IndexedColors = [c for i in range(len(bodies)) for c in ROCK[i % len(ROCK)]]
    shown.SetScalarBarVisibility(view, False)


def by_displacement(shown, scale, view):
    simple.ColorBy(shown, ("CELLS", "moved"))
    table = simple.GetColorTransferFunction("moved")
    table.ColorSpace = "Lab"
    table.RGBPoints = [0, *ROCK[0], scale / 2, 0.96, 0.76, 0.42, scale, *RED]
    bar = simple.GetScalarBar(table, view)
    bar.Title, bar.ComponentTitle = "displacement (m)", ""
    bar.TitleColor = bar.LabelColor = EDGE
    bar.AutomaticLabelFormat, bar.LabelFormat, bar.AddRangeLabels = 0, "%.1f", 0
    bar.UseCustomLabels, bar.CustomLabels = 1, [scale * i / 5 for i in range(6)]
    bar.WindowLocation, bar.Position = "Any Location", [0.89, 0.3]
    shown.SetScalarBarVisibility(view, True)


def new_view(height):
    view = simple.CreateView("RenderView")
    view.ViewSize = [WIDTH, height]
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    view.CameraViewUp = [0, 0, 1]
    return view


def save(view, name):
    simple.SaveScreenshot(name, view, ImageResolution=list(view.ViewSize), CompressionLevel="9")
    print(name)


def picture_of_blocks(example, name):
    how = EXAMPLES[example]
    view = new_view(800)
    blocks = last_frame(example, "blocks")
    if "scale" in how:
        surface = simple.ExtractSurface(Input=blocks)
        by_displacement(show(surface, view), how["scale"], view)
    else:
        rest = part(blocks, False)
        if "front" in how:
            rest = simple.Clip(Input=rest, ClipType="Plane", Invert=0)
            rest.ClipType.Origin = [0, how["front"], 0]
            rest.ClipType.Normal = [0, 1, 0]
        surface = simple.ExtractSurface(Input=rest)
        by_body(show(surface, view), surface, view)
        in_one_colour(show(simple.ExtractSurface(Input=part(blocks, True)), view), RED)
    view.CameraPosition, view.CameraFocalPoint = how["eye"], how["look"]
    view.CameraViewAngle = how["angle"]
    save(view, name)


def picture_of_section(example, name):
    """The section, which lies from west to east, as seen from the south."""
    west, east, low, high = EXAMPLES[example]["section"]
    view = new_view(round(WIDTH * (high - low) / (east - west)))
    section = last_frame(example, "section")
    moved, rest = part(section, True), part(section, False)
    by_body(show(rest, view), rest, view)
    in_one_colour(show(moved, view), PALE_RED)
    # The middles as they were: the coordinates hold the motion.
    middles = simple.WarpByVector(Input=simple.CellCenters(Input=moved),
                                  Vectors=["POINTS", "displacement_in_plane"], ScaleFactor=-1)
    arrows = simple.Glyph(Input=middles, GlyphType="Arrow", GlyphMode="All Points",
                          OrientationArray=["POINTS", "displacement_in_plane"],
                          ScaleArray=["POINTS", "displacement_in_plane"])
    arrows.ScaleFactor = 1  # afterwards: ParaView chooses a factor when it is given the array
    arrows.GlyphType.ShaftRadius, arrows.GlyphType.TipRadius = 0.025, 0.075
    arrows.GlyphType.ShaftResolution = arrows.GlyphType.TipResolution = 24
    arrows.GlyphType.TipLength = 0.25
    in_one_colour(simple.Show(arrows, view), BLUE)
    x, z = (west + east) / 2, (low + high) / 2
    y = section.GetDataInformation().GetBounds()[2]
    view.CameraParallelProjection = 1
    view.CameraParallelScale = (high - low) / 2
    view.CameraPosition, view.CameraFocalPoint = [x, y - 100, z], [x, y, z]
    save(view, name)


def main():
    if len(sys.argv) < 2 or sys.argv[1] not in EXAMPLES:
        sys.exit(f"usage: pvpython render.py {'|'.join(EXAMPLES)} [folder]")
    example = sys.argv[1]
    folder = sys.argv[2] if len(sys.argv) > 2 else "docs/pictures"
    simple._DisableFirstRenderCameraReset()
    picture_of_blocks(example, f"{folder}/{example}.png")
    if "section" in EXAMPLES[example]:
        picture_of_section(example, f"{folder}/{example}_section.png")


main()
