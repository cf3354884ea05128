// Strip width x height x depth, 0 <= X <= width, 0 <= Y <= height, 0 <= Z <= depth, its top Y = height divided into thirds.
// h, structured and the lengths may be set from outside. Structured: each third has Round(width/(3 h)) spacings, the height and the
// depth what fits best; `layers` > 0 sets the number through the depth, which h = width/21 would make 2 instead of the paper's 3.
DefineConstant[ h = 1/21, structured = 1, width = 1, height = 0.5, depth = 0.1, layers = 0 ];

Point(1) = {0, 0, 0, h};  Point(2) = {width/3, 0, 0, h};  Point(3) = {2*width/3, 0, 0, h};  Point(4) = {width, 0, 0, h};
Point(5) = {0, height, 0, h};  Point(6) = {width/3, height, 0, h};  Point(7) = {2*width/3, height, 0, h};  Point(8) = {width, height, 0, h};
Point(9) = {0, 0, depth, h};  Point(10) = {width/3, 0, depth, h};  Point(11) = {2*width/3, 0, depth, h};  Point(12) = {width, 0, depth, h};
Point(13) = {0, height, depth, h};  Point(14) = {width/3, height, depth, h};  Point(15) = {2*width/3, height, depth, h};  Point(16) = {width, height, depth, h};

Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};
Line(4) = {5, 6};  Line(5) = {6, 7};  Line(6) = {7, 8};
Line(7) = {1, 5};  Line(8) = {2, 6};  Line(9) = {3, 7};  Line(10) = {4, 8};
Line(11) = {9, 10};  Line(12) = {10, 11};  Line(13) = {11, 12};
Line(14) = {13, 14};  Line(15) = {14, 15};  Line(16) = {15, 16};
Line(17) = {9, 13};  Line(18) = {10, 14};  Line(19) = {11, 15};  Line(20) = {12, 16};
Line(21) = {1, 9};  Line(22) = {2, 10};  Line(23) = {3, 11};  Line(24) = {4, 12};
Line(25) = {5, 13};  Line(26) = {6, 14};  Line(27) = {7, 15};  Line(28) = {8, 16};

Curve Loop(1) = {1, 8, -4, -7};  Plane Surface(1) = {1};  // z = 0
Curve Loop(2) = {2, 9, -5, -8};  Plane Surface(2) = {2};  // z = 0
Curve Loop(3) = {3, 10, -6, -9};  Plane Surface(3) = {3};  // z = 0
Curve Loop(4) = {11, 18, -14, -17};  Plane Surface(4) = {4};  // z = depth
Curve Loop(5) = {12, 19, -15, -18};  Plane Surface(5) = {5};  // z = depth
Curve Loop(6) = {13, 20, -16, -19};  Plane Surface(6) = {6};  // z = depth
Curve Loop(7) = {1, 22, -11, -21};  Plane Surface(7) = {7};  // y = 0
Curve Loop(8) = {2, 23, -12, -22};  Plane Surface(8) = {8};  // y = 0
Curve Loop(9) = {3, 24, -13, -23};  Plane Surface(9) = {9};  // y = 0
Curve Loop(10) = {4, 26, -14, -25};  Plane Surface(10) = {10};  // y = height
Curve Loop(11) = {5, 27, -15, -26};  Plane Surface(11) = {11};  // y = height
Curve Loop(12) = {6, 28, -16, -27};  Plane Surface(12) = {12};  // y = height
Curve Loop(13) = {7, 25, -17, -21};  Plane Surface(13) = {13};  // x = 0
Curve Loop(14) = {8, 26, -18, -22};  Plane Surface(14) = {14};  // x = width/3
Curve Loop(15) = {9, 27, -19, -23};  Plane Surface(15) = {15};  // x = 2*width/3
Curve Loop(16) = {10, 28, -20, -24};  Plane Surface(16) = {16};  // x = width

Surface Loop(1) = {1, 4, 7, 10, 13, 14};  Volume(1) = {1};
Surface Loop(2) = {2, 5, 8, 11, 14, 15};  Volume(2) = {2};
Surface Loop(3) = {3, 6, 9, 12, 15, 16};  Volume(3) = {3};

nz = layers > 0 ? Round(layers) : Max(1, Round(depth/h));
If (structured)
  Transfinite Curve {1, 2, 3, 4, 5, 6, 11, 12, 13, 14, 15, 16} = Max(1, Round(width/(3*h))) + 1;
  Transfinite Curve {7, 8, 9, 10, 17, 18, 19, 20} = Max(1, Round(height/h)) + 1;
  Transfinite Curve {21, 22, 23, 24, 25, 26, 27, 28} = nz + 1;
  Transfinite Surface "*";
  Transfinite Volume "*";
EndIf

Physical Surface("punch") = {11};
Physical Surface("top") = {10, 12};  // the rest of it, free
Physical Surface("bottom") = {7, 8, 9};
Physical Surface("x0") = {13};
Physical Surface("x1") = {16};
Physical Surface("z0") = {1, 2, 3};
Physical Surface("z1") = {4, 5, 6};
Physical Volume("body") = {1, 2, 3};
