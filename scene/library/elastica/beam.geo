// Beam 0 <= X <= length, -depth/2 <= Y <= depth/2. h, structured and the lengths may be set from outside.
DefineConstant[ h = 0.0125, structured = 1, length = 1, depth = 0.05 ];

Point(1) = {0, -depth/2, 0, h};
Point(2) = {length, -depth/2, 0, h};
Point(3) = {length, depth/2, 0, h};
Point(4) = {0, depth/2, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};

If (structured)
  Transfinite Curve {1, 3} = Max(1, Round(length/h)) + 1;
  Transfinite Curve {2, 4} = Max(1, Round(depth/h)) + 1;
  Transfinite Surface {1};
EndIf

Physical Curve("clamped") = {4};
Physical Curve("end") = {2};
Physical Surface("body") = {1};
