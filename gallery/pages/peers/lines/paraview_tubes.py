"""ParaView: Tube filter."""

from paraview import simple

tubes = simple.Tube(simple.OpenDataFile("lines.vtp"), Radius=0.025, NumberofSides=12)
view = simple.CreateView("RenderView")
view.UseLight = 0
light = simple.AddLight(view=view)
light.Coords, light.Type, light.Position = "Scene", "Directional", [1, -0.6, 0.9]
display = simple.Show(tubes, view, Specular=0.4, SpecularPower=25, Ambient=0.2)
simple.ColorBy(display, ("POINTS", "Temp"))
simple.GetColorTransferFunction("Temp").ApplyPreset("Cool to Warm")
