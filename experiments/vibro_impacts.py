#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Forced oscillators against a wall: told errors of impacts over true ones.

    experiments/vibro_impacts.py [N [SEED]]        needs mpmath, numpy and scipy; LIVENS_PROGRAM names the program

x'' + 2 d w x' + w^2 x = F cos(W t), a wall at x = c with a restitution; each third one grazes it by 1e-9 .. 1e-2 first. The
truth is the closed form between impacts in 40 digits, and shares nothing with the program. Even runs have an accuracy, odd ones
a mesh of their own of degree 2 .. 4. Prints how many runs have the right impacts, quantiles of told/true, and the worst
ones. Where told errors are above what rounding does to an instant, RULED_BY_ROUNDING over its speed, at least 95 % are 0.5 to
3 times the true ones. At rounding true errors are small by chance and that ratio has no upper bound, so told ones are held to not
being too small. Exit 1 where one of both fails, or where a run has other impacts than the truth, or is far off, in exit 0.
"""
import os
import pathlib
import subprocess
import sys
import tempfile

import mpmath as mp
import numpy as np
from scipy.io import netcdf_file

PROGRAM = os.environ.get("LIVENS_PROGRAM", str(pathlib.Path(__file__).resolve().parents[1] / "build/release/livens"))
mp.mp.dps = 40
MOST = 6          # impacts that are compared
SLOW = 1e-7       # m/s: slower ones are not followed
MASS = 2          # kg
RULED_BY_ROUNDING = 1e-12   # m


class Oscillator:
    """Free flight between impacts, by the closed form."""

    def __init__(self, stiffness, damping, force, W):
        k, c, f, self.W = (mp.mpf(x) for x in (stiffness, damping, force, W))   # the very numbers of the scenario
        self.decay = c / MASS / 2
        self.damped = mp.sqrt(k / MASS - self.decay**2)
        self.amplitude = f / MASS / mp.mpc(k / MASS - self.W**2, 2 * self.decay * self.W)

    def flight(self, t0, x0, v0):
        """Functions of time: place and velocity."""
        a, wd, amp, W = self.decay, self.damped, self.amplitude, self.W
        p0 = amp * mp.expj(W * t0)
        A = x0 - p0.real
        B = (v0 - (1j * W * p0).real + a * A) / wd

        def at(t):
            s, p = t - t0, amp * mp.expj(W * t)
            e, c, n = mp.exp(-a * s), mp.cos(wd * s), mp.sin(wd * s)
            return (e * (A * c + B * n) + p.real,
                    e * ((-a * A + wd * B) * c + (-a * B - wd * A) * n) + (1j * W * p).real)

        def quick(t):
            A1, B1, a1, w1, W1, amp1, s = float(A), float(B), float(a), float(wd), float(W), complex(amp), t - float(t0)
            e, c, n, p = np.exp(-a1 * s), np.cos(w1 * s), np.sin(w1 * s), amp1 * np.exp(1j * W1 * t)
            return e * (A1 * c + B1 * n) + p.real, e * ((-a1 * A1 + w1 * B1) * c + (-a1 * B1 - w1 * A1) * n) + (1j * W1 * p).real
        return at, quick

    def next_hit(self, t0, x0, v0, wall, end):
        """(t, v) where x first comes to the wall again; None: not before the end. Looks at maxima, by their place in 40 digits."""
        at, quick = self.flight(t0, x0, v0)
        t = np.linspace(float(t0), float(end), 20001)
        v = quick(t)[1]
        for k in np.flatnonzero((v[:-1] > 0) & (v[1:] <= 0)):
            top = mp.findroot(lambda s: at(s)[1], (mp.mpf(t[k]), mp.mpf(t[k + 1])), solver="anderson", tol=1e-60, verify=False)
            if at(top)[0] <= wall:
                continue
            low = mp.mpf(t0) if k == 0 else None
            j = k
            while low is None:      # from where it rises to this top
                if v[j] <= 0 or j == 0:
                    low = mp.mpf(t[j])
                j -= 1
            if at(low)[0] > wall or low == t0:
                low = t0 + mp.mpf("1e-25") if low == t0 else low
            hit = mp.findroot(lambda s: at(s)[0] - wall, (low, top), solver="anderson", tol=1e-60, verify=False)
            return hit, at(hit)[1]
        return None

    def hits(self, x0, v0, wall, e, end):
        all_, t, x, v = [], mp.mpf(0), mp.mpf(x0), mp.mpf(v0)
        while len(all_) < MOST:
            found = self.next_hit(t, x, v, wall, end)
            if found is None:
                break
            t, v = found
            if v < SLOW:
                break
            all_.append((t, v))
            x, v = wall, -e * v
        return all_


def scenario(stiffness, damping, force, W, x0, v0, wall, e, end, accuracy, mesh):
    return f"""format = 1
body = [{{ name = "mass", shape = {{ sphere = 0.1 }}, mass = {MASS} }}]
[[joint]]
name = "x"
type = "prismatic"
between = ["world", "mass"]
at = [0, 0, 0]
axis = [1, 0, 0]
stiffness = {stiffness!r}
damping = {damping!r}
[[load]]
type = "actuator"
joint = "x"
expression = "{force!r}*cos({W!r}*t)"
[[stop]]
name = "wall"
joint = "x"
limits = ["-inf", {wall}]
restitution = {e!r}
[start]
coordinates = [{{ joint = "x", value = {x0!r}, rate = {v0!r} }}]
[time]
end = {end!r}
""" + (f'elements = {mesh[0]}\n[method]\nfamily = "lobatto"\ndegree = {mesh[1]}\n' if mesh else f"accuracy = {accuracy!r}\n")


def run(folder, text):
    file, out = folder / "one.toml", folder / "one.nc"
    file.write_text(text)
    done = subprocess.run([PROGRAM, "solve", str(file), "-o", str(out), "--quiet"], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 4, 7):
        sys.exit(f"{text}\n{done.stderr}")
    with netcdf_file(out, mmap=False) as nc:
        if "event_time" not in nc.variables:
            return done.returncode, []
        read = [nc.variables[f"event_{name}"].data.copy() for name in ("time", "error", "speed")]
    return done.returncode, [one for one in zip(*read) if one[2] > 0]


def main():
    n = int(sys.argv[1]) if len(sys.argv) > 1 else 500
    random = np.random.default_rng(int(sys.argv[2]) if len(sys.argv) > 2 else 1)
    folder = pathlib.Path(tempfile.mkdtemp())
    ratios, clear, lies, other, refused = [], [], 0, 0, 0
    for k in range(n):
        w, d, W = (float(f"{x:.4f}") for x in (random.uniform(1, 6), random.uniform(0, 0.15), random.uniform(1, 9)))
        force, x0, v0, e = (float(f"{x:.4f}") for x in (random.uniform(1, 20), random.uniform(-0.5, 0), random.uniform(-2, 2),
                                                        random.uniform(0.3, 0.95)))
        accuracy = float(f"1e-{random.integers(6, 13)}")
        system = float(MASS * w * w), float(2 * MASS * d * w), float(MASS * force), W
        end, oscillator = 6.0, Oscillator(*system)
        at, quick = oscillator.flight(mp.mpf(0), mp.mpf(x0), mp.mpf(v0))
        t = np.linspace(0, 3, 4001)
        x, v = quick(t)
        tops = [i for i in np.flatnonzero((v[:-1] > 0) & (v[1:] <= 0)) if x[i] > x0 + 0.05 and x[i] == x[:i + 1].max()]
        is_graze = k % 3 == 0 and len(tops) > 0
        if is_graze:
            top = mp.findroot(lambda s: at(s)[1], (mp.mpf(t[tops[0]]), mp.mpf(t[tops[0] + 1])), solver="anderson", tol=1e-60,
                              verify=False)
            wall = at(top)[0] - mp.mpf(10) ** mp.mpf(random.uniform(-9, -2))
        else:
            wall = mp.mpf(random.uniform(x0 + 0.05, x0 + 0.8))
        wall = float(f"{float(wall):.17g}")
        truth = oscillator.hits(x0, v0, mp.mpf(wall), mp.mpf(e), end)
        mesh = (int(random.integers(20, 200)), int(random.integers(2, 5))) if k % 2 else None
        text = scenario(*system, x0, v0, repr(wall), e, end, accuracy, mesh)
        code, found = run(folder, text)
        if code != 0:
            refused += 1
            continue
        slowest = np.inf   # which rounding grows by in this and all later instants
        for (t_true, v_true), (t_told, error, _) in zip(truth, found):
            true, slowest = float(abs(mp.mpf(t_told) - t_true)), min(slowest, float(v_true))
            if error > RULED_BY_ROUNDING / slowest:
                clear.append(error / true if true > 0 else np.inf)
            ratios.append((error / true if true > 0 else np.inf, error, true, float(v_true), k, accuracy, float(t_true)))
            if not true < max(10 * error, 1e-9, 0 if mesh else accuracy):
                lies += 1
                print(f"run {k}: an impact at {float(t_true)} s is off by {true:.1e} s, told {error:.1e}")
                break
        wanted = [one for one in truth if one[0] < end - 1e-6]
        if len(found) < min(len(wanted), MOST):
            other += 1
            print(f"run {k}: {len(found)} impacts of {len(wanted)}, accuracy {accuracy:.0e}")
    ratio, clear = np.array([r[0] for r in ratios]), np.array(clear)
    honest = float(np.mean((clear >= 0.5) & (clear <= 3))) if len(clear) else 0.0
    small = float(np.mean(ratio < 0.1))
    print(f"{n} runs, {refused} not converged, {len(ratios)} impacts; {lies} far off, {other} with other impacts")
    for name, of in (("all", ratio), ("above rounding", clear)):
        print(f"told/true, {name} ({len(of)}): " + ", ".join(f"{q} %: {np.quantile(of, q / 100):.3g}" for q in (0, 1, 5, 50, 95, 99)))
    print(f"above rounding 0.5 .. 3: {100 * honest:.1f} %; of all below 0.5: {100 * np.mean(ratio < 0.5):.1f} %, below 0.1: {100 * small:.1f} %")
    for r in sorted(ratios)[:12]:
        print("  ratio {:.3g}, told {:.1e}, true {:.1e}, speed {:.1e}, run {}, accuracy {:.0e}, t {:.3f}".format(*r))
    return 1 if lies or other or honest < 0.95 or small > 0.01 else 0


if __name__ == "__main__":
    sys.exit(main())
