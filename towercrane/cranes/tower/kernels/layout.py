"""Where the numbers of the flexible crane's compiled equations are."""

from __future__ import annotations

(ALONG_Y, TORSION, DRIVEN, LATERAL, VERTICAL, COORDINATES, TROLLEY_MASS, GRAVITY, SELF_GRAVITY, SLEWING_MASS,
 STATIC_MOMENT, ROLL, PITCH, YAW, JIB_LENGTH, TILT_LIMIT, LOAD_MASS, DRAG, HINGE_DAMPING,
 SLEWING_CHANNEL, WIND_CHANNEL, SOFT, STIFF, CORNER, DRIVE_DAMPING, FRICTION_TORQUE, FRICTION_RATE,
 HEAD_AREA, HEAD_AREA_MOMENT, PLANE_COSINE, PLANE_SINE, NUMBERS) = range(32)  # fmt: skip
"""Entries of ``numbers``, and how many they are. The coordinates of the tower along x come first; the first five
say where the others begin, and COORDINATES how many there are. SELF_GRAVITY is zero where the structure's own weight
is left out; a channel is -1 where there is none; PLANE_COSINE and PLANE_SINE are those of the angle from the fixed
x axis to the first axis of the coordinates, zero but in a plane."""

KNOWN = (ALONG_Y, TORSION, DRIVEN, LATERAL, VERTICAL, COORDINATES, SLEWING_CHANNEL, WIND_CHANNEL)
"""Those that the equations count and choose with."""

SLIDE_X, SLIDE_Y, TILT_X, TILT_Y, TURN, JIB_MASS, JIB_MOMENT, DAMPING, EXPOSURE, CAP, VECTORS = range(11)
"""Rows of ``vectors``, and how many, zero where they do not apply: what a coordinate moves the head (u_x and u_y of
the tower's top, tilt vector th_x and th_y, turning), int m phi and int m x phi of the jib modes, viscous damping,
int c phi of tower and jib modes with the drag c per squared speed, mass added to a coordinate itself where its
frequency is capped."""

MOTIONS = TURN + 1
"""How many motions the head has; their rows come first."""

OWN, STIFFNESS = range(2)
"""Entries of ``matrices``: mass of the tower alone, of the drive, and int m phi_i phi_j of all jib modes, lateral
with vertical too; stiffness."""

TROLLEY, ROPE, SLEWING = range(3)
"""Rows of ``inputs``; a slewing motion is there unless the head is fixed, the wind's three come last."""

TENSION, INNER_END, OUTER_END, TILT, INSIDE, OUTSIDE, SLEWING_TORQUE, TROLLEY_FORCE, GUARDS = range(9)
"""Guards, and how many: rope tension [N], way to either end of the jib [m], way to the tilt limit [rad], way to the
corner of the drive's coupling from inside and from outside [rad]. Outputs beside them: torque of the slewing drive
[N m] and force of the trolley's [N]."""

SHAPE, ACROSS, ROWS = range(3)
"""Rows of scratch after the mass matrix, and how many: jib modes at the trolley; N q of each jib mode with the other
direction."""
