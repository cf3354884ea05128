// Cook's membrane: a trapezoid, clamped on the left, loaded on the right. h, structured and the
// lengths may be set from outside. Structured: n x n cells with n = width/h.
DefineConstant[ h = 0.006, structured = 1, width = 0.048, left = 0.044, right = 0.016 ];
n = Round(width/h);
If (n < 1)
  n = 1;
EndIf

Point(1) = {0, 0, 0, h};
Point(2) = {width, left, 0, h};
Point(3) = {width, left + right, 0, h};
Point(4) = {0, left, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};

If (structured)
  Transfinite Curve "*" = n + 1;
  Transfinite Surface {1};
EndIf

Physical Curve("left") = {4};
Physical Curve("right") = {2};
Physical Surface("body") = {1};
