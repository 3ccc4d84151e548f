"""Environments: the interface of gymnasium, and the physics of one that is seen without a formula."""

import numpy as np
import pytest

gymnasium = pytest.importorskip("gymnasium")
from bryant.gym import make_vec
from test_model import CART


def test_copies_move_as_their_actions_say_and_begin_again():
    reward = lambda seen, action, before: -np.abs(seen[:, 0])
    env = make_vec(CART, 4, observe=["x", "a"], reward=reward, terminated=lambda seen: seen[:, 0] > 1, dt=0.1, horizon=12)
    seen, _ = env.reset(seed=1)
    np.testing.assert_array_equal(seen, [[0.0, 0.5]] * 4)
    actions = np.array([[0.0], [2.0], [-2.0], [1000.0]])
    for k in range(1, 12):
        seen, got, ended, late, _ = env.step(actions)
        t = 0.1 * k
        np.testing.assert_allclose(seen[:3, 0], [0, t * t / 2, -t * t / 2], atol=1e-12)
        if k == 1:
            # an action beyond the limits is the limit: 100 N on 2 kg
            assert seen[3, 0] == pytest.approx(0.25)
        if k == 2:
            assert seen[3, 0] == pytest.approx(1.0) or ended[3]
        assert not ended[:3].any() and not late[:3].any()
        np.testing.assert_allclose(got[:3], -np.abs(seen[:3, 0]))
    seen, got, ended, late, _ = env.step(actions)
    assert late[:3].all()
    seen, got, ended, late, _ = env.step(actions)
    np.testing.assert_array_equal(seen[:3, 0], 0.0)
    assert not late.any() and not got[:3].any()


def test_an_action_needs_limits():
    with pytest.raises(ValueError, match="push"):
        make_vec(CART.replace(", min: -100 N, max: 100 N", ""), 2)
