"""From PyVista to arrays and back: what filters take from a mesh and attach to it."""
