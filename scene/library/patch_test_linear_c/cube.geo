// Cube of side A with one corner at the origin. h, structured and A may be set from outside.
DefineConstant[ h = 0.25, structured = 1, A = 1 ];
n = Round(A/h);
If (n < 1)
  n = 1;
EndIf

Point(1) = {0, 0, 0, h};
Point(2) = {A, 0, 0, h};
Point(3) = {A, A, 0, h};
Point(4) = {0, A, 0, h};
Point(5) = {0, 0, A, h};
Point(6) = {A, 0, A, h};
Point(7) = {A, A, A, h};
Point(8) = {0, A, A, h};

Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Line(5) = {5, 6};  Line(6) = {6, 7};  Line(7) = {7, 8};  Line(8) = {8, 5};
Line(9) = {1, 5};  Line(10) = {2, 6}; Line(11) = {3, 7}; Line(12) = {4, 8};

Curve Loop(1) = {-4, -3, -2, -1};     Plane Surface(1) = {1};  // z = 0
Curve Loop(2) = {5, 6, 7, 8};         Plane Surface(2) = {2};  // z = A
Curve Loop(3) = {1, 10, -5, -9};      Plane Surface(3) = {3};  // y = 0
Curve Loop(4) = {3, 12, -7, -11};     Plane Surface(4) = {4};  // y = A
Curve Loop(5) = {4, 9, -8, -12};      Plane Surface(5) = {5};  // x = 0
Curve Loop(6) = {2, 11, -6, -10};     Plane Surface(6) = {6};  // x = A
Surface Loop(1) = {1, 2, 3, 4, 5, 6};
Volume(1) = {1};

If (structured)
  Transfinite Curve "*" = n + 1;
  Transfinite Surface "*";
  Transfinite Volume "*";
EndIf

Physical Surface("x0") = {5};
Physical Surface("x1") = {6};
Physical Surface("y0") = {3};
Physical Surface("y1") = {4};
Physical Surface("z0") = {1};
Physical Surface("z1") = {2};
Physical Surface("surface") = {1, 2, 3, 4, 5, 6};
Physical Surface("sides") = {2, 3, 4, 5, 6};  // all but z = 0
Physical Volume("body") = {1};
