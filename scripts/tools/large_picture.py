#!/usr/bin/python3
"""Draws docs/pictures/large_slope.png from what scripts/tools/large_slope.lua writes.

    build/release/talus scripts/tools/large_slope.lua [folder]
    xvfb-run -a /usr/bin/python3 scripts/tools/large_picture.py [folder [PICTURE]]

The blocks of the last frame, coloured by how far they have moved, with a legend, a scale in metres and an arrow to the
north (+y). Needs python3-vtk9; xvfb-run stands in for a screen."""
import json
import pathlib
import struct
import sys
import zlib

import vtk

WIDTH, HEIGHT = 1400, 860  # pixels
MOST = 3.0                 # m, displacement from which on the colour stays the same
LENGTH = 20                # m, of the scale
EYE, LOOK = (-112, -52, 78), (43, 39, 18)  # m
ROCK, INK = (0.83, 0.82, 0.79), (0.13, 0.13, 0.13)
COLOURS = ((0.0, ROCK), (0.02, (0.93, 0.88, 0.68)), (0.35, (0.96, 0.69, 0.32)), (0.7, (0.85, 0.30, 0.15)), (1.0, (0.48, 0.05, 0.16)))


def read(folder):
    series = json.loads((folder / "large_slope_blocks.vtk.series").read_text(encoding="ascii"))
    reader = vtk.vtkUnstructuredGridReader()
    reader.SetFileName(str(folder / series["files"][-1]["name"]))
    reader.ReadAllVectorsOn()
    reader.ReadAllScalarsOn()
    reader.Update()
    return reader.GetOutput()


def by_displacement(grid):
    """The mean displacement of its corners, as a length on the faces of each block."""
    cells = vtk.vtkPointDataToCellData()
    cells.SetInputData(grid)
    length = vtk.vtkArrayCalculator()
    length.SetInputConnection(cells.GetOutputPort())
    length.SetAttributeTypeToCellData()
    length.AddVectorArrayName("displacement")
    length.SetFunction("mag(displacement)")
    length.SetResultArrayName("moved")
    faces = vtk.vtkGeometryFilter()
    faces.SetInputConnection(length.GetOutputPort())
    faces.Update()
    return faces.GetOutput()


def table():
    colours = vtk.vtkLookupTable()
    colours.SetNumberOfTableValues(256)
    colours.SetTableRange(0, MOST)
    for i in range(256):
        share = i / 255
        k = next(k for k in range(1, len(COLOURS)) if share <= COLOURS[k][0])
        (low, one), (high, other) = COLOURS[k - 1], COLOURS[k]
        t = (share - low) / (high - low)
        colours.SetTableValue(i, *(a + t * (b - a) for a, b in zip(one, other)), 1)
    return colours


def surface(data, colours):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.SetScalarModeToUseCellFieldData()
    mapper.SelectColorArray("moved")
    mapper.SetLookupTable(colours)
    mapper.UseLookupTableScalarRangeOn()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    look = actor.GetProperty()
    look.SetInterpolationToFlat()
    look.SetAmbient(0.32)
    look.SetDiffuse(0.72)
    look.EdgeVisibilityOn()
    look.SetEdgeColor(0.25, 0.24, 0.23)
    look.SetLineWidth(0.8)
    return actor


def solid(source, colour, place=(0, 0, 0), turn=0):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(source.GetOutputPort())
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(colour)
    actor.GetProperty().LightingOff()
    actor.SetPosition(place)
    actor.RotateZ(turn)
    return actor


def words(renderer, text, place, size=26):
    label = vtk.vtkBillboardTextActor3D()
    label.SetInput(text)
    label.SetPosition(place)
    style = label.GetTextProperty()
    style.SetFontSize(size)
    style.SetColor(INK)
    style.SetJustificationToCentered()
    style.SetVerticalJustificationToCentered()
    renderer.AddActor(label)


def box(low, high):
    source = vtk.vtkCubeSource()
    source.SetBounds(low[0], high[0], low[1], high[1], low[2], high[2])
    return source


def scale(renderer, x, y, z):
    """A bar along y in four parts, on the ground before the slope."""
    for k in range(4):
        part = box((x - 0.6, y + k * LENGTH / 4, z), (x + 0.6, y + (k + 1) * LENGTH / 4, z + 0.3))
        renderer.AddActor(solid(part, INK if k % 2 == 0 else (1, 1, 1)))
    whole = box((x - 0.6, y, z), (x + 0.6, y + LENGTH, z + 0.3))
    frame = vtk.vtkOutlineFilter()
    frame.SetInputConnection(whole.GetOutputPort())
    renderer.AddActor(solid(frame, INK))
    words(renderer, "0", (x - 4, y + LENGTH, z))
    words(renderer, f"{LENGTH} m", (x - 4, y, z))


def north(renderer, x, y, z):
    arrow = vtk.vtkArrowSource()
    arrow.SetTipLength(0.4)
    arrow.SetTipRadius(0.13)
    arrow.SetShaftRadius(0.045)
    arrow.SetTipResolution(40)
    actor = solid(arrow, INK, (x, y, z), 90)
    actor.SetScale(14)
    renderer.AddActor(actor)
    words(renderer, "N", (x, y + 17.5, z), 30)


def legend(renderer, colours):
    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(colours)
    bar.SetNumberOfLabels(4)
    bar.SetLabelFormat("%.1f")
    bar.SetOrientationToHorizontal()
    bar.UnconstrainedFontSizeOn()
    title = vtk.vtkTextActor()
    title.SetInput("displacement (m)")
    title.SetPosition(0.025 * WIDTH, 0.1 * HEIGHT)
    for style, size in ((title.GetTextProperty(), 24), (bar.GetLabelTextProperty(), 22)):
        style.SetColor(INK)
        style.SetFontSize(size)
        style.BoldOff()
        style.ItalicOff()
        style.ShadowOff()
    renderer.AddActor2D(title)
    bar.SetPosition(0.025, 0.02)
    bar.SetWidth(0.27)
    bar.SetHeight(0.1)
    renderer.AddActor2D(bar)


def lights(renderer):
    for place, strength in (((-160, -40, 190), 0.95), ((-40, -200, 60), 0.35)):
        light = vtk.vtkLight()
        light.SetPosition(place)
        light.SetFocalPoint(LOOK)
        light.SetIntensity(strength)
        renderer.AddLight(light)


def write_png(path, shot):
    """With a palette of 256 colours, which vtkPNGWriter cannot write: a third of the size."""
    few = vtk.vtkImageQuantizeRGBToIndex()
    few.SetInputConnection(shot.GetOutputPort())
    few.SetNumberOfColors(256)
    few.Update()
    pixels, colours = few.GetOutput().GetPointData().GetScalars(), few.GetLookupTable()
    palette = bytes(round(255 * x) for i in range(256) for x in colours.GetTableValue(i)[:3])
    rows = b"".join(b"\0" + bytes(int(pixels.GetValue(y * WIDTH + x)) for x in range(WIDTH)) for y in reversed(range(HEIGHT)))

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    head = struct.pack(">IIBBBBB", WIDTH, HEIGHT, 8, 3, 0, 0, 0)
    pathlib.Path(path).write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"PLTE", palette) +
                                   chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    picture = sys.argv[2] if len(sys.argv) > 2 else "docs/pictures/large_slope.png"
    renderer, colours = vtk.vtkRenderer(), table()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(surface(by_displacement(read(folder)), colours))
    scale(renderer, 8, 22, 0)
    north(renderer, 6, 62, 0)
    legend(renderer, colours)
    lights(renderer)
    camera = renderer.GetActiveCamera()
    camera.SetPosition(EYE)
    camera.SetFocalPoint(LOOK)
    camera.SetViewUp(0, 0, 1)
    camera.SetViewAngle(26)
    renderer.ResetCameraClippingRange()
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(WIDTH, HEIGHT)
    window.AddRenderer(renderer)
    window.Render()
    shot = vtk.vtkWindowToImageFilter()
    shot.SetInput(window)
    shot.ReadFrontBufferOff()
    write_png(picture, shot)


if __name__ == "__main__":
    main()
