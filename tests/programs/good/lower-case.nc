g21 g90 g17 g94
n10 g0 z5
n20 m3 s10000
n30 g4 p2
n40 g0 x1y1
n50 g1 z-.5 f100
n60 g1 x+2. f300
n70 g0 z5
n80 m5
n90 m30
