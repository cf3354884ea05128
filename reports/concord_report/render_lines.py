"""Lines on bodies drawn with VTK: edges of cells, curved where they are, and a body's own sharp edges."""

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkCleanPolyData, vtkFeatureEdges
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

from . import frames

TETRAHEDRON = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))  # edges in VTK's order, as are the nodes on them
HEXAHEDRON = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))
CELLS = {10: (4, TETRAHEDRON), 24: (10, TETRAHEDRON), 12: (8, HEXAHEDRON), 25: (20, HEXAHEDRON), 29: (27, HEXAHEDRON)}
PIECES = 6  # of a curved edge


def vtk_points(positions):
    made = vtkPoints()
    made.SetData(numpy_to_vtk(np.ascontiguousarray(positions, float), deep=True))
    return made


def vtk_cells(cells):
    made = vtkCellArray()
    made.SetData(numpy_to_vtkIdTypeArray(np.arange(len(cells) + 1) * cells.shape[1], deep=True),
                 numpy_to_vtkIdTypeArray(np.ascontiguousarray(cells.reshape(-1), np.int64), deep=True))
    return made


def lines(points, lines, job):
    """Thin dark lines, a little nearer to the eye than they are."""
    view = job["view"]
    reach = max(h - l for l, h in zip(view["low"], view["high"]))
    drawing = vtkPolyData()
    drawing.SetPoints(vtk_points(points + 0.002 * reach * frames.view_axes(view["front"])[2]))
    drawing.SetLines(vtk_cells(lines))
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(drawing)
    mapper.ScalarVisibilityOff()
    actor = vtkActor()
    actor.SetMapper(mapper)
    look = actor.GetProperty()
    look.SetColor(0.05, 0.06, 0.08)
    look.SetOpacity(0.35)
    look.SetLineWidth(2.0)
    look.LightingOff()
    return actor


def creases(skin, job):
    """The body's own sharp edges: where a field is nearly white, the page would swallow the body."""
    clean = vtkCleanPolyData()  # faces of cells and shares meet in one point
    clean.SetInputData(skin)
    clean.SetTolerance(1e-6)
    edges = vtkFeatureEdges()
    edges.SetInputConnection(clean.GetOutputPort())
    edges.SetFeatureAngle(50)
    edges.NonManifoldEdgesOff()
    edges.BoundaryEdgesOff()
    edges.ColoringOff()
    edges.Update()
    found = edges.GetOutput()
    if not found.GetNumberOfPoints():
        return []
    pairs = vtk_to_numpy(found.GetLines().GetConnectivityArray()).reshape(-1, 2)
    return [lines(vtk_to_numpy(found.GetPoints().GetData()).astype(float), pairs, job)]


def edges(frame, positions, job):
    """The cells' edges, curved where they are; inner ones are hidden by the surface."""
    actors = []
    for kind in sorted(set(np.unique(frame["types"]).tolist()) & set(CELLS)):
        nodes, ends = CELLS[kind]
        starts = np.asarray(frame["offsets"])[:-1][frame["types"] == kind]
        cells = frame["connectivity"][starts[:, None] + np.arange(nodes)]
        pairs = np.sort(cells[:, ends].reshape(-1, 2), axis=1)
        pairs, first = np.unique(pairs, axis=0, return_index=True)
        corners = max(map(max, ends)) + 1
        curved = nodes > corners
        t = np.linspace(0, 1, PIECES + 1) if curved else np.array([0, 1])
        line = np.einsum("p,ed->epd", 1 - t, positions[pairs[:, 0]]) + np.einsum("p,ed->epd", t, positions[pairs[:, 1]])
        if curved:  # what the node on the edge is off its middle
            middle = cells[:, corners:corners + len(ends)].reshape(-1)[first]
            line += np.einsum("p,ed->epd", 4 * t * (1 - t), positions[middle] - positions[pairs].mean(axis=1))
        actors.append(lines(line.reshape(-1, 3), np.arange(len(line) * len(t)).reshape(-1, len(t)), job))
    return actors
