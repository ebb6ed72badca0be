"""Kills a study before each of its file operations in turn, and runs it again.

Run as a script, because the process forks: `kills.py FOLDER SUFFIX`. It prints how often the study
was killed, and the operations after which the second run failed, as JSON.
"""

import json
import os
import sys
from pathlib import Path
from typing import Any

import platecontact as pc
from studies import counts, journal, scene

POINTS = 40
OPERATIONS = {"open", "os.rename", "os.remove", "os.mkdir", "os.rmdir", "os.truncate"}
SCENE = scene()


def study(out: Path) -> None:
    """Run the study in this process."""
    pc.sweep(SCENE, {"impact.speed": f"0.5:2:{POINTS}"}, out=out, workers=1)


def killed(out: Path, number: int) -> str:
    """Run the study until a file operation, numbered from 0; return that operation, if any."""
    read, write = os.pipe()
    if not (child := os.fork()):
        left = number

        def hook(event: str, arguments: tuple[Any, ...]) -> None:
            nonlocal left
            if event in OPERATIONS and any(str(out.parent) in str(x) for x in arguments):
                if not left:
                    os.write(write, f"{event} {arguments[0]}".encode())
                    os._exit(1)
                left -= 1

        sys.addaudithook(hook)
        study(out)
        os._exit(0)
    os.close(write)
    with os.fdopen(read) as stream:
        operation = stream.read()
    os.waitpid(child, 0)
    return operation


def continued(out: Path, whole: bytes) -> bool:
    """Run the study again; return whether nothing is lost, and nothing computed twice."""
    study(out)
    once = bool((journal(out, POINTS) == 1).all() and (counts(out, POINTS) == 1).all())
    return once and out.read_bytes() == whole


def main(folder: Path, suffix: str) -> None:
    """Kill the study before each operation and print the result."""
    study(folder / f"whole{suffix}")
    whole, failures, number = (folder / f"whole{suffix}").read_bytes(), [], 0
    while operation := killed(folder / f"{number}{suffix}", number):
        if not continued(folder / f"{number}{suffix}", whole):
            failures.append(operation)
        number += 1
    print(json.dumps({"kills": number, "failures": failures}))


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2])
