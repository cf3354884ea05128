// Square -half <= X, Y <= half. h, structured and half may be set from outside. Structured: n x n cells, n = 2 half/h.
DefineConstant[ h = 0.125, structured = 1, half = 1.5 ];
n = Max(1, Round(2*half/h));

Point(1) = {-half, -half, 0, h};
Point(2) = { half, -half, 0, h};
Point(3) = { half,  half, 0, h};
Point(4) = {-half,  half, 0, h};
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

Physical Curve("sides") = {1, 2, 3, 4};
Physical Surface("body") = {1};
