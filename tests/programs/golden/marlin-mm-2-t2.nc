;clopen golden program
;dialect marlin
;program 2 of 3
;tool 2 "" drill cone angle 118 deg tip 0 mm diameter 2.5 mm
G21
G90
;operation holes
G0 Z5 F3000
M3 S51
G4 S2
G0 X3 Y3
G0 Z0.5
G1 Z-2 F250
G0 Z0.5 F3000
G0 Z-1.5
G1 Z-4 F250
G0 Z5 F3000
G0 X17 Y16.6667
G0 Z0.5
G1 Z-2 F250
G0 Z0.5 F3000
G0 Z-1.5
G1 Z-4 F250
G0 Z5 F3000
M5
