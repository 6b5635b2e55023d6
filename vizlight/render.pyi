from vizlight.pictures.render import *
