(clopen golden program)
(dialect grbl-laser)
(program 2 of 3)
(T2 tool diameter 2.5 mm, drill of 118.0 degrees)
G20
G17 G90 G94
(operation holes)
M5
G0 X0.11811 Y0.11811
G0 X0.66929 Y0.65617
M30
