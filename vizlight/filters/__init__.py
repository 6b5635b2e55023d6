"""PyVista in, PyVista out: arrays are taken from a mesh, lit, and attached to a new mesh.

Each filter has a file of its own, which is loaded when the package's name for it is first used.
"""
