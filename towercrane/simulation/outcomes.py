"""How a run can end, in the words of its results."""

from __future__ import annotations

FINISHED = "finished"
INTERRUPTED = "interrupted"

STALLED = "switching without progress"
COLLAPSED = "step size collapsed"
NOT_FINITE = "state not finite"

SLACK_ROPE = "slack rope"
SLACK_SLING = "slack sling"
ROPE_SLACK = "rope goes slack"
ROPE_CAUGHT = "rope is caught"
LANDS = "load lands"
IN_THE_GROUND = "load in the ground"
LIFTS_OFF = "load lifts off"
ON_THE_GROUND = "load on the ground"
SLACK_TIE = "slack tie bar"
NOT_LEVEL = "jib not level on its ties"
TROLLEY_OFF_JIB = "trolley off the jib"
TOWER_BUCKLED = "tower buckled"
JIB_OVER = "jib over backwards"
JIB_AT_STOP = "jib at its stop"
UNSTABLE = "no stable equilibrium"
