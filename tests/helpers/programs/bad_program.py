"""A program that steps a pendulum by Verlet's method, but for what its argument says.

    python bad_program.py hang

It reads `t h p q` and answers `p q`, as `verify check-integrator --command` asks.
"""

import math
import os
import signal
import sys
import time

MODE = sys.argv[1] if len(sys.argv) > 1 else "right"
kept = []


def step(h: float, p: float, q: float) -> tuple[float, float]:
    p -= h / 2 * math.sin(q)
    q += h * p
    return p - h / 2 * math.sin(q), q


def say(text: str) -> None:
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


for calls, line in enumerate(sys.stdin, 1):
    t, h, p, q = map(float, line.split())
    p, q = step(h, p, q)
    if MODE == "crash" or (MODE == "crash-late" and calls > 40):
        os.kill(os.getpid(), signal.SIGSEGV)
    elif MODE == "exit":
        sys.exit("no step today")
    elif MODE == "hang":
        time.sleep(3600)
    elif MODE == "spin":
        while True:
            pass
    elif MODE == "nonsense":
        say("segmentation fault (not really)")
    elif MODE == "too-few":
        say(repr(p))
    elif MODE == "nan":
        say(f"nan {q!r}")
    elif MODE == "state":
        say(f"{p + 1e-9 * calls!r} {q!r}")
    elif MODE == "allocate":
        while True:
            kept.append(bytearray(b"x") * (1 << 28))
    elif MODE == "chatter":
        say(f"{p!r} {q!r}")
        say("done")
    elif MODE == "flood":
        while True:
            sys.stdout.write("x" * 4096)
    elif MODE == "closed":
        os.close(1)
        time.sleep(3600)
    elif MODE == "single":
        say(f"{p:.7e} {q:.7e}")
    elif MODE == "order-1":
        say(f"{p + h * h / 10!r} {q!r}")
    elif MODE == "hexadecimal":
        say(f"{p.hex()} {q.hex()}")
    else:
        say(f"{p!r} {q!r}")
