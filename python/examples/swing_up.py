"""A pendulum whose motor is too weak to lift it learns to swing up: 512 copies, each with a small network of its own.

Networks are sampled about a mean, the best of each generation give the next mean and spread (cross-entropy method).

    python python/examples/swing_up.py
"""

import time

import numpy as np
from bryant.gym import make_vec

MODEL = """\
model: pendulum
dimension: 2
inputs: { torque: { value: 0 N*m, min: -3 N*m, max: 3 N*m } }
systems:
  - name: s
    reference: fixed
    elements: [{ name: rod, joint: { hinge: y }, mass: 1 kg, cg: [0, -1], inertia: 0.01 }]
forces:
  - { field: gravity, acceleration: [0, -9.81] }
  - { joint: s/rod, motor: torque, damping: 0.05 }
outputs:
  - { name: height, of: s/rod, what: position, at: [0, -1], component: z }
run: { duration: 1 s, every: 0.1 s }
"""

COPIES, ELITE, HIDDEN = 512, 20, 12
SHAPE = [(3, HIDDEN), (HIDDEN,), (HIDDEN, 1)]
SIZE = sum(int(np.prod(shape)) for shape in SHAPE)


def act(weights, seen):
    """The torques of all networks: two layers, of the cosine, the sine and the speed."""
    angle, speed = seen[:, 0], seen[:, 1]
    x = np.stack([np.cos(angle), np.sin(angle), speed / 6], axis=1)
    parts = np.split(weights, np.cumsum([np.prod(shape) for shape in SHAPE])[:-1], axis=1)
    a, b, c = (part.reshape(len(weights), *shape) for part, shape in zip(parts, SHAPE))
    hidden = np.tanh(np.einsum("ni,nih->nh", x, a) + b)
    return 3 * np.tanh(np.einsum("nh,nhj->nj", hidden, c))


def learn(env, generations, seconds, seed, goal):
    """Learns from one seed. Returns the mean height of the best networks over the second half, and the generations."""
    random = np.random.default_rng(seed)
    mean, spread = np.zeros(SIZE), np.full(SIZE, 1.5)
    steps = round(seconds / env.dt)
    for generation in range(1, generations + 1):
        weights = mean + spread * random.normal(size=(COPIES, SIZE))
        seen, _ = env.reset(seed=seed)
        total = np.zeros(COPIES)
        for step in range(steps):
            seen, *_ = env.step(act(weights, seen))
            # high up, and slow there; only the second half counts, the swings before are free
            if 2 * step >= steps:
                total += -np.cos(seen[:, 0]) - 0.01 * seen[:, 1] ** 2
        best = np.argsort(-total)[:ELITE]
        # noise that ends keeps the spread from collapsing too early
        noise = 0.3 * max(0.0, 1 - generation / 100)
        mean, spread = weights[best].mean(axis=0), weights[best].std(axis=0) + noise
        upright = total[best].mean() / (steps / 2)
        if upright > goal:
            break
    return upright, generation


def main(generations=100, seconds=8.0, seeds=range(2, 7), goal=0.95):
    env = make_vec(MODEL, COPIES, dt=0.05, parts=5, horizon=10**9)
    begin, done = time.perf_counter(), 0
    for seed in seeds:
        upright, generation = learn(env, generations, seconds, seed, goal)
        done += generation
        if upright > goal:
            break
    taken = time.perf_counter() - begin
    actions = done * COPIES * round(seconds / env.dt)
    print(f"{upright:.3f} of the height over the last {seconds / 2:g} s, after {done} generations: {actions} actions in {taken:.1f} s")
    return upright


if __name__ == "__main__":
    main()
