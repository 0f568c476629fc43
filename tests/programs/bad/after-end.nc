(after-end: the cut below never runs)
G21 G90 G17 G94
G0 Z5
M3 S12000
G4 P3
G0 X0 Y0
G1 Z-1 F300
G1 X10 F900
G0 Z5
M5
M30
%
(a comment is nothing)
G0 X20
G1 X30 F900
