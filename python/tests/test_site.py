"""Strain-compatible sites."""

from __future__ import annotations

import pickle
import warnings

import basemat as bm
import numpy as np
import pytest


def site(count: int = 6) -> tuple[bm.SoilColumn, list[bm.StrainCurves]]:
    clay = bm.Soil.from_shear_wave_speed(160.0, 0.4, 1800.0)
    rock = bm.Soil.from_shear_wave_speed(800.0, 0.25, 2300.0)
    layers = [bm.SoilLayer(clay, 2.5) for _ in range(count)]
    damping = bm.DampingLaw.constant_q(0.01)
    column = bm.SoilColumn(bm.SoilProfile(layers, rock, bedrock_damping=damping))
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
    with pytest.raises(bm.InputError, match="list of strain curves, one for each layer, has length 1, but must have 2"):
        column.equivalent_linear(bm.el_centro_1940(), curves[:1])
    with pytest.raises(bm.InputError, match="plasticity index is 300"):
        bm.StrainCurves.vucetic_dobry(300.0)
    with pytest.raises(bm.InputError, match="strain ratio is 2"):
        column.equivalent_linear(bm.el_centro_1940(), curves, strain_ratio=2.0)
    with pytest.raises(bm.InputError, match="lengths must be equal"):
        bm.StrainCurves.table([1e-4], [1.0, 0.9], [0.01])
    with pytest.raises(bm.InputError, match="bound is 'lower'"):
        bm.StrainCurves.seed_idriss("lower")


def test_deconvolution_through_soft_soil_warns_and_a_low_pass_helps() -> None:
    soft = bm.Soil.from_shear_wave_speed(100.0, poisson=0.4, density=1700.0)
    rock = bm.Soil.from_shear_wave_speed(760.0, poisson=0.25, density=2200.0)
    damping = bm.DampingLaw.constant_q(0.15, (0.2, 30.0), 1.0)
    column = bm.SoilColumn(bm.SoilProfile([bm.SoilLayer(soft, 100.0, damping)], rock))
    record = bm.el_centro_1940().padded(10.0, 40.0)
    with pytest.warns(bm.BasematWarning, match="more than a hundredfold, from .* Hz on: .*low_pass"):
        found = column.from_surface(record)
    assert found.peak_acceleration > 1e5
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        calm = column.from_surface(record.low_pass(2.5, order=8).padded(20.0, 20.0))
    assert calm.peak_acceleration < 100.0


def test_the_complex_modulus_has_two_conventions() -> None:
    column, curves = site(4)
    curves = [bm.StrainCurves.linear(0.2)] * 4
    record = bm.el_centro_1940().padded(0.0, 10.0)
    peaks = [
        column.equivalent_linear(record, curves, complex_modulus=own).surface.peak_acceleration
        for own in ("real_part", "magnitude")
    ]
    assert 0.01 < abs(peaks[1] / peaks[0] - 1.0) < 0.2
    with pytest.raises(bm.InputError, match="complex_modulus is 'shake'"):
        column.equivalent_linear(record, curves, complex_modulus="shake")  # type: ignore[arg-type]


def test_curves_that_stiffen_are_refused() -> None:
    with pytest.raises(bm.InputError, match="G/G_max of a table is 0.9"):
        bm.StrainCurves.table([1e-5, 1e-3], [0.8, 0.9], [0.01, 0.09])


def test_spectra_of_few_steps_say_so() -> None:
    record = bm.el_centro_1940()
    assert record.response_spectrum([0.2, 1.0]).warnings == []
    [text] = record.response_spectrum([0.05, 1.0]).broadened().warnings
    assert "fewer than ten time steps" in text
