"""Makes the pictures of docs/paraview.md with the macros beside this file, and checks what they show.

    pvpython pictures.py RUN FOLDER

RUN is the prefix of a run's files (out/slope); FOLDER gets paraview_NAME.png. Each has a scale in metres, axes and the time.
"""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import displacement  # noqa: E402
import exploded_view  # noqa: E402
import forces  # noqa: E402
import joints_by_state  # noqa: E402
import moved_blocks  # noqa: E402
from paraview.simple import (AnnotateTimeFilter, CreateRenderView, GetAnimationScene, GetColorTransferFunction,  # noqa: E402
                             GetDisplayProperties, GetScalarBar, Hide, OpenDataFile, Render, SaveScreenshot, SetActiveView, Show)


SIZE = [1000, 640]
BACKGROUND = [1.0, 1.0, 1.0]


def check(holds, sentence):
    if not holds:
        sys.exit(f"pictures.py: {sentence}")


class Scene:
    """One view of a run, at its last time."""

    def __init__(self, run, folder):
        self.run, self.folder = run, folder
        self.view = CreateRenderView()
        self.view.ViewSize = SIZE
        self.view.UseColorPaletteForBackground = 0
        self.view.Background = BACKGROUND
        self.view.OrientationAxesLabelColor = [0.0, 0.0, 0.0]
        self.view.AxesGrid.Visibility = 1
        for axis in "XYZ":
            title = {"X": "east, m", "Y": "north, m", "Z": "up, m"}[axis]
            setattr(self.view.AxesGrid, f"{axis}Title", title)
            for part in ("Title", "Label"):
                setattr(self.view.AxesGrid, f"{axis}{part}Color", [0.2, 0.2, 0.2])
        self.view.AxesGrid.GridColor = [0.6, 0.6, 0.6]
        SetActiveView(self.view)
        self.shown = []

    def open(self, content):
        source = OpenDataFile(f"{self.run}_{content}.vtk.series")
        check(source is not None, f"{self.run}_{content}.vtk.series cannot be opened")
        self.show(source)
        return source

    def show(self, source):
        Show(source, self.view)
        self.shown.append(source)

    def clear(self):
        for source in self.shown:
            Hide(source, self.view)
        self.shown = []

    def last(self, source):
        """Shows the last time, and tells which it is."""
        scene = GetAnimationScene()
        scene.UpdateAnimationUsingDataTimeSteps()
        scene.GoToLast()
        time = AnnotateTimeFilter(Input=source, Format="{time:.2f} s")
        label = Show(time, self.view)
        label.Color = [0.1, 0.1, 0.1]
        label.WindowLocation = "Upper Left Corner"
        self.shown.append(time)

    def legend(self, array, shown):
        """The colours of an array, in dark letters, or none."""
        bar = GetScalarBar(GetColorTransferFunction(array), self.view)
        bar.Visibility = int(shown)
        bar.TitleColor = bar.LabelColor = [0.1, 0.1, 0.1]

    def save(self, name):
        camera = self.view.GetActiveCamera()
        camera.SetPosition(-60.0, -80.0, 75.0)
        camera.SetFocalPoint(0.0, 0.0, 0.0)
        camera.SetViewUp(0.0, 0.0, 1.0)
        self.view.ResetCamera()
        Render(self.view)
        path = self.folder / f"paraview_{name}.png"
        SaveScreenshot(str(path), self.view)
        check(path.stat().st_size > 10000, f"{path} is empty")
        print(f"{path.name}: {path.stat().st_size} bytes", flush=True)


def main(run, folder):
    scene = Scene(run, pathlib.Path(folder))
    blocks = scene.open("blocks")
    times = list(blocks.TimestepValues)
    check(len(times) > 1 and times == sorted(set(times)), f"times {times} do not ascend")
    scene.last(blocks)
    high = displacement.colour(blocks, scene.view)
    check(math.isfinite(high) and high > 0, f"the scale ends at {high}")
    scene.legend("displacement", True)
    scene.save("displacement")
    moved = moved_blocks.show_moved(blocks, scene.view)
    scene.shown.append(moved)
    count, cells = moved.GetDataInformation().GetNumberOfCells(), blocks.GetDataInformation().GetNumberOfCells()
    check(0 < count < cells, f"{count} of {cells} blocks have moved")
    scene.save("moved")

    scene.clear()
    joints = scene.open("joints")
    scene.last(joints)
    joints_by_state.colour(joints, scene.view)
    scene.legend("displacement", False)
    scene.legend("state", True)
    scene.save("joints")

    contacts = scene.open("contacts")
    scene.last(contacts)
    GetDisplayProperties(joints, view=scene.view).Opacity = 0.15
    arrows = forces.draw(contacts, scene.view)
    check(arrows.GetDataInformation().GetNumberOfPoints() > 0, "no arrows")
    scene.shown.append(arrows)
    scene.legend("state", False)
    scene.legend("force", True)
    scene.save("forces")

    scene.clear()
    GetDisplayProperties(blocks, view=scene.view).Opacity = 1.0
    scene.show(blocks)
    scene.last(blocks)
    apart = exploded_view.explode(blocks, scene.view)
    low, far = blocks.GetDataInformation().GetBounds(), apart.GetDataInformation().GetBounds()
    check(all(far[2 * k + 1] - far[2 * k] > 1.05 * (low[2 * k + 1] - low[2 * k]) for k in range(3)), "the blocks are not apart")
    displacement.colour(apart, scene.view)
    scene.legend("force", False)
    scene.legend("displacement", True)
    scene.save("exploded")


if __name__ == "__main__":
    main(*sys.argv[1:])
