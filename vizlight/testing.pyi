from vizlight.pictures.testing import *
