(clopen golden program)
(dialect portable)
(program 3 of 3)
(tool 1 "" flat diameter 3 mm)
G21
G17 G90 G94
(operation slope)
G0 Z5
M3 S10000
G4 P2
G0 X0 Y20
G1 Z-0.25 F250
G1 X20 Z-1.25 F800
G3 X0 Y20 I-10 J-4
G0 Z5
M5
M30
