#!/usr/bin/env bash
# The README's table: bakes real scenes with default settings, renders each from its bake and compares with the truth
# of the same camera. Needs a build (samples/quickstart.sh) and a folder with the scenes:
#   samples/measure_scenes.sh DATA [OUT]      DATA/scenes/*.gltf|glb, DATA/env/std_env.hdr, DATA/reference/*.exr
# Truths are kept in OUT and used again. BAKE_OPTIONS and RENDER_OPTIONS add options, to see what each is worth:
#   BAKE_OPTIONS="--atlas 64" samples/measure_scenes.sh DATA
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

data=${1:?usage: samples/measure_scenes.sh DATA [OUT]}
out=${2:-out/measure}
strandlight=${STRANDLIGHT:-build/bin/strandlight}
size=320x240
truth_samples=${TRUTH_SAMPLES:-1024}
mkdir -p "$out"

field() { # text, first word of the line: the number after it
    awk -v key="$2" '$1 == key { print $2 }' <<<"$1"
}

measure() { # name, scene file, environment or -, camera or -
    local name=$1 scene=$2
    local common=()
    if [[ $3 != - ]]; then common+=(--env "$3"); fi
    local view=(--size "$size")
    if [[ $4 != - ]]; then view+=(--camera "$4"); fi
    local truth=$out/${name}_truth.exr
    if [[ $name == cornell_lambert ]]; then
        truth=$data/reference/cornell_lambert_cycles.exr # Blender Cycles, 7000 samples
    elif [[ ! -e $truth ]]; then
        "$strandlight" reference "$scene" ${common[@]+"${common[@]}"} "${view[@]}" --spp "$truth_samples" \
            -o "$truth" >"$out/$name.log"
    fi
    local bake
    # shellcheck disable=SC2086
    bake=$("$strandlight" bake "$scene" ${common[@]+"${common[@]}"} -o "$out/$name.sgl" ${BAKE_OPTIONS:-})
    # shellcheck disable=SC2086
    "$strandlight" render "$scene" ${common[@]+"${common[@]}"} "${view[@]}" --bake "$out/$name.sgl" \
        -o "$out/$name.exr" -o "$out/$name.png" ${RENDER_OPTIONS:-} >>"$out/$name.log"
    local result
    result=$("$strandlight" compare "$out/$name.exr" "$truth" --heatmap "$out/${name}_heatmap.png")
    printf '| %s | %s | %s | %s | %s | %s |\n' "$name" "$(field "$bake" seconds | tr -d :)" "$(field "$result" FLIP)" \
        "$(field "$result" relMSE)" "$(field "$result" SSIM)" "$(field "$result" PSNR)"
}

echo "| scene | bake, s | FLIP | relMSE | SSIM | PSNR, dB |"
echo "|---|---|---|---|---|---|"
scenes=${SCENES:-cornell_lambert cornellBox room living_room}
for name in $scenes; do
    case $name in
    room) measure "$name" "$data/scenes/room.glb" "$data/env/std_env.hdr" -4,1.6,-3,3,1.5,3,60 ;;
    living_room) measure "$name" "$data/scenes/living_room.glb" "$data/env/std_env.hdr" 0,1.5,1.5,-4,0,-2,60 ;;
    *) measure "$name" "$data/scenes/$name.gltf" - - ;;
    esac
done
