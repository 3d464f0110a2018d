# SPDX-License-Identifier: GPL-2.0-or-later
# pvbatch section.py FOLDER TORQUE PICTURE: von Mises stress of both bodies in a section just beside mid-face,
# around the pitch point.
import os
import sys

from paraview.simple import *

folder, torque, picture = sys.argv[1:4]
bodies = OpenDataFile(os.path.join(folder, "fields", f"bodies_{torque}Nm.pvd"))
bodies.UpdatePipeline(bodies.TimestepValues[0])
section = Slice(Input=bodies)
section.SliceType.Origin = place = [75, 0, 0.5]
section.SliceType.Normal = [0, 0, 1]
view = GetActiveViewOrCreate("RenderView")
view.ViewSize, view.OrientationAxesVisibility = [1400, 900], 0
display = Show(section, view)
ColorBy(display, ("POINTS", "von_mises_MPa"))
colours = GetColorTransferFunction("von_mises_MPa")
colours.ApplyPreset("Viridis (matplotlib)", True)
colours.RescaleTransferFunction(0, 500)
bar = GetScalarBar(colours, view)
bar.Title, bar.ComponentTitle = "von Mises stress [MPa]", ""
display.SetScalarBarVisibility(view, True)
ResetCamera(view)
view.CameraFocalPoint, view.CameraPosition, view.CameraViewUp = place, [place[0], place[1], 100], [0, 1, 0]
view.CameraParallelProjection, view.CameraParallelScale = 1, 2.2
Render(view)
SaveScreenshot(picture, view)
