// Five blocks in the shape of a ramp, in mm: a small mesh of every kind that is read.
SetFactory("OpenCASCADE");
Box(1) = {0, -0.5, 0.4, 1, 1, 0.6};
Box(2) = {0, -0.5, -1.0, 1, 1, 0.6};
Box(3) = {1, -0.5, 0.4, 1, 1, 0.6};
Box(4) = {1, -0.5, -0.4, 1, 1, 0.8};
Box(5) = {1, -0.5, -1.0, 1, 1, 0.6};
all[] = BooleanFragments{ Volume{1:5}; Delete; }{};
e = 1e-3;
Physical Volume("body") = {all[]};
Physical Surface("top") = Surface In BoundingBox {-e, -1, 0.4-e, 1+e, 1, 0.4+e};
Physical Surface("bottom") = Surface In BoundingBox {-e, -1, -0.4-e, 1+e, 1, -0.4+e};
Physical Surface("mount") = Surface In BoundingBox {2-e, -1, -2, 2+e, 1, 2};
Mesh.ElementOrder = 2;
If (hexahedra)
  Transfinite Curve "*" = 2;
  Transfinite Surface "*";
  Recombine Surface "*";
  Transfinite Volume "*";
Else
  Mesh.MeshSizeMin = 2;
EndIf
