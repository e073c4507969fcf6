#!/usr/bin/env bash
# From a fresh Debian 12 to a picture: installs the packages, builds, bakes the built-in room, renders it
# from the bake and as a path-traced truth, and writes how far apart they are.
# Then hair of four samples a pixel: averaged, filtered by the network, and as it should be.
# Result: out/room.png, out/room_reference.png, out/room_heatmap.png, out/report.html,
#         out/hair_average.png, out/hair_unet.png, out/hair_truth.png
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Sizes for two CPU cores, where all that follows the build takes one to two minutes. On a GPU, raise them.
scene=builtin:room
size=480x360          # of the pictures
atlas=128             # texels per side
lightfield=16         # directions per side and texel
samples=8             # paths per direction
steps=600             # of the fit
truth_samples=256     # paths per pixel
exposure=0            # stops
hair=(builtin:wavy --strands 8000 --size 480x288)
hair_truth_samples=256 # per pixel

samples/install_packages.sh

echo "== building into build/"
cmake -S . -B build -G Ninja
cmake --build build --target strandlight hello_graph bake_and_shade

started=$SECONDS
mkdir -p out
strandlight=build/bin/strandlight

echo "== baking $scene"
"$strandlight" bake "$scene" -o out/room.sgl --atlas "$atlas" --lightfield "$lightfield" \
    --spp "$samples" --steps "$steps" --json out/room_bake.json
echo "== rendering it from the bake"
"$strandlight" render "$scene" --bake out/room.sgl -o out/room.exr -o out/room.png \
    --size "$size" --exposure "$exposure" --stats --json out/room_render.json
echo "== path tracing the truth"
"$strandlight" reference "$scene" -o out/room_reference.exr -o out/room_reference.png \
    --size "$size" --exposure "$exposure" --spp "$truth_samples" --json out/room_reference.json
"$strandlight" compare out/room.exr out/room_reference.exr --exposure "$exposure" \
    --heatmap out/room_heatmap.png --json out/room_compare.json
"$strandlight" report --render out/room.exr --reference out/room_reference.exr \
    --exposure "$exposure" --title "The built-in room" \
    --results out/room_bake.json out/room_render.json out/room_reference.json -o out/report.html

echo "== hair: four samples averaged, filtered, and its truth"
"$strandlight" hair render "${hair[@]}" --filter average -o out/hair_average.exr -o out/hair_average.png
"$strandlight" hair render "${hair[@]}" --filter unet -o out/hair_unet.exr -o out/hair_unet.png
"$strandlight" hair reference "${hair[@]}" --spp "$hair_truth_samples" -o out/hair_truth.exr -o out/hair_truth.png
for filter in average unet; do
    echo "hair, $filter, against its truth:"
    "$strandlight" compare "out/hair_$filter.exr" out/hair_truth.exr
done
echo "== $((SECONDS - started)) s after the build; open out/report.html"
