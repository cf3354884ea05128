"""Draws one frame with VTK: particles as shaded spheres, meshes as their surface with edges."""

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_UNSIGNED_CHAR, vtkLookupTable, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData, vtkUnstructuredGrid
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals
from vtkmodules.vtkFiltersExtraction import vtkExtractEdges
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
from vtkmodules.vtkRenderingCore import (vtkActor, vtkLightKit, vtkPolyDataMapper, vtkRenderer,
                                         vtkRenderWindow, vtkWindowToImageFilter)
from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLSphereMapper

from . import frames

LONG = 1760  # pixels of the drawing's width; the picture has half of it: that smooths its edges
EDGES_UP_TO = 60000  # cells; a finer mesh's edges would only darken the picture
GREY = (0.62, 0.62, 0.62)


def _grid(frame, positions, data):
    grid = vtkUnstructuredGrid()
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(positions, float), deep=True))
    grid.SetPoints(points)
    cells = vtkCellArray()
    cells.SetData(numpy_to_vtkIdTypeArray(np.ascontiguousarray(frame["offsets"], np.int64), deep=True),
                  numpy_to_vtkIdTypeArray(np.ascontiguousarray(frame["connectivity"], np.int64), deep=True))
    grid.SetCells(numpy_to_vtk(np.ascontiguousarray(frame["types"], np.uint8), deep=True,
                               array_type=VTK_UNSIGNED_CHAR), cells)
    _attach(grid, data)
    return grid


def _attach(grid, data):
    scalars = numpy_to_vtk(np.ascontiguousarray(data), deep=True)
    scalars.SetName("color")
    grid.GetPointData().SetScalars(scalars)


def _colours(job):
    table = vtkLookupTable()
    stops = np.array([[int(c[k:k + 2], 16) for k in (1, 3, 5)] for c in job["stops"]]) / 255
    table.SetNumberOfTableValues(256)
    place = np.linspace(0, len(stops) - 1, 256)
    for i, at in enumerate(place):
        rgb = [np.interp(at, range(len(stops)), stops[:, k]) for k in range(3)]
        table.SetTableValue(i, *rgb, 1)
    table.SetRange(*job["limits"])
    table.SetNanColor(*GREY, 1)
    table.Build()
    return table


def _coloured(mapper, job):
    mapper.SetLookupTable(_colours(job))
    mapper.SetUseLookupTableScalarRange(True)
    mapper.SetScalarModeToUsePointData()
    mapper.SetInterpolateScalarsBeforeMapping(True)


def _spheres(positions, data, job):
    """Spheres of diameter h (discs in the plane); without h, from the volume of the bounds."""
    spread = np.ptp(positions[np.isfinite(positions).all(axis=1)], axis=0)
    full = spread[spread > 1e-9 * spread.max()]
    diameter = job["h"] or (np.prod(full) / max(1, len(positions))) ** (1 / max(1, len(full)))
    cloud = vtkPolyData()
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(positions, float), deep=True))
    cloud.SetPoints(points)
    _attach(cloud, data)
    vertices = vtkCellArray()
    vertices.SetData(numpy_to_vtkIdTypeArray(np.arange(len(positions) + 1), deep=True),
                     numpy_to_vtkIdTypeArray(np.arange(len(positions)), deep=True))
    cloud.SetVerts(vertices)
    mapper = vtkOpenGLSphereMapper()  # ray-cast spheres: two triangles each
    mapper.SetInputData(cloud)
    mapper.SetRadius(0.5 * diameter)
    _coloured(mapper, job)
    mapper.SetInterpolateScalarsBeforeMapping(False)
    actor = vtkActor()
    actor.SetMapper(mapper)
    return [actor]


def _surface(frame, positions, data, job):
    grid = _grid(frame, positions, data)
    surface = vtkDataSetSurfaceFilter()
    surface.SetInputData(grid)
    surface.SetNonlinearSubdivisionLevel(2)
    last = surface
    if not job["view"]["flat"]:
        normals = vtkPolyDataNormals()
        normals.SetInputConnection(surface.GetOutputPort())
        normals.SetFeatureAngle(35)
        last = normals
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(last.GetOutputPort())
    _coloured(mapper, job)
    actor = vtkActor()
    actor.SetMapper(mapper)
    actors = [actor]
    if len(frame["types"]) <= EDGES_UP_TO:
        actors.append(_edges(frame, positions, data, job))
    return actors


def _edges(frame, positions, data, job):
    """The straight edges of the cells on the surface, a little nearer to the eye than it."""
    view = job["view"]
    reach = max(h - l for l, h in zip(view["low"], view["high"]))
    positions = positions + 0.004 * reach * frames.view_axes(view["flat"])[2]
    surface = vtkDataSetSurfaceFilter()
    surface.SetInputData(_grid(frame, positions, data))
    surface.SetNonlinearSubdivisionLevel(0)
    edges = vtkExtractEdges()
    edges.SetInputConnection(surface.GetOutputPort())
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(edges.GetOutputPort())
    mapper.ScalarVisibilityOff()
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(0.05, 0.06, 0.08)
    actor.GetProperty().SetOpacity(0.35)
    actor.GetProperty().SetLineWidth(2.0)
    actor.GetProperty().LightingOff()
    return actor


def _shade(actor, flat):
    look = actor.GetProperty()
    if flat:
        look.LightingOff()
        return
    look.SetAmbient(0.38)
    look.SetDiffuse(0.72)
    look.SetSpecular(0.12)
    look.SetSpecularPower(30)


def _size(view):
    """Pixels of the picture: the shape of what is seen, within reason."""
    wide, high = (view["high"][k] - view["low"][k] for k in (0, 1))
    shape = min(3.0, max(0.5, wide / high if high > 0 else 3.0))
    width = min(LONG, LONG * shape / 1.1)
    return 2 * round(width / 2), 2 * round(width / shape / 2)


def _view(renderer, view, size):
    """Parallel projection onto the shared extent: pictures of one scene are to one scale."""
    low, high = np.array(view["low"]), np.array(view["high"])
    right, up, away = frames.view_axes(view["flat"])
    middle = (low + high) / 2
    centre = middle @ np.array([right, up, away])
    half = (high - low) / 2
    reach = max(half.max(), 1e-300)
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*centre)
    camera.SetPosition(*(centre + 10 * reach * away))
    camera.SetViewUp(*up)
    camera.SetParallelScale(max(half[1], half[0] * size[1] / size[0]) * 1.02)
    renderer.ResetCameraClippingRange()


def _lights(renderer):
    kit = vtkLightKit()
    kit.SetKeyLightIntensity(0.95)
    kit.SetKeyToFillRatio(2.6)
    kit.SetKeyLightWarmth(0.5)
    kit.SetFillLightWarmth(0.5)
    kit.AddLightsToRenderer(renderer)


def draw(frame, job):
    """RGBA pixels of the job's frame on a transparent ground."""
    positions, _ = frames.deformed(frame, job["scale"])
    data = frames.values(frame, job["color"])
    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.SetBackgroundAlpha(0)
    if job["particles"]:
        good = np.isfinite(positions).all(axis=1)
        actors = _spheres(positions[good], data[good], job)
    else:
        actors = _surface(frame, positions, data, job)
    for position, actor in enumerate(actors):
        if position == 0:
            _shade(actor, job["view"]["flat"])
        renderer.AddActor(actor)
    _lights(renderer)
    window = vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetAlphaBitPlanes(True)
    window.SetMultiSamples(0)
    size = _size(job["view"])
    window.SetSize(*size)
    window.AddRenderer(renderer)
    _view(renderer, job["view"], size)
    window.Render()
    return _pixels(window)


def _pixels(window):
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.SetInputBufferTypeToRGBA()
    grab.ReadFrontBufferOff()
    grab.Update()
    image = grab.GetOutput()
    width, height, _ = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, 4)[::-1].copy()
