"""Environments of gymnasium: many copies of one model, side by side in the registers of the processor."""

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space

from .model import Model, load


def make_vec(model, num_envs, *, act=None, observe=None, **options):
    """Many copies of a model as one environment: see VectorEnv."""
    return VectorEnv(model, num_envs, act=act, observe=observe, **options)


class VectorEnv(gymnasium.vector.VectorEnv):
    """Many copies of a model, as an environment that learns.

    model: a model, or what `bryant.load` takes.
    act: the inputs that an action has, by name, within their limits; all if left out. Others keep their values.
    observe: what is seen, by name: coordinates, velocities, outputs; all coordinates and velocities if left out.
    reward(seen, action, seen before): an array of rewards.
    terminated(seen): an array of truth values; never if left out.
    start(random, count): q and v with which so many copies begin; the start of the model if left out.
    dt [s]: the time between two actions, computed in `parts` steps; horizon: actions until a copy is truncated.
    threads: a number of threads.

    A copy that has ended begins again at the next step, whose action it ignores (AutoresetMode.NEXT_STEP).
    """

    metadata = {"autoreset_mode": AutoresetMode.NEXT_STEP, "render_modes": []}

    def __init__(self, model, num_envs, *, act=None, observe=None, reward=None, terminated=None, start=None, dt=0.02, parts=4, horizon=500, threads=1):
        self.model = model if isinstance(model, Model) else load(model)
        self.num_envs = num_envs
        self.reward, self.terminated, self._start = reward, terminated, start
        self.dt, self.parts, self.horizon, self.threads = dt, parts, horizon, threads
        inputs = self.model.inputs
        self.act = list(inputs if act is None else act)
        places = [inputs.index(name) for name in self.act]
        low, high = self.model.input_limits[places].T
        if not np.isfinite([low, high]).all():
            endless = [name for name, a, b in zip(self.act, low, high) if not np.isfinite([a, b]).all()]
            raise ValueError(f"an action needs limits: give min and max to {', '.join(endless)} in the model")
        # the whole state, then the outputs
        self._all = [*self.model.coordinates, *self.model.velocities]
        self.observe = list(self._all if observe is None else observe)
        self._of_outputs = any(name not in self._all for name in self.observe)
        names = self._all + (list(self.model.outputs_of) if self._of_outputs else [])
        missing = [name for name in self.observe if name not in names]
        if missing:
            raise KeyError(f"there is no {', '.join(missing)}; there are {', '.join(names)}")
        self._seen = [names.index(name) for name in self.observe]
        box = gymnasium.spaces.Box
        self.single_action_space = box(low, high, dtype=np.float64)
        self.single_observation_space = box(-np.inf, np.inf, (len(self._seen),), dtype=np.float64)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        q, v, z, m = self.model.begin()
        self._begin = np.array([*q, *v, *z, *m])
        self._n, self._k = len(q), len(q) + len(v)
        self._state = np.tile(self._begin, (num_envs, 1))
        self._next = np.empty((num_envs, 1, len(self._begin)))
        self._over = np.zeros(num_envs, dtype=bool)
        self._count = np.zeros(num_envs, dtype=int)

    def _restart(self, which):
        count = int(which.sum())
        if count:
            self._state[which] = self._begin
            if self._start is not None:
                q, v = self._start(self.np_random, count)
                self._state[which, : self._n], self._state[which, self._n : self._k] = q, v
        self._count[which] = 0

    def _parts_of(self, state):
        # copies without gaps, as the engine reads them
        q, v, rest = np.split(state, [self._n, self._k], axis=1)
        return np.ascontiguousarray(q), np.ascontiguousarray(v), np.ascontiguousarray(rest)

    def _look(self, action=None):
        if not self._of_outputs:
            return self._state[:, self._seen]
        q, v, rest = self._parts_of(self._state)
        states = rest if rest.size else None
        outputs = self.model.outputs(q, v, action, states=states, vary=self._vary(action), threads=self.threads)
        return np.concatenate([self._state[:, : self._k], outputs], axis=1)[:, self._seen]

    def _vary(self, action):
        return None if action is None or self.act == self.model.inputs.names else self.act

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        if seed is not None:
            self._np_random, self._np_random_seed = gymnasium.utils.seeding.np_random(seed)
        self._restart(np.ones(self.num_envs, dtype=bool))
        self._over[:] = False
        self._before = self._look()
        return self._before, {}

    def step(self, actions):
        action = np.clip(np.asarray(actions, dtype=float), self.action_space.low, self.action_space.high)
        q, v, rest = self._parts_of(self._state)
        states = rest if rest.size else None
        u = np.ascontiguousarray(action[:, None, :])
        self.model.rollout(
            q, v, u, dt=self.dt, parts=self.parts, states=states, vary=self._vary(action), out=self._next, threads=self.threads
        )
        begun = self._over.copy()
        going = ~begun
        self._state[going] = self._next[going, 0]
        self._count[going] += 1
        self._restart(begun)
        seen = self._look(action)
        reward = np.zeros(self.num_envs)
        if self.reward is not None:
            reward = np.where(going, self.reward(seen, action, self._before), 0.0)
        # a state that is no number is an end, too
        lost = ~np.isfinite(self._state).all(axis=1)
        ended = np.zeros(self.num_envs, dtype=bool)
        if self.terminated is not None:
            ended = np.asarray(self.terminated(seen), dtype=bool)
        ended = (ended | lost) & going
        late = (self._count >= self.horizon) & going & ~ended
        self._over = ended | late
        self._before = seen
        return seen, reward, ended, late, {}
