// Quarter of a block: side x side x height, 0 <= X, Y <= side, 0 <= Z <= height, its top divided at X, Y = punch.
// h, structured and the lengths may be set from outside. With h = side/n, n a multiple of 3, and punch = side/3 the lattice is even.
// grade > 1 (finite elements): spacings shrink towards the punch's edge and towards the top, from the first to the last of each line
// by nearly this factor.
DefineConstant[ h = 0.0001, structured = 1, side = 0.001, height = 0.001, punch = 0.001/3, grade = 1 ];

Point(1) = {0, 0, 0, h};  Point(2) = {punch, 0, 0, h};  Point(3) = {side, 0, 0, h};
Point(4) = {0, punch, 0, h};  Point(5) = {punch, punch, 0, h};  Point(6) = {side, punch, 0, h};
Point(7) = {0, side, 0, h};  Point(8) = {punch, side, 0, h};  Point(9) = {side, side, 0, h};
Point(10) = {0, 0, height, h};  Point(11) = {punch, 0, height, h};  Point(12) = {side, 0, height, h};
Point(13) = {0, punch, height, h};  Point(14) = {punch, punch, height, h};  Point(15) = {side, punch, height, h};
Point(16) = {0, side, height, h};  Point(17) = {punch, side, height, h};  Point(18) = {side, side, height, h};

Line(1) = {1, 2};  Line(2) = {2, 3};
Line(3) = {4, 5};  Line(4) = {5, 6};
Line(5) = {7, 8};  Line(6) = {8, 9};
Line(7) = {1, 4};  Line(8) = {4, 7};
Line(9) = {2, 5};  Line(10) = {5, 8};
Line(11) = {3, 6};  Line(12) = {6, 9};
Line(13) = {10, 11};  Line(14) = {11, 12};
Line(15) = {13, 14};  Line(16) = {14, 15};
Line(17) = {16, 17};  Line(18) = {17, 18};
Line(19) = {10, 13};  Line(20) = {13, 16};
Line(21) = {11, 14};  Line(22) = {14, 17};
Line(23) = {12, 15};  Line(24) = {15, 18};
Line(25) = {1, 10};  Line(26) = {2, 11};  Line(27) = {3, 12};
Line(28) = {4, 13};  Line(29) = {5, 14};  Line(30) = {6, 15};
Line(31) = {7, 16};  Line(32) = {8, 17};  Line(33) = {9, 18};

Curve Loop(1) = {1, 9, -3, -7};  Plane Surface(1) = {1};  // bottom
Curve Loop(2) = {2, 11, -4, -9};  Plane Surface(2) = {2};  // bottom
Curve Loop(3) = {3, 10, -5, -8};  Plane Surface(3) = {3};  // bottom
Curve Loop(4) = {4, 12, -6, -10};  Plane Surface(4) = {4};  // bottom
Curve Loop(5) = {13, 21, -15, -19};  Plane Surface(5) = {5};  // top, under the punch
Curve Loop(6) = {14, 23, -16, -21};  Plane Surface(6) = {6};  // top
Curve Loop(7) = {15, 22, -17, -20};  Plane Surface(7) = {7};  // top
Curve Loop(8) = {16, 24, -18, -22};  Plane Surface(8) = {8};  // top
Curve Loop(9) = {7, 28, -19, -25};  Plane Surface(9) = {9};  // x = 0
Curve Loop(10) = {8, 31, -20, -28};  Plane Surface(10) = {10};  // x = 0
Curve Loop(11) = {9, 29, -21, -26};  Plane Surface(11) = {11};  // x = punch
Curve Loop(12) = {10, 32, -22, -29};  Plane Surface(12) = {12};  // x = punch
Curve Loop(13) = {11, 30, -23, -27};  Plane Surface(13) = {13};  // x = side
Curve Loop(14) = {12, 33, -24, -30};  Plane Surface(14) = {14};  // x = side
Curve Loop(15) = {1, 26, -13, -25};  Plane Surface(15) = {15};  // y = 0
Curve Loop(16) = {2, 27, -14, -26};  Plane Surface(16) = {16};  // y = 0
Curve Loop(17) = {3, 29, -15, -28};  Plane Surface(17) = {17};  // y = punch
Curve Loop(18) = {4, 30, -16, -29};  Plane Surface(18) = {18};  // y = punch
Curve Loop(19) = {5, 32, -17, -31};  Plane Surface(19) = {19};  // y = side
Curve Loop(20) = {6, 33, -18, -32};  Plane Surface(20) = {20};  // y = side

Surface Loop(1) = {1, 5, 9, 11, 15, 17};  Volume(1) = {1};
Surface Loop(2) = {2, 6, 11, 13, 16, 18};  Volume(2) = {2};
Surface Loop(3) = {3, 7, 10, 12, 17, 19};  Volume(3) = {3};
Surface Loop(4) = {4, 8, 12, 14, 18, 20};  Volume(4) = {4};

If (structured)
  n1 = Max(1, Round(punch/h));  n2 = Max(1, Round((side - punch)/h));  n3 = Max(1, Round(height/h));
  If (grade == 1)
    Transfinite Curve {1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23} = n1 + 1;
    Transfinite Curve {2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24} = n2 + 1;
    Transfinite Curve {25, 26, 27, 28, 29, 30, 31, 32, 33} = n3 + 1;
  Else
    Transfinite Curve {1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23} = n1 + 1 Using Progression grade^(-1/n1);
    Transfinite Curve {2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24} = n2 + 1 Using Progression grade^(1/n2);
    Transfinite Curve {25, 26, 27, 28, 29, 30, 31, 32, 33} = n3 + 1 Using Progression grade^(-1/n3);
  EndIf
  Transfinite Surface "*";
  Transfinite Volume "*";
EndIf

Physical Surface("punch") = {5};
Physical Surface("top") = {6, 7, 8};  // the rest of it, free
Physical Surface("bottom") = {1, 3, 2, 4};
Physical Surface("x0") = {9, 10};
Physical Surface("y0") = {15, 16};
Physical Volume("body") = {1, 2, 3, 4};
