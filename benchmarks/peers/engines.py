# SPDX-License-Identifier: BSD-3-Clause
"""The engines of the comparison as data: how each is started and the settings it is tried with.

`families` are sequences of settings of rising accuracy. A sweep goes along each until it is accurate enough, takes
too long or gets no better, and keeps the cheapest setting for every accuracy.
"""
import dataclasses
import pathlib
import typing

ROOT = pathlib.Path(__file__).resolve().parents[2]
PEERS = ROOT / "build" / "peers"
PYTHON = PEERS / "venv" / "bin" / "python"
PROGRAMS = ROOT / "build" / "release" / "benchmarks" / "peers"
HERE = ROOT / "benchmarks" / "peers"


FLAGS = set(pathlib.Path("/proc/cpuinfo").read_text().partition("\nflags")[2].partition("\n")[0].split())


@dataclasses.dataclass
class Engine:
    title: str
    program: str                   # a C++ program, or a file for PYTHON
    families: typing.Callable      # of the number of bodies
    note: str = ""
    variables: dict = dataclasses.field(default_factory=dict)
    refine: typing.Callable = None # what else is tried of a good setting
    like: str = ""                 # an engine whose good settings are the only ones to be tried
    needs: str = ""                # of the processor, as /proc/cpuinfo has it
    by_name: bool = False          # knows a problem by its name: the ways to put it are one
    modules: tuple = ()            # of Python, whose versions are told
    patience: int = 60             # s for one answer; then it is ended
    asked: str = ""                # the word of settings that are accuracies: "accuracy" of "accuracy:1e-6"
    for_loaded: bool = True        # has a place beside problems with loads

    def command(self):
        """None: it is not to be had."""
        if self.needs and self.needs not in FLAGS:
            return None
        if self.program.endswith(".py"):
            return [str(PYTHON), "-B", str(HERE / self.program)] if PYTHON.exists() else None
        program = PROGRAMS / self.program
        return [str(program)] if program.exists() else None


def tolerances(first, last, mantissas=(5.6, 3.2, 1.8, 1)):
    return [f"{m}e-{k}" for k in range(first, last + 1) for m in mantissas]


def counts(first, last, ratio):
    found, n = [], float(first)
    while n <= last:
        if not found or round(n) != found[-1]:
            found.append(round(n))
        n *= ratio
    return found


def prefixed(names, values):
    return [[f"{name}:{value}" for value in values] for name in names]


def lobatto(n_bodies):
    degrees = (2, 3, 4, 5, 6, 8, 10, 12) if n_bodies < 10 else (3, 4, 5, 6, 7, 8)
    ratio, nodes, fewest = (1.15, 60, 4) if n_bodies < 10 else (1.15, 0, 5 if n_bodies < 50 else 10)
    return [[f"{p}:{n}" for n in counts(max(fewest, nodes // p), 20000, ratio)] for p in degrees]


def stopped_early(setting):
    """The iteration stops at 1e-14 by default."""
    return [f"{setting}:{tolerance}" for tolerance in ("1e-11", "1e-8", "1e-5", "1e-4")]


def livens(title, word, needs="", like="", for_loaded=False):
    return Engine(f"livens, {title}", "peer_livens", lobatto, "lobatto: degree, elements, tolerance",
                  {"LIVENS_SIMD": word}, stopped_early, like, needs, for_loaded=for_loaded)


def livens_asked(title, word, note):
    return Engine(f"livens, {title}", "peer_livens", lambda n: prefixed([word], tolerances(2, 12, COARSE)), note, asked=word)


COARSE = (3.2, 1)
ENGINES = {
    "livens_accuracy": livens_asked("asked for an accuracy", "accuracy",
                                    "family, degree and elements left open; includes a second solution for the estimate"),
    "livens_all": livens_asked("asked and judged", "all",
                               "the same with the growth of errors and the checks of its program: all but reading and writing"),
    "livens_avx512": livens("AVX-512", "avx512", "avx512f"),
    "livens_avx2": livens("AVX2", "avx2", "avx2", for_loaded=True),
    "livens_sse2": livens("SSE2", "sse2", like="livens_avx2"),
    "hand": Engine("by hand, C++", "peer_hand", lambda n: [tolerances(2, 14)],
                   "minimal coordinates derived on paper, DOP853 (tolerance)", by_name=True),
    "heyoka": Engine("heyoka", "peer_heyoka.py", lambda n: [[f"1e-{k}" for k in range(2, 17, 1 if n < 10 else 3)]],
                     "the same coordinates, Taylor series compiled for the problem (tolerance); compiling is not timed",
                     modules=("heyoka",), patience=300),
    "pinocchio": Engine("Pinocchio", "peer_pinocchio", lambda n: prefixed(["local", "world"], tolerances(2, 14)),
                        "articulated bodies, or constrained dynamics where loops close; DOP853 (frames, tolerance)",
                        modules=("pin",)),
    "simbody": Engine("Simbody", "peer_simbody",
                      lambda n: prefixed(["merson", "feldberg", "cpodes"][:3 if n < 10 else 2],
                                         tolerances(2, 13, COARSE)), "integrator, accuracy"),
    "drake": Engine("Drake", "peer_drake.py",
                    lambda n: prefixed(["runge_kutta5", "runge_kutta3"][:2 if n < 5 else 1],
                                       tolerances(2, 13, COARSE)),
                    "continuous MultibodyPlant (scheme, accuracy)", modules=("drake",)),
    "mujoco": Engine("MuJoCo", "peer_mujoco.py",
                     lambda n: prefixed(["RK4"], counts(40, 3e6, 1.25)) + prefixed(["implicitfast"],
                                                                                  counts(40, 3e6, 4)),
                     "integrator, steps", modules=("mujoco",)),
    "exudyn": Engine("Exudyn", "peer_exudyn.py",
                     lambda n: prefixed(["RK67"], counts(20, 2e6, 1.5)) +
                     prefixed(["DOPRI5"], tolerances(2, 13, COARSE)) +
                     (prefixed(["alpha", "trapezoid"], counts(100, 2e6, 2)) if n < 10 else []),
                     "solver, steps or tolerance", modules=("exudyn",)),
    "scipy": Engine("by hand, SciPy", "peer_scipy.py",
                    lambda n: prefixed(["DOP853", "LSODA"], tolerances(2, 14, COARSE)),
                    "the same coordinates in Python (solver, tolerance)", modules=("scipy",), by_name=True, for_loaded=False),
}

LEVELS = (1e-3, 1e-6, 1e-9, 1e-12)   # m


ANY = ("livens_avx512", "livens_avx2", "livens_sse2")
ASKED_LEVELS = (1e-6, 1e-9)   # that are compared first: accuracies that livens is asked for
# What was asked of livens for these: at most so many times the time of each, in its best settings, at the same true error.
ASKED = {"pinocchio": 1.0, "simbody": 1 / 3, "drake": 1 / 3, "mujoco": 1 / 3, "exudyn": 1 / 3}
LIMITS = ("heyoka", "hand")   # beside which no general engine comes


@dataclasses.dataclass
class Target:
    """What was asked: the time of the best of `ours` over that of the best of `others`, at most `ratio`."""
    problems: tuple
    others: tuple
    levels: tuple
    ratio: float
    ours: tuple = ANY


CHAINS = tuple(f"{kind}s{n}" for kind in ("ball", "hinge") for n in (10, 20, 50))
TARGETS = [
    Target(("bricks",), ("pinocchio",), (1e-12, 1e-9, 1e-6), 1.0),
    Target(("bricks",), ("pinocchio",), (1e-12,), 0.7, ("livens_avx2",)),
    Target(("bricks",), ("pinocchio",), (1e-9, 1e-6), 1.1, ("livens_avx2",)),
    Target(("bricks",), ("simbody",), (1e-9,), 1 / 70),
    Target(("links", "rods"), ("pinocchio",), (1e-12, 1e-9, 1e-6), 2.0),
    Target(("four_bar",), ("pinocchio", "simbody", "mujoco", "exudyn"), (1e-9, 1e-6, 1e-3), 1 / 10),
    Target(("four_bar",), ("simbody", "mujoco", "exudyn"), (1e-9, 1e-6, 1e-3), 1 / 10),
    Target(CHAINS, ("pinocchio",), (1e-6,), 2.0),
    Target(CHAINS, ("simbody", "mujoco"), (1e-6,), 1 / 3),
]
