# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The paper's equations in the most obvious way: loops over places, rectangles and classifiers.

Slow on purpose. Nothing here is shared with the package but the random draws (sub-patches and
measurement matrix), which come in as plain numbers.
"""

import math

import cv2
import numpy as np
from features.slow import all_features, replicated_window

BGR = ("b", "g", "r")


def planes(window, names):
    if window.ndim == 3:
        gray = cv2.cvtColor(window, cv2.COLOR_BGR2GRAY)
        by_name = {name: window[:, :, i] for i, name in enumerate(BGR)}
    else:
        gray = window
        by_name = dict.fromkeys(BGR, window)
    by_name["gray"] = gray
    return [by_name[name].astype(np.int64) for name in names]


class Normalisation:
    """Centre and deviation of each feature over the first frame's places."""

    def __init__(self, features, size):
        columns = list(zip(*features.values(), strict=True))
        self.centre = [round(mean(column)) for column in columns]
        self.deviation = [deviation(column) or size[0] * size[1] for column in columns]

    def __call__(self, features):
        return {
            place: [
                (value - c) / d
                for value, c, d in zip(values, self.centre, self.deviation, strict=True)
            ]
            for place, values in features.items()
        }


def mean(values):
    return math.fsum(values) / len(values)


def deviation(values):
    middle = mean(values)
    return math.sqrt(math.fsum((value - middle) ** 2 for value in values) / len(values))


def distance(a, b):
    return math.hypot(a[0] - b[0], a[1] - b[1])


class WeakClassifier:
    """Two Gaussians over one feature (eqs. 4, 5 and 18)."""

    def __init__(self, positives, negatives):
        self.mu1, self.sigma1 = mean(positives), deviation(positives)
        self.mu0, self.sigma0 = mean(negatives), deviation(negatives)

    def update(self, positives, negatives, keep):
        self.mu1, self.sigma1 = blended(self.mu1, self.sigma1, positives, keep)
        self.mu0, self.sigma0 = blended(self.mu0, self.sigma0, negatives, keep)

    def log_ratio(self, value, floor):
        return log_normal(value, self.mu1, max(self.sigma1, floor)) - log_normal(
            value, self.mu0, max(self.sigma0, floor)
        )


def blended(mu, sigma, samples, keep):
    new_mu, new_sigma = mean(samples), deviation(samples)
    variance = keep * sigma**2 + (1 - keep) * new_sigma**2 + keep * (1 - keep) * (mu - new_mu) ** 2
    return keep * mu + (1 - keep) * new_mu, math.sqrt(variance)


def log_normal(value, mu, sigma):
    return -0.5 * ((value - mu) / sigma) ** 2 - math.log(sigma * math.sqrt(2 * math.pi))


class BaseEnsemble:
    """m weak classifiers for one sub-patch (eq. 6)."""

    def __init__(self, config):
        self.config = config
        self.classifiers = []

    def learn(self, features, corner):
        positives = [
            place for place in features if distance(place, corner) < self.config.positive_radius
        ]
        negatives = [
            (x, y)
            for x, y in features
            if x % 2 == y % 2 == 0 and distance((x, y), corner) >= self.config.negative_radius
        ]
        first = not self.classifiers
        for i in range(len(features[0, 0])):
            one = [features[place][i] for place in positives]
            zero = [features[place][i] for place in negatives]
            if first:
                self.classifiers.append(WeakClassifier(one, zero))
            else:
                self.classifiers[i].update(one, zero, 1 - self.config.learning_rate)

    def score(self, values):
        return math.fsum(
            classifier.log_ratio(value, self.config.sigma_floor)
            for classifier, value in zip(self.classifiers, values, strict=True)
        )

    def vote(self, values):
        """Mean of the weak classifiers' p(y = 1 | l_i)."""
        return mean(
            [
                1
                / (1 + math.exp(-max(classifier.log_ratio(value, self.config.sigma_floor), -600)))
                for classifier, value in zip(self.classifiers, values, strict=True)
            ]
        )

    def detect(self, features, corner):
        """Best place within beta (eq. 7), the nearest of equals."""
        places = [
            place for place in features if distance(place, corner) < self.config.search_radius
        ]
        scores = {place: self.score(features[place]) for place in places}
        best = max(places, key=lambda place: (scores[place], -distance(place, corner)))
        return best, scores


def weights(scores, low, high):
    spread = deviation(scores)
    if spread == 0:
        return [(low + high) / 2] * len(scores)
    z = [(score - mean(scores)) / spread for score in scores]
    return [low + (high - low) * (v - min(z)) / (max(z) - min(z)) for v in z]


def combination(candidates, omega):
    total = sum(omega)
    return [
        sum(w * c[axis] for w, c in zip(omega, candidates, strict=True)) / total for axis in (0, 1)
    ]


def selected(scores):
    """Eq. (17)."""
    middle, spread = mean(scores), deviation(scores)
    return [middle - spread < s < middle + spread for s in scores]


class Kalman:
    """Textbook equations of the filter (eqs. 14 to 16)."""

    def __init__(self, centre, acceleration, noise, longest_dt):
        self.x = np.array([*centre, 0, 0], float)
        speed = acceleration * longest_dt
        self.p = np.diag([noise**2, noise**2, speed**2, speed**2])
        self.acceleration, self.noise = acceleration, noise

    def step(self, dt, measure, mean_weight=None):
        a = np.eye(4)
        a[0, 2] = a[1, 3] = dt
        b = np.zeros((2, 4))
        b[0, 0] = b[1, 1] = 1
        push = np.array([[dt**2 / 2, 0], [0, dt**2 / 2], [dt, 0], [0, dt]])
        q0 = self.acceleration**2 * push @ push.T
        self.x = a @ self.x
        z, mean_weight = measure(self.x[:2].copy())
        self.p = a @ self.p @ a.T + mean_weight * q0
        r = (1 - mean_weight) * self.noise**2 * np.eye(2)
        gain = self.p @ b.T @ np.linalg.inv(b @ self.p @ b.T + r)
        self.x = self.x + gain @ (np.array(z) - b @ self.x)
        self.p = (np.eye(4) - gain @ b) @ self.p


class Tracker:
    """The whole paper on one target, frame by frame.

    Args:
        config: a PaperConfig.
        names: channels.
        size, offsets, rows: the sub-patches' (w, h) and dp, and R's rows.
    """

    def __init__(self, config, names, size, offsets, rows):
        self.config, self.names, self.size = config, names, size
        self.offsets, self.rows = offsets, rows
        self.ensembles = [BaseEnsemble(config) for _ in offsets]

    def init(self, image, box):
        side = math.sqrt(box[2] * box[3])
        self.target = box[2:]
        self.motion = Kalman(
            (box[0] + box[2] / 2, box[1] + box[3] / 2),
            self.config.acceleration * side,
            self.config.measurement_noise * side,
            self.config.longest_dt,
        )
        raw, origin = self.look(image)
        self.normalise = Normalisation(raw, self.size)
        features = self.normalise(raw)
        for ensemble, corner in zip(self.ensembles, self.corners(origin), strict=True):
            ensemble.learn(features, corner)

    def look(self, image):
        """Raw features of every place of the window, and the window's origin."""
        margin = math.ceil(self.config.search_radius) + 1
        x, y = self.corner()
        left, top = math.floor(x - margin), math.floor(y - margin)
        window = replicated_window(
            image,
            left,
            top,
            math.ceil(self.target[0]) + 2 * margin,
            math.ceil(self.target[1]) + 2 * margin,
        )
        return all_features(planes(window, self.names), self.rows, self.size), (left, top)

    def corner(self):
        return [self.motion.x[axis] - self.target[axis] / 2 for axis in (0, 1)]

    def corners(self, origin):
        x, y = self.corner()
        return [(x - origin[0] + dx, y - origin[1] + dy) for dx, dy in self.offsets]

    def update(self, image, dt):
        """Leaves the frame's features, scores, detections and weights in attributes."""

        def measure(_):
            raw, self.origin = self.look(image)
            self.features = self.normalise(raw)
            found = [
                ensemble.detect(self.features, corner)
                for ensemble, corner in zip(self.ensembles, self.corners(self.origin), strict=True)
            ]
            self.places = [place for place, _ in found]
            self.scores = [scores for _, scores in found]
            best = [scores[place] for place, scores in found]
            self.omega = weights(best, self.config.weight_low, self.config.weight_high)
            candidates = [
                (x - dx + self.origin[0], y - dy + self.origin[1])
                for (x, y), (dx, dy) in zip(self.places, self.offsets, strict=True)
            ]
            corner = combination(candidates, self.omega)
            centre = [corner[axis] + self.target[axis] / 2 for axis in (0, 1)]
            return centre, mean(self.omega)

        self.motion.step(dt, measure)
        corners = self.corners(self.origin)
        new = [
            ensemble.score(self.features[round(x), round(y)])
            for ensemble, (x, y) in zip(self.ensembles, corners, strict=True)
        ]
        self.likelihood = mean(
            [
                ensemble.vote(self.features[round(x), round(y)])
                for ensemble, (x, y) in zip(self.ensembles, corners, strict=True)
            ]
        )
        self.chosen = selected(new)
        for ensemble, corner, chosen in zip(self.ensembles, corners, self.chosen, strict=True):
            if chosen:
                ensemble.learn(self.features, corner)
