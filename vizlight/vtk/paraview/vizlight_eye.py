"""Script for ParaView that ties the eye of Vizlight's filters to a view: the light follows it.

Run it by Run Script in the Python shell or as a macro, for all filters and the active view; in a
script of pvpython: ``import vizlight_eye; vizlight_eye.follow(filters, view)``.
"""

from paraview.simple import GetActiveViewOrCreate, GetSources


def follow(filters=None, view=None):
    """Set the eye of filters to the eye of a view now, and before each picture.

    Parameters
    ----------
    filters : list of proxies, optional
        Filters Vizlight Illuminate. Default: all of them.
    view : proxy, optional
        View with a camera. Default: the active one.

    Returns
    -------
    int
        Number of the observer of the view, by which ``view.SMProxy.RemoveObserver`` ends it.
    """
    view = view or GetActiveViewOrCreate("RenderView")
    if filters is None:
        filters = [it for it in GetSources().values() if hasattr(it, "ParallelProjection")]

    def look(*_):
        camera = view.GetActiveCamera()
        parallel = int(camera.GetParallelProjection())
        # An eye at infinity is the direction toward it, which runs against the projection's.
        away = [-x for x in camera.GetDirectionOfProjection()]
        eye = away if parallel else [*camera.GetPosition()]
        late = [it for it in filters if (it.ParallelProjection, [*it.Eye]) != (parallel, eye)]
        if late:
            # Where the camera was reset, the view takes for new what it has shown already, and a
            # change now would be lost.
            view.SMProxy.Update()
        for it in late:
            it.ParallelProjection, it.Eye = parallel, eye

    look()
    return view.SMProxy.AddObserver("StartEvent", look)


if __name__ == "__main__":
    follow()
