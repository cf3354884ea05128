// Rectangular plate in three stacked surfaces: between coarse edges a strip of fine spacing, half of it
// above and half below y = height/2. Lengths in m; h and the parameters may be set from outside.
// seed: another arrangement of particles, by a change of the fine spacing of up to .9 % (none for
// seed 1; the golden ratio spreads the others).
// slit: 1 makes the pre-crack a slit. From the left edge to x = crack the strip then is two surfaces that
// meet in two lines along y = height/2, one each, so that all particles there are doubled but the tip.
DefineConstant[ h = 0.00016666666666666666, height = 0.02, width = 0.03, strip = 0.008,
                edge_spacing = 0.001, seed = 1, slit = 0, crack = 0.003 ];
place = 0.6180339887498949*(seed - 1);
fine = h*(1 + 0.009*(place - Floor(place)));
low = (height - strip)/2;
high = (height + strip)/2;
If (low < 1e-9*height || strip < 1e-9*height)
  Error("the strip does not fit into the plate");
EndIf
If (slit != 0 && slit != 1)
  Error("slit is 0 or 1");
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
Line(8) = {8, 1};

If (slit)
  If (crack < h || crack > width - h)
    Error("the slit does not end inside the plate");
  EndIf
  Point(9) = {0, height/2, 0, fine};   // below the slit
  Point(10) = {0, height/2, 0, fine};  // above it
  Point(11) = {crack, height/2, 0, fine};
  Point(12) = {crack, low, 0, fine};
  Point(13) = {crack, high, 0, fine};
  Line(6) = {6, 7};
  Line(7) = {7, 10};
  Line(11) = {9, 8};
  Line(12) = {9, 11};
  Line(13) = {10, 11};
  Line(14) = {8, 12};
  Line(15) = {12, 3};
  Line(16) = {7, 13};
  Line(17) = {13, 4};
  Line(18) = {12, 11};
  Line(19) = {11, 13};
  Curve Loop(1) = {1, 2, -15, -14, 8};
  Curve Loop(2) = {14, 18, -12, 11};
  Curve Loop(3) = {13, 19, -16, 7};
  Curve Loop(4) = {15, 3, -17, -19, -18};
  Curve Loop(5) = {16, 17, 4, 5, 6};
  Plane Surface(1) = {1};
  Plane Surface(2) = {2};
  Plane Surface(3) = {3};
  Plane Surface(4) = {4};
  Plane Surface(5) = {5};
Else
  Line(6) = {6, 7};
  Line(7) = {7, 8};
  Line(9) = {8, 3};
  Line(10) = {7, 4};
  Curve Loop(1) = {1, 2, -9, 8};
  Curve Loop(2) = {9, 3, -10, 7};
  Curve Loop(3) = {10, 4, 5, 6};
  Plane Surface(1) = {1};
  Plane Surface(2) = {2};
  Plane Surface(3) = {3};
EndIf
Mesh.Algorithm = 5;

Physical Curve("bottom") = {1};
Physical Curve("top") = {5};
If (slit)
  Physical Curve("left") = {6, 7, 11, 8};
Else
  Physical Curve("left") = {6, 7, 8};
EndIf
Physical Curve("right") = {2, 3, 4};
Physical Surface("body") = Surface{:};
