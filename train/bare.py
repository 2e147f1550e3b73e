"""Training with torch and numpy alone, for a machine that has nothing else: ``python -m mrta_zoo.train.bare``.

At home, ``mrta-zoo train --preset capam-plus --out runs/plus --prepare`` writes the configuration and the plans to
imitate. Carry that folder and the sources to the other machine, with the folders ``policies``, ``train`` and ``eval``
inside ``mrta_zoo``, as they are when installed, and there::

    python -m mrta_zoo.train.bare runs/plus/config.json runs/plus/bare --plans runs/plus/plans

It leaves the best weights by validation in ``bare.npz``, what it needs to go on in ``bare.last.npz``, the history in
``bare.json``. Bring them back, and ``mrta-zoo train --out runs/plus --collect`` makes the run's policy of them.
"""

from __future__ import annotations

import argparse
import io
import json
import math
import sys
import time
import zipfile
from dataclasses import MISSING, asdict, fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import torch

from mrta_zoo.errors import ConfigError
from mrta_zoo.io.atomic import replacing
from mrta_zoo.io.stand_ins import why_unreadable
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.train.config import TrainConfig
from mrta_zoo.train.imitation.experts import read_plans
from mrta_zoo.train.reinforce import Reinforce, RunOptions, Update, Validation
from mrta_zoo.wording import counted

KINDS = {int: "a whole number", float: "a number", bool: "true or false", str: "a text", tuple: "a list"}
"""How JSON's kinds of values are called."""
MAY_CHANGE = ("updates", "epoch")
"""What a run may be resumed with other values of."""


def train(
    config: TrainConfig,
    out: Path,
    plans: Path | None = None,
    workers: int = 0,
    seconds: float = math.inf,
    compiled: bool = False,
    fit: bool = False,
    resume: bool = False,
) -> None:
    """Train, and print how it goes.

    Args:
        config: the run.
        out: where the best weights (OUT.npz), the last state (OUT.last.npz) and the history (OUT.json) go.
        plans: folder of the plans to imitate, if any.
        workers: processes that draw scenarios.
        seconds: after which training stops, be it at its end or not.
        compiled: see `Reinforce`.
        fit: once REINFORCE has begun, set the number of updates to what `seconds` has room for.
        resume: go on from OUT.last.npz.

    Raises:
        ConfigError: if there is imitation to be done and no plans, the baseline is not "samples", there is a policy to
            start from and no msgspec and safetensors to read it with, there is no folder for `out`, a run is there that
            is not to be resumed, or what is to be resumed is missing, damaged, or of another run.
    """
    if config.baseline != "samples":
        raise ConfigError(f"baseline is {config.baseline!r}, which needs SciPy; expected samples")
    if not out.parent.is_dir():
        raise ConfigError(f"{out.parent} is no folder; expected one for {out.name}.npz and the other files")
    there = [path for ending in ("npz", "last.npz", "json") if (path := out.with_name(f"{out.name}.{ending}")).exists()]
    if there and not resume:
        raise ConfigError(f"{there[0]} is there already; go on with that run (--resume), or give another OUT")
    begun, asked = time.perf_counter(), config
    try:
        # To be resumed, it has its weights; what it once began from may be gone.
        run = Reinforce(replace(config, initial="") if resume else config, options=RunOptions(workers, compiled))
    except ModuleNotFoundError as error:
        raise ConfigError(
            f"initial is {config.initial!r}, which cannot be read without {error.name}; expected none on a machine "
            "with torch and NumPy alone"
        ) from None
    run.config = config
    spent = _resume(out, run) if resume else 0.0
    config = run.config
    if run.update < config.imitation_updates:
        if plans is None:
            raise ConfigError("there is imitation to be done; name a folder of plans (--plans)")
        known = read_plans(config, plans, config.imitation_plans, workers)
        if not known:
            raise ConfigError(f"{plans} holds no plans; expected {config.imitation_plans:,} of them")
        if len(known) < config.imitation_plans:
            print(f"{out.name}: {plans} holds {len(known):,} plans, not {config.imitation_plans:,}", flush=True)
            run.config = config = replace(config, imitation_plans=len(known))
        run.set_plans(known)
    print(f"{out.name}: ready after {time.perf_counter() - begun:.1f} s on {run.device}", flush=True)
    last = session = time.perf_counter()
    saved = -math.inf
    first_reinforce = None
    start = max(run.update, config.imitation_updates)
    updates: list[Update] = []
    try:
        for event in run.run():
            now = time.perf_counter()
            if isinstance(event, Update):
                updates.append(event)
                into = event.update - start
                if fit and into == 15:
                    first_reinforce = now
                if fit and into == 75 and first_reinforce is not None:
                    left = seconds - (now - begun) - 12
                    more = int(left / ((now - first_reinforce) / 60 * 1.08))
                    run.config = config = replace(
                        config, updates=start - config.imitation_updates + into + max(more, 1)
                    )
                    print(f"{out.name}: {counted(config.updates, 'update')} of REINFORCE", flush=True)
            else:
                mean = sum(update.loss for update in updates) / max(1, len(updates))
                print(
                    f"{out.name} update {event.update} episodes {event.episodes:,} loss {mean:.4f} validation "
                    f"{100 * event.completion:.2f} % cost {event.cost:.4f} {now - begun:.0f} s "
                    f"({(now - last) / max(1, len(updates)):.3f} s/update)",
                    flush=True,
                )
                updates, last = [], now
                if event is run.best:
                    _write(out, run, asked, spent + now - session)
                if now - saved > 60:
                    saved = now
                    _save(out, run, asked, spent + now - session)
            if now - begun > seconds:
                break
    except KeyboardInterrupt:
        print(
            f"{out.name} is interrupted; go on with --resume, from a minute ago at most or the last validation before",
            flush=True,
        )
        run.close()
        raise
    if run.history[-1].update != run.update:
        run.validate()
        if run.history[-1] is run.best:
            _write(out, run, asked, spent + time.perf_counter() - session)
    _save(out, run, asked, spent + time.perf_counter() - session)
    print(
        f"{out.name} ends after update {run.update} at {100 * run.history[-1].completion:.2f} %, best "
        f"{100 * run.best.completion:.2f} %",
        flush=True,
    )
    run.close()


def read_config(path: Path) -> TrainConfig:
    """A TrainConfig from JSON, as `dataclasses.asdict` gives it.

    Raises:
        ConfigError: if the file is missing or no JSON, has an unknown field, or a value is out of range.
    """
    try:
        values: dict[str, Any] = json.loads(path.read_text(encoding="utf-8-sig"))
        return _config_of(values.get("config", values))  # the history that `train` leaves holds it, too
    except ConfigError:
        raise
    except (OSError, ValueError, TypeError, AttributeError) as error:
        raise ConfigError(f"{path}: not a configuration{why_unreadable(path, error)}") from None


def _config_of(values: dict[str, Any]) -> TrainConfig:
    rest = {name: value for name, value in values.items() if name != "network"}
    network = NetworkConfig(**_arguments(NetworkConfig, values.get("network", {})))
    return TrainConfig(network=network, **_arguments(TrainConfig, rest))


def _arguments(of: type[NetworkConfig | TrainConfig], values: dict[str, Any]) -> dict[str, Any]:
    """What JSON says of a dataclass, as its arguments: tuples where JSON has only lists.

    Raises:
        ConfigError: if a value is of another kind than the field's default.
    """
    arguments = {name: tuple(value) if isinstance(value, list) else value for name, value in values.items()}
    for field in fields(of):
        if field.name in arguments and field.default is not MISSING:
            expected, value = type(field.default), arguments[field.name]
            if type(value) is not expected and (expected, type(value)) != (float, int):
                raise ConfigError(f"{field.name} is {json.dumps(value)}; expected {KINDS[expected]}")
    return arguments


def _write(out: Path, run: Reinforce, asked: TrainConfig, seconds: float) -> None:
    _store(out.with_name(out.name + ".npz"), run, asked, seconds, _arrays(dict(run.network.state_dict())))
    _write_history(out, run)


def _save(out: Path, run: Reinforce, asked: TrainConfig, seconds: float) -> None:
    arrays = _arrays(dict(run.network.state_dict()))
    for name, parameter in run.network.named_parameters():
        for key, value in run.optimizer.state.get(parameter, {}).items():
            arrays[f"adam/{name}/{key}"] = value.detach().cpu().numpy()
    _store(out.with_name(out.name + ".last.npz"), run, asked, seconds, arrays)
    _write_history(out, run)


def _write_history(out: Path, run: Reinforce) -> None:
    with replacing(out.with_name(out.name + ".json")) as partial:
        history = [asdict(each) for each in run.history]
        partial.write_text(json.dumps({"config": asdict(run.config), "history": history}), encoding="utf-8")


def _arrays(tensors: dict[str, torch.Tensor]) -> dict[str, Any]:
    return {name: value.detach().cpu().numpy() for name, value in tensors.items()}


def _store(path: Path, run: Reinforce, asked: TrainConfig, seconds: float, arrays: dict[str, Any]) -> None:
    about = {
        "update": run.update, "seconds": round(seconds, 1), "torch": str(torch.__version__),
        "device": torch.cuda.get_device_name() if run.device.type == "cuda" else "cpu",
        "threads": torch.get_num_threads(), "history": [asdict(each) for each in run.history],
        "config": asdict(asked), "updates": run.config.updates,
    }  # fmt: skip
    with replacing(path) as partial, partial.open("wb") as file:
        np.savez(file, about=np.array(json.dumps(about)), **arrays)


def _resume(out: Path, run: Reinforce) -> float:
    """Put the run where it was; the seconds spent on it before.

    Raises:
        ConfigError: if there is nothing to go on with, it is damaged, or it belongs to another run: of what was asked
            for only `MAY_CHANGE` may have changed since.
    """
    path = out.with_name(out.name + ".last.npz")
    try:
        with np.load(io.BytesIO(path.read_bytes()), allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        about = json.loads(str(arrays.pop("about")))
        asked, now = _config_of(about["config"]), run.config
        changed = [each.name for each in fields(now) if getattr(asked, each.name) != getattr(now, each.name)]
        if different := [name for name in changed if name not in MAY_CHANGE]:
            raise ConfigError(
                f"{path} is of another run: {different[0]} was {getattr(asked, different[0])!r}, now it is "
                f"{getattr(now, different[0])!r}"
            )
        if now.updates == asked.updates:  # what --fit has made of it counts
            run.config = replace(now, updates=about["updates"])
        state = {name: torch.from_numpy(array) for name, array in arrays.items() if not name.startswith("adam/")}
        run.network.load_state_dict(state)
        for name, parameter in run.network.named_parameters():
            keys = [key for key in ("step", "exp_avg", "exp_avg_sq") if f"adam/{name}/{key}" in arrays]
            if keys:
                moments = {key: torch.from_numpy(arrays[f"adam/{name}/{key}"]) for key in keys}
                run.optimizer.state[parameter] = {
                    key: value if key == "step" else value.to(parameter.device) for key, value in moments.items()
                }
        run.update, run.history = int(about["update"]), [Validation(**each) for each in about["history"]]
        seconds = float(about["seconds"])
    except FileNotFoundError:
        raise ConfigError(f"{path}: no such file; there is nothing to go on with") from None
    except ConfigError:
        raise
    except (OSError, ValueError, KeyError, TypeError, RuntimeError, EOFError, zipfile.BadZipFile) as error:
        why = why_unreadable(path, type(error).__name__)
        raise ConfigError(f"{path}: not what a run leaves to go on with{why}") from None
    if not 0 <= run.update <= run.config.total_updates or not run.history:
        raise ConfigError(
            f"{path}: update is {run.update}; expected at most {run.config.total_updates}, validated before"
        )
    return seconds


def main() -> None:
    """Run from the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("config", type=Path, help="TrainConfig as JSON")
    parser.add_argument("out", type=Path, help="weights go to OUT.npz, the history to OUT.json")
    parser.add_argument("--plans", type=Path, help="folder of plans to imitate")
    parser.add_argument("--workers", type=int, default=0, help="processes that draw scenarios")
    parser.add_argument("--seconds", type=float, default=math.inf, help="stop after so long")
    parser.add_argument("--compiled", action="store_true", help="compile the decoder's layers")
    parser.add_argument("--fit", action="store_true", help="as many updates as --seconds has room for")
    parser.add_argument("--resume", action="store_true", help="go on from OUT.last.npz")
    parser.add_argument("--threads", type=int, default=1, help="CPU threads of torch; 0 leaves the choice to it")
    a = parser.parse_args()
    if a.workers < 0 or a.threads < 0 or not a.seconds > 0:
        parser.error("--workers and --threads are whole numbers >= 0, --seconds a number > 0")
    if a.threads:
        torch.set_num_threads(a.threads)
    try:
        train(read_config(a.config), a.out, a.plans, a.workers, a.seconds, a.compiled, a.fit, a.resume)
    except ConfigError as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(2)
    except OSError as error:
        print(f"error: {a.out} cannot be written: {(error.strerror or str(error)).lower()}", file=sys.stderr)
        sys.exit(2)
    except KeyboardInterrupt:
        sys.exit(130)


if __name__ == "__main__":
    main()
