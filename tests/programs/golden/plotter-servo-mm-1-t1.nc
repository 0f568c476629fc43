(clopen golden program)
(dialect plotter-servo)
(program 1 of 3)
(tool 1 "" flat diameter 3 mm)
G21
G17 G90 G94
(operation pocket)
M3 S30
G4 P0.2
G0 X12 Y10
M3 S60
G4 P0.2
G3 X8 Y10 I-2 J0 F800
G3 X12 Y10 I2 J0
G1 X14
G1 Y13
G3 X13 Y14 I-1 J0
G1 X11
G1 X10.5
G1 X9.5
G1 X9
G1 X7
G3 X6 Y13 I0 J-1
G1 Y7
G3 X7 Y6 I1 J0
G1 X13
G3 X14 Y7 I0 J1
G1 Y10
M3 S30
G4 P0.2
M30
