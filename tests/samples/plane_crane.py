"""A plane crane of one segment for each member, without a counter-jib."""

from modal import Chain, CraneFrame, EndBody, Segment

HEIGHT, REACH, BENDING = 24.0, 50.0, 2.9e9
TOWER = Chain((Segment(HEIGHT, 350.0, BENDING),), {1: EndBody(17000.0, 3e6)})
JIB = Chain((Segment(REACH, 120.0, 7e8),))
FRAME = CraneFrame(TOWER, JIB, None, 350.0, 800.0, 18.0)
