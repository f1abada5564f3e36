"""Paths with strain across the plane and with an initial stress: python3 make_paths.py (numpy)

Writes iwan_general_paths.csv and drucker_prager_general_paths.csv beside this file. Materials are those of the files
*_materials.csv. The formulas are computed in full 3 x 3 tensors:

* Iwan: return of each component; the initial stress is reached by loading the virgin material, whose strain follows by
  bisection. Derivatives by complex steps, which have no error of truncation.
* Drucker-Prager: Newton's method on the six stresses and the multiplier; the apex by the condition that the trial stress
  lies in the cone of its plastic strains. Derivatives by the implicit function theorem.
"""
import csv
from pathlib import Path

import numpy as np

FOLDER = Path(__file__).parent
UNIT = np.eye(3)
H = 1e-40
STRAINS = ["e_xx", "e_yy", "e_zz", "g_xy"]
STRESSES = ["s_xx", "s_yy", "s_zz", "s_xy"]
INITIAL = ["i_xx", "i_yy", "i_zz", "i_xy"]
TANGENT = [f"c{i}{j}" for i in range(4) for j in range(4)]


def tensor(components, shear_factor):
    xx, yy, zz, xy = components
    return np.array([[xx, shear_factor * xy, 0], [shear_factor * xy, yy, 0], [0, 0, zz]])


def flat(stress):
    return np.array([stress[0, 0], stress[1, 1], stress[2, 2], stress[0, 1]])


def dev(a):
    return a - np.trace(a) / 3 * UNIT


def norm(a):
    return np.sqrt(np.sum(a * a))


class Iwan:
    def __init__(self, rows):
        gamma, tau = (np.array([float(row[name]) for row in rows]) for name in ("gamma", "tau"))
        self.K = float(rows[0]["K"])
        slopes = np.diff(np.r_[0, tau]) / np.diff(np.r_[0, gamma])
        self.G = slopes - np.r_[slopes[1:], 0]
        self.r = np.sqrt(2) * self.G * gamma
        self.strength = tau[-1]

    def components(self, strain, plastic):
        """Stresses and new plastic strains of the components."""
        stresses, new = [], []
        for G, r, p in zip(self.G, self.r, plastic):
            s = 2 * G * (dev(strain) - p)
            if norm(s).real > r:
                s = s * (r / norm(s))
            stresses.append(s)
            new.append(dev(strain) - s / (2 * G))
        return stresses, new

    def start(self, initial):
        self.plastic = [np.zeros((3, 3))] * len(self.G)
        s = dev(initial)
        size = norm(s)
        direction = s / size if size else s
        low, high = 0.0, 10.0
        for _ in range(400):
            middle = (low + high) / 2
            reached = norm(sum(self.components(middle * direction, self.plastic)[0]))
            low, high = (middle, high) if reached < size else (low, middle)
        self.offset = low * direction if size else s
        self.mean = np.trace(initial) / 3
        self.plastic = self.components(self.offset, self.plastic)[1]
        self.rest = 0.0
        self.rest = self.stored(np.zeros((3, 3)))
        self.dissipated = 0.0

    def stress(self, strain):
        stresses, _ = self.components(self.offset + strain, self.plastic)
        return sum(stresses) + (self.mean + self.K * np.trace(strain)) * UNIT

    def stored(self, strain):
        stresses, _ = self.components(self.offset + strain, self.plastic)
        deviatoric = sum(np.sum(s * s) / (4 * G) for s, G in zip(stresses, self.G))
        return deviatoric + (self.mean + self.K * np.trace(strain)) ** 2 / (2 * self.K) - self.rest

    def tangent(self, strain):
        columns = [flat(self.stress(strain + 1j * H * tensor(e, 0.5))).imag / H for e in np.eye(4)]
        return np.array(columns).T

    def commit(self, strain):
        stresses, new = self.components(self.offset + strain, self.plastic)
        self.dissipated += sum(np.sum(s * (q - p)) for s, p, q in zip(stresses, self.plastic, new))
        self.plastic = new


class DruckerPrager:
    def __init__(self, row):
        self.G, self.K, c, phi, psi = (float(row[name]) for name in ("G", "K", "c", "phi", "psi"))
        t, d = np.tan(np.radians(phi)), np.tan(np.radians(psi))
        self.alpha = t / np.sqrt(9 + 12 * t * t)
        self.beta = d / np.sqrt(9 + 12 * d * d)
        self.k = 3 * c / np.sqrt(9 + 12 * t * t)

    def elastic(self, strain):
        return 2 * self.G * dev(strain) + self.K * np.trace(strain) * UNIT

    def compliance(self, stress):
        return dev(stress) / (2 * self.G) + np.trace(stress) / (9 * self.K) * UNIT

    def f(self, stress):
        return norm(dev(stress)) / np.sqrt(2) + self.alpha * np.trace(stress) - self.k

    def start(self, initial):
        assert self.f(initial) < 0
        self.initial = initial
        self.plastic = np.zeros((3, 3))
        self.dissipated = 0.0

    def trial(self, strain):
        return self.initial + self.elastic(strain - self.plastic)

    def residual(self, unknowns, strain):
        stress, multiplier = unknowns[:9].reshape(3, 3), unknowns[9]
        flow = dev(stress) / (np.sqrt(2) * norm(dev(stress))) + self.beta * UNIT
        # Stress of the flow over G, so that all residuals have the unit of a stress.
        errors = stress - self.trial(strain) + multiplier / self.G * self.elastic(flow)
        return np.r_[errors.ravel(), self.f(stress)]

    def is_apex(self, trial):
        if self.alpha == 0:
            return False
        beyond = np.trace(trial) - self.k / self.alpha
        shear = norm(dev(trial)) / np.sqrt(2)
        return beyond > 0 and 9 * self.K * self.beta * shear <= self.G * beyond

    def solve(self, strain):
        """Kind of the return, and its stress and multiplier times G."""
        trial = self.trial(strain)
        if self.f(trial) <= 0:
            return "elastic", np.r_[trial.ravel(), 0.0]
        if self.is_apex(trial):
            return "apex", np.r_[(self.k / (3 * self.alpha) * UNIT).ravel(), 0.0]
        unknowns = np.r_[(trial - (0.9 * dev(trial))).ravel(), 0.0]
        scale = norm(trial) + self.k
        for _ in range(100):
            residual = self.residual(unknowns, strain)
            unknowns = unknowns - np.linalg.solve(self.jacobian(unknowns, strain), residual)
            if np.abs(residual).max() < 1e-15 * scale:
                break
        assert np.abs(self.residual(unknowns, strain)).max() < 1e-12 * scale
        return "cone", unknowns

    def jacobian(self, unknowns, strain):
        columns = [self.residual(unknowns + 1j * H * e, strain).imag / H for e in np.eye(10)]
        return np.array(columns).T

    def stress(self, strain):
        return self.solve(strain)[1][:9].reshape(3, 3)

    def tangent(self, strain):
        kind, unknowns = self.solve(strain)
        if kind == "apex":
            return np.zeros((4, 4))
        columns = []
        for e in np.eye(4):
            if kind == "elastic":
                columns.append(flat(self.elastic(tensor(e, 0.5))))
                continue
            change = self.residual(unknowns, strain + 1j * H * tensor(e, 0.5)).imag / H
            columns.append(flat(np.linalg.solve(self.jacobian(unknowns, strain), -change)[:9].reshape(3, 3)))
        return np.array(columns).T

    def stored(self, strain):
        def energy(stress):
            return np.sum(stress * self.compliance(stress)) / 2

        return energy(self.stress(strain)) - energy(self.initial)

    def commit(self, strain):
        stress = self.stress(strain)
        plastic = strain - self.compliance(stress - self.initial)
        self.dissipated += np.sum(stress * (plastic - self.plastic))
        self.plastic = plastic


def rows(name):
    with open(FOLDER / name, encoding="utf8") as file:
        return list(csv.DictReader(file))


def main():
    random = np.random.default_rng(64)

    def write(name, cases):
        with open(FOLDER / name, "w", encoding="utf8") as file:
            print(*["material", "path", "step"] + INITIAL + STRAINS + STRESSES + TANGENT + ["stored", "dissipated"], sep=",", file=file)
            for material, path, law, initial, strains in cases:
                law.start(tensor(initial, 1))
                for step, components in enumerate(strains):
                    strain = tensor(components, 0.5)
                    values = [*flat(law.stress(strain)), *law.tangent(strain).ravel(), law.stored(strain)]
                    law.commit(strain)
                    values.append(law.dissipated)
                    texts = [f"{value:.15g}" for value in [*initial, *components, *values]]
                    print(material, path, step, *texts, sep=",", file=file)

    def walk(size, steps=16):
        """Random strains as the file has them."""
        strains = np.cumsum(random.normal(0, size, (steps, 4)) * [1, 1, 1, 2], axis=0)
        return [[float(f"{value:.15g}") for value in strain] for strain in strains]

    def at_rest(law, level, mean):
        """Initial stress with a random deviator at a level of the strength."""
        s = dev(tensor(random.normal(0, 1, 4), 1))
        stress = flat(s * (level * np.sqrt(2) * law / norm(s)) + mean * UNIT)
        return [float(f"{value:.15g}") for value in stress]

    cases = []
    table = rows("iwan_materials.csv")
    for material in sorted({row["material"] for row in table}):
        law = Iwan([row for row in table if row["material"] == material])
        for path, (level, size) in enumerate([(0, 3e-4), (0, 4e-3), (0.02, 3e-4), (0.5, 1e-3), (0.97, 3e-3)]):
            initial = [0.0] * 4 if level == 0 else at_rest(law.strength, level, random.uniform(-2e5, 0))
            cases.append((material, path, law, initial, walk(size)))
    write("iwan_general_paths.csv", cases)

    cases = []
    for row in rows("drucker_prager_materials.csv"):
        law = DruckerPrager(row)
        for path, (level, size) in enumerate([(0, 1e-4), (0, 1e-3), (0.3, 3e-4), (0.7, 5e-4), (0.98, 1e-3)]):
            mean = random.uniform(-3e5, -2e4)
            initial = [0.0] * 4 if level == 0 else at_rest(law.k - 3 * law.alpha * mean, level, mean)
            cases.append((row["material"], path, law, initial, walk(size)))
    write("drucker_prager_general_paths.csv", cases)


if __name__ == "__main__":
    main()
