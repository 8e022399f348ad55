#!/usr/bin/env python3
"""parse.py BUILD TARGETS -- BUILT: the compiler of the configured folder BUILD reads the sources of the TARGETS that
the targets BUILT do not need, with all warnings. It generates no code."""
import os
import shlex
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

build = sys.argv[1]
between = sys.argv.index("--")
targets, built = sys.argv[2:between], sys.argv[between + 1:]


def compilations(targets):
    """{object or precompiled header: the command that makes it}"""
    commands = subprocess.run(["ninja", "-C", build, "-t", "commands", *targets], stdout=subprocess.PIPE, text=True, check=True)
    words = [shlex.split(line) for line in commands.stdout.splitlines()]
    return {command[command.index("-o") + 1]: command for command in words if "-c" in command and "-o" in command}


there = compilations(built)
rest = {output: command for output, command in compilations(targets).items() if output not in there}
headers = [output for output in rest if "/cmake_pch." in output]
# What tests wait for would be built whole: their sources include nothing generated but what those of the program do.
generated = ["cmake_object_order_depends_target_" + target for target in targets if not target.endswith("_test")]
subprocess.run(["cmake", "--build", build, "--target", *generated, *headers], check=True)
sources = sorted(rest.keys() - set(headers))


def parse(output):
    result = subprocess.run([*rest[output], "-fsyntax-only"], cwd=build, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                            check=False)
    print(result.stdout, end="")
    return result.returncode == 0


with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as workers:
    good = list(workers.map(parse, sources))
print(f"parsed: {len(good)} sources beside the {len(there)} that are built")
sys.exit(0 if good and all(good) else 1)
