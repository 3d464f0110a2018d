# SPDX-License-Identifier: GPL-2.0-or-later
# A view of the fields that lie beside this file: von Mises stress of both bodies, contact pressure on the flanks, over the mesh cycle.
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
    return max(files, key=lambda name: float(name.rsplit("_", 1)[1][:-len("Nm.pvd")]), default=None)


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


bodies, contact = series("bodies"), series("contact")
if bodies:
    with open(sorted(glob.glob(bodies.replace(".pvd", "_position_*.pvtu")))[0]) as first:
        with_stress = "von_mises_MPa" in first.read()
    array, title = ("von_mises_MPa", "von Mises stress [MPa]") if with_stress else ("displacement_mm", "displacement [mm]")
    source, display = show(bodies, array, title, 0.3, "Viridis (matplotlib)", [0.02, 0.55])
    display.NonlinearSubdivisionLevel = 2  # curved elements
    display.Ambient, display.Diffuse = 0.35, 0.75
if contact:
    source, display = show(contact, "pressure_MPa", "contact pressure [MPa]", 1, "Inferno (matplotlib)", [0.02, 0.08])

# From above the face, upon the contact.
GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
ResetCamera(view)
x0, x1, y0, y1, z0, z1 = source.GetDataInformation().GetBounds()
view.CameraFocalPoint = [(x0 + x1) / 2, (y0 + y1) / 2, z1]
view.CameraPosition = [(x0 + x1) / 2 + 10, (y0 + y1) / 2 - 30, z1 + 200]
view.CameraViewUp = [0, 1, 0]
view.CameraParallelProjection = 1
view.CameraParallelScale = 0.5 * view.CameraParallelScale if not contact else 1.1 * max(x1 - x0, y1 - y0)
Render(view)
if len(sys.argv) > 1:
    SaveScreenshot(sys.argv[1], view)
