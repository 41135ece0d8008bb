#!/usr/bin/env python3
"""One step of the lumped time-varying model, ours against the same step compiled by Numba.

Purpose: to check the claim that a step of the lumped set with tabulated mesh forces (OH-58, four planets, 17
coordinates, eight meshes, 140 steps per mesh cycle) costs about a microsecond. All programs solve the same
problem from the same equilibrium by Newmark's average acceleration, with the mesh forces solved for in every
step.

Two programs are compared, both @njit without fastmath, with preallocated arrays and all constants prepared
beforehand:

- "same algorithm": that of this project in NumPy and Numba: modal coordinates, condensed to the eight
  deflections, Newton with a kept Jacobian, forces extrapolated from the last two steps.
- "dense": a direct implementation: constant inverse of the 17 by 17 step matrix, condensed to the
  deflections as well, Newton with numpy.linalg.solve at every iteration, from the last deflections.

Method: timed alternately, each over a batch that is long compared with the clock's resolution, in an order
that is reversed from round to round, so that other load on the machine affects all; reported is the ratio
within each round (median, quartiles). Before any timing displacements, velocities and mesh forces after 20
mesh cycles are compared, and a disagreement ends the run.

Noise: ratios of quartiles within 10 % of the median are usual on a quiet machine. Time: a minute after the
build, most of it Numba's compilation.

Needs numpy and numba, and installs nothing:  pip install numpy numba
"""

import argparse
import sys

from beside import build, in_turns, print_times, problem, time_call, time_ours, wanted

try:
    import numba
    import numpy
    from numba import njit
except ImportError as missing:
    sys.exit(f"{missing}: this script needs numpy and numba (pip install numpy numba)")

# Differences over the largest entry after 2800 steps.
AGREEMENT = 1e-9

# A step ends with one linear correction once the residual over the largest free deflection is below NEARLY;
# the Jacobian is kept while an iteration reduces the residual to less than the share KEPT.
NEARLY = 1e-11
KEPT = 0.02


@njit(inline="always")
def mesh_force(curves, inverse_step, curve, deflection):
    """Force and tangent: piecewise cubic on equal steps, zero before contact, linear beyond the last node."""
    t = (deflection - curves[curve, 0]) * inverse_step[curve]
    if t <= 0.0:
        return 0.0, 0.0
    last = (curves.shape[1] - 2) // 2 - 1
    i = int(t)
    if i >= last:
        force, rise = curves[curve, 2 + 2 * last], curves[curve, 3 + 2 * last]
        return force + rise * (t - last), rise * inverse_step[curve]
    s = t - i
    f0, m0 = curves[curve, 2 + 2 * i], curves[curve, 3 + 2 * i]
    f1, m1 = curves[curve, 4 + 2 * i], curves[curve, 5 + 2 * i]
    rise = f1 - f0
    d = m0 + m1 - 2.0 * rise
    c = rise - m0 - d
    force = f0 + s * (m0 + s * (c + s * d))
    return force, (m0 + s * (2.0 * c + 3.0 * s * d)) * inverse_step[curve]


@njit
def march_modal(
    count, step, x, v, a, f, c, inverse, rows, answers, y, lag, h, curves, inverse_step, places, now, before,
    work,
):
    """This project's algorithm: modes, condensation, kept Jacobian. Arrays are changed in place."""
    n, m = rows.shape
    inertia, rate = 4.0 / (h * h), 2.0 / h
    gain = 1.0 + lag * rate
    acceleration, velocity, free = work[0], work[1], work[2]
    b, shift, delta, p, d, r = work[3], work[4], work[5], work[6], work[7], work[8]
    g = work[9:9 + m]
    for _ in range(count):
        step = step + 1
        if step == places.shape[0]:
            step = 0
        for i in range(n):
            acceleration[i] = inertia * x[i] + 2.0 * rate * v[i] + a[i]
            velocity[i] = rate * x[i] + v[i]
            free[i] = inverse[i] * (f[i] + acceleration[i] + c[i] * velocity[i])
        for k in range(m):
            b[k] = 0.0
            shift[k] = 0.0
        for i in range(n):
            for k in range(m):
                b[k] += rows[i, k] * free[i]
                shift[k] -= rows[i, k] * velocity[i]
        scale = 1e-13
        for k in range(m):
            shift[k] *= lag
            scale = max(scale, abs(b[k]))
            delta[k] = b[k]
        for l in range(m):
            guess = 2.0 * now[l] - before[l]
            for k in range(m):
                delta[k] -= y[l, k] * guess
        last, fresh = numpy.inf, False
        for iteration in range(60):
            for k in range(m):
                force, tangent = mesh_force(
                    curves, inverse_step, places[step, k], gain * delta[k] + shift[k]
                )
                p[k] = force
                d[k] = gain * tangent
            for k in range(m):
                r[k] = delta[k] - b[k]
            for l in range(m):
                for k in range(m):
                    r[k] += y[l, k] * p[l]
            worst = 0.0
            for k in range(m):
                worst = max(worst, abs(r[k]))
            if worst == 0.0:
                break
            if not (fresh and worst < KEPT * last):
                # Columns of I + Y D as rows; Gauss-Jordan leaves columns of the inverse.
                for j in range(m):
                    for k in range(m):
                        g[j, k] = d[j] * y[j, k]
                    g[j, j] += 1.0
                for k in range(m):
                    pivot = 1.0 / g[k, k]
                    g[k, k] = 1.0
                    for j in range(m):
                        g[k, j] *= pivot
                    for i in range(m):
                        if i != k:
                            factor = g[i, k]
                            g[i, k] = 0.0
                            for j in range(m):
                                g[i, j] -= factor * g[k, j]
                fresh = True
            last = worst
            ends = worst <= NEARLY * scale
            part = -1.0 if iteration < 13 or ends else -0.5
            if ends:
                for l in range(m):
                    for k in range(m):
                        p[k] += d[k] * g[l, k] * (part * r[l])
                break
            for l in range(m):
                for k in range(m):
                    delta[k] += g[l, k] * (part * r[l])
        else:
            return -1
        for l in range(m):
            for i in range(n):
                free[i] -= answers[l, i] * p[l]
        for i in range(n):
            x[i] = free[i]
            v[i] = rate * free[i] - velocity[i]
            a[i] = inertia * free[i] - acceleration[i]
        for k in range(m):
            before[k] = now[k]
            now[k] = p[k]
    return step


@njit
def march_dense(
    count, step, x, v, a, f, mass, c, inverse, rows, answers, y, lag, h, curves, inverse_step, places,
    delta, p,
):
    """A direct implementation: dense matrices, numpy.linalg.solve. Arrays are changed in place."""
    m = rows.shape[0]
    inertia, rate = 4.0 / (h * h), 2.0 / h
    gain = 1.0 + lag * rate
    one, d = numpy.eye(m), numpy.empty(m)
    for _ in range(count):
        step = (step + 1) % places.shape[0]
        acceleration = inertia * x + 2.0 * rate * v + a
        velocity = rate * x + v
        free = inverse @ (f + mass * acceleration + c @ velocity)
        b = rows @ free
        shift = -lag * (rows @ velocity)
        scale = max(1e-13, numpy.max(numpy.abs(b)))
        for iteration in range(60):
            for k in range(m):
                p[k], d[k] = mesh_force(curves, inverse_step, places[step, k], gain * delta[k] + shift[k])
                d[k] *= gain
            r = delta - b + y @ p
            change = numpy.linalg.solve(one + y * d, r)
            delta -= change
            if numpy.max(numpy.abs(r)) <= NEARLY * scale:
                p -= d * change
                break
        else:
            return -1
        new = free - answers @ p
        v[:] = rate * new - velocity
        a[:] = inertia * new - acceleration
        x[:] = new
    return step


class Modal:
    """This project's algorithm in NumPy and Numba, at rest at first."""

    def __init__(self, data):
        mass, rows = data["mass"], data["rows"]
        self.h, self.lag, _ = data["numbers"]
        root = numpy.sqrt(mass)
        values, vectors = numpy.linalg.eigh(data["stiffness"] / numpy.outer(root, root))
        self.shapes = vectors / root[:, None]
        c = numpy.diag(self.shapes.T @ data["damping"] @ self.shapes).copy()
        inverse = 1.0 / (4.0 / self.h**2 + 2.0 / self.h * c + values)
        modal = numpy.ascontiguousarray((rows @ self.shapes).T)
        answers = numpy.ascontiguousarray((modal * inverse[:, None]).T)
        y = numpy.ascontiguousarray((answers @ modal).T)
        x = self.shapes.T @ (mass * data["rest"])
        n, m = modal.shape
        now = rest_forces(data)
        self.state = [x, numpy.zeros(n), numpy.zeros(n)]
        self.linear = [self.shapes.T @ data["load"], c, inverse, modal, answers, y, self.lag, self.h]
        self.law = law(data)
        self.forces = [now, now.copy()]
        self.work = numpy.zeros((9 + m, max(n, m)))
        self.step = 0

    def march(self, count):
        self.step = march_modal(
            count, self.step, *self.state, *self.linear, *self.law, *self.forces, self.work
        )

    def answer(self):
        return self.shapes @ self.state[0], self.shapes @ self.state[1], self.forces[0]


class Dense:
    """The direct implementation, at rest at first."""

    def __init__(self, data):
        mass, rows = data["mass"], data["rows"]
        self.h, self.lag, _ = data["numbers"]
        a = numpy.diag(4.0 / self.h**2 * mass) + 2.0 / self.h * data["damping"] + data["stiffness"]
        inverse = numpy.linalg.inv(a)
        answers = inverse @ rows.T
        n = len(mass)
        self.state = [data["rest"].copy(), numpy.zeros(n), numpy.zeros(n)]
        y = numpy.ascontiguousarray(rows @ answers)
        self.linear = [data["load"], mass, data["damping"], inverse, rows, answers, y, self.lag, self.h]
        self.law = law(data)
        self.delta, self.p = rows @ data["rest"], rest_forces(data)
        self.step = 0

    def march(self, count):
        self.step = march_dense(
            count, self.step, *self.state, *self.linear, *self.law, self.delta, self.p
        )

    def answer(self):
        return self.state[0], self.state[1], self.p


def law(data):
    """Curves with tangents times their step, inverse steps, index of the curve of each step and mesh."""
    curves = data["curves"].copy()
    curves[:, 3::2] *= curves[:, 1:2]
    return [curves, 1.0 / curves[:, 1], data["places"].astype(numpy.int64)]


def rest_forces(data):
    """Mesh forces at rest."""
    curves, inverse_step, places = law(data)
    deflections = data["rows"] @ data["rest"]
    each = [mesh_force(curves, inverse_step, places[0, k], d)[0] for k, d in enumerate(deflections)]
    return numpy.array(each)


def compare(rival, data):
    """Largest relative difference of displacements, velocities and forces after the dumped steps."""
    rival.march(int(data["numbers"][2]))
    if rival.step < 0:
        sys.exit("a rival's step did not converge")
    ours = [data["end"][:, 0], data["end"][:, 1], data["forces"]]
    relative = [
        numpy.max(numpy.abs(theirs - own)) / numpy.max(numpy.abs(own))
        for theirs, own in zip(rival.answer(), ours)
    ]
    return max(relative)


def main():
    parser = argparse.ArgumentParser(description="Our lumped step against Numba's.")
    arguments = wanted(parser, 50_000, "steps")

    harness = build("lumped_step")
    data = problem(harness)
    rivals = {"same algorithm": Modal(data), "dense": Dense(data)}
    n, m = len(data["mass"]), len(data["rows"])
    print(f"{n} coordinates, {m} meshes, numba {numba.__version__}, numpy {numpy.__version__}")
    for name, rival in rivals.items():
        difference = compare(rival, data)
        print(f"{name}: worst relative difference {difference:.1e} (allowed {AGREEMENT:.0e})")
        if not difference <= AGREEMENT:
            print("the two do not march the same problem", file=sys.stderr)
            return 1

    runs = {"ours": lambda: time_ours(harness, arguments.batch)}
    for name, rival in rivals.items():
        march = lambda rival=rival: rival.march(arguments.batch)
        runs[name] = lambda march=march: time_call(march, arguments.batch)
    times = in_turns(runs, arguments.rounds)
    print(f"{arguments.rounds} rounds of {arguments.batch} steps; median [quartiles]")
    print_times(times)
    return 0


if __name__ == "__main__":
    sys.exit(main())
