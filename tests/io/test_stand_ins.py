"""What is no file of ours, but lies or is named where one should be: pointers of Git LFS, web pages, URLs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from command_line import Captured, fails
from factories import small_scenario
from sentences import check_sentence
from valid_files import TABLE

from mrta_zoo import Plan
from mrta_zoo.cli.main import COMMANDS
from mrta_zoo.errors import ConfigError, MrtaError
from mrta_zoo.io import read_cases, read_plan, read_scenario, read_trace, write_plan, write_scenario
from mrta_zoo.io.paths import check_no_url

POINTER = b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a2146\nsize 2512345\n"
PAGE = b"\n<!DOCTYPE html>\n<html lang=en><title>weights at main</title></html>\n"
SAID = {
    POINTER: "is a pointer of Git LFS; expected the file itself, which `git lfs pull` fetches",
    PAGE: "is a web page; expected the file itself, to which the page may lead",
}
READERS: dict[str, Callable[[Path], object]] = {
    "m.txt": read_scenario,
    "m.csv": read_scenario,
    "m.json": read_scenario,
    "plan.json": read_plan,
    "trace.json": read_trace,
    "reference.csv": lambda path: read_cases(path.parent),
}


@pytest.mark.parametrize("content", SAID, ids=["pointer", "page"])
@pytest.mark.parametrize("name", READERS)
def test_text_that_is_not_there(tmp_path: Path, name: str, content: bytes) -> None:
    (tmp_path / "case.csv").write_text(TABLE)
    (tmp_path / name).write_bytes(content)
    with pytest.raises(MrtaError) as caught:
        READERS[name](tmp_path / name)
    check_sentence(caught.value, f"{tmp_path / name} {SAID[content]}")


@pytest.mark.parametrize(
    ("content", "said"), [*SAID.items(), (b"", "is empty; expected the file itself")], ids=["pointer", "page", "empty"]
)
def test_weights_that_are_not_there(tmp_path: Path, content: bytes, said: str, capsys: Captured) -> None:
    pytest.importorskip("torch")
    from mrta_zoo.policies.neural.capam.config import NetworkConfig
    from mrta_zoo.policies.neural.policy import load_policy
    from mrta_zoo.policies.pretrained import pretrained_path
    from mrta_zoo.train.config import TrainConfig
    from mrta_zoo.train.imitation.experts import read_plans, shard_path

    path = tmp_path / "p.safetensors"
    path.write_bytes(content)
    path.with_suffix(".json").write_bytes(pretrained_path("capam").with_suffix(".json").read_bytes())
    sentence = f"{path}: not a readable safetensors file: it {said}"
    with pytest.raises(ConfigError) as caught:
        load_policy(path)
    check_sentence(caught.value, sentence)
    (tmp_path / "m.csv").write_text(TABLE)
    assert sentence in fails(capsys, ["solve", str(tmp_path / "m.csv"), "--method", str(path)])

    path.with_suffix(".json").write_bytes(content)
    with pytest.raises(ConfigError, match=said.split(";")[0]):
        load_policy(path)

    shard_path(tmp_path, 0).write_bytes(content)
    with pytest.raises(ConfigError, match=f"not a readable file of plans: it {said}"):
        read_plans(TrainConfig(network=NetworkConfig()), tmp_path, 1)


URLS = ("https://example.org/m.csv", "file:///data/m.csv", "hf://who/what", "S3://bucket/cases")


@pytest.mark.parametrize("url", URLS)
def test_urls_are_not_taken_for_paths(url: str) -> None:
    said = f"{url} is a URL; expected the path of a file or folder on this computer"
    for read in (read_scenario, read_plan, read_cases):
        with pytest.raises(MrtaError) as caught:
            read(url)
        check_sentence(caught.value, said)
    pytest.importorskip("torch")
    from mrta_zoo.policies.neural.policy import load_policy
    from mrta_zoo.policies.registry import make_solver

    for make in (load_policy, make_solver):
        with pytest.raises(ConfigError) as told:
            make(url)
        check_sentence(told.value, said)


@pytest.mark.parametrize("url", ["https://example.org/a/m.json", "s3://bucket/m.csv", "https://example.org/m.txt"])
def test_nothing_is_written_to_a_url(url: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("torch")
    pytest.importorskip("matplotlib")
    from mrta_zoo.io.case_folder import write_case_folder
    from mrta_zoo.policies.neural.weights import load_weights
    from mrta_zoo.show.plan.picture import save_plan_picture
    from mrta_zoo.train import checkpoint
    from mrta_zoo.train.config import TrainConfig

    monkeypatch.chdir(tmp_path)
    scenario, plan = small_scenario(3), Plan.of([[0], [1], []])
    for act in (
        lambda: write_scenario(scenario, url),
        lambda: write_plan(plan, url),
        lambda: save_plan_picture(scenario, plan, Path(url)),
        lambda: write_case_folder([scenario], Path(url), "csv"),
        lambda: load_weights(Path(url)),
        lambda: checkpoint.start(Path(url), TrainConfig()),
        lambda: checkpoint.resume(Path(url)),
    ):
        with pytest.raises(MrtaError) as caught:
            act()
        check_sentence(caught.value, f"{url} is a URL; expected the path")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["a" * 300, "a\0"])
def test_names_that_no_file_can_have(name: str) -> None:
    pytest.importorskip("torch")
    pytest.importorskip("matplotlib")
    from mrta_zoo.policies.neural.policy import load_policy
    from mrta_zoo.show.plan.picture import save_plan_picture

    with pytest.raises(ConfigError, match="there is no policy"):
        load_policy(name)
    with pytest.raises(ConfigError, match="cannot be written"):
        save_plan_picture(small_scenario(3), Plan.of([[0], [1], []]), Path(name + ".png"))


def test_a_url_is_known_without_its_second_slash() -> None:
    with pytest.raises(ConfigError, match=r"^https://example\.org/m\.csv is a URL"):
        check_no_url(Path("https://example.org/m.csv"), ConfigError)


@pytest.mark.parametrize("path", ["m.csv", "/data/m.csv", "C:/data/m.csv", "c:\\m.csv", "a:b", "runs/at:/x", "3://x"])
def test_paths_are_no_urls(path: str) -> None:
    check_no_url(path, ConfigError)


@pytest.mark.parametrize("command", COMMANDS)
def test_no_command_takes_urls(command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    monkeypatch.chdir(tmp_path)
    url = "https://example.org/a?b=c"
    for arguments in ([url], ["--out", url], [f"--out={url}"], ["--methods", f"nearest,{url}"], [f"--cases=x,{url}"]):
        assert fails(capsys, [command, *arguments]).startswith(f"error: {url} is a URL; expected the path")
    assert list(tmp_path.iterdir()) == []
