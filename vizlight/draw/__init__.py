"""Pictures: plotters with light that follows the camera, movies, pages, glTF, ParaView."""
