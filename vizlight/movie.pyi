from vizlight.pictures.movie import *
