(clopen golden program)
(dialect plotter-servo)
(program 2 of 3)
(T2 tool diameter 2.5 mm, drill of 118.0 degrees)
G21
G17 G90 G94
(operation holes)
M3 S30
G4 P0.2
G0 X3 Y3
G0 X17 Y16.6667
M30
