# SPDX-License-Identifier: GPL-2.0-or-later
# A view of the fields that lie beside this file, over the mesh cycle: of gears von Mises stress in both
# bodies and contact pressure on the flanks, of the double-roller drive the force on each part and the
# pressure on its surface.
#   paraview --script=view.py        or        pvbatch view.py picture.png
import glob
import inspect
import os
import sys

from paraview.simple import *

here = os.path.dirname(os.path.abspath(inspect.getfile(inspect.currentframe())))


def series(what):
    """The series of the greatest torque."""
    files = glob.glob(os.path.join(here, what + "_*Nm.pvd"))
    return max(files, key=lambda name: float(name.rsplit("_", 1)[1][: -len("Nm.pvd")]), default=None)


view = GetActiveViewOrCreate("RenderView")
view.ViewSize = [1600, 1000]
view.Background = [0.2, 0.2, 0.2]
view.UseColorPaletteForBackground = 0
view.OrientationAxesVisibility = 0


def show(name, array, title, part, preset, place):
    """Opens a series, coloured by an array from 0 to a part of its greatest value over the series."""
    source = OpenDataFile(name)
    display = Show(source, view)
    greatest = 0.0
    for time in source.TimestepValues or [0.0]:
        source.UpdatePipeline(time)
        greatest = max(greatest, source.PointData[array].GetRange()[1])
    ColorBy(display, ("POINTS", array))
    colours = GetColorTransferFunction(array)
    colours.ApplyPreset(preset, True)
    colours.RescaleTransferFunction(0, part * greatest)
    bar = GetScalarBar(colours, view)
    bar.Title, bar.ComponentTitle = title, ""
    bar.TitleColor = bar.LabelColor = [1, 1, 1]
    bar.WindowLocation = "Any Location"
    bar.Position, bar.ScalarBarLength = place, 0.35
    display.SetScalarBarVisibility(view, True)
    return source, display


bodies, contact, parts = series("bodies"), series("contact"), series("drive")
if bodies:
    with open(sorted(glob.glob(bodies.replace(".pvd", "_position_*.pvtu")))[0]) as first:
        with_stress = "von_mises_MPa" in first.read()
    array, title = (
        ("von_mises_MPa", "von Mises stress [MPa]")
        if with_stress
        else ("displacement_mm", "displacement [mm]")
    )
    source, display = show(bodies, array, title, 0.12, "Viridis (matplotlib)", [0.02, 0.55])
    display.NonlinearSubdivisionLevel = 2  # curved elements
    display.Ambient, display.Diffuse = 0.35, 0.75
if contact:
    source, display = show(
        contact, "pressure_MPa", "contact pressure [MPa]", 1, "Inferno (matplotlib)", [0.02, 0.08]
    )
if parts:
    source, display = show(parts, "force_N", "force on the part [N]", 1, "Viridis (matplotlib)", [0.02, 0.55])
    display.Opacity, display.Ambient = 0.5, 0.6
    if series("pressure"):
        show(
            series("pressure"),
            "pressure_MPa",
            "contact pressure [MPa]",
            0.5,
            "Inferno (matplotlib)",
            [0.02, 0.08],
        )[1].Ambient = 0.6

# From above the face, upon the contact; of a drive along its axis, a little from the side.
GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
ResetCamera(view)
x0, x1, y0, y1, z0, z1 = source.GetDataInformation().GetBounds()
aside = 60 if parts else 10
view.CameraFocalPoint = [(x0 + x1) / 2, (y0 + y1) / 2, z1]
view.CameraPosition = [(x0 + x1) / 2 + aside, (y0 + y1) / 2 - 30, z1 + 200]
view.CameraViewUp = [0, 1, 0]
view.CameraParallelProjection = 1
view.CameraParallelScale = (
    0.5 * view.CameraParallelScale
    if bodies and not contact
    else (0.6 if parts else 1.1) * max(x1 - x0, y1 - y0)
)
Render(view)
if len(sys.argv) > 1:
    SaveScreenshot(sys.argv[1], view)
