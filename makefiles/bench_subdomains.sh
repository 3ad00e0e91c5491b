#!/usr/bin/env bash
# make bench-subdomains: domain decomposition against the direct solver; writes docs/benchmarks/subdomains.md.
# Faster, with fewer plates: makefiles/bench_subdomains.sh build --cells 70 --large 0
set -euo pipefail
cd "$(dirname "$0")/.."
source makefiles/mpi_environment.sh
cmake --build "${1:-build}" --target subdomains
exec /usr/bin/python3 tests/benchmark/subdomains.py --program "${1:-build}/tests/subdomains" --out docs/benchmarks "${@:2}"
