"""PyVista with VTK's mapper of line integral convolution."""

import pyvista as pv
from vtkmodules.vtkRenderingLICOpenGL2 import vtkSurfaceLICMapper

surface = pv.read("surface.vtp")
surface.set_active_scalars("speed")
surface.set_active_vectors("V")
plotter = pv.Plotter(lighting="none")
plotter.add_light(pv.Light(position=(1, 0.9, 0.5), light_type="scene light"))
mapper = vtkSurfaceLICMapper()
mapper.SetInputDataObject(surface)
mapper.SetInputArrayToProcess(0, 0, 0, 0, "V")
mapper.SetLookupTable(pv.LookupTable("coolwarm"))
mapper.SetScalarRange(surface.get_data_range("speed"))
lic = mapper.GetLICInterface()
lic.SetNumberOfSteps(40)
lic.SetColorMode(lic.COLOR_MODE_MAP)
lic.SetEnhanceContrast(lic.ENHANCE_CONTRAST_BOTH)
lic.SetGenerateNoiseTexture(True)
lic.SetNoiseGrainSize(2)
lic.SetMapModeBias(0.25)
actor = pv.Actor()
actor.SetMapper(mapper)
actor.prop.interpolation, actor.prop.ambient = "Phong", 0.2
plotter.add_actor(actor)
