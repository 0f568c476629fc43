;clopen golden program
;dialect smoothieware
;program 3 of 3
;tool 1 "" flat diameter 3 mm
G20
G17 G90
;operation slope
G0 Z0.19685
M3 S10000
G4 S2
G0 X0 Y0.7874
G1 Z-0.00984 F9.843
G1 X0.7874 Z-0.04921 F31.496
G3 X0 Y0.7874 I-0.3937 J-0.15748
G0 Z0.19685
M5
M2
