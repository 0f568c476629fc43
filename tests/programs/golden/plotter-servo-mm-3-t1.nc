(clopen golden program)
(dialect plotter-servo)
(program 3 of 3)
(tool 1 "" flat diameter 3 mm)
G21
G17 G90 G94
(operation slope)
M3 S30
G4 P0.2
G0 X0 Y20
M3 S60
G4 P0.2
G1 X20 F800
G3 X0 Y20 I-10 J-4
M3 S30
G4 P0.2
M30
