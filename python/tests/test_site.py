"""Strain-compatible sites."""

from __future__ import annotations

import pickle

import basemat as bm
import numpy as np
import pytest


def site(count: int = 6) -> tuple[bm.SoilColumn, list[bm.StrainCurves]]:
    clay = bm.Soil.from_shear_wave_speed(160.0, 0.4, 1800.0)
    rock = bm.Soil.from_shear_wave_speed(800.0, 0.25, 2300.0)
    layers = [bm.SoilLayer(clay, 2.5) for _ in range(count)]
    damping = bm.DampingLaw.constant_q(0.01)
    column = bm.SoilColumn(bm.SoilProfile(layers, rock, base_damping=damping))
    return column, [bm.StrainCurves.vucetic_dobry(30.0)] * count


def test_properties_are_those_of_the_curves_at_the_effective_strain() -> None:
    column, curves = site()
    strong = bm.el_centro_1940().padded(0.0, 10.0)
    told = column.equivalent_linear(strong, curves).warnings
    assert len(told) == 2 and told[0].startswith("layer 5 strains by 0.5")
    record = strong.scaled(0.5)
    found = column.equivalent_linear(record, curves, strain_ratio=0.6, tolerance=1e-4)
    assert (
        found.last_change <= 1e-4 and 3 < found.iterations < 50 and found.warnings == []
    )
    np.testing.assert_allclose(found.effective_strain, 0.6 * found.largest_strain)
    modulus, damping = curves[0].at(found.effective_strain)
    np.testing.assert_allclose(found.modulus_ratio, modulus, rtol=1e-3)
    np.testing.assert_allclose(found.damping, damping, rtol=1e-3)
    np.testing.assert_allclose(
        found.shear_modulus, 1800.0 * 160.0**2 * found.modulus_ratio
    )
    assert found.accelerations.shape == (7, len(record))
    np.testing.assert_array_equal(
        found.peak_acceleration, np.abs(found.accelerations).max(axis=1)
    )
    np.testing.assert_array_equal(found.surface.accelerations, found.accelerations[0])
    frame = found.to_frame()
    assert list(frame.index) == list(found.depth) == [2.5 * k for k in range(6)]
    assert list(frame["damping"]) == list(found.damping) and "iterations" in str(found)


def test_the_profile_carries_a_ground_and_pickles() -> None:
    column, curves = site(3)
    profile = column.equivalent_linear(bm.el_centro_1940(), curves).profile()
    again = pickle.loads(pickle.dumps(profile))
    assert (
        str(again) == str(profile) and again.first_frequency == profile.first_frequency
    )
    assert bm.ElasticGround(profile, bm.Strip(-3.0, 3.0, 4)).elements.shape[0] == 4


def test_curves_by_every_name() -> None:
    table = bm.StrainCurves.table([1e-5, 1e-3], [1.0, 0.5], [0.01, 0.09])
    modulus, damping = table.at([1e-6, 1e-4, 1e-2])
    np.testing.assert_allclose(modulus, [1.0, 0.75, 0.5])
    np.testing.assert_allclose(damping, [0.01, 0.05, 0.09])
    for curves in (
        bm.StrainCurves.linear(0.02),
        bm.StrainCurves.seed_idriss(),
        bm.StrainCurves.seed_idriss("upper"),
        bm.StrainCurves.epri(10.0),
        bm.StrainCurves.darendeli(20.0, 2.0, 100.0e3, cycles=20.0),
    ):
        modulus, damping = pickle.loads(pickle.dumps(curves)).at([0.0, 1e-3])
        assert modulus[1] <= modulus[0] == 1.0 and damping[1] >= damping[0] > 0.0


def test_bad_sites_name_layer_and_quantity() -> None:
    column, curves = site(2)
    with pytest.raises(bm.InputError, match="1 strain curves were given for 2 layers"):
        column.equivalent_linear(bm.el_centro_1940(), curves[:1])
    with pytest.raises(bm.InputError, match="plasticity index is 300"):
        bm.StrainCurves.vucetic_dobry(300.0)
    with pytest.raises(bm.InputError, match="strain ratio is 2"):
        column.equivalent_linear(bm.el_centro_1940(), curves, strain_ratio=2.0)
    with pytest.raises(bm.InputError, match="one length"):
        bm.StrainCurves.table([1e-4], [1.0, 0.9], [0.01])
    with pytest.raises(bm.InputError, match="bound is 'lower'"):
        bm.StrainCurves.seed_idriss("lower")
