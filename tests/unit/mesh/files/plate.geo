SetFactory("Built-in");
Point(1)={0,0,0,0.5}; Point(2)={2,0,0,0.5}; Point(3)={2,1,0,0.5}; Point(4)={0,1,0,0.5}; Point(5)={1,3,0,1};
Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,1}; Line(5)={3,5};
Curve Loop(1)={1,2,3,4}; Plane Surface(1)={1};
Physical Point("corner")={1}; Physical Curve("root")={4}; Physical Curve("stiffener", 7)={2,5}; Physical Surface("skin")={1};
