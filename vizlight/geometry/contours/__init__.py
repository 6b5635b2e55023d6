"""Contours of equal luminance: in closed form, on solids and on triangle meshes."""
