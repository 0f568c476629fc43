(clopen golden program)
(dialect plotter-servo)
(program 3 of 3)
(tool 1 "" flat diameter 3 mm)
G20
G17 G90 G94
(operation slope)
M3 S30
G4 P0.2
G0 X0 Y0.7874
M3 S60
G4 P0.2
G1 X0.7874 F31.496
G3 X0 Y0.7874 I-0.3937 J-0.15748
M3 S30
G4 P0.2
M30
