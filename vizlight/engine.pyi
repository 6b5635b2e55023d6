from vizlight.shading.engine import *
