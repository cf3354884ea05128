"""Voronoi cells in space: the body as the outer faces of its cells, or all cells, seen through, with their particles."""

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

from . import render_lines, voronoi_cells

FACES, OPACITY = (0.36, 0.55, 0.80), 0.16  # of cells that are seen through, as in Fig. 3 of the Voronoi paper
PARTICLE = 0.32  # of the spacing: the diameter of a particle among cells


def polygons(points, corners, begin):
    made = vtkPolyData()
    made.SetPoints(render_lines.vtk_points(points))
    cells = vtkCellArray()
    cells.SetData(numpy_to_vtkIdTypeArray(np.ascontiguousarray(begin, np.int64), deep=True),
                  numpy_to_vtkIdTypeArray(np.ascontiguousarray(corners, np.int64), deep=True))
    made.SetPolys(cells)
    return made


def outlines(corners, begin):
    """(n, 2) corners at the ends of the polygons' edges, each edge once."""
    after = np.arange(1, len(corners) + 1)
    after[begin[1:] - 1] = begin[:-1]
    return np.unique(np.sort(np.stack([corners, corners[after]], -1), axis=1), axis=0)


def skin(job, reference, positions, data):
    """(surface with a colour a polygon, edges of its polygons as lines)."""
    points, corners, begin, owner = voronoi_cells.skin(voronoi_cells.read(job["cells"]), reference, positions, job["h"])
    surface = polygons(points, corners, begin)
    colours = numpy_to_vtk(np.ascontiguousarray(data[owner]), deep=True)
    colours.SetName("color")
    surface.GetCellData().SetScalars(colours)
    return surface, render_lines.lines(points, outlines(corners, begin), job)


def cells(job, reference, positions):
    """Actors of all cells: faces seen through, edges."""
    points, corners, begin, _, _ = voronoi_cells.polygons(voronoi_cells.read(job["cells"]), reference, positions, job["h"])
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(polygons(points, corners, begin))
    mapper.ScalarVisibilityOff()
    faces = vtkActor()
    faces.SetMapper(mapper)
    faces.GetProperty().SetColor(*FACES)
    faces.GetProperty().SetOpacity(OPACITY)
    faces.GetProperty().LightingOff()
    edges = render_lines.lines(points, outlines(corners, begin), job)
    edges.GetProperty().SetOpacity(0.75)
    return [edges, faces]
