"""From a scene to numbers: what is needed, what may be cheaper, and the engine that runs it."""
