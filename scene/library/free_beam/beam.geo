// Beam side x side x length along z: -side/2 <= x, y <= side/2, 0 <= z <= length. h, structured, side and length may be set from outside.
DefineConstant[ h = 0.25, structured = 1, side = 1, length = 6 ];

Point(1) = {-side/2, -side/2, 0, h};
Point(2) = { side/2, -side/2, 0, h};
Point(3) = { side/2,  side/2, 0, h};
Point(4) = {-side/2,  side/2, 0, h};
Point(5) = {-side/2, -side/2, length, h};
Point(6) = { side/2, -side/2, length, h};
Point(7) = { side/2,  side/2, length, h};
Point(8) = {-side/2,  side/2, length, h};

Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Line(5) = {5, 6};  Line(6) = {6, 7};  Line(7) = {7, 8};  Line(8) = {8, 5};
Line(9) = {1, 5};  Line(10) = {2, 6}; Line(11) = {3, 7}; Line(12) = {4, 8};

Curve Loop(1) = {-4, -3, -2, -1};     Plane Surface(1) = {1};
Curve Loop(2) = {5, 6, 7, 8};         Plane Surface(2) = {2};
Curve Loop(3) = {1, 10, -5, -9};      Plane Surface(3) = {3};
Curve Loop(4) = {3, 12, -7, -11};     Plane Surface(4) = {4};
Curve Loop(5) = {4, 9, -8, -12};      Plane Surface(5) = {5};
Curve Loop(6) = {2, 11, -6, -10};     Plane Surface(6) = {6};
Surface Loop(1) = {1, 2, 3, 4, 5, 6};
Volume(1) = {1};

If (structured)
  Transfinite Curve {1, 2, 3, 4, 5, 6, 7, 8} = Max(1, Round(side/h)) + 1;
  Transfinite Curve {9, 10, 11, 12} = Max(1, Round(length/h)) + 1;
  Transfinite Surface "*";
  Transfinite Volume "*";
EndIf

Physical Surface("surface") = {1, 2, 3, 4, 5, 6};
Physical Volume("body") = {1};
