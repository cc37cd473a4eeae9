# Sourced by ./reproduce and ./check: installs the Debian packages that are missing.

build_packages="build-essential cmake ninja-build pkg-config git
  libtinygltf-dev libmeshoptimizer-dev libglm-dev libeigen3-dev libopenexr-dev flatbuffers-compiler libflatbuffers-dev libzstd-dev liblz4-dev
  libdeflate-dev libhdf5-dev libpng-dev libwebp-dev nettle-dev libboost-dev libhwy-dev libembree-dev libcli11-dev libfmt-dev liblo-dev libwebsockets-dev nlohmann-json3-dev libjs-three
  libgl-dev libegl-dev libosmesa6-dev libegl1 libegl-mesa0 libgl1-mesa-dri libosmesa6
  libvtk9-dev fonts-liberation2"
test_packages="libcgal-dev libgtest-dev libgmock-dev librapidcheck-dev libexpat1-dev zstd clang-14
  libclang-rt-14-dev clang-format-14 clang-tidy-14 patchelf mandoc groff man-db lintian zsh fish
  gcc-avr avr-libc libsimavr-dev libelf-dev liblo-tools chromium python3-jsonschema python3-websockets
  slurmctld slurmd slurm-client munge procps"

# install_packages NAME…: nothing to do, nothing said; not allowed to, the line to run is printed.
install_packages() {
  local missing=() package
  for package in "$@"; do
    dpkg-query -W -f='${Status}\n' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  local run="apt-get install -y --no-install-recommends ${missing[*]}"
  if [ "$(id -u)" -eq 0 ]; then
    apt-get update && DEBIAN_FRONTEND=noninteractive $run
  elif command -v sudo >/dev/null && { [ -t 0 ] || sudo -n true 2>/dev/null; }; then
    sudo apt-get update && sudo DEBIAN_FRONTEND=noninteractive $run
  else
    printf 'Packages are missing. As root, run:\n  apt-get update && %s\n' "$run" >&2
    return 1
  fi
}
