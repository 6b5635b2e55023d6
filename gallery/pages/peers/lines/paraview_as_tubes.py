"""ParaView: lines rendered as tubes."""

from paraview import simple

lines = simple.OpenDataFile("lines.vtp")
view = simple.CreateView("RenderView")
view.UseLight = 0
light = simple.AddLight(view=view)
light.Coords, light.Type, light.Position = "Scene", "Directional", [1, -0.6, 0.9]
display = simple.Show(
    lines, view, RenderLinesAsTubes=1, LineWidth=5, Specular=0.4, SpecularPower=25
)
simple.ColorBy(display, ("POINTS", "Temp"))
simple.GetColorTransferFunction("Temp").ApplyPreset("Cool to Warm")
