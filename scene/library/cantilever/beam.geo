// Beam length x side x side along x: 0 <= x <= length, -side/2 <= y, z <= side/2. h, structured, side and length may be set from outside.
DefineConstant[ h = 0.25, structured = 1, side = 1, length = 6 ];

Point(1) = {0, -side/2, -side/2, h};
Point(2) = {length, -side/2, -side/2, h};
Point(3) = {length,  side/2, -side/2, h};
Point(4) = {0,  side/2, -side/2, h};
Point(5) = {0, -side/2,  side/2, h};
Point(6) = {length, -side/2,  side/2, h};
Point(7) = {length,  side/2,  side/2, h};
Point(8) = {0,  side/2,  side/2, h};

Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Line(5) = {5, 6};  Line(6) = {6, 7};  Line(7) = {7, 8};  Line(8) = {8, 5};
Line(9) = {1, 5};  Line(10) = {2, 6}; Line(11) = {3, 7}; Line(12) = {4, 8};

Curve Loop(1) = {-4, -3, -2, -1};     Plane Surface(1) = {1};  // z = -side/2
Curve Loop(2) = {5, 6, 7, 8};         Plane Surface(2) = {2};  // z = side/2
Curve Loop(3) = {1, 10, -5, -9};      Plane Surface(3) = {3};  // y = -side/2
Curve Loop(4) = {3, 12, -7, -11};     Plane Surface(4) = {4};  // y = side/2
Curve Loop(5) = {4, 9, -8, -12};      Plane Surface(5) = {5};  // x = 0
Curve Loop(6) = {2, 11, -6, -10};     Plane Surface(6) = {6};  // x = length
Surface Loop(1) = {1, 2, 3, 4, 5, 6};
Volume(1) = {1};

If (structured)
  Transfinite Curve {1, 3, 5, 7} = Max(1, Round(length/h)) + 1;
  Transfinite Curve {2, 4, 6, 8, 9, 10, 11, 12} = Max(1, Round(side/h)) + 1;
  Transfinite Surface "*";
  Transfinite Volume "*";
EndIf

Physical Surface("clamped") = {5};
Physical Surface("end") = {6};
Physical Surface("free") = {1, 2, 3, 4, 6};
Physical Volume("body") = {1};
