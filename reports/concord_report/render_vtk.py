"""Draws one frame with VTK: particles as shaded spheres, meshes as their surface with edges."""

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

from . import frames

SIZE = (1320, 990)
FROM = (0.62, -1.0, 0.55)  # direction to the eye in three dimensions
EDGES_UP_TO = 60000  # cells; a finer mesh's edges would only darken the picture
GREY = (0.62, 0.62, 0.62)


def _grid(frame, positions, data):
    grid = vtk.vtkUnstructuredGrid()
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(positions, float), deep=True))
    grid.SetPoints(points)
    cells = vtk.vtkCellArray()
    cells.SetData(numpy_to_vtkIdTypeArray(np.ascontiguousarray(frame["offsets"], np.int64), deep=True),
                  numpy_to_vtkIdTypeArray(np.ascontiguousarray(frame["connectivity"], np.int64), deep=True))
    grid.SetCells(numpy_to_vtk(np.ascontiguousarray(frame["types"], np.uint8), deep=True,
                               array_type=vtk.VTK_UNSIGNED_CHAR), cells)
    _attach(grid, data)
    return grid


def _attach(grid, data):
    scalars = numpy_to_vtk(np.ascontiguousarray(data), deep=True)
    scalars.SetName("color")
    grid.GetPointData().SetScalars(scalars)


def _colours(job):
    table = vtk.vtkLookupTable()
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
    cloud = vtk.vtkPolyData()
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(positions, float), deep=True))
    cloud.SetPoints(points)
    _attach(cloud, data)
    ball = vtk.vtkSphereSource()
    ball.SetRadius(0.5 * diameter)
    fine = 24 if len(positions) < 3000 else 14 if len(positions) < 30000 else 8
    ball.SetThetaResolution(fine)
    ball.SetPhiResolution(fine)
    mapper = vtk.vtkGlyph3DMapper()
    mapper.SetInputData(cloud)
    mapper.SetSourceConnection(ball.GetOutputPort())
    mapper.ScalingOff()
    mapper.OrientOff()
    _coloured(mapper, job)
    mapper.SetInterpolateScalarsBeforeMapping(False)
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    return [actor]


def _surface(frame, positions, data, job):
    grid = _grid(frame, positions, data)
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputData(grid)
    surface.SetNonlinearSubdivisionLevel(2)
    last = surface
    if not job["flat"]:
        normals = vtk.vtkPolyDataNormals()
        normals.SetInputConnection(surface.GetOutputPort())
        normals.SetFeatureAngle(35)
        last = normals
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(last.GetOutputPort())
    _coloured(mapper, job)
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actors = [actor]
    if len(frame["types"]) <= EDGES_UP_TO:
        actors.append(_edges(frame, positions, data))
    return actors


def _edges(frame, positions, data):
    """The straight edges of the cells on the surface."""
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputData(_grid(frame, positions, data))
    surface.SetNonlinearSubdivisionLevel(0)
    edges = vtk.vtkExtractEdges()
    edges.SetInputConnection(surface.GetOutputPort())
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(edges.GetOutputPort())
    mapper.ScalarVisibilityOff()
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    mapper.SetRelativeCoincidentTopologyLineOffsetParameters(-2, -2)
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(0.05, 0.06, 0.08)
    actor.GetProperty().SetOpacity(0.35)
    actor.GetProperty().SetLineWidth(1.2)
    actor.GetProperty().LightingOff()
    return actor


def _shade(actor, flat):
    look = actor.GetProperty()
    if flat:
        look.LightingOff()
        return
    look.SetAmbient(0.3)
    look.SetDiffuse(0.72)
    look.SetSpecular(0.12)
    look.SetSpecularPower(30)


def _view(renderer, view):
    """Parallel projection onto the shared bounds: pictures of one scene are to one scale."""
    low, high = np.array(view["low"]), np.array(view["high"])
    centre, size = (low + high) / 2, max((high - low).max(), 1e-300)
    away = np.array((0.0, 0.0, 1.0) if view["flat"] else FROM)
    away /= np.linalg.norm(away)
    up = np.array((0.0, 1.0, 0.0) if view["flat"] else (0.0, 0.0, 1.0))
    right = np.cross(up, away)
    right /= np.linalg.norm(right)
    up = np.cross(away, right)
    corners = np.array([[(low, high)[i][0], (low, high)[j][1], (low, high)[k][2]]
                        for i in (0, 1) for j in (0, 1) for k in (0, 1)]) - centre
    half = max(np.abs(corners @ up).max(), np.abs(corners @ right).max() * SIZE[1] / SIZE[0])
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*centre)
    camera.SetPosition(*(centre + 10 * size * away))
    camera.SetViewUp(*up)
    camera.SetParallelScale(half * 1.08)
    renderer.ResetCameraClippingRange()


def _lights(renderer):
    kit = vtk.vtkLightKit()
    kit.SetKeyLightIntensity(0.95)
    kit.SetKeyToFillRatio(2.6)
    kit.SetKeyLightWarmth(0.5)
    kit.SetFillLightWarmth(0.5)
    kit.AddLightsToRenderer(renderer)


def draw(frame, job):
    """RGBA pixels of the job's frame on a transparent ground."""
    positions, _ = frames.deformed(frame, job["scale"])
    data = frames.values(frame, job["color"])
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.SetBackgroundAlpha(0)
    if job["particles"]:
        good = np.isfinite(positions).all(axis=1)
        actors = _spheres(positions[good], data[good], job)
    else:
        actors = _surface(frame, positions, data, job)
    for position, actor in enumerate(actors):
        if position == 0:
            _shade(actor, job["flat"])
        renderer.AddActor(actor)
    _lights(renderer)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetAlphaBitPlanes(True)
    window.SetMultiSamples(8)
    window.SetSize(*SIZE)
    window.AddRenderer(renderer)
    _view(renderer, job["view"])
    window.Render()
    return _pixels(window)


def _pixels(window):
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.SetInputBufferTypeToRGBA()
    grab.ReadFrontBufferOff()
    grab.Update()
    image = grab.GetOutput()
    width, height, _ = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, 4)[::-1].copy()
