"""A sample of mutants against the killers, and what lives.

    python -m tests.mutants.run --sample 300 --seed 7 --workers 2

The killers must pass on the sound code first. Results are written as they come, and the same
command goes on where it was interrupted.
"""

import argparse
import multiprocessing
import sys
from collections.abc import Callable, Iterator, Set
from concurrent.futures import ProcessPoolExecutor, as_completed
from functools import partial
from pathlib import Path

from tests.mutants import forked, records
from tests.mutants.killers import (
    BATTERY,
    Killer,
    by_property,
    concerns,
    killers,
    on_mutant,
    on_sound_code,
    unit_killers,
)
from tests.mutants.mutate import ROOT, Mutant, mutants
from tests.mutants.records import Record
from tests.mutants.summary import summary
from tests.mutants.targets import modules, sample

RESULTS = Path(__file__).parent / "results.jsonl"
_SLOWER = 5  # times the sound code's processor time, after which a mutant is said to hang
_TRIED = 200  # mutants at most for one property
_OF_MAPS = "verify.schemes.methods.taylor.lie", "verify.schemes.maps.step_map"
_SOUND = 1800.0  # seconds for a killer on the sound code


def attempt(
    mutant: Mutant, sound: list[Record], order: list[Killer], timeout: float, most: float
) -> Record:
    """The first killer that kills it, of those that enter the function it stands in.

    Once `most` seconds of the processor are spent no other is asked, and it is said to live; so
    that what is far and dear can only make the share of the killed smaller.
    """
    spent, tried = 0.0, 0
    seen = {r["killer"]: r for r in sound}
    found: Record = {"killed": False, "by": None}
    entering = [k for k in order if _enters(seen[k.name], mutant)]
    for killer in entering:
        if spent > most:
            break
        tried += 1
        limit = max(timeout, _SLOWER * seen[killer.name]["seconds"])
        work = partial(on_mutant, killer, mutant.module, mutant.index, seen[killer.name])
        ended = forked.forked(work, limit)
        spent += ended.seconds
        verdict = _judged(killer, ended)
        if verdict is not None:
            found = {"killed": True, "killer": killer.name, "stage": killer.stage, **verdict}
            break
    return {
        "kind": "mutant",
        "key": mutant.key,
        "module": mutant.module,
        "operator": mutant.operator,
        **found,
        "tried": tried,
        "entering": len(entering),
        "seconds": round(spent, 1),
    }


def _judged(killer: Killer, ended: forked.Ended) -> Record | None:
    """What killed the mutant; None where it lives."""
    if ended.how != "done":
        return {"by": killer.name, "how": ended.how, "why": ended.said}
    return ended.value if ended.value["by"] else None


def _enters(sound: Record, mutant: Mutant) -> bool:
    return mutant.function in sound["entered"].get(mutant.module, [])


def sound_code(killer: Killer, names: tuple[str, ...]) -> Record:
    """The killer on the sound code: its time, and what it enters. Raises SystemExit if it kills."""
    watched = _passed(killer, partial(on_sound_code, killer, names))
    record: Record = {"kind": "sound", "killer": killer.name, "stage": killer.stage}
    record |= {k: watched.value[k] for k in ("entered", "plan") if k in watched.value}
    # By a plan it does less than it did to make it; that is the time to hold a mutant's against.
    planned = _passed(killer, partial(killer.work, record)) if "plan" in record else watched
    return record | {"seconds": round(planned.seconds, 1)}


def _passed(killer: Killer, work: Callable[[], Record]) -> forked.Ended:
    ended = forked.forked(work, _SOUND)
    if _judged(killer, ended) is not None:
        why = ended.value.get("why") or ended.said
        raise SystemExit(f"{killer.name} kills the sound code ({ended.how}): {why}")
    return ended


def ordered(mutant: Mutant, sound: list[Record], all_killers: list[Killer]) -> list[Killer]:
    """The battery and the files that import the module or its package, then the other files.

    Each by what it costs: what is near and cheap kills most, and a survivor is seen by all.
    """
    seconds = {r["killer"]: r["seconds"] for r in sound}
    package = mutant.module.rpartition(".")[0]

    def cost(killer: Killer) -> tuple[bool, float]:
        path = ROOT / killer.name
        near = killer.stage == 1 or any(concerns(path, n) for n in (mutant.module, package))
        return not near, seconds[killer.name]

    return sorted(all_killers, key=cost)


def main() -> None:
    asked = _arguments()
    sys.path.insert(0, str(ROOT))
    forked.warm_up()
    known = records.read(asked.into)
    _same_source(known, asked.into)
    chosen = tuple(asked.module) or modules()
    wanted = sample(asked.sample, asked.seed, chosen)
    records.add(asked.into, _asked(asked))
    order = [k for k in killers(asked.examples) if k.stage <= asked.stage]
    context = multiprocessing.get_context("fork")
    with ProcessPoolExecutor(
        asked.workers, mp_context=context, initializer=forked.end_with_parent
    ) as pool:
        sound = _sound(pool, order, known, asked.into)
        mine = records.of_kind(known, "mutant")
        done = {r["key"] for r in mine if r["killed"] or r["last"] >= asked.stage}
        waiting = [m for m in wanted if m.key not in done]
        work = [
            pool.submit(attempt, m, sound, ordered(m, sound, order), asked.timeout, asked.most)
            for m in waiting
        ]
        for n, future in enumerate(as_completed(work), 1):
            record = future.result() | {"last": asked.stage}
            records.add(asked.into, record)
            said = record["by"] if record["killed"] else "LIVES"
            print(f"{n}/{len(waiting)} {record['seconds']:6.1f} s {record['key']}: {said}")
        if asked.explain:
            _explain(pool, wanted, asked)
        if asked.show:
            _show(pool, wanted, sound, asked)
    print(summary(records.read(asked.into), {m.key for m in wanted}))


def _sound(
    pool: ProcessPoolExecutor, order: list[Killer], known: list[Record], path: Path
) -> list[Record]:
    """Each killer on the sound code, what is known of it included."""
    found = [r for r in records.of_kind(known, "sound") if r["killer"] in {k.name for k in order}]
    missing = [k for k in order if k.name not in {r["killer"] for r in found}]
    for future in as_completed([pool.submit(sound_code, k, modules()) for k in missing]):
        record = future.result()
        records.add(path, record)
        found.append(record)
        print(f"sound code passes {record['killer']} in {record['seconds']} s")
    return found


def _explain(pool: ProcessPoolExecutor, wanted: list[Mutant], asked: argparse.Namespace) -> None:
    """Stage 3: what the unit tests of their modules say of the mutants that live."""
    path, limits = asked.into, (asked.timeout, asked.most)
    known = records.read(path)
    living = {r["key"] for r in records.of_kind(known, "mutant") if not r["killed"]}
    done = {r["key"] for r in records.of_kind(known, "unit")}
    waiting = [m for m in wanted if m.key in living - done]
    needed = {k.name: k for m in waiting for k in unit_killers(m.module)}
    sound = _sound(pool, list(needed.values()), known, path)
    work = [
        pool.submit(attempt, m, sound, ordered(m, sound, list(unit_killers(m.module))), *limits)
        for m in waiting
    ]
    for future in as_completed(work):
        record = future.result() | {"kind": "unit"}
        records.add(path, record)
        print(f"unit tests: {record['key']}: {record['by'] or 'lives'}")


def _show(
    pool: ProcessPoolExecutor, wanted: list[Mutant], sound: list[Record], asked: argparse.Namespace
) -> None:
    """A mutant for each property of the battery that was first at none: it is run by itself."""
    known = records.read(asked.into)
    first = {r["by"] for r in records.of_kind(known, "mutant") if r.get("how") == "violated"}
    first |= {r["property"] for r in records.of_kind(known, "shown")}
    whole = [r for r in sound if r["killer"] == BATTERY]
    missing = [name for r in whole for name in r["plan"]["looks"] if name not in first]
    tried = [*wanted, *_of_maps({m.key for m in wanted})]
    work = [pool.submit(shown, n, tried, whole[0], asked.examples, asked.timeout) for n in missing]
    for future in as_completed(work):
        record = future.result()
        records.add(asked.into, record)
        print(f"{record['property']}: {record['key'] or 'kills none that it was tried on'}")


def _of_maps(known: Set[str]) -> Iterator[Mutant]:
    """All other mutants of the modules that make maps, of which a sample has but a few."""
    for module in modules():
        if module.startswith(_OF_MAPS):
            yield from (m for m in mutants(module) if m.key not in known)


def shown(name: str, wanted: list[Mutant], sound: Record, examples: int, timeout: float) -> Record:
    """The first of the mutants that violates the property; no more than some are tried."""
    entering = [m for m in wanted if _enters(sound, m)]
    if len(entering) > _TRIED:  # those of maps first, for they break most
        entering.sort(key=lambda m: not m.module.startswith(_OF_MAPS))
        entering = entering[:_TRIED]
    limit = max(timeout, _SLOWER * sound["seconds"])
    for mutant in entering:
        work = partial(by_property, name, examples, mutant.module, mutant.index, sound)
        ended = forked.forked(work, limit)
        if ended.how == "done" and ended.value["by"] and ended.value["how"] == "violated":
            return {"kind": "shown", "property": name, "key": mutant.key}
    return {"kind": "shown", "property": name, "key": None, "tried": len(entering)}


def _same_source(known: list[Record], path: Path) -> None:
    if any(r["source"] != records.source() for r in records.of_kind(known, "asked")):
        raise SystemExit(f"{path} holds results of other source; move it away, or give --into")


def _asked(asked: argparse.Namespace) -> Record:
    module = "".join(f" --module {name}" for name in asked.module)
    command = f"python -m tests.mutants.run --sample {asked.sample} --seed {asked.seed}"
    command += f" --workers {asked.workers} --examples {asked.examples}{module}"
    return {
        "kind": "asked",
        "command": command,
        "sample": asked.sample,
        "seed": asked.seed,
        "module": asked.module,
        "source": records.source(),
    }


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--sample", type=int, default=300)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--module", action="append", default=[])
    parser.add_argument("--timeout", type=float, default=60, help="least limit, in processor time")
    parser.add_argument("--most", type=float, default=60, help="seconds without a kill: it lives")
    parser.add_argument("--examples", type=int, default=60, help="scenes of the battery")
    parser.add_argument("--stage", type=int, default=2, choices=(1, 2), help="the last to be run")
    parser.add_argument("--explain", action="store_true", help="survivors against unit tests")
    parser.add_argument("--show", action="store_true", help="a mutant for each property")
    parser.add_argument("--into", type=Path, default=RESULTS)
    return parser.parse_args()


if __name__ == "__main__":
    main()
