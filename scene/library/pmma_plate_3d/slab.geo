// The plate of ../pmma_plate drawn out along Z: three stacked surfaces, between coarse edges a strip of fine
// spacing, in layers of the fine spacing over the thickness. Lengths in m; h and the parameters may be set
// from outside. seed: as there, another arrangement by a change of the fine spacing.
DefineConstant[ h = 0.0005, height = 0.02, width = 0.03, thickness = 0.001, strip = 0.008,
                edge_spacing = 0.001, seed = 1 ];
place = 0.6180339887498949*(seed - 1);
fine = h*(1 + 0.009*(place - Floor(place)));
low = (height - strip)/2;
high = (height + strip)/2;
layers = Max(1, Round(thickness/h));
If (low < 1e-9*height || strip < 1e-9*height)
  Error("the strip does not fit into the plate");
EndIf

Point(1) = {0, 0, 0, edge_spacing};
Point(2) = {width, 0, 0, edge_spacing};
Point(3) = {width, low, 0, fine};
Point(4) = {width, high, 0, fine};
Point(5) = {width, height, 0, edge_spacing};
Point(6) = {0, height, 0, edge_spacing};
Point(7) = {0, high, 0, fine};
Point(8) = {0, low, 0, fine};

Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 7};
Line(7) = {7, 8};
Line(8) = {8, 1};
Line(9) = {8, 3};
Line(10) = {7, 4};

Curve Loop(1) = {1, 2, -9, 8};
Curve Loop(2) = {9, 3, -10, 7};
Curve Loop(3) = {10, 4, 5, 6};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Plane Surface(3) = {3};
Mesh.Algorithm = 5;

// Of each: the far face, the volume, then the sides in the order of the loop.
lower[] = Extrude {0, 0, thickness} { Surface{1}; Layers{layers}; };
middle[] = Extrude {0, 0, thickness} { Surface{2}; Layers{layers}; };
upper[] = Extrude {0, 0, thickness} { Surface{3}; Layers{layers}; };

Physical Surface("bottom") = {lower[2]};
Physical Surface("top") = {upper[4]};
Physical Surface("left") = {lower[5], middle[5], upper[5]};
Physical Surface("right") = {lower[3], middle[3], upper[3]};
Physical Surface("back") = {1, 2, 3};
Physical Surface("front") = {lower[0], middle[0], upper[0]};
Physical Volume("body") = {lower[1], middle[1], upper[1]};
