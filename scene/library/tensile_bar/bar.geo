// Tensile bar: a straight neck between two wider grips, joined by quarter-circle fillets; the axis is
// x = 0, the bottom y = 0. h and the parameters may be set from outside. Lengths in m.
// algorithm: gmsh's algorithm for surfaces (5 Delaunay, 6 frontal). neck_mesh: 0 free, 1 and 2
// rows of triangles in the neck with right and alternate diagonals, grips free.
DefineConstant[ h = 0.00055, height = 0.04, neck_height = 0.018, neck_width = 0.006,
                grip_width = 0.018, fillet_radius = 0.006, algorithm = 5, neck_mesh = 0 ];
w = neck_width/2;
R = fillet_radius;
g = grip_width/2;
y1 = (height - neck_height)/2;  // the neck's lower and upper end
y2 = height - y1;
tiny = 1e-9*height;
If (w + R > g + tiny || y1 - R < tiny)
  Error("the fillets do not fit between neck and grips");
EndIf
shoulder = g - w - R > tiny;  // a straight piece between fillet and grip

// Counter-clockwise from the lower left corner.
Point(1) = {-g, 0, 0, h};
Point(2) = {g, 0, 0, h};
Point(3) = {g, y1 - R, 0, h};
Point(5) = {w, y1, 0, h};
Point(6) = {w, y2, 0, h};
Point(8) = {g, y2 + R, 0, h};
Point(9) = {g, height, 0, h};
Point(10) = {-g, height, 0, h};
Point(11) = {-g, y2 + R, 0, h};
Point(13) = {-w, y2, 0, h};
Point(14) = {-w, y1, 0, h};
Point(16) = {-g, y1 - R, 0, h};
f4 = 3;  f7 = 8;  f12 = 11;  f15 = 16;  // where the fillets meet the grips
If (shoulder)
  f4 = 4;  f7 = 7;  f12 = 12;  f15 = 15;
  Point(4) = {w + R, y1 - R, 0, h};
  Point(7) = {w + R, y2 + R, 0, h};
  Point(12) = {-w - R, y2 + R, 0, h};
  Point(15) = {-w - R, y1 - R, 0, h};
EndIf
Point(17) = {w + R, y1, 0, h};  // centres
Point(18) = {w + R, y2, 0, h};
Point(19) = {-w - R, y2, 0, h};
Point(20) = {-w - R, y1, 0, h};

Line(1) = {1, 2};
Line(2) = {2, 3};
Circle(4) = {f4, 17, 5};
Line(5) = {5, 6};
Circle(6) = {6, 18, f7};
Line(8) = {8, 9};
Line(9) = {9, 10};
Line(10) = {10, 11};
Circle(12) = {f12, 19, 13};
Line(13) = {13, 14};
Circle(14) = {14, 20, f15};
Line(16) = {16, 1};
lower[] = {};  upper[] = {};  upper_left[] = {};  lower_left[] = {};
If (shoulder)
  Line(3) = {3, 4};
  Line(7) = {7, 8};
  Line(11) = {11, 12};
  Line(15) = {15, 16};
  lower[] = {3};  upper[] = {7};  upper_left[] = {11};  lower_left[] = {15};
EndIf

If (neck_mesh == 0)
  Curve Loop(1) = {1, 2, lower[], 4, 5, 6, upper[], 8, 9, 10, upper_left[], 12, 13, 14,
                   lower_left[], 16};
  Plane Surface(1) = {1};
Else
  Line(17) = {14, 5};
  Line(18) = {13, 6};
  Curve Loop(1) = {1, 2, lower[], 4, -17, 14, lower_left[], 16};
  Curve Loop(2) = {17, 5, -18, 13};
  Curve Loop(3) = {18, 6, upper[], 8, 9, 10, upper_left[], 12};
  Plane Surface(1) = {1};
  Plane Surface(2) = {2};
  Plane Surface(3) = {3};
  Transfinite Curve {5, 13} = Round(neck_height/h) + 1;
  Transfinite Curve {17, 18} = Round(neck_width/h) + 1;
  If (neck_mesh == 1)
    Transfinite Surface {2} = {14, 5, 6, 13} Right;
  Else
    Transfinite Surface {2} = {14, 5, 6, 13} Alternate;
  EndIf
EndIf
Mesh.Algorithm = algorithm;

Physical Curve("bottom") = {1};
Physical Curve("top") = {9};
Physical Surface("body") = Surface "*";
