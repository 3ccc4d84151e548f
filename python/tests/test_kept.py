"""Models kept in files: the same bits, without the description."""

import bryant
import numpy as np
import pytest


def test_a_kept_model_has_the_bits_and_the_functions(tmp_path):
    dummy = bryant.load("dummy15")
    path = tmp_path / "dummy.bryant"
    dummy.keep(path, functions=["inverse_dynamics", "center_of_mass"])
    kept = bryant.load(path)
    q, v = dummy.start()
    assert (kept.start()[0] == q).all() and list(kept.velocities) == list(dummy.velocities)
    many = q + 0.1 * np.random.default_rng(1).normal(size=(20, len(q)))
    rates = np.zeros((20, len(v)))
    assert (kept.accelerations(many, rates) == dummy.accelerations(many, rates)).all()
    assert (kept.mass_matrix(q) == dummy.mass_matrix(q)).all()
    assert (kept.inverse_dynamics(q, v, v) == dummy.inverse_dynamics(q, v, v)).all()
    assert (kept.center_of_mass(q) == dummy.center_of_mass(q)).all()
    with pytest.raises(bryant.Error, match="was not kept"):
        kept.inverse_dynamics_derivatives(q, v, v)
    for needs in (lambda: kept.run(), lambda: kept.gradient("peak of x", ["y"])):
        with pytest.raises(bryant.Error, match="load the description"):
            needs()
    with pytest.raises(bryant.Error, match="copy that"):
        kept.keep(tmp_path / "again.bryant")


def test_other_files_are_refused(tmp_path):
    with pytest.raises(bryant.Error, match="ends in .bryant"):
        bryant.load("child-seat").keep(tmp_path / "elbow.yaml")
    for content, words in [(b"model: x", "no kept engine"), (b"bryant engine 0.0.1\nabc", "0.0.1")]:
        path = tmp_path / "wrong.bryant"
        path.write_bytes(content)
        with pytest.raises(bryant.Error, match=words):
            bryant.load(path)
    with pytest.raises(bryant.Error):
        bryant.load(tmp_path / "none.bryant")
