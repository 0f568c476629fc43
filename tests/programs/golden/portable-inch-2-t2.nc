(clopen golden program)
(dialect portable)
(program 2 of 3)
(tool 2 "" drill cone angle 118 deg tip 0 mm diameter 2.5 mm)
G20
G17 G90 G94
(operation holes)
G0 Z0.19685
M3 S6000
G4 P2
G0 X0.11811 Y0.11811
G0 Z0.01969
G1 Z-0.07874 F9.843
G0 Z0.01969
G0 Z-0.05906
G1 Z-0.15748
G0 Z0.19685
G0 X0.66929 Y0.65617
G0 Z0.01969
G1 Z-0.07874
G0 Z0.01969
G0 Z-0.05906
G1 Z-0.15748
G0 Z0.19685
M5
M30
