(clopen golden program)
(dialect grbl)
(program 2 of 3)
(tool 2 "" drill cone angle 118 deg tip 0 mm diameter 2.5 mm)
G21
G17 G90 G94
(operation holes)
G0 Z5
M3 S6000
G4 P2
G0 X3 Y3
G0 Z0.5
G1 Z-2 F250
G0 Z0.5
G0 Z-1.5
G1 Z-4
G0 Z5
G0 X17 Y16.6667
G0 Z0.5
G1 Z-2
G0 Z0.5
G0 Z-1.5
G1 Z-4
G0 Z5
M5
M30
