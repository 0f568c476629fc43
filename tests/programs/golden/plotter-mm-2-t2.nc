(clopen golden program)
(dialect plotter)
(program 2 of 3)
(tool 2 "" drill cone angle 118 deg tip 0 mm diameter 2.5 mm)
G21
G17 G90 G94
(operation holes)
G0 Z3
G0 X3 Y3
G0 X17 Y16.6667
M30
