from vizlight.plotting.paraview import *
