"""Lines as arrays: tangents of polylines, fibres on a surface."""
