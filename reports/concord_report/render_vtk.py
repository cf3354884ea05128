"""Draws one frame with VTK: meshes as their surface with edges; bodies of particles as their surface too, one
colour a particle, so that methods compare; particles outside such a body as shaded spheres."""

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_UNSIGNED_CHAR, vtkLookupTable
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData, vtkUnstructuredGrid
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
from vtkmodules.vtkRenderingCore import (vtkActor, vtkLightKit, vtkPolyDataMapper, vtkRenderer,
                                         vtkRenderWindow, vtkWindowToImageFilter)
from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLSphereMapper

from . import frames, render_cells, render_lines, solid_cells

EDGES_UP_TO = 60000  # cells; a finer mesh's edges would only darken the picture
GREY = (0.62, 0.62, 0.62)
PLAIN = (0.72, 0.74, 0.77)  # of bodies without a field


def _grid(frame, positions, data):
    grid = vtkUnstructuredGrid()
    grid.SetPoints(render_lines.vtk_points(positions))
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
    if job["color"] == frames.PLAIN:
        table.SetTableRange(0, 1)
        for i in range(256):
            table.SetTableValue(i, *PLAIN, 1)
    table.SetNanColor(*GREY, 1)
    table.Build()
    return table


def _coloured(mapper, job):
    mapper.SetLookupTable(_colours(job))
    mapper.SetUseLookupTableScalarRange(True)
    mapper.SetScalarModeToUsePointData()
    mapper.SetInterpolateScalarsBeforeMapping(True)


def _spheres(positions, data, job, part=1.0):
    """Spheres of diameter h, or `part` of it (discs in the plane); without h, from the volume of the bounds."""
    spread = np.ptp(positions[np.isfinite(positions).all(axis=1)], axis=0)
    full = spread[spread > 1e-9 * spread.max()]
    diameter = job["h"] or (np.prod(full) / max(1, len(positions))) ** (1 / max(1, len(full)))
    cloud = vtkPolyData()
    cloud.SetPoints(render_lines.vtk_points(positions))
    _attach(cloud, data)
    cloud.SetVerts(render_lines.vtk_cells(np.arange(len(positions))[:, None]))
    mapper = vtkOpenGLSphereMapper()  # ray-cast spheres: two triangles each
    mapper.SetInputData(cloud)
    mapper.SetRadius(0.5 * part * diameter)
    _coloured(mapper, job)
    mapper.SetInterpolateScalarsBeforeMapping(False)
    actor = vtkActor()
    actor.SetMapper(mapper)
    return [actor]


SURFACES = []  # (reference positions, their surface) of the bodies drawn so far: a run has one at all instants


def _surface_of(reference, h):
    for known, found in SURFACES:
        if known.shape == reference.shape and np.abs(known - reference).max() <= 1e-6 * h:
            return found
    SURFACES.append((reference, solid_cells.surface(reference, h)))
    return SURFACES[-1][1]


def _body(positions, reference, data, job):
    """The surface of a body of particles, each with its share of it; spheres for those that belong to none."""
    triangles, alone = _surface_of(reference, job["h"])
    if not len(triangles):
        return _spheres(positions, data, job)
    points, quads, owner = solid_cells.shares(triangles, reference, positions)
    skin = _polygons(points, quads)
    colours = numpy_to_vtk(np.ascontiguousarray(data[owner]), deep=True)
    colours.SetName("color")
    skin.GetCellData().SetScalars(colours)
    actor = _faces(skin, job)
    rim = render_lines.lines(points[quads[:, [1, 2, 3]]].reshape(-1, 3), np.arange(3 * len(quads)).reshape(-1, 3), job)
    rim.GetProperty().SetOpacity(0.16)
    return [actor, rim, *render_lines.creases(skin, job), *(_spheres(positions[alone], data[alone], job) if len(alone) else ())]


def _faces(skin, job):
    """Polygons with a colour each."""
    actor, mapper = _lit(skin, job)
    mapper.SetScalarModeToUseCellData()
    mapper.SetInterpolateScalarsBeforeMapping(False)
    return actor


def _voronoi(positions, reference, data, job):
    """The body as the outer faces of its cells; with draw = "cells" all of them, seen through, and the particles."""
    if job["draw"] == "cells":
        return [*_spheres(positions, data, job, render_cells.PARTICLE), *render_cells.cells(job, reference, positions)]
    skin, rim = render_cells.skin(job, reference, positions, data)
    rim.GetProperty().SetOpacity(0.22)
    return [_faces(skin, job), rim, *render_lines.creases(skin, job)]


def _particles(positions, reference, data, job):
    good = np.isfinite(positions).all(axis=1)
    solid = reference is not None and job["h"] and not job["view"]["flat"] and job["draw"] != "spheres"
    if solid and job["cells"] and good.all():
        return _voronoi(positions, reference, data, job)
    if solid:
        return _body(positions[good], reference[good], data[good], job)
    return _spheres(positions[good], data[good], job)


def _polygons(points, cells):
    """Polygons with equally many corners."""
    skin = vtkPolyData()
    skin.SetPoints(render_lines.vtk_points(points))
    skin.SetPolys(render_lines.vtk_cells(cells))
    return skin


def _lit(skin, job):
    """(actor, mapper) of polygons that are smoothly shaded but at sharp edges."""
    normals = vtkPolyDataNormals()
    normals.SetInputData(skin)
    normals.SetFeatureAngle(35)
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(normals.GetOutputPort())
    _coloured(mapper, job)
    actor = vtkActor()
    actor.SetMapper(mapper)
    return actor, mapper


def _plate(job):
    """Where a body is held: a grey plate behind its fixed points."""
    corners = np.array(job["plate"])
    faces = np.array([(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(_polygons(corners[faces].reshape(-1, 3), np.arange(24).reshape(-1, 4)))
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*GREY)
    return actor


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
    last.Update()
    actors = [actor] if job["view"]["flat"] else [actor, *render_lines.creases(surface.GetOutput(), job)]
    if len(frame["types"]) <= EDGES_UP_TO:
        actors += render_lines.edges(frame, positions, job)
    return actors


def _shade(actor, front):
    look = actor.GetProperty()
    if front:
        look.LightingOff()
        return
    look.SetAmbient(0.38)
    look.SetDiffuse(0.72)
    look.SetSpecular(0.12)
    look.SetSpecularPower(30)


def _size(view, across):
    """Pixels of the drawing, at most `across` in a line: the shape of what is seen, within reason."""
    wide, high = (view["high"][k] - view["low"][k] for k in (0, 1))
    shape = min(3.0, max(0.5, wide / high if high > 0 else 3.0))
    width = min(across, across * shape / 1.1)
    return 2 * round(width / 2), 2 * round(width / shape / 2)


def _view(renderer, view, size):
    """Parallel projection onto the shared extent: pictures of one scene are to one scale."""
    low, high = np.array(view["low"]), np.array(view["high"])
    right, up, away = frames.view_axes(view["front"])
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
    positions, reference = frames.deformed(frame, job["scale"])
    data = frames.values(frame, job["color"])
    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.SetBackgroundAlpha(0)
    if job["particles"]:
        actors = _particles(positions, reference, data, job)
    else:
        actors = _surface(frame, positions, data, job)
    for position, actor in enumerate(actors):
        if position == 0:
            _shade(actor, job["view"]["front"])
        renderer.AddActor(actor)
    if job.get("plate"):
        actors = [_plate(job)]
        _shade(actors[0], False)
        renderer.AddActor(actors[0])
    _lights(renderer)
    size = _size(job["view"], job["wide"])
    _view(renderer, job["view"], size)
    return _pixels(_window(renderer, size))


WINDOWS = []  # one of each size: making it costs as much as drawing


def _window(renderer, size):
    """A window that shows the renderer alone."""
    window = next((w for w in WINDOWS if tuple(w.GetSize()) == size), None)
    if window is None:
        window = vtkRenderWindow()
        window.SetOffScreenRendering(True)
        window.SetAlphaBitPlanes(True)
        window.SetMultiSamples(0)
        window.SetSize(*size)
        WINDOWS.append(window)
    for old in list(window.GetRenderers()):
        window.RemoveRenderer(old)
    window.AddRenderer(renderer)
    window.Render()
    return window


def _pixels(window):
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.SetInputBufferTypeToRGBA()
    grab.ReadFrontBufferOff()
    grab.Update()
    image = grab.GetOutput()
    width, height, _ = image.GetDimensions()
    pixels = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, 4)[::-1].copy()
    pixels[..., 3] = np.where(pixels[..., 3] > 0, 255, 0)  # faint lines thin out the ground that they are drawn on
    return pixels
