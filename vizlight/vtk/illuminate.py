"""A filter of VTK that lights a dataset, in a pipeline, block by block and piece by piece."""

from __future__ import annotations

import dataclasses
import json

import numpy as np
from numpy.typing import ArrayLike
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkDataSet
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

from vizlight import _check
from vizlight._types import Exponent, Facing, Foreign, Keywords, Model, Precision, Raw
from vizlight.scene import Scene
from vizlight.scene.keywords import named
from vizlight.scene.presets import as_scene
from vizlight.shading import engine
from vizlight.shading.inputs import ShadingInputs
from vizlight.shading.options import LightOptions
from vizlight.shading.results import arrays_of, digest, of_light, record_key, unlit
from vizlight.vtk.cells import GHOSTS, as_vtk, check_whole
from vizlight.vtk.parts import Part, part_of, uses_normals

#: Options that are names of arrays: a pipeline has no others.
_NAMES = ("tangents", "normals", "positions", "occlusion")
#: Options that matter between points, give a mesh new ones, or need PyVista.
_WITHOUT = ("feature_angle", "line_field", "bundle")
_NO_GHOSTS = (
    "light at the borders of the pieces is computed without their neighbours; give the pieces a "
    "layer of ghost cells before they are contoured, or normals as a point array"
)


class _Option:
    """An option of light as a property that marks the filter as modified if it changes."""

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name
        self.__doc__ = f"Option ``{name}`` of light, as for :func:`vizlight.illuminate`."
        words = "".join(word.capitalize() for word in name.split("_"))
        # Methods as all filters of VTK have them, by which wrappers and scripts set properties.
        setattr(owner, f"Get{words}", lambda algorithm: getattr(algorithm, name))
        setattr(owner, f"Set{words}", lambda algorithm, value: setattr(algorithm, name, value))

    def __get__(self, algorithm: Illuminate | None, owner: type) -> Foreign:
        return self if algorithm is None else getattr(algorithm.options, self.name)

    def __set__(self, algorithm: Illuminate, value: object) -> None:
        if self.name in _NAMES and value is not None:
            _check.text(self.name, value, expected="the name of a point array")
        if self.name == "name":
            _check.array_name("name", value)
        changes: Keywords = {self.name: value}
        algorithm._change("_options", dataclasses.replace(algorithm.options, **changes))


class Illuminate(VTKPythonAlgorithmBase):
    """Filter of VTK that lights datasets; the light is a point array of its output.

    Parameters
    ----------
    scene : Scene, optional
        Lights, material and view, in the unit of the data; ``Scene()`` until one is set. A depth
        cue has both ends.
    **options
        Properties of the filter, which are options of :func:`vizlight.illuminate`. Arrays are
        given by name.

    Raises
    ------
    TypeError, ValueError
        If a value does not fit, when it is set. A value that does not fit the data is an error of
        VTK (``ErrorEvent``) when they come, and the output is then empty.

    See Also
    --------
    vizlight.illuminate : The same light for meshes of PyVista.

    Notes
    -----
    The filter takes any ``vtkDataSet`` and gives one of the same type that shares the arrays of
    its input; composite data are lit block by block. It needs VTK 9.1, and no PyVista. It computes
    when its output is asked for, and only if the input or a property has changed. Each property
    has a pair of methods too, such as ``SetTangents`` and ``GetTangents``. ``facing`` is ignored
    where tangents are lit without a surface. Points that could not be lit are a warning of VTK
    (``WarningEvent``), with their count.

    Where a pipeline runs in several pieces, light does not depend on the cut: ``facing="auto"``
    then means ``"eye"``, which lights both sides alike if the scene has no view, ``"outward"`` is
    an error, and ``luminance_valid`` is always written. Normals that come from data, such as the
    gradient of a contoured field, need nothing else. Normals of faces, which contours of
    unstructured grids have too, need a layer of ghost cells that the pieces have before they are
    contoured: where the filter itself computes them without any, it warns.

    Examples
    --------
    >>> from vtkmodules.vtkFiltersSources import vtkSphereSource
    >>> import vizlight
    >>> scene = vizlight.Scene(
    ...     lights=vizlight.Light(direction=(1, 1, 1)), view=vizlight.View(direction=(0, 0, 1))
    ... )
    >>> source, lit = vtkSphereSource(), vizlight.vtk.Illuminate(scene, model="blinn")
    >>> lit.SetInputConnection(source.GetOutputPort())
    >>> done = lit.Update()
    >>> lit.GetOutput().GetPointData().GetScalars().GetName()
    'luminance'
    """

    tangents = _Option()
    positions = _Option()
    normals = _Option()
    facing = _Option()
    conditioned = _Option()
    occlusion = _Option()
    model = _Option()
    exponent = _Option()
    components = _Option()
    precision = _Option()
    name = _Option()

    @named
    def __init__(
        self,
        scene: Scene | None = None,
        *,
        tangents: str | ArrayLike | None = None,
        positions: str | None = None,
        normals: str | ArrayLike | None = None,
        facing: Facing = "auto",
        conditioned: bool | str | None = False,
        occlusion: str | None = None,
        name: str = "luminance",
        exponent: Exponent = "compensated",
        model: Model = "phong",
        components: bool = False,
        precision: Precision | None = None,
    ) -> None:
        options = LightOptions.of(locals())
        super().__init__(  # type: ignore[no-untyped-call]
            nInputPorts=1, nOutputPorts=1, inputType="vtkDataSet", outputType="vtkDataSet"
        )
        self._scene: Scene | None = None
        self._options = LightOptions()
        self.scene = scene
        for option, value in options.changed().items():
            setattr(self, option, value)

    @property
    def scene(self) -> Scene | None:
        """Lights, material and view."""
        return self._scene

    @scene.setter
    def scene(self, scene: Scene | None) -> None:
        _check.instance("scene", scene, Scene, optional=True)
        cue = None if scene is None else scene.depth_cue
        if cue is not None and (cue.front is None or cue.back is None):
            expected, remedy = "both ends in a pipeline", "pass DepthCue(front=, back=), distances"
            raise _check.value_error("depth_cue", expected, "none or one", remedy)
        self._change("_scene", scene)

    def SetScene(self, scene: Scene | None) -> None:
        """Set the scene."""
        self.scene = scene

    def GetScene(self) -> Scene | None:
        """Return the scene."""
        return self.scene

    @property
    def options(self) -> LightOptions:
        """All options of light."""
        return self._options

    def SetInputData(self, data: vtkDataSet) -> None:
        """Set the dataset that is lit, where no other filter gives it."""
        self.SetInputDataObject(0, data)

    def GetOutput(self) -> vtkDataSet:
        """Return the dataset that is lit."""
        output: vtkDataSet = self.GetOutputDataObject(0)
        return output

    def prepare(self) -> None:
        """Set options that depend on others before the input is lit; this filter has none."""

    def _change(self, name: str, value: object) -> None:
        """Set an attribute; the filter runs again if its value has changed."""
        if getattr(self, name) != value:
            setattr(self, name, value)
            self.Modified()

    def RequestDataObject(self, _request: Foreign, inputs: Foreign, out: Foreign) -> int:
        """Make an output of the type of the input."""
        data: vtkDataSet | None = vtkDataSet.GetData(inputs[0])
        output: vtkDataSet | None = vtkDataSet.GetData(out)
        if data is None:
            other = vtkDataObject.GetData(inputs[0])
            kind = "nothing" if other is None else other.GetClassName()
            self._tell(
                "ErrorEvent", _check.message("input", "a vtkDataSet or blocks of them", kind)
            )
            return 0
        # An output of the right type stays, so that whoever holds it sees each new run.
        if output is None or output.GetClassName() != data.GetClassName():
            information = out.GetInformationObject(0)
            information.Set(vtkDataObject.DATA_OBJECT(), data.NewInstance())
        return 1

    def RequestData(self, _request: Foreign, inputs: Foreign, out: Foreign) -> int:
        """Light the input."""
        data, output = vtkDataSet.GetData(inputs[0]), vtkDataSet.GetData(out)
        information = out.GetInformationObject(0)
        # 0 where nobody asked for pieces.
        pieces = information.Get(vtkStreamingDemandDrivenPipeline.UPDATE_NUMBER_OF_PIECES()) or 1
        try:
            self.prepare()
            arrays, record = self._lit(data, pieces)
        except (TypeError, ValueError) as error:
            # The light of an earlier run must not stay there as if it belonged to this input.
            output.Initialize()
            self._tell("ErrorEvent", str(error))
            return 0
        output.ShallowCopy(data)
        for name, array in arrays.items():
            output.GetPointData().AddArray(as_vtk(array, name))
        output.GetPointData().SetActiveScalars(self.name)
        text = vtkStringArray()
        text.SetName(record_key(self.name))
        text.InsertNextValue(json.dumps(record))
        output.GetFieldData().AddArray(text)
        return 1

    def _lit(self, data: vtkDataSet, pieces: int) -> tuple[dict[str, Raw], dict[str, object]]:
        """Return the arrays that a dataset gets, by name, and their record."""
        scene = as_scene(self._scene)
        check_whole(data, "input")
        part = self._part(data, scene, pieces)
        shading = engine.run(part.inputs, scene, part.options)
        # All pieces have the same arrays, whether or not a point of one of them could not be lit.
        arrays = arrays_of(shading, self.name, valid=pieces > 1)
        # With a record of this name the arrays are light of an earlier filter, which may be
        # replaced.
        if not data.GetFieldData().HasArray(record_key(self.name)):
            for name in arrays:
                if data.GetPointData().HasArray(name):
                    expected, remedy = "one that the input has no array of", "pass another name="
                    raise _check.value_error("name", expected, repr(name), remedy)
        # Points inside a volume are on no surface: they are no fault to warn of.
        inside = 0 if part.sided is None else int(part.sided.inside)
        if shading.invalid > inside:
            count = shading.luminance.size - inside
            self._tell("WarningEvent", unlit(shading.invalid - inside, count))
        digests = {name: digest(array) for name, array in arrays.items()}
        record = of_light(shading, "illuminate", scene, self._options)
        return arrays, record | {"arrays": digests}

    def _part(self, data: vtkDataSet, scene: Scene, pieces: int) -> Part:
        """Return the inputs of the light of a dataset, the same in one piece and in several."""
        options = self._options
        if not data.GetNumberOfPoints():
            # A piece without points may lack the arrays that the others have.
            nothing = np.zeros((0, 3), np.float32)
            plain = dataclasses.replace(options, model="phong", conditioned=False)
            return Part(ShadingInputs(points=nothing, normals=nothing), plain, None)
        if not uses_normals(data, options):
            options = dataclasses.replace(options, facing="auto")
        elif pieces > 1:
            # The whole surface tells the outer side, and a piece sees a part of it.
            if options.facing == "outward":
                expected = "'eye' or 'as given' where the pipeline runs in several pieces"
                raise _check.value_error("facing", expected, "'outward'")
            if options.facing == "auto":
                # Toward the eye each point is turned by itself, wherever the cut lies.
                options = dataclasses.replace(options, facing="eye")
        part = part_of(data, "", scene, options)
        # Tangents of lines and normals of faces depend on neighbours, which lie in other pieces at
        # the cut.
        of_lines = options.tangents is None and part.inputs.tangents is not None
        computed = part.sided is not None and part.sided.computed
        if pieces > 1 and (of_lines or computed) and not data.GetCellData().HasArray(GHOSTS):
            self._tell("WarningEvent", _NO_GHOSTS)
        return part

    def _tell(self, event: str, text: str) -> None:
        """Report an error (``ErrorEvent``) or a warning (``WarningEvent``) as filters of VTK do."""
        words = f"{type(self).__name__}: {text}"
        # VTK's own macros do so: with an observer they print nothing.
        if self.HasObserver(event):
            self.InvokeEvent(event, words)
            return
        window = vtkOutputWindow.GetInstance()
        show = window.DisplayErrorText if event == "ErrorEvent" else window.DisplayWarningText
        show(f"{words}\n")
