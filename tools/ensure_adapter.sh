#!/usr/bin/env bash
# ensure_adapter.sh PYTHON: makes sure that WebGPU finds something to draw with.
# A machine without a graphics card draws on the CPU through Mesa's software Vulkan driver, which this installs
# where it may (apt-get, as root or with a sudo that asks nothing); anywhere else it says what to install.
set -euo pipefail
python="$1"

complaints="$(mktemp)"
trap 'rm -f "$complaints"' EXIT

has_adapter() {
    # The OpenGL back end of wgpu lacks what Pellucid needs, so it does not count.
    "$python" - <<'PYTHON' 2>"$complaints"
import sys
import wgpu
backends = {adapter.info.get("backend_type") for adapter in wgpu.gpu.enumerate_adapters_sync()}
sys.exit(backends.isdisjoint({"Vulkan", "Metal", "D3D12"}))
PYTHON
}

remedy() {
    echo "Pellucid found no graphics adapter (Vulkan, Metal or Direct3D 12)."
    case "$(uname -s)" in
        Linux)
            echo "Without a graphics card, install Mesa's software Vulkan driver:"
            echo "  Debian, Ubuntu:  sudo apt-get install mesa-vulkan-drivers libvulkan1"
            echo "  Fedora:          sudo dnf install mesa-vulkan-drivers vulkan-loader"
            echo "  Arch:            sudo pacman -S vulkan-swrast vulkan-icd-loader"
            echo "  Alpine:          sudo apk add mesa-vulkan-swrast vulkan-loader"
            ;;
        Darwin) echo "Metal should always be there on macOS 11 or newer; is this a virtual machine without graphics?" ;;
        *) echo "Update the graphics driver, or install a Vulkan driver for this system." ;;
    esac
}

has_adapter && exit 0
if ! "$python" -c 'import wgpu' 2>"$complaints"; then
    tail -n 1 "$complaints" >&2
    echo "wgpu, the WebGPU package, does not load in this environment." >&2
    exit 1
fi

as_root=()
if [[ "$(id -u)" != 0 ]]; then
    if ! sudo -n true 2>/dev/null; then
        remedy >&2
        exit 1
    fi
    as_root=(sudo -n)
fi
if ! command -v apt-get >/dev/null; then
    remedy >&2
    exit 1
fi

echo "no graphics adapter: installing Mesa's software Vulkan driver"
# A package list that fails to refresh (one broken source of many) need not stop the installation.
if ! log="$({ "${as_root[@]}" apt-get update -qq || true
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -qq --no-install-recommends mesa-vulkan-drivers libvulkan1; } 2>&1)"; then
    echo "$log" | tail -n 5 >&2
    remedy >&2
    exit 1
fi

if ! has_adapter; then
    remedy >&2
    echo "The driver was installed, but WebGPU still sees no adapter." >&2
    exit 1
fi
