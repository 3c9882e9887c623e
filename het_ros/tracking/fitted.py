# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Constants that ``make fit`` writes; not to be edited by hand.

Date: 2026-11-28.
Data: 36170 frames of 156 runs, without and with NanoTrack v3, of 41 sequences, each from its
first true box (1 seed) and from boxes off by a tenth (1 seed): Bolt2 Car1 Couple Crossing
DAVIS-bear DAVIS-breakdance DAVIS-car-roundabout DAVIS-dance-jump DAVIS-dance-twirl
DAVIS-drift-turn DAVIS-horsejump-low DAVIS-mallard-water DAVIS-motocross-bumps DAVIS-soapbox
DAVIS-stroller DAVIS-tennis DTB70-Gull1 DTB70-MountainBike6 David Dog Dog1 DragonBaby FaceOcc1
Freeman1 Human3 Human7 Jogging-1 Jogging-2 MotorRolling SegTrack-frog Skiing UAV-car16_1
UAV-person11 UAV-person12_1 UAV-wakeboard7 VOT15-ball1 Woman rendered-hidden_1s-0
rendered-leaves_and_returns-0 rendered-lookalike_at_column-0 rendered-lookalike_crosses-0.

Held out, each sequence weighing the same:
    without_network: calibration error 0.033, ROC 0.756, 18085 frames, 83% right
    with_network: calibration error 0.035, ROC 0.638, 18085 frames, 86% right
    network_is_right: calibration error 0.193, ROC 0.635, 62 frames, 92% right

``without_network`` is not that of this run but RECORDED_WITH's, which was fitted to tracks of
several judgements: this run's (4.369, 1.534, 3.69, -2.332, -0.785, -4.24, -6.151) costs 0.02 of
AUC, paired over 37 sequences and 3 seeds. Tracks that are judged by `moved` show few large ones,
so a fit to them says too little of it.
"""

from het_ros.tracking.calibration import Calibration

FITTED = Calibration(
    without_network=(3.72, 0.61, 3.46, -3.06, -1.63, -2.67, -4.21),
    with_network=(0.21, 0.703, 1.12, -1.214, 0.377, 3.128, 0.296, -0.022, 5.821, -3.904),
    network_is_right=(5.465, 5.116, 1.16, 2.91),
)

# What the tracker ran with while it was recorded.
RECORDED_WITH = Calibration(
    without_network=(3.72, 0.61, 3.46, -3.06, -1.63, -2.67, -4.21),
    with_network=(4.07, 0.7, 1.81, -0.09, 0.1, 0.66, 2.88, -3.21, 0.0, -5.81),
    network_is_right=(4.28, 2.07, -0.9, 1.03),
)
