#!/usr/bin/env python3
"""Fails if code that must give the same bits everywhere uses a fused or an approximate operation.

usage: no_fma.py [LIBRARY]

Without a library the sources are read; of a library, what the compiler made of them.
"""
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ("include", "src")
# Whole words: Highway's fused and approximate operations, their intrinsics, the C and C++ functions. Trees that are
# solved approximately have a name that begins alike.
FORBIDDEN = re.compile(
    r"\b(?:(?:Neg)?Mul(?:Add|Sub)\w*|Approximate(?!Trees?\b)\w*|MulAddSub"
    r"|fmaf?l?|rsqrt\w*|rcp\w*"
    r"|(?:_mm\d*|__builtin_ia32|v)_?\w*(?:fmadd|fmsub|fnmadd|fnmsub|rsqrt|rcp)\w*"
    r"|ffast_math|fast_math)\b"
)

# Of x86 and of ARM, as objdump writes them behind a tab.
FUSED_INSTRUCTION = re.compile(r"\tv?f(?:n?m(?:add|sub)|ml[as])\w*\b")
SKIPPED = 77


def offenses(text):
    for number, line in enumerate(text.splitlines(), 1):
        match = FORBIDDEN.search(line)
        if match:
            yield number, match[0]


def self_check():
    bad = ("MulAdd(a, b, c)", "hn::NegMulAdd(a, b, c)", "hn::MulSub(x)", "ApproximateReciprocalSqrt(v)",
           "std::fma(a, b, c)", "fmaf(a, b, c)", "_mm256_fmadd_ps(a, b, c)", "_mm_rsqrt_ss(a)", "_mm_rcp_ps(a)")
    good = ("hn::Mul(a, b)", "hn::Add(a, b)", "format(x)", "TreeLanes<ApproximateTrees>", "fmax(a, b)", "std::sqrt(x)", "source", "parcel")
    code = ("\tvfmaddsub231ps %xmm1,%xmm2,%xmm0", "\tvfnmadd132sd (%rax),%xmm1,%xmm0", "\tfmla v0.4s, v1.4s, v2.4s")
    other = ("\tvaddsubps %xmm1,%xmm2,%xmm0", "\tmulps %xmm1,%xmm0", "\tfmul v0.4s, v1.4s, v2.4s")
    return (all(list(offenses(s)) for s in bad) and not any(list(offenses(s)) for s in good) and
            all(FUSED_INSTRUCTION.search(s) for s in code) and not any(FUSED_INSTRUCTION.search(s) for s in other))


def fused_instructions(library):
    """The functions of the library that have any, each once."""
    found, function = [], "?"
    command = ["objdump", "--disassemble", "--demangle", "--no-show-raw-insn", library]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as objdump:
        for line in objdump.stdout:
            if line.endswith(">:\n"):
                function = line[line.index("<") + 1:-3]
            elif FUSED_INSTRUCTION.search(line) and function not in found:
                found.append(function)
    if objdump.returncode != 0:
        sys.exit(f"no_fma: objdump cannot read {library}")
    return found


def check_library(library):
    if not shutil.which("objdump"):
        print("no_fma: no objdump here")
        return SKIPPED
    fused = fused_instructions(library)
    print("\n".join(f"fused instructions in {function}" for function in fused) or "no_fma: ok")
    return 1 if fused else 0


def main():
    if not self_check():
        sys.exit("no_fma: the pattern no longer tells good from bad")
    if len(sys.argv) > 1:
        return check_library(sys.argv[1])
    errors = [f"{path.relative_to(ROOT)}:{number}: '{word}' gives other bits on other machines"
              for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*.[hc]*"))
              for number, word in offenses(path.read_text())]
    print("\n".join(errors) or "no_fma: ok")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
