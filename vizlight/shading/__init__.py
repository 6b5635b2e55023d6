"""From a scene to numbers: the plan of the terms, their cheaper forms, and the engine."""
