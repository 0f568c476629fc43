(clopen golden program)
(dialect grbl-laser)
(program 3 of 3)
(tool 1 "" flat diameter 3 mm)
G20
G17 G90 G94
(operation slope)
M5
G0 X0 Y0.7874
M4 S500
G1 X0.7874 F31.496
G3 X0 Y0.7874 I-0.3937 J-0.15748
M5
M30
