(clopen golden program)
(dialect grbl-laser)
(program 2 of 3)
(tool 2 "" drill cone angle 118 deg tip 0 mm diameter 2.5 mm)
G20
G17 G90 G94
(operation holes)
M5
G0 X0.11811 Y0.11811
G0 X0.66929 Y0.65617
M30
