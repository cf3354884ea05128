// Block A x B x C, standing on the plane Z = 0, its axis on X = Y = 0. h, structured, A, B and C may be
// set from outside.
DefineConstant[ h = 0.25, structured = 1, A = 1, B = 1, C = 1 ];

Point(1) = {-A/2, -B/2, 0, h};
Point(2) = { A/2, -B/2, 0, h};
Point(3) = { A/2,  B/2, 0, h};
Point(4) = {-A/2,  B/2, 0, h};
Point(5) = {-A/2, -B/2, C, h};
Point(6) = { A/2, -B/2, C, h};
Point(7) = { A/2,  B/2, C, h};
Point(8) = {-A/2,  B/2, C, h};

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
  Transfinite Curve {1, 3, 5, 7} = Max(1, Round(A/h)) + 1;
  Transfinite Curve {2, 4, 6, 8} = Max(1, Round(B/h)) + 1;
  Transfinite Curve {9, 10, 11, 12} = Max(1, Round(C/h)) + 1;
  Transfinite Surface "*";
  Transfinite Volume "*";
EndIf

Physical Surface("bottom") = {1};
Physical Surface("top") = {2};
Physical Surface("sides") = {3, 4, 5, 6};
Physical Volume("body") = {1};
