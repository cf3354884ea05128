// L-shaped block: a leg 0 <= X <= thick, 0 <= Y <= height and a foot thick <= X <= foot, 0 <= Y <= thick, 0 <= Z <= depth.
// h, structured and the lengths may be set from outside. Structured: every length is divided evenly, so h = thick/n gives cubes
// where height, foot and depth are multiples of h.
DefineConstant[ h = 1, structured = 1, thick = 3, height = 10, foot = 6, depth = 3 ];

Point(1) = {0, 0, 0, h};
Point(2) = {thick, 0, 0, h};
Point(3) = {foot, 0, 0, h};
Point(4) = {foot, thick, 0, h};
Point(5) = {thick, thick, 0, h};
Point(6) = {thick, height, 0, h};
Point(7) = {0, height, 0, h};
Point(8) = {0, thick, 0, h};
Point(11) = {0, 0, depth, h};
Point(12) = {thick, 0, depth, h};
Point(13) = {foot, 0, depth, h};
Point(14) = {foot, thick, depth, h};
Point(15) = {thick, thick, depth, h};
Point(16) = {thick, height, depth, h};
Point(17) = {0, height, depth, h};
Point(18) = {0, thick, depth, h};

Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 5};  Line(5) = {5, 6};
Line(6) = {6, 7};  Line(7) = {7, 8};  Line(8) = {8, 1};  Line(9) = {2, 5};  Line(10) = {5, 8};
Line(11) = {11, 12};  Line(12) = {12, 13};  Line(13) = {13, 14};  Line(14) = {14, 15};  Line(15) = {15, 16};
Line(16) = {16, 17};  Line(17) = {17, 18};  Line(18) = {18, 11};  Line(19) = {12, 15};  Line(20) = {15, 18};
Line(21) = {1, 11};  Line(22) = {2, 12};  Line(23) = {3, 13};  Line(24) = {4, 14};
Line(25) = {5, 15};  Line(26) = {6, 16};  Line(27) = {7, 17};  Line(28) = {8, 18};

Curve Loop(1) = {-8, -10, -9, -1};    Plane Surface(1) = {1};   // z = 0, corner
Curve Loop(2) = {9, -4, -3, -2};      Plane Surface(2) = {2};   // foot
Curve Loop(3) = {10, -7, -6, -5};     Plane Surface(3) = {3};   // leg
Curve Loop(4) = {11, 19, 20, 18};     Plane Surface(4) = {4};   // z = depth, corner
Curve Loop(5) = {12, 13, 14, -19};    Plane Surface(5) = {5};
Curve Loop(6) = {-20, 15, 16, 17};    Plane Surface(6) = {6};
Curve Loop(7) = {1, 22, -11, -21};    Plane Surface(7) = {7};   // y = 0, corner
Curve Loop(8) = {2, 23, -12, -22};    Plane Surface(8) = {8};   // y = 0, foot
Curve Loop(9) = {3, 24, -13, -23};    Plane Surface(9) = {9};   // x = foot: the foot's end
Curve Loop(10) = {4, 25, -14, -24};   Plane Surface(10) = {10}; // y = thick, foot
Curve Loop(11) = {5, 26, -15, -25};   Plane Surface(11) = {11}; // x = thick, leg
Curve Loop(12) = {6, 27, -16, -26};   Plane Surface(12) = {12}; // y = height: the leg's end
Curve Loop(13) = {7, 28, -17, -27};   Plane Surface(13) = {13}; // x = 0, leg
Curve Loop(14) = {8, 21, -18, -28};   Plane Surface(14) = {14}; // x = 0, corner
Curve Loop(15) = {9, 25, -19, -22};   Plane Surface(15) = {15}; // inside, x = thick
Curve Loop(16) = {10, 28, -20, -25};  Plane Surface(16) = {16}; // inside, y = thick

Surface Loop(1) = {1, 4, 7, 14, 15, 16};   Volume(1) = {1};
Surface Loop(2) = {2, 5, 8, 9, 10, 15};    Volume(2) = {2};
Surface Loop(3) = {3, 6, 11, 12, 13, 16};  Volume(3) = {3};

If (structured)
  Transfinite Curve {1, 11, 6, 16, 10, 20} = Max(1, Round(thick/h)) + 1;
  Transfinite Curve {3, 13, 8, 18, 9, 19} = Max(1, Round(thick/h)) + 1;
  Transfinite Curve {2, 12, 4, 14} = Max(1, Round((foot - thick)/h)) + 1;
  Transfinite Curve {5, 15, 7, 17} = Max(1, Round((height - thick)/h)) + 1;
  Transfinite Curve {21, 22, 23, 24, 25, 26, 27, 28} = Max(1, Round(depth/h)) + 1;
  Transfinite Surface "*";
  Transfinite Volume "*";
EndIf

Physical Surface("foot_end") = {9};
Physical Surface("leg_end") = {12};
Physical Surface("surface") = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14};
Physical Volume("body") = {1, 2, 3};
