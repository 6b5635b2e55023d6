"""Lines as arrays: tangents of polylines, and fibres that grow on a surface."""
