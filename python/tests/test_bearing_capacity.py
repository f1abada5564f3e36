"""Bearing capacity of footings, beside formulas of EN 1997-1, Annex D, written again."""

from __future__ import annotations

import math
import pickle

import pytest

import basemat as bm


def test_factors_of_thirty_degrees() -> None:
    angle = math.radians(30.0)
    factors = bm.BearingFactors(angle)
    surcharge = math.exp(math.pi * math.tan(angle)) * math.tan(math.pi / 4 + angle / 2) ** 2
    assert factors.surcharge == pytest.approx(surcharge, rel=1e-12)
    assert factors.cohesion == pytest.approx((surcharge - 1) / math.tan(angle), rel=1e-12)
    assert factors.unit_weight == pytest.approx(2 * (surcharge - 1) * math.tan(angle), rel=1e-12)
    assert bm.BearingFactors(0.0).cohesion == pytest.approx(math.pi + 2)
    assert pickle.loads(pickle.dumps(factors)) == factors
    with pytest.raises(bm.InputError, match="friction angle"):
        bm.BearingFactors(30.0)


def test_inclined_and_eccentric_load() -> None:
    """The worked example of the Rust tests: 95 kPa."""
    footing = bm.ShallowFooting(
        [1.0, 6.0],
        surcharge=7.5e3,
        eccentricity=(0.15, 0.44),
        vertical_force=200e3,
        horizontal_force=(60e3, 30e3),
    )
    sand = bm.SoilStrength(math.radians(30.0))
    assert footing.drained_pressure(sand, 10e3) == pytest.approx(95e3, abs=500.0)
    assert footing.effective_sides == pytest.approx([0.7, 5.12])
    assert footing.effective_area == pytest.approx(3.584)
    assert pickle.loads(pickle.dumps(footing)) == footing
    law = bm.Yielding(footing.drained_pressure(sand, 10e3), 0.5)
    assert law.modes


def test_strips_circles_and_rocking() -> None:
    strip = bm.ShallowFooting([2.0, math.inf], surcharge=20e3)
    assert strip.undrained_pressure(50e3) == pytest.approx(20e3 + (math.pi + 2) * 50e3, rel=1e-12)
    circle = bm.ShallowFooting.circle(2.0, surcharge=20e3)
    assert circle.undrained_pressure(50e3) == pytest.approx(20e3 + 1.2 * (math.pi + 2) * 50e3, rel=1e-12)
    sand = bm.SoilStrength(math.radians(42.0))
    factors = bm.BearingFactors(math.radians(42.0))
    assert strip.pressure_growth(sand, 16.3e3) == pytest.approx(16.3e3 * factors.surcharge)
    ratio, moments = bm.ShallowFooting([2.8, 0.65]).rocking_capacity(285e3, 814e3)
    assert ratio == pytest.approx(285 / (814 * 2.8 * 0.65))
    assert moments == pytest.approx([285e3 * 1.4 * (1 - ratio), 285e3 * 0.325 * (1 - ratio)])
    with pytest.raises(bm.InputError, match="eccentricity"):
        bm.ShallowFooting([2.0, 1.0], eccentricity=(0.0, 0.5))
