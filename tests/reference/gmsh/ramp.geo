// The default ramp of opshock (docs/ramp-geometry.md), in mm. gmsh -3 -o ramp.msh ramp.geo
SetFactory("OpenCASCADE");
DefineConstant[ size = {0.8, Name "size"} ];
slot = 0.4175;      // half the disk and the clearance
tip = 0.3; root = 0.9; slope = 1.8; finger = 3.2; width = 1.6;
body = 3.0; body_width = 4.0; depth = 2.6;
neck = 0.8; pad = 2.8; mount = 0.8;
contact = 0.35; contact_length = 0.3;

x[] = {0, contact - contact_length/2, contact + contact_length/2, slope, finger};
volumes[] = {};
For side In {-1:1:2}
  For k In {0:3}
    For e In {0:1}
      t = x[k+e] < slope ? tip + (root - tip)*x[k+e]/slope : root;
      p~{e}~{0} = newp; Point(p~{e}~{0}) = {x[k+e], -width/2, side*slot};
      p~{e}~{1} = newp; Point(p~{e}~{1}) = {x[k+e], -width/2, side*(slot + t)};
    EndFor
    l1 = newl; Line(l1) = {p~{0}~{0}, p~{1}~{0}};
    l2 = newl; Line(l2) = {p~{1}~{0}, p~{1}~{1}};
    l3 = newl; Line(l3) = {p~{1}~{1}, p~{0}~{1}};
    l4 = newl; Line(l4) = {p~{0}~{1}, p~{0}~{0}};
    c = newll; Curve Loop(c) = {l1, l2, l3, l4};
    s = news; Plane Surface(s) = {c};
    out[] = Extrude {0, width, 0} { Surface{s}; };
    volumes[] += out[1];
  EndFor
EndFor
v = newv; Box(v) = {finger, -body_width/2, -depth, body, body_width, depth + slot + root}; volumes[] += v;
v = newv; Box(v) = {finger + body, -body_width/2, -depth, neck, body_width, mount}; volumes[] += v;
v = newv; Box(v) = {finger + body + neck, -body_width/2, -depth, pad, body_width, mount}; volumes[] += v;
all[] = BooleanFragments{ Volume{volumes[]}; Delete; }{};

e = 1e-4;
Physical Volume("body") = {all[]};
Physical Surface("top") = Surface In BoundingBox {x[1]-e, -width/2-e, slot-e, x[2]+e, width/2+e, slot+e};
Physical Surface("bottom") = Surface In BoundingBox {x[1]-e, -width/2-e, -slot-e, x[2]+e, width/2+e, -slot+e};
Physical Surface("mount") = Surface In BoundingBox {finger+body+neck-e, -body_width/2-e, -depth-e, 100, body_width/2+e, -depth+e};

Mesh.ElementOrder = 2;
Mesh.MeshSizeMax = size;
Mesh.MshFileVersion = 4.1;
