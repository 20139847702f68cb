#!/usr/bin/env python3
"""Fails if code that must give the same bits everywhere uses a fused or an approximate operation."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ("include", "src")
# Whole words: Highway's fused and approximate operations, their intrinsics, the C and C++ functions.
FORBIDDEN = re.compile(
    r"\b(?:(?:Neg)?Mul(?:Add|Sub)\w*|Approximate\w*|MulAddSub"
    r"|fmaf?l?|rsqrt\w*|rcp\w*"
    r"|(?:_mm\d*|__builtin_ia32|v)_?\w*(?:fmadd|fmsub|fnmadd|fnmsub|rsqrt|rcp)\w*"
    r"|ffast_math|fast_math)\b"
)


def offenses(text):
    for number, line in enumerate(text.splitlines(), 1):
        match = FORBIDDEN.search(line)
        if match:
            yield number, match[0]


def self_check():
    bad = ("MulAdd(a, b, c)", "hn::NegMulAdd(a, b, c)", "hn::MulSub(x)", "ApproximateReciprocalSqrt(v)",
           "std::fma(a, b, c)", "fmaf(a, b, c)", "_mm256_fmadd_ps(a, b, c)", "_mm_rsqrt_ss(a)", "_mm_rcp_ps(a)")
    good = ("hn::Mul(a, b)", "hn::Add(a, b)", "format(x)", "fmax(a, b)", "std::sqrt(x)", "source", "parcel")
    return all(list(offenses(s)) for s in bad) and not any(list(offenses(s)) for s in good)


def main():
    if not self_check():
        sys.exit("no_fma: the pattern no longer tells good from bad")
    errors = [f"{path.relative_to(ROOT)}:{number}: '{word}' gives other bits on other machines"
              for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*.[hc]*"))
              for number, word in offenses(path.read_text())]
    print("\n".join(errors) or "no_fma: ok")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
