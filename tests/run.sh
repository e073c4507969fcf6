#!/usr/bin/env bash
# Installs what is missing, builds, runs every test and adds up. The last line is
# `N passed, N failed` (test cases). Exit code 1 when one failed, or a program died or hung.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

samples/install_packages.sh --tests

build=build
cmake -S . -B "$build" -G Ninja -DSTRANDLIGHT_BUILD_TESTS=ON
cmake --build "$build"

# Caches stay inside the build folder; vectors as wide as this machine's, as users have them.
export MESA_SHADER_CACHE_DIR="$PWD/$build/cache/mesa"
export XDG_CACHE_HOME="$PWD/$build/cache"
unset LP_NATIVE_VECTOR_WIDTH
mkdir -p "$MESA_SHADER_CACHE_DIR" "$build/test_logs"

passed=0
failed=0
skipped=0

# name, log: adds up doctest's last line; a program without one counts as one failure.
add_counts() {
    local name=$1 log=$2 code=$3 seconds=$4 line
    line=$(sed 's/\x1b\[[0-9;]*m//g' "$log" | grep -E '^\[doctest\] test cases:' | tail -n 1 || true)
    if [[ "$line" =~ \|\ *([0-9]+)\ passed\ *\|\ *([0-9]+)\ failed\ *\|\ *([0-9]+)\ skipped ]]; then
        local p=${BASH_REMATCH[1]} f=${BASH_REMATCH[2]} s=${BASH_REMATCH[3]}
        if ((code != 0 && f == 0)); then
            f=1 # it died after its summary
            echo "$name ended with exit code $code after its summary" >>"$log"
        fi
    else
        local p=0 f=1 s=0
        echo "$name ended with exit code $code before its summary" >>"$log"
    fi
    passed=$((passed + p))
    failed=$((failed + f))
    skipped=$((skipped + s))
    printf '%-9s %4d passed, %d failed, %d skipped  %4d s\n' "$name" "$p" "$f" "$s" "$seconds"
    if ((f > 0)); then
        echo "---- $log, the end of it:"
        tail -n 60 "$log"
        echo "----"
    fi
}

echo "== tests"
log=$build/test_logs/layering.log
if ctest --test-dir "$build" -R '^layering$' --output-on-failure >"$log" 2>&1; then
    echo "layering     1 passed, 0 failed"
    passed=$((passed + 1))
else
    echo "layering     0 passed, 1 failed"
    failed=$((failed + 1))
    cat "$log"
fi

for rung in unit gpu nn render command; do
    program=$build/bin/test_$rung
    log=$build/test_logs/$rung.log
    started=$SECONDS
    code=0
    if [[ -x "$program" ]]; then
        timeout --kill-after=10 600 "$program" >"$log" 2>&1 </dev/null || code=$?
    else
        code=127
        echo "$program was not built" >"$log"
    fi
    add_counts "$rung" "$log" "$code" $((SECONDS - started))
done

if ((skipped > 0)); then
    echo "$passed passed, $failed failed, $skipped skipped"
else
    echo "$passed passed, $failed failed"
fi
((failed == 0))
