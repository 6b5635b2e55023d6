"""Conversion between PyVista meshes and arrays: the input and the output of the filters."""
