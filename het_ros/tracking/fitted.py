# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Constants that ``make fit`` writes; not to be edited by hand.

Date: 2026-11-29.
Data: 36170 frames of 156 runs, without and with NanoTrack v3, of 41 sequences, each from its
first true box (1 seed) and from boxes off by a tenth (1 seed): Bolt2 Car1 Couple Crossing
DAVIS-bear DAVIS-breakdance DAVIS-car-roundabout DAVIS-dance-jump DAVIS-dance-twirl
DAVIS-drift-turn DAVIS-horsejump-low DAVIS-mallard-water DAVIS-motocross-bumps DAVIS-soapbox
DAVIS-stroller DAVIS-tennis DTB70-Gull1 DTB70-MountainBike6 David Dog Dog1 DragonBaby FaceOcc1
Freeman1 Human3 Human7 Jogging-1 Jogging-2 MotorRolling SegTrack-frog Skiing UAV-car16_1
UAV-person11 UAV-person12_1 UAV-wakeboard7 VOT15-ball1 Woman rendered-hidden_1s-0
rendered-leaves_and_returns-0 rendered-lookalike_at_column-0 rendered-lookalike_crosses-0.

Held out, each sequence weighing the same:
    without_network: as before, not of this run
    with_network: calibration error 0.042, ROC 0.752, 18085 frames, 86% right
"""

from het_ros.tracking.calibration import Calibration

FITTED = Calibration(
    without_network=(3.72, 0.61, 3.46, -3.06, -1.63, -2.67, -4.21),
    with_network=(0.362, 0.651, 1.157, -1.078, 0.364, 1.935, 0.524, -0.291, 5.782, -4.181),
)

# What the tracker ran with while it was recorded.
RECORDED_WITH = Calibration(
    without_network=(3.72, 0.61, 3.46, -3.06, -1.63, -2.67, -4.21),
    with_network=(4.07, 0.7, 1.81, -0.09, 0.1, 0.66, 2.88, -3.21, 0.0, -5.81),
)
