#!/usr/bin/env bash
# Installs what Strandlight is built from, on Debian 12. Does nothing when all of it is there.
#   samples/install_packages.sh           to build and run
#   samples/install_packages.sh --tests   the Vulkan validation layers as well
set -euo pipefail

packages=(
    build-essential cmake ninja-build ca-certificates
    glslang-tools                        # GLSL to SPIR-V, at build time
    libvulkan-dev libvulkan-volk-dev     # headers and loader
    mesa-vulkan-drivers                  # lavapipe, and the drivers of AMD and Intel
    libglm-dev libglfw3-dev libtinygltf-dev libstb-dev libtinyexr-dev
    libcli11-dev nlohmann-json3-dev doctest-dev
)
if [[ "${1:-}" == --tests ]]; then
    packages+=(vulkan-validationlayers)
fi

installed() {
    [[ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" == installed ]]
}

missing=()
for package in "${packages[@]}"; do
    installed "$package" || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
    exit 0
fi

as_root=()
if ((EUID != 0)); then
    if ! command -v sudo >/dev/null; then
        echo "error: these packages are missing and only root can install them: ${missing[*]}" >&2
        echo "       run this script as root, or install sudo" >&2
        exit 1
    fi
    as_root=(sudo)
fi

echo "== installing ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -y -q)
"${apt[@]}" update
"${apt[@]}" install --no-install-recommends "${missing[@]}"
