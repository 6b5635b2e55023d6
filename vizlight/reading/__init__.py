"""Datasets of VTK as arrays: points, tangents, normals and their sides. It needs no PyVista."""
