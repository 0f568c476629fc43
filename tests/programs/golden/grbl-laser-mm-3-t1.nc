(clopen golden program)
(dialect grbl-laser)
(program 3 of 3)
(tool 1 "" flat diameter 3 mm)
G21
G17 G90 G94
(operation slope)
M5
G0 X0 Y20
M4 S500
G1 X20 F800
G3 X0 Y20 I-10 J-4
M5
M30
