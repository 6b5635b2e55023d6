"""ParaView: Surface LIC."""

from paraview import simple

surface = simple.OpenDataFile("surface.vtp")
view = simple.CreateView("RenderView")
view.UseLight = 0
light = simple.AddLight(view=view)
light.Coords, light.Type, light.Position = "Scene", "Directional", [1, 0.9, 0.5]
display = simple.Show(surface, view, Representation="Surface LIC", Ambient=0.2)
display.SelectInputVectors, display.NumberOfSteps = ["POINTS", "V"], 40
display.ColorMode, display.EnhanceContrast = "Multiply", "LIC and Color"
display.GenerateNoiseTexture, display.NoiseGrainSize = 1, 2
display.MapModeBias = 0.25
simple.ColorBy(display, ("POINTS", "speed"))
simple.GetColorTransferFunction("speed").ApplyPreset("Cool to Warm")
