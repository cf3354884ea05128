// Ring between two polygons of n sides about the origin: the inner one around the circle `inner`, the outer one within the circle
// `outer`. h, structured, inner, outer and n may be set from outside. Structured: (outer - inner)/h cells across, 2 pi/(n h) along a side.
DefineConstant[ h = 0.125, structured = 1, inner = 0.75, outer = 1.25, n = 24 ];
n = Round(n);

For k In {0:n - 1}
  Point(2*k + 1) = {inner/Cos(Pi/n)*Cos(2*Pi*k/n), inner/Cos(Pi/n)*Sin(2*Pi*k/n), 0, h};
  Point(2*k + 2) = {outer*Cos(2*Pi*k/n), outer*Sin(2*Pi*k/n), 0, h};
EndFor
For k In {0:n - 1}
  next = (k + 1)%n;
  Line(1000 + k) = {2*k + 1, 2*next + 1};  // inner side
  Line(2000 + k) = {2*k + 2, 2*next + 2};  // outer side
  Line(3000 + k) = {2*k + 1, 2*k + 2};     // spoke
EndFor
For k In {0:n - 1}
  next = (k + 1)%n;
  Curve Loop(k + 1) = {3000 + k, 2000 + k, -(3000 + next), -(1000 + k)};
  Plane Surface(k + 1) = {k + 1};
EndFor

If (structured)
  Transfinite Curve {1000:1000 + n - 1, 2000:2000 + n - 1} = Max(1, Round(2*Pi/(n*h))) + 1;
  Transfinite Curve {3000:3000 + n - 1} = Max(1, Round((outer - inner)/h)) + 1;
  Transfinite Surface "*";
EndIf

Physical Curve("inner") = {1000:1000 + n - 1};
Physical Curve("outer") = {2000:2000 + n - 1};
Physical Surface("body") = {1:n};
