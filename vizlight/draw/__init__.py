"""Pictures: plotters whose light follows the camera, offscreen, movies, pages, glTF, ParaView."""
