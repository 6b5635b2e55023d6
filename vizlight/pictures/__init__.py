"""Pictures of lit meshes: offscreen rendering, movies, and tests that compare pictures."""
