#!/usr/bin/env bash
# make fuzz: coverage-guided fuzzing (libFuzzer, with the address and undefined-behaviour sanitizers) of what reads files:
# scenes, Gmsh meshes, decks, bulk data, reduced bodies. Begins from tests/fuzz/seeds; what is new stays in build-fuzz/corpus.
# SECONDS_EACH: of each reader (60); 1200 is what a release takes. READERS: some of them. JOBS.
# A crash, a leak of an exception that is no InputError, or ten seconds for one input end it; the input is in build-fuzz.
set -euo pipefail
cd "$(dirname "$0")/.."
build=build-fuzz jobs=${JOBS:-$(nproc)} seconds=${SECONDS_EACH:-60} readers=${READERS:-scene msh inp bdf reduced}
source makefiles/mpi_environment.sh
export OMPI_MCA_mpi_yield_when_idle=0
CC=clang-16 CXX=clang++-16 cmake -S . -B $build -G Ninja -DFLOE_FUZZ=ON >$build.log 2>&1 || { cat $build.log; exit 1; }
rm -f $build.log
cmake --build $build -j "$jobs" --target $(printf 'fuzz_%s ' $readers)
export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=0 UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
# The keys of scenes are the words that a scene is made of.
grep -ohE '"[a-z][A-Za-z_0-9-]*"' src/scene/schema*.cpp | sort -u >$build/scene.dict
failed=0
for reader in $readers; do
  mkdir -p $build/corpus/"$reader"
  dictionary=()
  [ -e $build/"$reader".dict ] && dictionary=(-dict=$build/"$reader".dict)
  [ -e tests/fuzz/"$reader".dict ] && dictionary=(-dict=tests/fuzz/"$reader".dict)
  log=$build/fuzz_$reader.log
  if $build/tests/fuzz/fuzz_"$reader" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=3000 -max_len=65536 \
    -print_final_stats=1 -artifact_prefix=$build/"$reader"- "${dictionary[@]}" \
    $build/corpus/"$reader" tests/fuzz/seeds/"$reader" >"$log" 2>&1; then
    runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
    covered=$(grep -o 'cov: [0-9]*' "$log" | tail -n 1)
    echo "$reader: $runs inputs in $seconds s, no crash, no hang; $covered"
  else
    failed=1
    echo "$reader: failed, see $log"
    grep -aE 'ERROR|SUMMARY|runtime error|what\(\)|Test unit' "$log" | head -n 8
  fi
done
exit $failed
