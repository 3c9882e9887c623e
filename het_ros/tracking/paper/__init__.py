# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The Hierarchical Ensemble Tracker as its paper has it, by itself, to be read beside it.

"Robust Object Tracking with a Hierarchical Ensemble Framework", M. Wang, Y. Liu, R. Xiong,
IROS 2016. Its equations in its order, by number and by the label of its source:

====  =====================  ==========================================================
(1)   patches                appearance.SubPatches
(2)   1                      features.compressive.raw_feature_maps, CompressiveFeatures
(3)   random metrix          features.compressive.draw_measurement_matrix
(4)   classifier             weak_classifiers.WeakClassifiers
(5)   Gaussian               weak_classifiers.Gaussians
(6)   strongClassifier       base_ensembles.score_maps
(7)   classification         detection.detect
(8)   error                  combination.hypotheses
(9)   weightAverage          combination.combine
(10)  sum-of-squares error   combination.squared_errors
(11)  average error          combination.average_error
(12)  assume                 assumed by combination.combined_error
(13)  expected error         combination.combined_error
(14)  Kalman(k+1)            kalman.AdaptiveKalman
(15)  Q_update               kalman.AdaptiveKalman.adapt
(16)  R_update               kalman.AdaptiveKalman.adapt
(17)  patchUpdate            model_update.to_be_updated
(18)  parameterUpdate        model_update.blended
====  =====================  ==========================================================

The six steps of its Figure 1 are six calls in target.Target.follow. Four slips are corrected, and
said where they are: the sign of the hypotheses (combination), the shape of B (kalman), the centre
and the corner of the target (target), and what the mean weight can say (combination.weights).
"""
